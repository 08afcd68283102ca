// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What accuracy costs: sums of float kept in each way that a policy has, on the emulator. Values of a chosen
/// condition number are added in many orders; each sum is compared with the exact one, and its error with the
/// bound that is documented for it. One sum for all values, or many that values go to at random.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>
#include <vector>
#include <warpagg/match.hpp>
#include <warpagg/simt/lanes.hpp>

namespace {

using nlohmann::ordered_json;
using namespace warpagg;
using warp_model = emulator::narrow_lanes<8>;

constexpr double u = 0x1p-24;

struct problem {
    std::vector<float> values;
    std::vector<std::uint32_t> keys;  ///< the sum that each value goes to
    std::uint32_t sums;

    void shuffle(std::mt19937_64& random) {
        for (std::size_t i = values.size(); i > 1; --i) {
            const std::size_t other = random() % i;
            std::swap(values[i - 1], values[other]);
            std::swap(keys[i - 1], keys[other]);
        }
    }
};

/// Pairs that cancel but for a tenth of them, which have what is left: sum|x| / |sum x| is about k.
void add_conditioned(double k, std::size_t n, std::mt19937_64& random, std::vector<float>& values) {
    std::normal_distribution<float> normal;
    const std::size_t first = values.size(), pairs = n * 9 / 20;
    double magnitude = 0;
    for (std::size_t i = 0; i < pairs; ++i) {
        const float x = normal(random);
        values.insert(values.end(), {x, -x});
        magnitude += 2 * std::abs(static_cast<double>(x));
    }
    const std::size_t left = first + n - values.size();
    const double each = std::max(magnitude, 1.0) / k / static_cast<double>(left);
    while (values.size() < first + n)
        values.push_back(static_cast<float>(each) * (1 + 0.1f * std::abs(normal(random))));
}

using generator = std::function<void(std::size_t, std::mt19937_64&, std::vector<float>&)>;

std::map<std::string, generator> generators() {
    std::map<std::string, generator> all;
    all["uniform"] = [](std::size_t n, std::mt19937_64& random, std::vector<float>& values) {
        std::uniform_real_distribution<float> draw(0, 1);
        for (std::size_t i = 0; i < n; ++i) values.push_back(draw(random));
    };
    all["lognormal"] = [](std::size_t n, std::mt19937_64& random, std::vector<float>& values) {
        std::lognormal_distribution<float> draw(0, 3);
        for (std::size_t i = 0; i < n; ++i) values.push_back(draw(random));
    };
    for (const int range : {30, 120, 250})
        all["2^-" + std::to_string(range) + " to 1"] = [range](std::size_t n, std::mt19937_64& random,
                                                               std::vector<float>& values) {
            std::uniform_real_distribution<float> draw(-1, 1);
            for (std::size_t i = 0; i < n; ++i)
                values.push_back(std::ldexp(
                    draw(random), 100 - static_cast<int>(random() % static_cast<unsigned>(range + 1))));
        };
    for (int decade = 0; decade <= 12; decade += 2)
        all[std::string("condition 1e") + (decade < 10 ? "0" : "") + std::to_string(decade)] =
            [decade](std::size_t n, std::mt19937_64& random, std::vector<float>& values) {
                add_conditioned(std::pow(10, decade), n, random, values);
            };
    return all;
}

problem draw(const generator& values_of, std::size_t n, std::uint32_t sums, std::mt19937_64& random) {
    problem p{{}, {}, sums};
    for (std::uint32_t s = 0; s < sums; ++s) {
        values_of(n / sums, random, p.values);
        p.keys.resize(p.values.size(), s);
    }
    p.shuffle(random);
    return p;
}

/// Where `native` keeps its sums, so that it reads like the others.
struct native_cell {
    float number;
    float value() const { return number; }
};

template <class Accumulate>
using cell_of =
    typename std::conditional_t<std::is_same_v<Accumulate, accumulate::native>,
                                std::type_identity<native_cell>, std::type_identity<cell<Accumulate>>>::type;

template <class Accumulate>
std::vector<cell_of<Accumulate>> add_up(const problem& p, const Accumulate& how) {
    std::vector<cell_of<Accumulate>> cells(p.sums);
    const warp_model w;
    const policy all{how};
    const auto n = static_cast<unsigned>(p.values.size());
    for (unsigned base = 0; base < n; base += warp_model::size) {
        const auto index = w.lane() + base;
        const auto active = index < n;
        const value_t<warp_model, float> v[1] = {w.load(p.values.data(), index, active)};
        auto* const to = [&] {
            if constexpr (std::is_same_v<Accumulate, accumulate::native>) {
                return &cells[0].number;
            } else {
                return cells.data();
            }
        }();
        if (p.sums == 1) {
            warp_reduce_atomic<float, 1>(w, to, v, active, all);
        } else {
            warp_match_reduce_atomic(w, to, w.load(p.keys.data(), index, active), v, active, all);
        }
    }
    return cells;
}

/// Of each sum of a problem, what errors are relative to and bounds are made of.
struct sizes {
    double n = 0, magnitude = 0, largest = 0, sum = 0;
    cell<accumulate::exact> exact;

