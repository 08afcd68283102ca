// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/// What a call of warp_reduce_atomic costs by policy, type, number of values and share of active lanes: the
/// figures behind `default_policy`.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "../cuda_figures.hpp"
#include "variants.hpp"

namespace {

constexpr int rounds = 5;

struct share {
    const char* lanes;
    activity who;
    bool for_every_n;
};
constexpr std::uint32_t percent = 42949673u;
constexpr share shares[] = {{"32", {32, 0}, true},
                            {"12", {12, 0}, false},
                            {"8", {8, 0}, false},
                            {"6", {6, 0}, false},
                            {"5", {5, 0}, false},
                            {"4", {4, 0}, true},
                            {"3", {3, 0}, false},
                            {"2", {2, 0}, false},
                            {"1", {1, 0}, true},
                            {"50 %", {0, 50 * percent}, false},
                            {"15 %", {0, 15 * percent}, false},
                            {"3 %", {0, 3 * percent}, true}};

/// Numbers of values for which all shares are measured; for the others, those that the default depends on.
bool is_examined(int n) {
    constexpr int all[] = {1, 2, 3, 4, 8, 9, 16, 32};
    return std::ranges::find(all, n) != std::end(all);
}

double thousandths(double x) { return std::round(x * 1000) / 1000; }

/// The variants of one question take turns, so that other work of the machine affects all of them.
void measure(const std::vector<const variant*>& of, share s, void* memory,
             nlohmann::ordered_json& questions) {
    std::map<const variant*, std::vector<double>> ms;
    stopwatch watch;
    for (int round = -1; round < rounds; ++round)  // the first warms up
        for (const variant* v : of) {
            const double t = watch.milliseconds([&] { v->launch(memory, s.who); });
            if (round >= 0) ms[v].push_back(t);
        }
    nlohmann::ordered_json policies;
    for (const variant* v : of) {
        auto& all = ms[v];
        std::ranges::sort(all);
        const std::string policy = v->policy + std::string(v->aligned ? "" : ", unaligned");
        std::printf("%s\t%d\t%s\t%s\t%.3f\n", v->type, v->n, s.lanes, policy.c_str(), all[rounds / 2]);
        policies[policy] = {thousandths(all[rounds / 2]), thousandths(all.front()), thousandths(all.back())};
    }
    questions.push_back({{"type", of[0]->type}, {"n", of[0]->n}, {"active", s.lanes}, {"ms", policies}});
}

/// A question a line: whoever compares two runs sees which have changed.
void write(const char* path, nlohmann::ordered_json json) {
    const nlohmann::ordered_json questions = json["median_least_most"];
    json.erase("median_least_most");
    std::string head = json.dump(1);
    head.resize(head.rfind('\n'));
    std::ofstream out(path);
    out << head << ",\n \"median_least_most\": [";
    for (std::size_t i = 0; i < questions.size(); ++i)
        out << (i == 0 ? "\n" : ",\n") << "  " << questions[i].dump();
    out << "\n ]\n}\n";
}

}  // namespace

int main(int argc, char** argv) {
    try {
        nlohmann::ordered_json json = figures_of_this_gpu("atomics");
        json["seed"] = seed;
        json["warp_steps"] = std::uint64_t{blocks} * (threads / 32) * steps_per_warp;
        json["records"] = records;
        json["rounds"] = rounds;

        std::map<std::pair<std::string, int>, std::vector<const variant*>> questions;
        for (const variant& v : variants()) questions[{v.type, v.n}].push_back(&v);
        void* memory = nullptr;
        check(cudaMalloc(&memory, 33 * sizeof(double) * records));
        check(cudaMemset(memory, 0, 33 * sizeof(double) * records));
        std::printf("type\tN\tactive\tpolicy\tms\n");
        for (const auto& [key, of] : questions)
            for (const share s : shares)
                if (s.for_every_n || is_examined(key.second))
                    measure(of, s, memory, json["median_least_most"]);
        check(cudaFree(memory));
        if (argc > 1) write(argv[1], json);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\n", e.what());
        return 2;
    }
}
