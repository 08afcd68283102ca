// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "checkpoint_file.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "../core/atomic_file_write.hpp"
#include "../core/error.hpp"
#include "../core/file_bytes.hpp"
#include "../core/parse_json.hpp"

namespace gs {
namespace {

static_assert(std::endian::native == std::endian::little, "safetensors files are little-endian");

using nlohmann::json;

constexpr const char* metadata_key = "__metadata__";
constexpr const char* format_key = "format";
constexpr const char* format = "warpagg checkpoint 1";
constexpr const char* checksum_key = "crc32";
constexpr std::uint64_t most_header_bytes = std::uint64_t{1} << 24;

std::size_t size_of_element(const std::string& element) {
    if (element == "U8") return 1;
    return element == "U64" || element == "F64" ? 8 : 4;
}

std::uint32_t continued(std::uint32_t checksum, const void* bytes, std::size_t count) {
    const auto* next = static_cast<const Bytef*>(bytes);
    while (count > 0) {  // zlib counts in 32 bits
        const auto part = static_cast<uInt>(std::min<std::size_t>(count, std::numeric_limits<uInt>::max()));
        checksum = static_cast<std::uint32_t>(crc32(checksum, next, part));
        next += part;
        count -= part;
    }
    return checksum;
}

/// Returns the checksum of the header, without the checksum itself, and of all arrays.
std::string checksum_of(const json& header, const state_archive::array_map& arrays) {
    const std::string text = header.dump();
    std::uint32_t checksum = continued(0, text.data(), text.size());
    for (const auto& [name, array] : arrays)
        checksum = continued(checksum, array.bytes.data(), array.bytes.size());
    return std::to_string(checksum);
}

/// Returns when the content of a file is on the disk, so that it survives a loss of power.
void flush_to_disk(const std::filesystem::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return;
    fsync(descriptor);
    close(descriptor);
}

/// Reads a checkpoint. Its functions throw `error` for a damaged file.
class checkpoint_reader {
  public:
    explicit checkpoint_reader(const std::filesystem::path& file) : file_(file) {}

    state_archive read() {
        json header = read_header();
        auto values = read_values(header);
        auto arrays = read_arrays(header);
        const auto checksum = values.extract(checksum_key);
        header[metadata_key].erase(checksum_key);
        if (checksum.empty() || checksum.mapped() != checksum_of(header, arrays))
            refuse("its checksum is wrong");
        return {std::move(values), std::move(arrays)};
    }

  private:
    [[noreturn]] void refuse(const std::string& why) const {
        throw error("the checkpoint " + file_.name + " is damaged: " + why);
    }

    void read_bytes(void* to, std::size_t count) {
        file_.in.read(static_cast<char*>(to), static_cast<std::streamsize>(count));
        if (!file_.in) refuse("it is truncated");
    }

    json read_header() {
        std::uint64_t length = 0;
        read_bytes(&length, sizeof length);
        if (length > most_header_bytes || length > file_.size - sizeof length) refuse("it is truncated");
        std::string text(length, '\0');
        read_bytes(text.data(), text.size());
        data_bytes_ = file_.size - sizeof length - length;
        json header = parse_json<json>(text, "the header of the checkpoint " + file_.name);
        if (!header.is_object()) refuse("its header is no JSON object");
        return header;
    }

    state_archive::value_map read_values(const json& header) const {
        state_archive::value_map values;
        if (const auto metadata = header.find(metadata_key);
            metadata != header.end() && metadata->is_object())
            for (const auto& [name, value] : metadata->items())
                if (value.is_string()) values[name] = value.get<std::string>();
        const auto found = values.extract(format_key);
        if (found.empty() || found.mapped() != format)
            throw error(file_.name + " is no checkpoint of this program: its metadata lack the format '" +
                        format + "'");
        return values;
    }

    /// Reads the arrays, which follow one another in the order of their names.
    state_archive::array_map read_arrays(const json& header) {
        state_archive::array_map arrays;
        std::uint64_t first = 0;
        for (const auto& [name, entry] : header.items()) {
            if (name == metadata_key) continue;
            std::string element;
            std::array<std::uint64_t, 2> range{};
            try {
                element = entry.at("dtype").get<std::string>();
                range = entry.at("data_offsets").get<std::array<std::uint64_t, 2>>();
            } catch (const json::exception&) {
                refuse("its header lacks the type or the place of the array '" + name + "'");
            }
            if (range[0] != first || range[1] < first || range[1] > data_bytes_) refuse("it is truncated");
            state_archive::array& array = arrays[name];
            array.element = element;
            array.bytes.resize(range[1] - range[0]);
            if (!array.bytes.empty()) read_bytes(array.bytes.data(), array.bytes.size());
            first = range[1];
        }
        if (first != data_bytes_) refuse("it has " + std::to_string(data_bytes_ - first) + " bytes too many");
        return arrays;
    }

    opened_file file_;
    std::uint64_t data_bytes_ = 0;  ///< number of bytes after the header
};

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const state_archive& archive) {
    json header;
    std::uint64_t first = 0;
    for (const auto& [name, array] : archive.arrays()) {
        const std::uint64_t end = first + array.bytes.size();
        header[name] = {{"dtype", array.element},
                        {"shape", {array.bytes.size() / size_of_element(array.element)}},
                        {"data_offsets", {first, end}}};
        first = end;
    }
    header[metadata_key] = archive.values();
    header[metadata_key][format_key] = format;
    header[metadata_key][checksum_key] = checksum_of(header, archive.arrays());
    std::string text = header.dump();
    text.resize((text.size() + 7) / 8 * 8, ' ');  // aligns the arrays
    atomic_file_write(file, [&](std::ostream& out) {
        const std::uint64_t length = text.size();
        out.write(reinterpret_cast<const char*>(&length), sizeof length);
        out.write(text.data(), static_cast<std::streamsize>(text.size()));
        for (const auto& [name, array] : archive.arrays())
            out.write(reinterpret_cast<const char*>(array.bytes.data()),
                      static_cast<std::streamsize>(array.bytes.size()));
    });
    flush_to_disk(file);
}

state_archive read_checkpoint(const std::filesystem::path& file) { return checkpoint_reader(file).read(); }

}  // namespace gs
