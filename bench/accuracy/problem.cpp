// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "problem.hpp"

#include <algorithm>
#include <cmath>

using namespace warpagg;

namespace {

/// Nine tenths of the values form pairs that cancel; the rest makes sum|x| / |sum x| about k.
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

/// Adds one value.
void add(accumulator<accumulate::exact>& sum, float x) {
    std::int64_t limbs[accumulate::exact::limbs];
    accumulate::exact::decompose(x, limbs);
    for (int i = 0; i < accumulate::exact::limbs; ++i) sum.limb[i] += limbs[i];
}

}  // namespace

void problem::shuffle(std::mt19937_64& random) {
    for (std::size_t i = values.size(); i > 1; --i) {
        const std::size_t other = random() % i;
        std::swap(values[i - 1], values[other]);
        std::swap(keys[i - 1], keys[other]);
    }
}

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

problem draw(const generator& values_of, std::size_t n, std::uint32_t sums, bool zipf, double active,
             std::mt19937_64& random) {
    problem p{{}, {}, sums};
    double harmonic = 0;
    for (std::uint32_t s = 0; s < sums; ++s) harmonic += 1.0 / (s + 1);
    for (std::uint32_t s = 0; s < sums; ++s) {
        const double share = zipf ? 1 / ((s + 1) * harmonic) : 1.0 / sums;
        constexpr std::size_t least = 8;  // or there is nothing to condition
        values_of(std::max(least, static_cast<std::size_t>(static_cast<double>(n) * share)), random,
                  p.values);
        p.keys.resize(p.values.size(), s);
    }
    const auto lanes = static_cast<std::size_t>(static_cast<double>(p.values.size()) / active);
    p.values.resize(lanes, 0.0f);
    p.keys.resize(lanes, problem::nowhere);
    p.shuffle(random);
    return p;
}

double sizes::minus(float x) const {
    accumulator<accumulate::exact> difference = exact;
    add(difference, -x);
    return static_cast<double>(difference.value());
}

std::vector<sizes> sizes_of(const problem& p) {
    std::vector<sizes> all(p.sums);
    for (std::size_t i = 0; i < p.values.size(); ++i) {
        if (p.keys[i] == problem::nowhere) continue;
        sizes& s = all[p.keys[i]];
        const double x = std::abs(static_cast<double>(p.values[i]));
        ++s.n;
        s.magnitude += x;
        s.largest = std::max(s.largest, x);
        add(s.exact, p.values[i]);
    }
    for (sizes& s : all) s.sum = std::abs(static_cast<double>(s.exact.value()));
    return all;
}
