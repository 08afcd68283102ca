// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../core/file_bytes.hpp"

namespace gs::evaluate {

/// A file in the safetensors format: 8 bytes with the length of a header, the header as JSON, and
/// the values of the tensors in little-endian order.
class safetensors_file {
  public:
    /// Opens a file and reads its header. Throws `error` with the file's name if it cannot be read,
    /// or if the header is malformed or longer than 64 KiB.
    explicit safetensors_file(const std::filesystem::path& file);

    /// Returns the values of a tensor, in C order. Throws `error` with the names of the file and of
    /// the tensor if it is missing, has another shape, is not stored as float32, ends after the
    /// file, or contains a value that is not finite.
    std::vector<float> read(const std::string& tensor, const std::vector<std::size_t>& shape);

    /// Returns an entry of the header's metadata, or an empty string.
    std::string metadata(const std::string& key) const;

  private:
    /// Returns the position of the tensor's values in the file.
    std::uint64_t find(const std::string& tensor, const std::vector<std::size_t>& shape,
                       std::uint64_t bytes) const;

    opened_file file_;
    nlohmann::json header_;
    std::uint64_t values_begin_ = 0;
};

}  // namespace gs::evaluate
