// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// Times of whole kernels by policy. The default policy is chosen on these kernels.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>

#include "kernel.hpp"

namespace {

constexpr int rounds = 9;
constexpr double least_milliseconds = 1;  // shorter kernels are launched several times per measurement

double rounded(double x) { return std::round(x * 10000) / 10000; }

/// Throws if the variants do not add the same sums.
void compare_results(const kernel_case& of) {
    std::vector<float> expected;
    for (const variant& v : of.variants) {
        of.clear();
        v.launch();
        check(cudaGetLastError());
        check(cudaDeviceSynchronize());
        const std::vector<float> sums = of.result();
        if (expected.empty()) expected = sums;
        double scale = 0, difference = 0;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            scale = std::max(scale, std::abs(double{expected[i]}));
            difference = std::max(difference, std::abs(double{sums[i]} - double{expected[i]}));
        }
        if (!(scale > 0) || !(difference <= of.tolerance * scale))
            throw std::runtime_error(of.kernel + ", " + of.input + ": " + v.name + " adds other sums than " +
                                     of.variants.front().name);
    }
}

void measure(const kernel_case& of, nlohmann::ordered_json& rows) {
    compare_results(of);
    stopwatch watch;
    std::vector<int> launches;
    for (const variant& v : of.variants) {
        const double ms = watch.milliseconds(v.launch);
        launches.push_back(std::clamp(static_cast<int>(least_milliseconds / ms), 1, 50));
    }
    std::vector<std::vector<double>> times(of.variants.size());
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < of.variants.size(); ++i)
            times[i].push_back(watch.milliseconds([&] {
                for (int k = 0; k < launches[i]; ++k) of.variants[i].launch();
            }) / launches[i]);
    nlohmann::ordered_json variants;
    for (std::size_t i = 0; i < times.size(); ++i) {
        std::ranges::sort(times[i]);
        const double median = times[i][rounds / 2];
        std::printf("%s\t%s\t%.2f\t%s\t%.4f\n", of.kernel.c_str(), of.input.c_str(), of.idle_share,
                    of.variants[i].name.c_str(), median);
        variants[of.variants[i].name] = {rounded(median), rounded(times[i].front()),
                                         rounded(times[i].back())};
    }
    std::fflush(stdout);
    rows.push_back({{"kernel", of.kernel},
                    {"input", of.input},
                    {"idle_share", rounded(of.idle_share)},
                    {"median_least_most", variants}});
}

struct group {
    const char* name;
    std::vector<kernel_maker> (*cases)();
};
constexpr group groups[] = {{"blending", blending_cases},
                            {"hash_grid", hash_grid_cases},
                            {"interpolation", interpolation_cases},
                            {"scatter", scatter_cases},
                            {"deterministic_scatter", deterministic_scatter_cases}};

}  // namespace

/// Usage: bench_kernels [FILE.json [GROUP]]
int main(int argc, char** argv) {
    try {
        nlohmann::ordered_json json = figures_of_this_gpu("kernels");
        json["rounds"] = rounds;
        std::printf("kernel\tinput\tidle\tvariant\tms\n");
        const std::string only = argc > 2 ? argv[2] : "";
        bool found = only.empty();
        for (const group& g : groups) {
            if (!only.empty() && only != g.name) continue;
            found = true;
            for (const kernel_maker& make : g.cases()) measure(make(), json["rows"]);
        }
        if (!found)
            throw std::runtime_error("there is no group '" + only +
                                     "': choose blending, hash_grid, interpolation, scatter or "
                                     "deterministic_scatter");
        if (argc > 1) std::ofstream(argv[1]) << json.dump(1) << '\n';
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\n", e.what());
        return 2;
    }
}
