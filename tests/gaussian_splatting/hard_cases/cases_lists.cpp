// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "bounds.hpp"
#include "cases.hpp"
#include "device/distribute.hpp"
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
    // list of two tiles' Gaussians mixes them. A tile of the image has to look as it does alone: where
    // there is one tile, it takes no bits of a key.
    for (const int tiles : {1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 32, 33})
        for (const bool upright : {false, true}) {
            CAPTURE(tiles);
            CAPTURE(upright);
            render_case q = empty_case(upright ? 16 : 16 * tiles, upright ? 16 * tiles : 16);
            constexpr double focal = 1024;  // a long lens: the last tile looks as the first
            q.view.camera.fx = q.view.camera.fy = focal;
            q.view.camera.cx = q.view.camera.cy = 8;
            std::vector<render_case> alone;
            for (int t = 0; t < tiles; ++t) {
                render_case one = empty_case(16, 16);
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
                    g.color = {0.2 + 0.6 * which, t * 1.0 / tiles, 0.9};
                    add(q, g);
                    add(one, g);
                }
                alone.push_back(one);
            }
            on_each_backend([&](const backend& b) {
                const std::vector<double> whole = b.render(q).render;
                double apart = 0, seen = 1;
                for (int t = 0; t < tiles; ++t) {
                    const std::vector<double> tile = b.render(alone[static_cast<std::size_t>(t)]).render;
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
    render_case q = random_case(18, 1000, 24, 10, 1);
    q.view.camera.rotation = glm::dmat3(1);
    q.view.camera.translation = glm::dvec3(0);
    for (std::size_t i = 0; i < q.count(); ++i) q.parameters[0][3 * i + 2] = 4;
    // The same depths, one ulp apart, in ascending and in descending order.
    render_case ascending = q, descending = q;
    float z = 4;
    for (std::size_t i = 0; i < q.count(); ++i, z = std::nextafter(z, 5.0f)) {
        ascending.parameters[0][3 * i + 2] = z;
        descending.parameters[0][3 * (q.count() - 1 - i) + 2] = z;
    }
    q.weights = off_thresholds(q, 1e-3);
    on_each_backend([&](const backend& b) {
        const render_result first = b.render(q);
        CHECK(distance(b.render(ascending), first, q) < 1e-3);
        CHECK(distance(b.render(descending), first, q) > 0.1);
        std::size_t other = 0;
        for (int run = 0; run < 50; ++run) {
            omp_set_num_threads(run % 5 == 0 ? 2 + run % 3 : 1);
            other += b.render(q).render == first.render ? 0 : 1;
        }
        omp_set_num_threads(1);
        CHECK(other == 0);
    });
}

TEST_CASE("keys are sorted, and equal ones keep their order") {
    std::mt19937 random(1);
    // Sizes on both sides of the tile that a block of a GPU sorts.
    for (const std::size_t n : {0, 1, 32, 2047, 2048, 2049, 100000})
        for (const std::uint32_t values : {1u, 3u, 0x10000u, 0xffffffffu}) {
            CAPTURE(n);
            CAPTURE(values);
            std::vector<std::uint32_t> keys, order(n);
            for (std::size_t i = 0; i < n; ++i)
                keys.push_back(random() % 8 == 0 ? 0xffffffffu
                                                 : static_cast<std::uint32_t>(random()) % values);
            std::iota(order.begin(), order.end(), 0u);
            std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return keys[i]; });
            on_each_backend([&](const backend& b) {
                for (const int threads : {3, 1}) {
                    omp_set_num_threads(threads);
                    CHECK(b.sort(keys) == order);
                }
            });
        }
}

TEST_CASE("lists of buckets are those made one item at a time, however long the items are") {
    std::mt19937 random(2);
    struct shape {
        std::size_t items, buckets, usual, most;
    };
    // Among them more buckets than a block of a GPU has shared memory for, and so many items that a GPU cuts
    // them into more slices.
    for (const shape& s : {shape{0, 0, 1, 1}, shape{0, 3, 1, 1}, shape{1, 1, 1, 1}, shape{33, 7, 3, 7},
                           shape{40, 13000, 9, 13000}, shape{5000, 625, 6, 625}, shape{5000, 1, 1, 1},
                           shape{140000, 50, 2, 20}}) {
        CAPTURE(s.items);
        CAPTURE(s.buckets);
        std::vector<std::vector<std::uint32_t>> items(s.items), lists(s.buckets);
        std::uint64_t required = 0;
        for (std::uint32_t i = 0; i < s.items; ++i) {
            if (random() % 8 == 0) continue;  // has none
            const std::size_t size = random() % 64 == 0 ? s.most : 1 + random() % s.usual;
            std::size_t bucket = random() % s.buckets;
            for (std::size_t k = 0; k < size; ++k, bucket = (bucket + 1) % s.buckets) {
                const bool goes = random() % 4 != 0;
                items[i].push_back(goes ? static_cast<std::uint32_t>(bucket) : gs::device::no_bucket);
                if (goes) lists[bucket].push_back(i);
                required += goes ? 1 : 0;
            }
        }
        for (const std::uint64_t capacity : {required + 5, required, required / 2, std::uint64_t{0}}) {
            CAPTURE(capacity);
            std::vector<std::vector<std::uint32_t>> fitting = lists;
            std::uint64_t left = capacity;
            for (auto& list : fitting) {
                list.resize(std::min<std::uint64_t>(list.size(), left));
                left -= list.size();
            }
            on_each_backend([&](const backend& b) {
                for (const int threads : {3, 1}) {
                    omp_set_num_threads(threads);
                    const std::uint32_t moved = threads == 3 ? 0 : 37;
                    const bucket_lists found = b.distribute(items, s.buckets, capacity, moved);
                    CHECK(found.required == required);
                    CHECK((found.items == fitting));
                }
            });
        }
    }
}
