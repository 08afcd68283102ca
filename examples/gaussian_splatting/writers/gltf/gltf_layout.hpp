// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "../../model/gaussians.hpp"

namespace gs {

inline constexpr const char* gltf_extension = "KHR_gaussian_splatting";

/// The beginning of a .glb file, and of each of its two chunks.
struct glb_header {
    std::uint32_t magic = 0x46546c67;  ///< "glTF"
    std::uint32_t version = 2;
    std::uint32_t size = 0;  ///< of the file
};
struct glb_chunk {
    std::uint32_t size = 0;
    std::uint32_t type = 0;
};
inline constexpr std::uint32_t glb_json = 0x4e4f534a, glb_binary = 0x004e4942;
inline constexpr int gltf_float = 5126, gltf_unsigned_byte = 5121;  ///< types of components

/// How floats in the file become floats of the model.
enum class gltf_encoding { plain, exponential, sigmoid, rotation };

/// An attribute: its name, and its floats in the file and in the model.
struct gltf_attribute {
    std::string name;
    const char* type;  ///< of the accessor
    std::vector<float> gaussians::*array;
    std::size_t width;               ///< floats per Gaussian in the file
    std::size_t first, model_width;  ///< position of the first float in the model, and floats per Gaussian
    gltf_encoding encoding;
    std::array<float, 4> sign;  ///< between the axes of the model and of glTF
};

/// Returns the attributes of an SH degree, 0 to 3. `model_degree`: the SH degree of the model.
std::vector<gltf_attribute> gltf_attributes(int sh_degree, int model_degree);

}  // namespace gs
