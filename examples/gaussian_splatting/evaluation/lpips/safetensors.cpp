// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "safetensors.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "../../core/error.hpp"
#include "../../core/sanitize_for_message.hpp"

namespace gs::evaluate {

namespace {

using nlohmann::json;

constexpr std::uint64_t longest_header = 64 << 10;

/// Returns two positions [begin, end) relative to the first value, or an empty range if `offsets`
/// does not specify one.
std::pair<std::uint64_t, std::uint64_t> range_of(const json& offsets) {
    if (!offsets.is_array() || offsets.size() != 2 ||
        !std::ranges::all_of(offsets, [](const json& one) { return one.is_number_unsigned(); }))
        return {0, 0};
    return {offsets[0].get<std::uint64_t>(), offsets[1].get<std::uint64_t>()};
}

}  // namespace

safetensors_file::safetensors_file(const std::filesystem::path& file) : file_(file) {
    static_assert(std::endian::native == std::endian::little);
    std::uint64_t length = 0;
    file_.in.read(reinterpret_cast<char*>(&length), sizeof length);
    if (!file_.in || length > longest_header || length > file_.size - sizeof length)
        throw error(file_.name +
                    " is not a safetensors file: its header does not fit into the file or into " +
                    std::to_string(longest_header) + " bytes");
    std::string text(length, '\0');
    file_.in.read(text.data(), static_cast<std::streamsize>(length));
    if (!file_.in) throw error("cannot read " + file_.name);
    header_ = json::parse(text, nullptr, false);
    if (!header_.is_object())
        throw error(file_.name + " is not a safetensors file: its header is not a JSON object");
    values_begin_ = sizeof length + length;
}

std::vector<float> safetensors_file::read(const std::string& tensor, const std::vector<std::size_t>& shape) {
    std::size_t count = 1;
    for (const std::size_t extent : shape) count *= extent;
    file_.in.seekg(static_cast<std::streamoff>(find(tensor, shape, count * sizeof(float))));
    std::vector<float> values(count);
    file_.in.read(reinterpret_cast<char*>(values.data()),
                  static_cast<std::streamsize>(count * sizeof(float)));
    if (!file_.in) throw error("cannot read the tensor " + tensor + " of " + file_.name);
    if (!std::ranges::all_of(values, [](float value) { return std::isfinite(value); }))
        throw error(file_.name + ": the tensor " + tensor + " contains a value that is not finite");
    return values;
}

std::uint64_t safetensors_file::find(const std::string& tensor, const std::vector<std::size_t>& shape,
                                     std::uint64_t bytes) const {
    const auto entry = header_.find(tensor);
    if (entry == header_.end() || !entry->is_object())
        throw error(file_.name + " has no tensor " + tensor +
                    ": create the file with scripts/convert_lpips_weights.py");
    const json found_shape = entry->value("shape", json()), type = entry->value("dtype", json());
    if (found_shape != json(shape))
        throw error(file_.name + ": the tensor " + tensor + " has the shape " +
                    sanitize_for_message(found_shape.dump()) + " instead of " + json(shape).dump());
    if (type != "F32")
        throw error(file_.name + ": the tensor " + tensor + " has the type " +
                    sanitize_for_message(type.dump()) + " instead of \"F32\"");
    const auto [begin, end] = range_of(entry->value("data_offsets", json()));
    if (end < begin || end - begin != bytes || end > file_.size - values_begin_)
        throw error(file_.name + ": the offsets of the tensor " + tensor +
                    " do not match its shape or exceed the file");
    return values_begin_ + begin;
}

std::string safetensors_file::metadata(const std::string& key) const {
    const json all = header_.value("__metadata__", json());
    if (!all.is_object()) return "";
    const json found = all.value(key, json());
    return found.is_string() ? found.get<std::string>() : "";
}

}  // namespace gs::evaluate
