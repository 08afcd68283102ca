// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "../cli/run_program.hpp"
#include "ranks/communicator.hpp"
#include "ranks/run.hpp"

using namespace gs_test;
using gs::ranks::communicator;
using gs::ranks::purpose;
using gs::ranks::shared_array;
using gs::ranks::window_array;

namespace {

constexpr int steps = 6;

/// The part `exchange` of metrics.json of a training without densification.
nlohmann::json exchange_of(const std::string& scene, int ranks, const words& options) {
    const temporary_folder folder;
    const fs::path output = folder / "out";
    check_success(words{"train", "-d", scene, "-o", output.string(), "-r", "48", "-i", std::to_string(steps),
                        "--device", "cpu", "--quiet", "--no-viewer", "--num-downscales", "0",
                        "--densify-until-iter", "0", "--ranks", std::to_string(ranks)} +
                      options,
                  "2");
    const auto metrics = read_json(output / "metrics.json");
    CHECK(metrics.at("gaussians") == 3000);
    return metrics.contains("exchange") ? metrics.at("exchange") : nlohmann::json();
}

/// The mean of the bytes that a rank sends in a step, from those of all ranks in a step.
double mean(std::uint64_t of_all, int ranks) { return static_cast<double>(of_all * steps) / (steps * ranks); }

/// Checks the formula of docs/explanation/when_several_gpus_help.md. All numbers are of one view.
void check_formula(const nlohmann::json& exchange, int ranks, std::uint64_t values, double bytes_of_sum,
                   double bytes_of_splat = 60) {
    constexpr std::uint64_t tile_rows = 3;
    const auto others = static_cast<std::uint64_t>(ranks - 1), all = static_cast<std::uint64_t>(ranks);
    const auto& bytes = exchange.at("bytes");
    const double sent = exchange.at("sent_splats");
    const double counts = 16 * static_cast<double>(others * (all + 1));
    CHECK(bytes.at("splats").get<double>() == doctest::Approx(bytes_of_splat * sent + counts).epsilon(1e-12));
    CHECK(bytes.at("lists") == mean(others * 2 * 8 * (tile_rows + 1), ranks));
    CHECK(bytes.at("gradients").get<double>() == doctest::Approx(12 * bytes_of_sum * sent).epsilon(1e-12));
    CHECK(bytes.at("effects") == mean(others * 2 * 4 * values, ranks));
    CHECK(bytes.at("scores") == 0);
}

/// Whether each rank has counted as many bytes and calls as expected, for all ranks together.
bool all_count(int count, purpose of, std::uint64_t bytes, std::uint64_t calls,
               const std::function<void(communicator&)>& exchange) {
    const auto end = gs::ranks::run(count, [&](communicator& all) {
        exchange(all);
        const auto& found = all.traffic().of(of);
        return found.bytes == bytes && found.calls == calls ? 0 : 1;
    });
    return end.code == 0 && end.reason.empty();
}

}  // namespace

TEST_CASE("traffic: a step of 2, 3 and 4 ranks exchanges the bytes of the formula") {
    // All Gaussians are in all views of this scene.
    for (int ranks = 2; ranks <= 4; ++ranks)
        for (const bool fixed : {false, true}) {
            CAPTURE(ranks);
            CAPTURE(fixed);
            const auto exchange =
                exchange_of("synthetic:alpha,views=8", ranks,
                            words{"--effects", "none"} + (fixed ? words{"--deterministic"} : words{}));
            CHECK(exchange.at("ranks") == ranks);
            CHECK(exchange.at("steps") == steps);
            CHECK(exchange.at("visible_splats") == 3000);
            // The shares are of 94 blocks, the last of which has 24 Gaussians, and the others 32.
            CHECK(exchange.at("largest_share") ==
                  std::array{47 * 32, 31 * 32 + 24, 24 * 32}.at(static_cast<std::size_t>(ranks) - 2));
            check_formula(exchange, ranks, 0, fixed ? 8 : 4);
            // Each rank would send all its splats to all others if strips did not matter.
            CHECK(exchange.at("sent_splats") > 0);
            CHECK(exchange.at("sent_splats") < 3000.0 * (ranks - 1) / ranks);
            const auto& calls = exchange.at("calls");
            CHECK(calls.at("splats") == 2);
            CHECK(calls.at("lists") == 1);
            CHECK(calls.at("gradients") == 1);
            CHECK(calls.at("effects") == 0);
        }
}

TEST_CASE("traffic: effects add the bytes of their values, and depth maps those of another splat") {
    // Exposures have 12 sums per patch of 8 by 8 pixels, and all views have 36 patches.
    check_formula(exchange_of("synthetic:alpha,views=8", 2, {"--effects", "exposure"}), 2, 12 * 36, 4);
    check_formula(exchange_of("synthetic:alpha,views=8,depths=0.02", 3, {"--effects", "depth"}), 3, 0, 4,
                  60 + 48);
}

TEST_CASE("traffic: one process exchanges nothing, and its metrics.json has no such part") {
    CHECK(exchange_of("synthetic:alpha,views=8", 1, {"--effects", "none"}).is_null());
    communicator alone;
    double value = 1;
    alone.sum(&value, 1);
    CHECK(alone.traffic().of(purpose::other).bytes == 0);
    CHECK(alone.traffic().of(purpose::other).calls == 0);
}

TEST_CASE("traffic: sums, windows and shares have their own numbers of bytes") {
    for (const int count : {2, 3, 5}) {
        CAPTURE(count);
        const auto others = static_cast<std::uint64_t>(count - 1);
        const gs::ranks::shares shares(100, 8, count);
        std::vector<double> values(200);
        CHECK(all_count(count, purpose::other, others * 2 * 8 * 11, 2, [&](communicator& all) {
            std::uint64_t most = 1;
            all.sum(values.data(), 10);
            all.maximum(&most, 1);
        }));
        // Rank r sends r items to each other one.
        CHECK(all_count(
            count, purpose::splats, others * (others + 1) / 2 * others * (8 * 3 + 4), 1,
            [&](communicator& all) {
                std::vector<std::size_t> items;
                for (int r = 0; r < count; ++r)
                    items.insert(items.end(), static_cast<std::size_t>(count), static_cast<std::size_t>(r));
                std::vector<double> sent(3 * 100), received(3 * 100);
                std::vector<float> sent_too(100), received_too(100);
                const window_array arrays[] = {window_array::of(sent.data(), received.data(), 3),
                                               window_array::of(sent_too.data(), received_too.data(), 1)};
                all.exchange(gs::ranks::windows(items, count), arrays);
            }));
        CHECK(all_count(count, purpose::gaussians, others * (8 * 200 + 4 * 100), 1, [&](communicator& all) {
            std::vector<float> more(100);
            const shared_array arrays[] = {shared_array::of(values.data(), 16, 200),
                                           shared_array::of(more.data(), 8, 100)};
            all.gather(shares, arrays);
        }));
    }
}

TEST_CASE("traffic: exchanges count for the inner of two purposes, and afterwards for the outer one") {
    using scope = gs::ranks::traffic_counter::scope;
    const auto exchange = [](communicator& all) {
        float value = 1;
        const scope outer(all.traffic(), purpose::effects);
        {
            const scope inner(all.traffic(), purpose::splats);
            all.sum(&value, 1);
        }
        all.sum(&value, 1);
        all.sum(&value, 1);
    };
    CHECK(all_count(2, purpose::splats, 8, 1, exchange));
    CHECK(all_count(2, purpose::effects, 16, 2, exchange));
    CHECK(all_count(2, purpose::other, 0, 0, exchange));
}
