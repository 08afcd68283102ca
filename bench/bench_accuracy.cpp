// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What accuracy costs: sums of float kept in each way that a policy has, on the emulator or on a GPU, where
/// all warps add at the same time. Values of a chosen condition number are added in many orders; each sum is
/// compared with the exact one, and its error with the bound that is documented for it. One sum for all
/// values, or many that values go to at random.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "accuracy/adder.hpp"
#include "driver.hpp"
#include "engine/engine.hpp"

namespace {

using nlohmann::ordered_json;

constexpr double u = 0x1p-24;

/// See warpagg/accumulator.hpp and warpagg/segmented_sum.hpp.
double bound(way how, const sizes& s, float scale, unsigned lanes) {
    switch (how) {
        case way::native:
            return s.n * u * s.magnitude;
        case way::f64:
            return s.n * 0x1p-53 * s.magnitude + u * s.sum;
        case way::compensated:
            return u * s.sum + 5 * s.n * u * u * s.magnitude;
        case way::fixed:
            return s.n * 0x1p-21 / static_cast<double>(scale) + u * s.sum;
        case way::binned2:
            return s.n * 0x1p-24 * s.largest + u * s.sum;
        case way::binned3:
            return s.n * 0x1p-48 * s.largest + u * s.sum;
        case way::exact:
            return u * s.sum;
        case way::ordered:
            return (s.n / 1024 + 1024.0 / lanes + 10) * u * s.magnitude;
    }
    return 0;
}

struct record {
    std::vector<double> errors, nanoseconds;
    double largest = 0, over_bound = 0;
    std::set<std::vector<std::uint32_t>> patterns;

    ordered_json json(way how) {
        std::ranges::sort(errors);
        std::ranges::sort(nanoseconds);
        return {{"tag", way_names[static_cast<std::size_t>(how)]},
                {"median_error", errors[errors.size() / 2]},
                {"largest_error", largest},
                {"error_over_bound", over_bound},
                {"bit_patterns", patterns.size()},
                {"nanoseconds_a_value",
                 {{"median", nanoseconds[nanoseconds.size() / 2]},
                  {"least", nanoseconds.front()},
                  {"most", nanoseconds.back()}}}};
    }
};

/// In each order all ways take turns.
ordered_json measure(adder& on, problem p, int orders, std::mt19937_64& random) {
    const std::vector<sizes> of = sizes_of(p);
    float largest = 0;
    double n = 0;
    for (const float x : p.values) largest = std::max(largest, std::abs(x));
    for (const sizes& s : of) n += s.n;
    const float scale = fixed_way::scale_to_fit(largest);
    std::vector<record> records(way_names.size());
    for (int order = -1; order < orders; ++order) {  // the first warms up
        p.shuffle(random);
        on.put(p);
        for (std::size_t i = 0; i < records.size(); ++i) {
            const auto how = static_cast<way>(i);
            const std::vector<float> found = on.add_up(how);
            if (order < 0) continue;
            record& r = records[i];
            r.nanoseconds.push_back(on.nanoseconds() / n);
            std::vector<std::uint32_t> bits;
            for (std::uint32_t s = 0; s < p.sums; ++s) {
                bits.push_back(std::bit_cast<std::uint32_t>(found[s]));
                const double error = std::abs(of[s].minus(found[s]));
                r.errors.push_back(error / of[s].sum);
                r.largest = std::max(r.largest, r.errors.back());
                r.over_bound = std::max(r.over_bound, error / bound(how, of[s], scale, on.lanes()));
            }
            r.patterns.insert(bits);
        }
    }
    ordered_json tags;
    for (std::size_t i = 0; i < records.size(); ++i) tags.push_back(records[i].json(static_cast<way>(i)));
    double condition = 0;
    for (const sizes& s : of) condition = std::max(condition, s.magnitude / s.sum);
    return {{"n", n}, {"condition", condition}, {"tags", tags}};
}

/// The processor's name, by Linux; empty if it does not say.
std::string processor() {
    std::ifstream about("/proc/cpuinfo");
    for (std::string line; std::getline(about, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "";
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What sums of float err by, and cost, as they are kept");
    std::vector<std::size_t> sizes{1 << 16};
    std::vector<std::uint32_t> sums{1, 32, 1024};
    std::vector<double> shares{1};
    std::vector<std::string> values;
    bool zipf = false;
    int orders = 100;
    std::uint64_t seed = 0;
    std::string output, device = "auto";
    app.add_option("-n", sizes, "How many values")->check(CLI::Range(1024, 100000000))->capture_default_str();
    app.add_option("--sums", sums, "How many sums they go to")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    app.add_flag("--zipf", zipf, "To the k-th sum a k-th of the first one's, instead of as many to each");
    app.add_option("--active", shares, "Share of the lanes that have a value")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    std::set<std::string> names;
    for (const auto& [name, unused] : generators()) names.insert(name);
    app.add_option("--values", values, "Which; by default all")->check(CLI::IsMember(names));
    app.add_option("--orders", orders)->check(CLI::Range(1, 10000))->capture_default_str();
    app.add_option("--device", device)->check(CLI::IsMember({"auto", "cpu", "cuda"}))->capture_default_str();
    app.add_option("--seed", seed)->capture_default_str();
    app.add_option("-o,--output", output, "JSON file")->required();
    CLI11_PARSE(app, argc, argv);
    if (values.empty()) values.assign(names.begin(), names.end());
    std::string reason;
    const bool cuda = device != "cpu" && gs::train::cuda_is_available(reason);
    if (device == "cuda" && !cuda) {
        std::fprintf(stderr, "error: --device cuda: no GPU can be used: %s\n", reason.c_str());
        return 1;
    }
    const auto on = cuda ? make_cuda_adder() : make_cpu_adder();

    ordered_json rows;
    const auto all = generators();
    for (const std::string& name : values)
        for (const std::size_t n : sizes)
            for (const std::uint32_t count : sums)
                for (const double share : shares) {
                    std::mt19937_64 random(seed);
                    const problem p = draw(all.at(name), n, count, zipf, share, random);
                    ordered_json row{{"values", name}, {"sums", count}, {"zipf", zipf}, {"active", share}};
                    row.update(measure(*on, p, orders, random));
                    std::printf("%s, %.0f values, %u sums%s, %.0f %% of the lanes, condition %.1e\n",
                                name.c_str(), row["n"].get<double>(), count, zipf ? " by Zipf" : "",
                                100 * share, row["condition"].get<double>());
                    for (const auto& tag : row["tags"])
                        std::printf(
                            "  %-22s error %.1e to %.1e, of its bound %.2g, %d bit patterns, %.3f ns "
                            "a value\n",
                            tag["tag"].get<std::string>().c_str(), tag["median_error"].get<double>(),
                            tag["largest_error"].get<double>(), tag["error_over_bound"].get<double>(),
                            tag["bit_patterns"].get<int>(),
                            tag["nanoseconds_a_value"]["median"].get<double>());
                    rows.push_back(row);
                }
    const ordered_json result{{"bench", "accuracy"},      {"device", on->device()},
                              {"processor", processor()}, {"compiler", WARPAGG_COMPILER},
                              {"nvcc", WARPAGG_NVCC},     {"driver", driver_version()},
                              {"commit", WARPAGG_COMMIT}, {"seed", seed},
                              {"orders", orders},         {"rows", rows}};
    if ((std::ofstream(output) << result.dump(1) << '\n').flush()) return 0;
    std::fprintf(stderr, "error: %s cannot be written\n", output.c_str());
    return 1;
}
