// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
//
// What the library's calls compile to, counted in the PTX of ptx/kernels.cu. PTX says `atom` where ptxas
// makes RED of it, the result being unused.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

const std::vector<std::string> files = {WARPAGG_PTX_FILES};

/// The opcodes of one kernel, in order, as in "shfl.sync.bfly.b32".
std::vector<std::string> opcodes(const std::string& file, const std::string& kernel) {
    std::ifstream in(file);
    REQUIRE(in);
    std::string line;
    while (std::getline(in, line) && line.find(".entry " + kernel + "(") == std::string::npos) {
    }
    REQUIRE(in);
    std::vector<std::string> result;
    while (std::getline(in, line) && line != "}") {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (!word.empty() && word[0] == '@') words >> word;
        const bool instruction =
            !word.empty() && word[0] >= 'a' && word[0] <= 'z' && line.find(';') != std::string::npos;
        if (instruction) result.push_back(word.substr(0, word.find(';')));
    }
    return result;
}

long count(const std::vector<std::string>& opcodes, const std::vector<std::string>& starts) {
    return std::count_if(opcodes.begin(), opcodes.end(), [&](const std::string& opcode) {
        return std::any_of(starts.begin(), starts.end(),
                           [&](const std::string& start) { return opcode.rfind(start, 0) == 0; });
    });
}
long shuffles(const std::vector<std::string>& opcodes) { return count(opcodes, {"shfl."}); }
long atomics(const std::vector<std::string>& opcodes) { return count(opcodes, {"atom.", "red."}); }
long votes(const std::vector<std::string>& opcodes) { return count(opcodes, {"vote."}); }

}  // namespace

TEST_CASE("N = 9 float takes 12 shuffles and 1 atomic by scatter, 45 by the trees, also in a loop") {
    struct cost {
        std::string kernel;
        long shuffles, atomics, votes;
    };
    for (const auto& file : files) {
        for (const cost& expected : {cost{"scatter_once", 12, 1, 1}, cost{"scatter_looped", 12, 1, 1},
                                     cost{"shfl_down_once", 45, 9, 1}, cost{"shfl_down_looped", 45, 9, 1},
                                     cost{"butterfly_once", 45, 1, 1}, cost{"butterfly_looped", 45, 1, 1},
                                     cost{"per_lane_once", 0, 9, 0}}) {
            INFO(file, ": ", expected.kernel);
            const auto all = opcodes(file, expected.kernel);
            CHECK(shuffles(all) == expected.shuffles);
            CHECK(atomics(all) == expected.atomics);
            CHECK(votes(all) == expected.votes);
        }
    }
}

TEST_CASE("cuda_warp adds no instruction to code written with intrinsics") {
    for (const auto& file : files) {
        INFO(file);
        const auto by_hand = opcodes(file, "by_hand");
        REQUIRE(by_hand.size() > 20);
        CHECK(opcodes(file, "members") == by_hand);
    }
}
