// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "iteration_plan.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace gs {

std::optional<iteration_plan> iteration_plan::parse(const std::string& text, int most) {
    const char *at = text.data(), *const end = at + text.size();
    const auto read = [&](int& number) {
        const auto [next, problem] = std::from_chars(at, end, number);
        at = next;
        return problem == std::errc() && number >= 1 && number <= most;
    };
    const auto skip = [&](char separator) { return at != end && *at++ == separator; };
    int last = 0;
    if (!read(last)) return {};
    iteration_plan plan(last);
    while (at != end) {
        int after = 0;
        if (!skip(',') || !read(after) || !skip(':') || !read(last)) return {};
        if (after <= plan.entries_->back().after || after > plan.last() || after >= last) return {};
        plan.correct(after, last);
    }
    return plan;
}

std::string iteration_plan::text() const {
    std::string all = std::to_string(entries_->front().last);
    for (std::size_t e = 1; e < entries_->size(); ++e)
        all += ',' + std::to_string((*entries_)[e].after) + ':' + std::to_string((*entries_)[e].last);
    return all;
}

double iteration_plan::progress(int iteration) const {
    const auto next = std::ranges::find_if(entries_->begin() + 1, entries_->end(),
                                           [=](const entry& e) { return e.after >= iteration; });
    const entry& e = *(next - 1);
    const double share = static_cast<double>(iteration - e.after) / (e.last - e.after);
    return std::min(1.0, e.progress + (1 - e.progress) * share);
}

int iteration_plan::milestone(double progress) const {
    constexpr double rounding = 1e-6;  // of products that are whole numbers
    int iteration = 0;
    for (const entry& e : *entries_) {
        if (e.after > 0 && iteration <= e.after) break;  // it is passed
        const double share = (progress - e.progress) / (1 - e.progress);
        const int after_it = static_cast<int>(std::floor(share * (e.last - e.after) + rounding));
        iteration = e.after + std::max(after_it, e.after > 0 ? 1 : 0);
    }
    return iteration;
}

void iteration_plan::correct(int after, int last) { entries_->push_back({after, last, progress(after)}); }

iteration_plan iteration_plan::first_iterations(int iteration) const {
    iteration_plan first(entries_->front().last);
    const auto later = std::ranges::find_if(entries_->begin() + 1, entries_->end(),
                                            [=](const entry& e) { return e.after > iteration; });
    first.entries_->assign(entries_->begin(), later);
    return first;
}

std::optional<int> iteration_plan::correction_after(int iteration) const {
    for (const entry& e : *entries_)
        if (e.after == iteration && iteration > 0) return e.last;
    return {};
}

}  // namespace gs
