// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "zip_bundle.hpp"

#include <zip.h>

#include <new>

#include "../../core/error.hpp"
#include "../../core/file_bytes.hpp"
#include "../../core/sanitize_for_message.hpp"

namespace gs {

std::string zip_of(std::span<const bundled_file> files) {
    zip_error_t problem;
    zip_error_init(&problem);
    // Building an archive in memory fails only without memory.
    zip_source_t* const source = zip_source_buffer_create(nullptr, 0, 0, &problem);
    if (!source) throw std::bad_alloc();
    zip_source_keep(source);
    const std::unique_ptr<zip_source_t, decltype(&zip_source_free)> kept(source, zip_source_free);
    zip_t* const archive = zip_open_from_source(source, ZIP_TRUNCATE, &problem);
    if (!archive) throw std::bad_alloc();
    for (const bundled_file& file : files) {
        zip_source_t* const content = zip_source_buffer(archive, file.bytes.data(), file.bytes.size(), 0);
        const zip_int64_t index = zip_file_add(archive, file.name.c_str(), content, ZIP_FL_ENC_UTF_8);
        constexpr time_t any_time = 315532800;  // the beginning of 1980, so that archives are equal
        if (index < 0 ||
            zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0) != 0 ||
            zip_file_set_mtime(archive, static_cast<zip_uint64_t>(index), any_time, 0) != 0) {
            zip_discard(archive);
            throw std::bad_alloc();
        }
    }
    if (zip_close(archive) != 0) {
        zip_discard(archive);
        throw std::bad_alloc();
    }
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_source_stat(source, &stat) != 0 || zip_source_open(source) != 0) throw std::bad_alloc();
    std::string bytes(stat.size, '\0');
    const zip_int64_t read = zip_source_read(source, bytes.data(), bytes.size());
    zip_source_close(source);
    if (read != static_cast<zip_int64_t>(bytes.size())) throw std::bad_alloc();
    return bytes;
}

zip_bundle::zip_bundle(const std::filesystem::path& file) : where_(file.string()) {
    const opened_file readable(file);  // for the message of the system
    int code = 0;
    archive_ = {zip_open(file.c_str(), ZIP_RDONLY, &code), [](zip_t* z) {
                    if (z) zip_discard(z);
                }};
    if (!archive_) throw error(where_ + ": it is not a .zip archive, or is damaged");
}

std::string zip_bundle::read(const std::string& name, std::uint64_t most) const {
    const auto fail = [&](const std::string& what) {
        throw error(where_ + ": its file '" + sanitize_for_message(name) + "' " + what);
    };
    const zip_int64_t index = zip_name_locate(archive_.get(), name.c_str(), 0);
    if (index < 0) fail("does not exist");
    zip_stat_t stat;
    if (zip_stat_index(archive_.get(), static_cast<zip_uint64_t>(index), 0, &stat) != 0 ||
        (stat.valid & ZIP_STAT_SIZE) == 0)
        fail("is damaged");
    if (stat.size > most) fail("has " + std::to_string(stat.size) + " bytes, which is too much");
    const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> in(
        zip_fopen_index(archive_.get(), static_cast<zip_uint64_t>(index), 0), zip_fclose);
    if (!in) fail("cannot be read");
    std::string bytes(stat.size, '\0');
    // The read past the end checks the checksum.
    char beyond = 0;
    if (zip_fread(in.get(), bytes.data(), bytes.size()) != static_cast<zip_int64_t>(bytes.size()) ||
        zip_fread(in.get(), &beyond, 1) != 0)
        fail("is damaged");
    return bytes;
}

}  // namespace gs
