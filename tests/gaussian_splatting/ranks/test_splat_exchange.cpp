// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <omp.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "../render/random_model.hpp"
#include "model/gaussian_shares.hpp"
#include "ranks/run.hpp"

using gs::accumulator;
using gs::ranks::communicator;
using gs::ranks::windows;

namespace {

/// What a rank has after drawing its strip of a view.
struct strip_result {
    std::vector<float> pixels;         ///< of its own rows
    std::vector<float> sums;           ///< of its drawn Gaussians
    std::vector<std::size_t> windows;  ///< numbers of sent splats
    std::size_t drawn = 0, listed_places = 0;

    bool looks_like(const strip_result& other) const {
        return pixels == other.pixels && sums == other.sums && windows == other.windows &&
               drawn == other.drawn;
    }
};

class strip_drawing {
  public:
    explicit strip_drawing(communicator& all) : all_(all), on_(false) {
        on_.device.join(all);
        view_.width = size;
        view_.height = size;
        view_.fx = view_.fy = 40;
        view_.cx = view_.cy = size / 2.0;
        view_.translation = {0, 0, 3};
    }
    auto& renderer() { return on_.renderer; }
    strip_result draw(const std::optional<windows>& expected, accumulator how) {
        strip_of_rank(expected);
        on_.renderer.list(on_.gaussians.read(), model<float>::count, view_, model<float>::sh_degree);
        on_.renderer.blend({0.2f, 0.3f, 0.4f});
        strip_result found;
        const gs::row_range rows = on_.renderer.own_rows();
        for (int channel = 0; channel < 3; ++channel)
            for (int i = rows.first * size; i < rows.last * size; ++i)
                found.pixels.push_back(on_.renderer.render()[channel * size * size + i]);
        std::vector<float> gradient(3 * size * size, 0.f);
        for (int i = 0; i < 3 * size * size; ++i)
            if (const int row = i / size % size; row >= rows.first && row < rows.last)
                gradient[static_cast<std::size_t>(i)] = 1e-3f * static_cast<float>(i % 7 - 2);
        const float* sums = on_.renderer.pixel_sums(gradient.data(), 1e-2f, how);
        const gs::ranks::share own = on_.renderer.own_gaussians();
        for (std::size_t g = own.first; g < own.last; ++g)
            if (on_.renderer.tiles_of()[g] != 0)
                found.sums.insert(found.sums.end(), sums + g * gs::raster::record_stride,
                                  sums + (g + 1) * gs::raster::record_stride);
        found.windows = on_.renderer.exchange().window_counts();
        found.drawn = on_.renderer.exchange().drawn().items();
        found.listed_places = on_.renderer.exchange().received();
        return found;
    }

  private:
    static constexpr int size = 64, tile_rows = size / gs::raster::tile_size;

    void strip_of_rank(const std::optional<windows>& expected) {
        gs::raster::view_strip strip;
        for (int rank = 0; rank < all_.count(); ++rank)
            strip.own_of_all.push_back(
                {tile_rows * rank / all_.count(), tile_rows * (rank + 1) / all_.count()});
        strip.own = strip.own_of_all[static_cast<std::size_t>(all_.rank())];
        strip.gaussians = gs::gaussian_shares().of(model<float>::count, all_.count());
        strip.windows = expected;
        on_.renderer.set_strip(strip);
    }

    communicator& all_;
    drawing<float> on_;
    gs::camera view_;
};

/// Returns windows with these numbers of places.
windows windows_of(std::vector<std::size_t> counts, std::size_t more, int ranks) {
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (i / static_cast<std::size_t>(ranks) != i % static_cast<std::size_t>(ranks)) counts[i] += more;
    return windows(counts, ranks);
}

}  // namespace

TEST_CASE("splat exchange: expected windows of any size yield the pixels and sums of known numbers") {
    for (const int count : {2, 3})
        for (const accumulator how : {accumulator::native, accumulator::fixed}) {
            CAPTURE(count);
            CAPTURE(static_cast<int>(how));
            const auto end = gs::ranks::run(count, [&](communicator& all) {
                omp_set_num_threads(1);
                strip_drawing on(all);
                const strip_result known = on.draw({}, how);
                const auto sent = std::accumulate(known.windows.begin(), known.windows.end(), std::size_t{0});
                if (known.drawn < 20 || sent < 5) return 2;
                const strip_result too_small =
                    on.draw(windows_of(std::vector(known.windows.size(), std::size_t{0}), 1, count), how);
                const strip_result exact = on.draw(windows_of(known.windows, 0, count), how);
                const strip_result large = on.draw(windows_of(known.windows, 20, count), how);
                if (large.listed_places != known.listed_places + 20 * static_cast<std::size_t>(count - 1))
                    return 3;
                const strip_result again = on.draw({}, how);
                if (!known.looks_like(too_small)) return 4;
                if (!known.looks_like(exact)) return 5;
                if (!known.looks_like(large)) return 6;
                return known.looks_like(again) ? 0 : 7;
            });
            CHECK(end.reason == "");
            CHECK(end.code == 0);
        }
}

TEST_CASE("strips: ranks have memory for the tile lists of their strips, and not for those of the view") {
    constexpr int count = 3;
    const auto end = gs::ranks::run(count, [&](communicator& all) {
        omp_set_num_threads(1);
        strip_drawing on(all);
        if (on.renderer().strip_places() != 0) return 2;
        const strip_result first = on.draw({}, accumulator::fixed);
        const std::uint64_t places = on.renderer().strip_places(), of_view = on.renderer().instances();
        if (places == 0 || on.renderer().reserved_instances() < of_view) return 3;
        std::uint64_t of_all = places;
        all.sum(&of_all, 1);
        if (of_all > 2 * of_view || places > 3 * of_view / 4) return 4;
        const strip_result second = on.draw({}, accumulator::fixed);
        if (on.renderer().strip_places() != places) return 5;
        if (all.rank() == 1) on.renderer().release_strips();  // makes its lists again, without the others
        const strip_result third = on.draw({}, accumulator::fixed);
        return first.looks_like(second) && first.looks_like(third) ? 0 : 6;
    });
    CHECK(end.reason == "");
    CHECK(end.code == 0);
}

TEST_CASE("windows: those with a place for each item of others have places for them") {
    const windows small(std::vector<std::size_t>{0, 3, 4, 0}, 2),
        large(std::vector<std::size_t>{0, 3, 5, 0}, 2);
    CHECK(large.have_places_for(small));
    CHECK(small.have_places_for(small));
    CHECK_FALSE(small.have_places_for(large));
}
