// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "scene_archive.hpp"

#include <sys/stat.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string_view>
#include <vector>

#include "../core/error.hpp"
#include "../core/sanitize_for_message.hpp"
#include "../image/image.hpp"
#include "validation.hpp"

namespace gs {
namespace {

/// The endings of files that scenes need besides images.
constexpr std::string_view other_endings[] = {".json", ".bin", ".txt", ".ply"};

std::string in_lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

bool is_hidden(const std::filesystem::path& part) {
    return part.string().starts_with('.') || part == "__MACOSX";
}

bool is_used(const std::filesystem::path& name) {
    const std::string ending = in_lower_case(name.extension().string());
    const auto images = image_endings();
    const bool has_use = std::ranges::find(other_endings, ending) != std::end(other_endings) ||
                         std::ranges::find(images, ending) != images.end();
    return has_use && std::ranges::none_of(name, is_hidden);
}

class zip_reader {
  public:
    zip_reader(const std::filesystem::path& file, const archive_limits& limits) : where_(file.string()) {
        int code = 0;
        zip_.reset(zip_open(file.c_str(), ZIP_RDONLY, &code));
        if (!zip_) {
            zip_error_t problem;
            zip_error_init_with_code(&problem, code);
            const std::string text = zip_error_strerror(&problem);
            zip_error_fini(&problem);
            throw error("cannot read the archive " + where_ + ": " + text);
        }
        most_bytes_ =
            std::min(limits.bytes, limits.always_allowed + limits.ratio * std::filesystem::file_size(file));
        count_ = static_cast<std::uint64_t>(zip_get_num_entries(zip_.get(), 0));
        if (count_ > limits.entries)
            throw error(where_ + " has " + std::to_string(count_) + " entries, more than the limit of " +
                        std::to_string(limits.entries));
    }

    /// Unpacks the used files. Checks all entries before it writes any.
    void extract_to(const std::filesystem::path& folder) {
        std::vector<entry> entries;
        for (std::uint64_t i = 0; i < count_; ++i)
            if (auto found = check(i); is_used(found.name)) entries.push_back(std::move(found));
        if (entries.empty()) throw error(where_ + " has no files of a scene");
        std::uint64_t declared = 0;
        for (const entry& one : entries) {
            if (one.size > most_bytes_ - declared) refuse_size();
            declared += one.size;
        }
        if (const auto space = std::filesystem::space(folder); space.available < declared)
            throw error(where_ + " unpacks to " + std::to_string(declared) + " bytes, but " +
                        folder.parent_path().string() + " has only " + std::to_string(space.available) +
                        " bytes left; set TMPDIR to a folder with more space");
        for (const entry& one : entries) extract(one, folder);
    }

  private:
    struct entry {
        std::uint64_t index;
        std::filesystem::path name;
        std::uint64_t size;  ///< as the archive declares it
    };

    [[noreturn]] void refuse(const std::filesystem::path& name, const std::string& why) const {
        throw error(where_ + ": the entry " + sanitize_for_message(name.string()) + " " + why);
    }

    [[noreturn]] void refuse_size() const {
        throw error(where_ + " unpacks to more than " + std::to_string(most_bytes_) +
                    " bytes, the limit for an archive of its size");
    }

    entry check(std::uint64_t index) const {
        zip_stat_t stat;
        if (zip_stat_index(zip_.get(), index, 0, &stat) != 0 || (stat.valid & ZIP_STAT_NAME) == 0)
            throw error(where_ + ": entry " + std::to_string(index) + " cannot be read");
        std::string name = stat.name;
        std::ranges::replace(name, '\\', '/');  // as some programs on Windows separate folders
        if (name.size() > longest_path) refuse(name, "has a name that is too long");
        const std::filesystem::path path(name);
        if (path.is_absolute() || std::ranges::find(path, "..") != path.end())
            refuse(path, "lies outside of the archive's folder");
        if (is_link(index)) refuse(path, "is a symbolic link or a special file");
        return {index, path.lexically_normal(), (stat.valid & ZIP_STAT_SIZE) != 0 ? stat.size : 0};
    }

    bool is_link(std::uint64_t index) const {
        zip_uint8_t system = 0;
        zip_uint32_t attributes = 0;
        if (zip_file_get_external_attributes(zip_.get(), index, 0, &system, &attributes) != 0) return false;
        const auto type = static_cast<mode_t>(attributes >> 16) & S_IFMT;
        return system == ZIP_OPSYS_UNIX && type != 0 && type != S_IFREG && type != S_IFDIR;
    }

    void extract(const entry& one, const std::filesystem::path& folder) {
        const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> in(zip_fopen_index(zip_.get(), one.index, 0),
                                                                    zip_fclose);
        if (!in) refuse(one.name, "cannot be read: " + std::string(zip_strerror(zip_.get())));
        const auto file = folder / one.name;
        std::filesystem::create_directories(file.parent_path());
        if (std::filesystem::exists(file)) refuse(one.name, "exists twice");
        std::ofstream out(file, std::ios::binary);
        std::array<char, 1 << 14> bytes;
        zip_int64_t read = 0;
        std::uint64_t size = 0;
        while ((read = zip_fread(in.get(), bytes.data(), bytes.size())) > 0) {
            size += static_cast<std::uint64_t>(read);
            if (size > one.size) break;
            out.write(bytes.data(), static_cast<std::streamsize>(read));
        }
        if (read < 0) refuse(one.name, "is damaged: " + std::string(zip_file_strerror(in.get())));
        if (size != one.size) refuse(one.name, "is not of the size that the archive declares");
        out.close();
        if (!out) throw error("cannot write " + file.string() + ": the disk may be full; set TMPDIR");
    }

    std::string where_;
    std::unique_ptr<zip_t, decltype(&zip_discard)> zip_{nullptr, zip_discard};
    std::uint64_t count_ = 0, most_bytes_ = 0;
};

std::filesystem::path make_temporary_folder() {
    std::string name = (std::filesystem::temp_directory_path() / "gaussian_splatting_XXXXXX").string();
    if (!mkdtemp(name.data())) throw error("cannot make the temporary folder " + name + "; set TMPDIR");
    return name;
}

}  // namespace

bool is_archive(const std::string& data) {
    std::error_code ignored;
    return in_lower_case(data).ends_with(".zip") && std::filesystem::is_regular_file(data, ignored);
}

extracted_archive::extracted_archive(const std::filesystem::path& archive, const archive_limits& limits)
    : archive_(archive) {
    zip_reader reader(archive, limits);
    folder_ = make_temporary_folder();
    try {
        reader.extract_to(folder_);
    } catch (const std::filesystem::filesystem_error& problem) {
        remove_folder();
        throw error("cannot unpack " + archive.string() + " to " + problem.path1().string() + ": " +
                    problem.code().message());
    } catch (...) {
        remove_folder();
        throw;
    }
}

extracted_archive::~extracted_archive() { remove_folder(); }

void extracted_archive::remove_folder() const {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path extracted_archive::only_folder() const {
    const std::filesystem::directory_iterator entries(folder_);
    const std::filesystem::path first = entries->path();
    return std::distance(entries, {}) == 1 && std::filesystem::is_directory(first) ? first : folder_;
}

std::string extracted_archive::with_archive_name(std::string message) const {
    const std::string temporary = folder_.string(), shown = archive_.string();
    for (std::size_t at = message.find(temporary); at != std::string::npos;
         at = message.find(temporary, at + shown.size()))
        message.replace(at, temporary.size(), shown);
    return message;
}

}  // namespace gs
