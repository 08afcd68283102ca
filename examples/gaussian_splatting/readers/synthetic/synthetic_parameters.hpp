// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace gs {

/// The content of a synthetic scene and the properties of its photos. By default surfaces are
/// matte, and all photos have the same distance and exposure and no noise.
struct synthetic_parameters {
    std::string world;
    double gloss = 0;       ///< share of specular reflection, 0 to 1
    double exposure = 0;    ///< standard deviation of log2 of the brightness of photos, 0 to 2
    double scales = 1;      ///< ratio of the largest and smallest camera distance, 1 to 16
    double distance = 1;    ///< factor of all camera distances, 0.25 to 16
    double passers = 0;     ///< share of each photo that a masked disc hides, 0 to 0.5
    double moving = 0;      ///< share of the training photos in which a moving thing hides a part, 0 to 1
    double blur = 0;        ///< largest motion blur of the training photos, as if 128 pixels wide, 0 to 32
    double shutter = 0;     ///< largest rolling-shutter shift, from the first row to the last, -32 to 32
    double vignetting = 0;  ///< share of the light that is lost in the corners, as displayed, 0 to 0.8
    double response = 0;    ///< strength of the tone curve of the camera, 0 to 1
    double depths = -1;     ///< relative noise of depth maps, 0 to 10; negative for no depth maps
    double sky = 0;         ///< brightness of the sky, which depends only on direction, 0 to 1
    double walls = 0;       ///< brightness of smooth walls around scene and cameras, 0 to 1; 0 for none
    double points = 3000;   ///< number of points, 1 to 100000
    double views = 48;      ///< largest number of training images, 1 to 48
    double fisheye = 0;     ///< degrees across a fisheye image, 0 to 190; 0 for pinhole cameras
    double panorama = 0;    ///< 1 for panoramas, which are twice as wide as high; otherwise 0
    double poses = 0;       ///< error of given poses: degrees, and percent of the cameras' distance, 0 to 5
    double noise = 0;       ///< standard deviation of the noise of colors in [0, 1], 0 to 0.5
};

/// Parses "WORLD", "WORLD,gloss=0.5,noise=0.02" and so on. Throws `error` for a parameter that is
/// unknown, repeated or out of range, for panoramas together with a fisheye lens, vignetting or a
/// response, for a sky together with walls, and for moving cameras without a pinhole. Does not check `world`.
synthetic_parameters parse_synthetic(const std::string& text);

}  // namespace gs