    /// How far x is from the exact sum, rounded once.
    double minus(float x) const {
        cell<accumulate::exact> difference = exact;
        std::int64_t numbers[accumulate::exact::numbers];
        accumulate::exact::split(-x, numbers);
        for (int i = 0; i < accumulate::exact::numbers; ++i) difference.number[i] += numbers[i];
        return static_cast<double>(difference.value());
    }
};

std::vector<sizes> sizes_of(const problem& p) {
    std::vector<sizes> all(p.sums);
    const auto exact = add_up(p, accumulate::exact{});
    for (std::size_t i = 0; i < p.values.size(); ++i) {
        sizes& s = all[p.keys[i]];
        const double x = std::abs(static_cast<double>(p.values[i]));
        ++s.n;
        s.magnitude += x;
        s.largest = std::max(s.largest, x);
    }
    for (std::uint32_t i = 0; i < p.sums; ++i) {
        all[i].exact = exact[i];
        all[i].sum = std::abs(static_cast<double>(exact[i].value()));
    }
    return all;
}

using bound = std::function<double(const sizes&)>;

template <class Accumulate>
ordered_json measure(problem p, const std::vector<sizes>& of, const char* name, const Accumulate& how,
                     const bound& most, int orders, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<double> errors;
    double largest = 0, over_bound = 0;
    std::vector<double> nanoseconds;
    std::set<std::vector<std::uint32_t>> patterns;
    for (int order = 0; order < orders; ++order) {
        p.shuffle(random);
        const auto start = std::chrono::steady_clock::now();
        const auto cells = add_up(p, how);
        const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
        nanoseconds.push_back(taken.count() / static_cast<double>(p.values.size()));
        std::vector<std::uint32_t> bits;
        for (std::uint32_t i = 0; i < p.sums; ++i) {
            float found = cells[i].value();
            if constexpr (requires { how.scale; }) found /= how.scale;
            bits.push_back(std::bit_cast<std::uint32_t>(found));
            const double error = std::abs(of[i].minus(found));
            errors.push_back(error / of[i].sum);
            largest = std::max(largest, errors.back());
            over_bound = std::max(over_bound, error / most(of[i]));
        }
        patterns.insert(bits);
    }
    std::ranges::sort(errors);
    std::ranges::sort(nanoseconds);
    return {{"tag", name},
            {"median_error", errors[errors.size() / 2]},
            {"largest_error", largest},
            {"error_over_bound", over_bound},
            {"bit_patterns", patterns.size()},
            {"nanoseconds_a_value",
             {{"median", nanoseconds[nanoseconds.size() / 2]},
              {"least", nanoseconds.front()},
              {"most", nanoseconds.back()}}}};
}

ordered_json measure_all(const problem& p, const std::vector<sizes>& of, int orders, std::uint64_t seed) {
    ordered_json tags;
    const auto add = [&](const char* name, const auto& how, const bound& most) {
        tags.push_back(measure(p, of, name, how, most, orders, seed));
    };
    float largest = 0;
    for (const float x : p.values) largest = std::max(largest, std::abs(x));
    using fixed = accumulate::fixed<20>;
    const float scale = fixed::scale_to_fit(largest);
    add("native", accumulate::native{}, [](const sizes& s) { return s.n * u * s.magnitude; });
    add("f64", accumulate::f64{}, [](const sizes& s) { return s.n * 0x1p-53 * s.magnitude + u * s.sum; });
    add("compensated", accumulate::compensated{},
        [](const sizes& s) { return u * s.sum + 5 * s.n * u * u * s.magnitude; });
    add("fixed, scaled to fit", fixed{nullptr, scale},
        [&](const sizes& s) { return s.n * 0x1p-21 / static_cast<double>(scale) + u * s.sum; });
    add("binned<2>", accumulate::binned<2>{},
        [](const sizes& s) { return s.n * 0x1p-24 * s.largest + u * s.sum; });
    add("binned<3>", accumulate::binned<3>{},
        [](const sizes& s) { return s.n * 0x1p-48 * s.largest + u * s.sum; });
    add("exact", accumulate::exact{}, [](const sizes& s) { return u * s.sum; });
    return tags;
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
    std::size_t n = 1 << 16;
    std::vector<std::uint32_t> sums{1, 32, 1024};
    int orders = 100;
    std::uint64_t seed = 0;
    std::string output;
    app.add_option("-n", n, "Values")->check(CLI::Range(1024, 100000000))->capture_default_str();
    app.add_option("--sums", sums, "How many sums they go to")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    app.add_option("--orders", orders)->check(CLI::Range(1, 10000))->capture_default_str();
    app.add_option("--seed", seed)->capture_default_str();
    app.add_option("-o,--output", output, "JSON file")->required();
    CLI11_PARSE(app, argc, argv);

    ordered_json rows;
    for (const auto& [name, values_of] : generators())
        for (const std::uint32_t count : sums) {
            std::mt19937_64 random(seed);
            const problem p = draw(values_of, n, count, random);
            const std::vector<sizes> of = sizes_of(p);
            double condition = 0;
            for (const sizes& s : of) condition = std::max(condition, s.magnitude / s.sum);
            rows.push_back({{"values", name},
                            {"sums", count},
                            {"n", p.values.size()},
                            {"condition", condition},
                            {"tags", measure_all(p, of, orders, seed)}});
            std::printf("%s, %u sums, condition %.1e\n", name.c_str(), count, condition);
            for (const auto& tag : rows.back()["tags"])
                std::printf(
                    "  %-22s error %.1e to %.1e, of its bound %.2g, %d bit patterns, %.1f ns a value\n",
                    tag["tag"].get<std::string>().c_str(), tag["median_error"].get<double>(),
                    tag["largest_error"].get<double>(), tag["error_over_bound"].get<double>(),
                    tag["bit_patterns"].get<int>(), tag["nanoseconds_a_value"]["median"].get<double>());
        }
    const ordered_json result{{"bench", "accuracy"},      {"device", "emulator, 8 lanes"},
                              {"processor", processor()}, {"compiler", WARPAGG_COMPILER},
                              {"commit", WARPAGG_COMMIT}, {"seed", seed},
                              {"orders", orders},         {"rows", rows}};
    if ((std::ofstream(output) << result.dump(1) << '\n').flush()) return 0;
    std::fprintf(stderr, "error: %s cannot be written\n", output.c_str());
    return 1;
}
