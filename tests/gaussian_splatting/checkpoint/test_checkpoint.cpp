// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "checkpoint/checkpoint_file.hpp"
#include "checkpoint/checkpoint_folder.hpp"

namespace fs = std::filesystem;
using gs::state_archive;
using gs_test::error_of;
using gs_test::says;
using gs_test::temporary_folder;

namespace {

struct sample {
    bool flag = true;
    int number = -7;
    std::uint64_t large = std::numeric_limits<std::uint64_t>::max();
    double tiny = std::numeric_limits<double>::denorm_min();
    double third = 1.0 / 3;
    std::string text = "a \"text\"\nin two lines";
    std::vector<float> floats{0.0f, -0.0f, 1e-45f, 3.4e38f};
    std::vector<std::uint32_t> numbers{1, 2, 3};
    std::vector<std::uint64_t> none;

    bool operator==(const sample&) const = default;

    void exchange(state_archive& archive) {
        archive.exchange("flag", flag);
        const state_archive::scope scope(archive, "inner");
        archive.exchange("number", number);
        archive.exchange("large", large);
        archive.exchange("tiny", tiny);
        archive.exchange("third", third);
        archive.exchange("text", text);
        archive.exchange("floats", floats);
        archive.exchange("numbers", numbers);
        archive.exchange("none", none);
    }
};

state_archive saved(sample s = {}) {
    state_archive archive;
    s.exchange(archive);
    return archive;
}

sample loaded(state_archive archive) {
    sample s{false, 0, 0, 0, 0, "", {}, {}, {9}};
    s.exchange(archive);
    return s;
}

}  // namespace

TEST_CASE("a checkpoint file returns values and arrays exactly") {
    const temporary_folder folder;
    const fs::path file = folder / "state.safetensors";
    gs::write_checkpoint(file, saved());
    CHECK(loaded(gs::read_checkpoint(file)) == sample());
    CHECK(fs::file_size(file) % 4 == 0);
}

TEST_CASE("a checkpoint file is a safetensors file") {
    const temporary_folder folder;
    const fs::path file = folder / "state.safetensors";
    gs::write_checkpoint(file, saved());
    const std::string bytes = gs_test::read_file(file);
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data(), sizeof length);
    REQUIRE(length < bytes.size());
    CHECK(length % 8 == 0);
    const std::string header = bytes.substr(8, length);
    CHECK(says(header, {"\"__metadata__\"", "\"format\":\"warpagg checkpoint 1\"",
                        R"("inner.floats":{"data_offsets":[0,16],"dtype":"F32","shape":[4]})"}));
    float third = 0;
    std::memcpy(&third, bytes.data() + 8 + length + 8, sizeof third);
    CHECK(third == sample().floats[2]);
}

TEST_CASE("a checkpoint is refused if any byte has changed") {
    const temporary_folder folder;
    const fs::path file = folder / "state.safetensors";
    gs::write_checkpoint(file, saved());
    const std::string good = gs_test::read_file(file);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 1);
        gs_test::write_file(file, bad);
        const std::string problem = error_of([&] { gs::read_checkpoint(file); });
        // Spaces that pad the header carry nothing.
        if (problem.empty()) CHECK(good[i] == ' ');
        if (says(problem, {file.string()})) ++refused;
    }
    CHECK(refused > good.size() - 8);
}

TEST_CASE("a checkpoint is refused if it is truncated at any byte, or has more bytes") {
    const temporary_folder folder;
    const fs::path file = folder / "state.safetensors";
    gs::write_checkpoint(file, saved());
    const std::string good = gs_test::read_file(file);
    for (std::size_t length = 0; length < good.size(); ++length) {
        CAPTURE(length);
        gs_test::write_file(file, good.substr(0, length));
        CHECK(says(error_of([&] { gs::read_checkpoint(file); }), {file.string()}));
    }
    gs_test::write_file(file, good + "x");
    CHECK(says(error_of([&] { gs::read_checkpoint(file); }), {"is damaged: it has 1 bytes too many"}));
    CHECK(says(error_of([&] { gs::read_checkpoint(folder / "missing"); }), {"cannot read", "missing"}));
}

