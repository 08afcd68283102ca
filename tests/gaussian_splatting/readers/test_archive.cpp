// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <sys/stat.h>
#include <zip.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "known_scene.hpp"
#include "readers/scene_archive.hpp"

namespace {

using gs_test::error_of;
using gs_test::known_scene;
using gs_test::load;
using gs_test::options_for;
using gs_test::read_file;
using gs_test::says;
using gs_test::temporary_folder;
using gs_test::write_file;

struct entry {
    std::string name, content;
    mode_t type = S_IFREG;
};

void write_zip(const std::filesystem::path& file, const std::vector<entry>& entries) {
    int code = 0;
    zip_t* const archive = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    REQUIRE(archive != nullptr);
    for (const entry& one : entries) {
        zip_source_t* const bytes = zip_source_buffer(archive, one.content.data(), one.content.size(), 0);
        const auto index = zip_file_add(archive, one.name.c_str(), bytes, ZIP_FL_ENC_UTF_8);
        REQUIRE(index >= 0);
        REQUIRE(zip_file_set_external_attributes(archive, static_cast<zip_uint64_t>(index), 0, ZIP_OPSYS_UNIX,
                                                 (one.type | 0644U) << 16) == 0);
    }
    REQUIRE(zip_close(archive) == 0);
}

/// A Polycam scene as the entries of an archive.
std::vector<entry> scene_entries(const std::string& top, const gs::scene& known) {
    const temporary_folder folder;
    const gs::camera& c = known.train[0].camera;
    gs_test::write_photo(folder / "a.png", known.train[0].pixels);
    const std::string camera =
        "{\"t_00\":1,\"t_01\":0,\"t_02\":0,\"t_03\":0,\"t_10\":0,\"t_11\":1,\"t_12\":0,"
        "\"t_13\":0,\"t_20\":0,\"t_21\":0,\"t_22\":1,\"t_23\":0,\"fx\":" +
        std::to_string(c.fx) + ",\"fy\":50,\"cx\":24,\"cy\":24,\"width\":48,\"height\":48}";
    return {{top + "keyframes/cameras/a.json", camera},
            {top + "keyframes/images/a.png", read_file(folder / "a.png")}};
}

/// Points TMPDIR at a folder of its own, to see what an archive leaves there.
class temporary_files {
  public:
    temporary_files() {
        if (const char* before = std::getenv("TMPDIR")) before_ = before;
        setenv("TMPDIR", folder_.path().c_str(), 1);
    }
    ~temporary_files() {
        if (before_.empty())
            unsetenv("TMPDIR");
        else
            setenv("TMPDIR", before_.c_str(), 1);
    }
    bool are_gone() const { return std::filesystem::is_empty(folder_.path()); }

  private:
    temporary_folder folder_;
    std::string before_;
};

}  // namespace

TEST_CASE("archive: a scene is read from a .zip file, with or without a folder around it") {
    const temporary_folder folder;
    const temporary_files temporary;
    const gs::scene known = known_scene();
    const auto file = folder / "scene.ZIP";
    for (const std::string top : {"", "my scan/", "./"}) {
        CAPTURE(top);
        auto entries = scene_entries(top, known);
        entries.push_back({top + "raw.glb", "not needed"});
        entries.push_back({"__MACOSX/my scan/._a.json", "not needed"});
        entries.push_back({".DS_Store", "not needed"});
        write_zip(file, entries);
        const gs::scene read = load(file);
        REQUIRE(read.train.size() == 1);
        CHECK(gs_test::share_of_differences(read.train[0].pixels, known.train[0].pixels) == 0);
        CHECK(temporary.are_gone());
    }
}

TEST_CASE("archive: errors and messages name the archive, and the temporary files are removed") {
    const temporary_folder folder;
    const temporary_files temporary;
    auto entries = scene_entries("", known_scene());
    const auto file = folder / "scene.zip";
    write_zip(file, {{"keyframes/cameras/a.json", "{}"}, entries[1]});
    CHECK(error_of([&] { load(file); }) ==
          file.string() + "/keyframes/cameras/a.json: the field width is missing");
    CHECK(temporary.are_gone());
    write_zip(file, {{"a/readme.txt", "no scene"}});
    CHECK(says(error_of([&] { load(file); }),
               {file.string() + "/a is not a scene", "keyframes", ".zip archive"}));
    write_zip(file, {{"a.json", "{}"}});
    CHECK(says(error_of([&] { load(file); }), {file.string() + " is not a scene"}));
    write_zip(file, {{"photo.raw", "?"}});
    CHECK(says(error_of([&] { load(file); }), {"scene.zip", "no files of a scene"}));
    CHECK(temporary.are_gone());
}

