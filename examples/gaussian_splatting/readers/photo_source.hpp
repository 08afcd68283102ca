// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fit_to_files.hpp"
#include "reader.hpp"

namespace gs {

/// The files of a photo, and how to make a view's photo from them.
struct photo_source {
    image_record record;
    fitted_photo fitted;
    camera pinhole;  ///< of the undistorted photo
    camera scaled;   ///< of the view

    /// Reads the files, removes lens distortion, applies the mask, and downsamples. Throws `error`
    /// with the name of a file that cannot be used.
    photo load() const;
    /// Like the function above, but replaces `result` and reuses its memory.
    void load(photo& result) const;
};

/// Returns the view with its photo.
view resident_view(const photo_source& source);
/// Returns the view without its photo, which it decodes on request. Loads the photo once, to check it.
/// `view::decode` throws `error` if the size or the time of a file differs from those at this call.
view streamed_view(std::shared_ptr<const photo_source> source);

}  // namespace gs