TEST_CASE("a checkpoint whose header nests too deeply or is too long is refused") {
    const temporary_folder folder;
    const fs::path file = folder / "state.safetensors";
    const auto refusal_of = [&](const std::string& header) {
        const std::uint64_t length = header.size();
        gs_test::write_file(file,
                            std::string(reinterpret_cast<const char*>(&length), sizeof length) + header);
        return error_of([&] { gs::read_checkpoint(file); });
    };
    const std::string deep =
        "{\"a\":{\"shape\":" + std::string(200000, '[') + std::string(200000, ']') + "}}";
    CHECK(says(refusal_of(deep), {file.string(), "no valid JSON"}));
    CHECK(says(refusal_of(std::string(std::size_t{1} << 25, ' ')), {file.string(), "truncated"}));
    CHECK(says(refusal_of("{}"), {file.string(), "no checkpoint of this program"}));
}

TEST_CASE("an archive names the value or array that it lacks") {
    state_archive archive(
        {{"word", "seven"}, {"large", "300"}, {"negative", "-1"}},
        {{"odd", {"F32", std::vector<std::byte>(3)}}, {"whole", {"I32", std::vector<std::byte>(8)}}});
    int number = 0;
    unsigned char small = 0;
    std::size_t count = 0;
    std::vector<float> floats;
    const auto problem = [&](const char* name, auto& member) {
        return error_of([&] { archive.exchange(name, member); });
    };
    CHECK(says(problem("nothing", number), {"no value for nothing", "--overwrite"}));
    CHECK(says(problem("word", number), {"no number for word"}));
    CHECK(says(problem("large", small), {"a number out of range for large"}));
    CHECK(says(problem("negative", count), {"for negative"}));
    CHECK(says(problem("nothing", floats), {"no array for nothing"}));
    CHECK(says(problem("odd", floats), {"an array of the wrong type for odd"}));
    CHECK(says(problem("whole", floats), {"an array of the wrong type for whole"}));
}

TEST_CASE("a checkpoint folder keeps the newest checkpoints and removes files of killed runs") {
    const temporary_folder folder;
    const gs::checkpoint_folder checkpoints(folder / "checkpoints");
    CHECK_FALSE(checkpoints.newest([](const std::string&) { FAIL("a warning"); }));
    for (const int iteration : {90, 100, 1100}) {
        gs_test::write_file(folder / "checkpoints/iteration_95.safetensors.part", "half");
        sample s;
        s.number = iteration;
        checkpoints.write(iteration, saved(s), 2);
    }
    CHECK_FALSE(fs::exists(checkpoints.file_of(90)));
    CHECK(fs::exists(checkpoints.file_of(100)));
    CHECK_FALSE(fs::exists(folder / "checkpoints/iteration_95.safetensors.part"));
    const auto newest = checkpoints.newest([](const std::string&) { FAIL("a warning"); });
    REQUIRE(newest);
    CHECK(newest->iteration == 1100);
    CHECK(loaded(newest->archive).number == 1100);
}

TEST_CASE("a damaged checkpoint is reported, and the one before it is used") {
    const temporary_folder folder;
    const gs::checkpoint_folder checkpoints(folder / "checkpoints");
    checkpoints.write(10, saved(), 2);
    checkpoints.write(20, saved(), 2);
    gs_test::write_file(checkpoints.file_of(20), "damaged");
    std::vector<std::string> warnings;
    const auto warn = [&](const std::string& line) { warnings.push_back(line); };
    const auto newest = checkpoints.newest(warn);
    REQUIRE(newest);
    CHECK(newest->iteration == 10);
    REQUIRE(warnings.size() == 1);
    CHECK(says(warnings[0], {"iteration_20", "is damaged"}));
    CHECK(gs_test::read_file(checkpoints.file_of(20).string() + ".damaged") == "damaged");
    checkpoints.write(30, saved(), 2);
    CHECK(fs::exists(checkpoints.file_of(10)));

    for (const int iteration : {10, 30}) gs_test::write_file(checkpoints.file_of(iteration), "damaged");
    CHECK(says(error_of([&] { checkpoints.newest(warn); }), {"all checkpoints", "--overwrite"}));
    CHECK(gs_test::read_file(checkpoints.file_of(30)) == "damaged");
}
