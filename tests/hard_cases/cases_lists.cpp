// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <omp.h>

#include <cmath>

#include "bounds.hpp"
#include "questions.hpp"
#include "table.hpp"

using namespace hard_cases;

TEST_CASE("case 13: more instances of tiles than 31 and 32 bits hold") {
    on_each_backend([](const backend& b) {
        // A million Gaussians of 2,047 to 4,099 tiles each: sums above 2^31 and 2^32.
        for (const std::uint32_t each : {2047u, 4096u}) {
            std::vector<std::uint32_t> counts;
            std::uint64_t sum = 0;
            for (std::uint32_t i = 0; i < (1u << 20) + 3; ++i) counts.push_back(each + i % 4);
            const std::vector<std::uint64_t> first = b.prefix_sum(counts);
            REQUIRE(first.size() == counts.size() + 1);
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < counts.size(); ++i) {
                wrong += first[i] == sum ? 0 : 1;
                sum += counts[i];
            }
            CHECK(wrong == 0);
            CHECK(first.back() == sum);
            REQUIRE(sum > (std::uint64_t{each} << 20));
        }
        CHECK(b.prefix_sum({}) == std::vector<std::uint64_t>{0});
        CHECK(b.prefix_sum({0xffffffffu, 0xffffffffu}).back() == 0x1fffffffeu);

        for (const std::uint64_t many : {std::uint64_t{1} << 31, (std::uint64_t{1} << 32) + 5}) {
            const std::string said = b.complaint_about_instances(many);
            CHECK(said.find(std::to_string(many)) != std::string::npos);
            CHECK(said.find("--max-cap") != std::string::npos);
        }
        CHECK(b.complaint_about_instances(1000) == "");
    });
}

TEST_CASE("case 14: numbers of tiles at powers of two") {
    // Two small Gaussians in the middle of each tile, all the second ones behind all the first, so that a
    // list of two tiles' Gaussians mixes them. A tile of the picture has to look as it does alone: where
    // there is one tile, it takes no bits of a key.
    for (const int tiles : {1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 32, 33})
        for (const bool upright : {false, true}) {
            CAPTURE(tiles);
            CAPTURE(upright);
            question q = empty_question(upright ? 16 : 16 * tiles, upright ? 16 * tiles : 16);
            constexpr double focal = 1024;  // a long lens: the last tile looks as the first
            q.view.camera.fx = q.view.camera.fy = focal;
            q.view.camera.cx = q.view.camera.cy = 8;
            std::vector<question> alone;
            for (int t = 0; t < tiles; ++t) {
                question one = empty_question(16, 16);
                one.view.camera = q.view.camera;
                one.view.camera.width = one.view.camera.height = 16;
                (upright ? one.view.camera.cy : one.view.camera.cx) -= 16 * t;
                for (const int which : {0, 1}) {
                    gaussian g;
                    const double z = 4 + 0.01 * (tiles - t) + which,
                                 along = z * (16 * t + 0.5 * which) / focal;
                    g.mean = {upright ? 0 : along, upright ? along : 0, z};
                    g.log_scale = glm::dvec3(-5);
                    g.opacity = 1;
                    g.colour = {0.2 + 0.6 * which, t * 1.0 / tiles, 0.9};
                    add(q, g);
                    add(one, g);
                }
                alone.push_back(one);
            }
            on_each_backend([&](const backend& b) {
                const std::vector<double> whole = b.ask(q).picture;
                double apart = 0, seen = 1;
                for (int t = 0; t < tiles; ++t) {
                    const std::vector<double> tile = b.ask(alone[static_cast<std::size_t>(t)]).picture;
                    seen = std::min(seen, largest(tile));
                    for (std::size_t i = 0; i < tile.size(); ++i) {
                        const std::size_t channel = i / 256, x = i % 16, y = i / 16 % 16,
                                          first = 16 * static_cast<std::size_t>(t);
                        const std::size_t pixel =
                            upright ? (first + y) * 16 + x
                                    : y * static_cast<std::size_t>(q.view.camera.width) + first + x;
                        apart = std::max(apart, std::abs(tile[i] - whole[channel * q.pixels() + pixel]));
                    }
                }
                CHECK(seen > 0.3);
                CHECK(apart < 1e-4);
            });
        }
}

TEST_CASE("case 18: 1,000 Gaussians at one depth keep their order") {
    question q = random_question(18, 1000, 24, 10, 1);
    q.view.camera.rotation = glm::dmat3(1);
    q.view.camera.translation = glm::dvec3(0);
    for (std::size_t i = 0; i < q.count(); ++i) q.parameters[0][3 * i + 2] = 4;
    // The same an ulp behind one another, in this order and against it.
    question ascending = q, descending = q;
    float z = 4;
    for (std::size_t i = 0; i < q.count(); ++i, z = std::nextafter(z, 5.0f)) {
        ascending.parameters[0][3 * i + 2] = z;
        descending.parameters[0][3 * (q.count() - 1 - i) + 2] = z;
    }
    q.weights = off_thresholds(q, 1e-3);
    on_each_backend([&](const backend& b) {
        const answer first = b.ask(q);
        CHECK(distance(b.ask(ascending), first, q) < 1e-3);
        CHECK(distance(b.ask(descending), first, q) > 0.1);
        std::size_t other = 0;
        for (int run = 0; run < 50; ++run) {
            omp_set_num_threads(run % 5 == 0 ? 2 + run % 3 : 1);
            other += b.ask(q).picture == first.picture ? 0 : 1;
        }
        omp_set_num_threads(1);
        CHECK(other == 0);
    });
}
