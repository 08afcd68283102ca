// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <warpagg/warp/simd.hpp>

#include "../cli/run_program.hpp"
#include "densify/parameter_gather.hpp"
#include "device/cpu/cpu.hpp"
#include "ranks/run.hpp"

using namespace gs_test;
using gs::ranks::communicator;
using gs::train::birth;
using cpu = gs::device::cpu;
using parameters = gs::train::trained_parameters<cpu>;

namespace {

constexpr std::size_t gaussians_before = 1000, with_sh_before = 640;

std::uint32_t number(std::size_t seed, std::size_t i) {
    return static_cast<std::uint32_t>((i + 1) * 2654435761u + seed * 40503u) >> 8;
}

template <class Memory>
void fill(Memory& memory, std::size_t seed) {
    memory.resize(gaussians_before, with_sh_before, 3);
    for (std::size_t p = 0; p < gs::parameter_count; ++p)
        for (std::size_t i = 0; i < memory[p].size(); ++i)
            memory[p].data()[i] = static_cast<float>(number(seed + p, i));
}

/// Returns all elements, of all ranks.
std::string text_of(parameters& all, cpu& d) {
    gs::state_archive archive;
    all.exchange(archive, d);
    std::string text;
    for (const auto& [name, array] : archive.arrays())
        text += name + std::string(reinterpret_cast<const char*>(array.bytes.data()), array.bytes.size());
    return text;
}

/// Changes Gaussians in a rank, and writes the result after each change to the folder.
void change(communicator& ranks, const fs::path& folder) {
    cpu d;
    d.join(ranks);
    parameters all;
    std::size_t seed = 0;
    for (auto* memory : {&all.values, &all.first, &all.second}) fill(*memory, 10 * seed++);
    all.last_step.resize(gaussians_before);
    for (std::size_t i = 0; i < gaussians_before; ++i) all.last_step.data()[i] = number(7, i);
    gs::gaussian_shares shares;
    if (ranks.count() > 1) all.divide(d, shares.of(gaussians_before, ranks.count()));
    const auto write = [&](const std::string& name) {
        std::ofstream(folder / (name + std::to_string(ranks.rank())), std::ios::binary) << text_of(all, d);
    };
    write("divided");

    // Pieces of several blocks, which end in any share.
    gs::train::parameter_gather<cpu> gather(d, shares, 700);
    constexpr std::size_t more = 1500, more_with_sh = 768;
    gather.reserve(more);
    for (std::size_t i = 0; i < more; ++i) {
        gather.origins()[i] = number(3, i) % gaussians_before;
        gather.births()[i] = static_cast<birth>(number(4, i) % 4);
    }
    gather.run(all, more, more_with_sh, 3);
    write("gathered");

    // Borders of shares move.
    std::vector<std::size_t> shown(static_cast<std::size_t>(ranks.count()), 100);
    shown.front() = 1000;
    shares.note(gs::ranks::shares(shown), more, ranks.count());
    shares.balance();
    gather.keep_all(more);
    gather.run(all, more, more_with_sh, 3);
    if (ranks.count() > 1 && *all.shares != shares.of(more, ranks.count()))
        throw std::runtime_error("the Gaussians are not where the shares are");
    write("moved");

    if (all.shares) all.undivide_values(d);
    write("values_undivided");
    if (all.shares) all.divide(d, *all.shares);
    all.change_sh_degree(d, 3, 2);
    write("lower_degree");
}

}  // namespace

TEST_CASE("divided parameters: any number of ranks has the same elements after all changes") {
    const temporary_folder alone;
    REQUIRE(gs::ranks::run(1, [&](communicator& ranks) {
                change(ranks, alone.path());
                return 0;
            }).reason == "");
    for (int ranks = 2; ranks <= 5; ++ranks) {
        CAPTURE(ranks);
        const temporary_folder folder;
        const auto end = gs::ranks::run(ranks, [&](communicator& all) {
            change(all, folder.path());
            return 0;
        });
        REQUIRE(end.reason == "");
        for (const std::string name : {"divided", "gathered", "moved", "values_undivided", "lower_degree"})
            for (int rank = 0; rank < ranks; ++rank) {
                CAPTURE(name);
                CAPTURE(rank);
                CHECK(read_file(folder / (name + std::to_string(rank))) == read_file(alone / (name + "0")));
            }
    }
    CHECK(read_file(alone / "moved0") == read_file(alone / "gathered0"));
    CHECK(read_file(alone / "lower_degree0") != read_file(alone / "moved0"));
}