TEST_CASE("archive: only files of scenes are unpacked") {
    const temporary_folder folder;
    write_zip(folder / "a.zip", {{"b/c.JPG", "1"},
                                 {"b\\d.ply", "2"},
                                 {"b/e.exe", "3"},
                                 {".f/g.png", "4"},
                                 {"b/__MACOSX/h.png", "5"},
                                 {"i.bin", ""},
                                 {"empty/", "", S_IFDIR}});
    std::filesystem::path unpacked;
    {
        const gs::extracted_archive archive(folder / "a.zip");
        unpacked = archive.folder();
        std::vector<std::string> names;
        for (const auto& found : std::filesystem::recursive_directory_iterator(unpacked))
            if (found.is_regular_file())
                names.push_back(found.path().lexically_relative(unpacked).generic_string());
        std::ranges::sort(names);
        CHECK(names == std::vector<std::string>{"b/c.JPG", "b/d.ply", "i.bin"});
        CHECK(read_file(unpacked / "b/d.ply") == "2");
    }
    CHECK_FALSE(std::filesystem::exists(unpacked));
}

TEST_CASE("archive: entries that lead out of the folder, links and doubles are refused") {
    const temporary_folder folder;
    const temporary_files temporary;
    const auto file = folder / "a.zip";
    const auto error_with = [&](const entry& one) {
        write_zip(file, {{"a.json", "{}"}, one});
        return error_of([&] { gs::extracted_archive archive(file); });
    };
    CHECK(error_with({"b.json", ""}).empty());
    CHECK(error_with({"b..json", ""}).empty());
    for (const char* name :
         {"../b.json", "b/../../c.json", "/b.json", "..\\b.json", "\\b.json", "../b.exe", ".."})
        CHECK(says(error_with({name, ""}), {"a.zip", "outside of the archive's folder"}));
    CHECK(says(error_with({"b.json", "/etc/passwd", S_IFLNK}), {"a.zip", "b.json", "symbolic link"}));
    CHECK(says(error_with({"b.json", "", S_IFIFO}), {"b.json", "special file"}));
    CHECK(says(error_with({std::string(5000, 'b') + ".json", ""}), {"bbb", "too long"}));
    CHECK(says(error_with({std::string(300, 'b') + ".json", ""}), {"a.zip"}));
    CHECK(says(error_with({"a.json/b.json", ""}), {"a.zip"}));
    CHECK(says(error_with({"./a.json", ""}), {"a.json", "exists twice"}));
    CHECK(temporary.are_gone());
}

TEST_CASE("archive: too many entries, and sizes beyond the limit, are refused") {
    const temporary_folder folder;
    const temporary_files temporary;
    const auto file = folder / "a.zip";
    const auto error_within = [&](const gs::archive_limits& limits) {
        return error_of([&] { gs::extracted_archive archive(file, limits); });
    };
    write_zip(file, {{"a.bin", std::string(100'000, '\0')}, {"b.bin", std::string(100'000, '\0')}});
    CHECK(error_within({}).empty());
    CHECK(error_within({.entries = 2, .bytes = 200'000}).empty());
    CHECK(says(error_within({.entries = 1}), {"a.zip", "2 entries", "limit of 1"}));
    CHECK(says(error_within({.bytes = 199'999}), {"a.zip", "more than 199999 bytes"}));
    CHECK(says(error_within({.ratio = 10, .always_allowed = 0}),
               {"a.zip", "limit for an archive of its size"}));

    // An archive that declares a smaller size than it has.
    std::string bytes = read_file(file);
    const std::string size("\xA0\x86\x01\x00", 4), lie("\x01\x00\x00\x00", 4);
    for (std::size_t at = bytes.find(size); at != std::string::npos; at = bytes.find(size, at + 1))
        bytes.replace(at, size.size(), lie);
    write_file(file, bytes);
    CHECK(says(error_within({}), {"a.zip", "a.bin", "not of the size that the archive declares"}));
    CHECK(temporary.are_gone());
}

TEST_CASE("archive: damaged archives are refused") {
    const temporary_folder folder;
    const temporary_files temporary;
    const auto file = folder / "a.zip";
    write_zip(file,
              {{"a.json", "{\"a text\": \"that is long enough to be compressed, compressed, compressed\"}"}});
    const std::string whole = read_file(file);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        write_file(file, whole.substr(0, length));
        REQUIRE(says(error_of([&] { gs::extracted_archive archive(file); }), {"a.zip"}));
    }
    std::string changed = whole;
    changed[50] = static_cast<char>(changed[50] ^ 1);
    write_file(file, changed);
    CHECK(says(error_of([&] { gs::extracted_archive archive(file); }), {"a.zip", "a.json", "damaged"}));
    CHECK(says(error_of([&] { gs::extracted_archive archive(folder / "none.zip"); }), {"none.zip"}));
    CHECK_FALSE(gs::is_archive((folder / "none.zip").string()));
    CHECK_FALSE(gs::is_archive(folder.path().string()));
    CHECK(temporary.are_gone());
}
