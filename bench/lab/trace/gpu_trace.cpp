// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "gpu_trace.hpp"

#include <cupti.h>
#include <cxxabi.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <stdexcept>

namespace {

void check(CUptiResult status) {
    if (status == CUPTI_SUCCESS) return;
    const char* text = "";
    cuptiGetResultString(status, &text);
    throw std::runtime_error(std::string("CUPTI: ") + text);
}

constexpr std::array kinds{
    CUPTI_ACTIVITY_KIND_CONCURRENT_KERNEL, CUPTI_ACTIVITY_KIND_MEMCPY,          CUPTI_ACTIVITY_KIND_MEMSET,
    CUPTI_ACTIVITY_KIND_RUNTIME,           CUPTI_ACTIVITY_KIND_SYNCHRONIZATION, CUPTI_ACTIVITY_KIND_MEMORY2};

using interval = std::pair<std::uint64_t, std::uint64_t>;

/// What has come in. CUPTI hands buffers back on a thread of its own.
struct records {
    std::mutex guard;
    gpu_trace::result found;
    std::vector<interval> intervals;

    void add(std::map<std::string, gpu_trace::total>& to, const std::string& name, std::uint64_t start,
             std::uint64_t end) {
        ++to[name].count;
        to[name].nanoseconds += end - start;
    }
    void add_work(const std::string& name, std::uint64_t start, std::uint64_t end) {
        add(found.work, name, start, end);
        intervals.emplace_back(start, end);
    }
};

records& all_records() {
    static records r;
    return r;
}

/// Removes namespaces, parameters and repetitions.
std::string short_name(const char* mangled) {
    int status = 0;
    const std::unique_ptr<char, decltype(&std::free)> demangled(
        abi::__cxa_demangle(mangled, nullptr, nullptr, &status), &std::free);
    std::string name = status == 0 ? demangled.get() : mangled;
    if (name.starts_with("void ")) name.erase(0, 5);
    int depth = 0;
    for (std::size_t i = 0; i < name.size(); ++i) {
        depth += name[i] == '<' ? 1 : name[i] == '>' ? -1 : 0;
        if (name[i] == '(' && depth == 0) name.resize(i);
    }
    for (std::size_t i; (i = name.find("::")) != std::string::npos;) {
        std::size_t from = i;
        while (from > 0 &&
               (std::isalnum(static_cast<unsigned char>(name[from - 1])) || name[from - 1] == '_'))
            --from;
        name.erase(from, i + 2 - from);
    }
    constexpr std::size_t longest = 64;
    return name.size() > longest ? name.substr(0, longest - 3) + "..." : name;
}

const char* what_was_waited_for(CUpti_ActivitySynchronizationType type) {
    switch (type) {
        case CUPTI_ACTIVITY_SYNCHRONIZATION_TYPE_EVENT_SYNCHRONIZE:
            return "event";
        case CUPTI_ACTIVITY_SYNCHRONIZATION_TYPE_STREAM_WAIT_EVENT:
            return "event, by a stream";
        case CUPTI_ACTIVITY_SYNCHRONIZATION_TYPE_STREAM_SYNCHRONIZE:
            return "stream";
        case CUPTI_ACTIVITY_SYNCHRONIZATION_TYPE_CONTEXT_SYNCHRONIZE:
            return "device";
        default:
            return "other";
    }
}

void note(records& r, const CUpti_Activity* record) {
    switch (record->kind) {
        case CUPTI_ACTIVITY_KIND_CONCURRENT_KERNEL: {
            const auto* k = reinterpret_cast<const CUpti_ActivityKernel10*>(record);
            return r.add_work(short_name(k->name), k->start, k->end);
        }
        case CUPTI_ACTIVITY_KIND_MEMCPY: {
            const auto* m = reinterpret_cast<const CUpti_ActivityMemcpy6*>(record);
            return r.add_work("memcpy", m->start, m->end);
        }
        case CUPTI_ACTIVITY_KIND_MEMSET: {
            const auto* m = reinterpret_cast<const CUpti_ActivityMemset4*>(record);
            return r.add_work("memset", m->start, m->end);
        }
        case CUPTI_ACTIVITY_KIND_RUNTIME: {
            const auto* call = reinterpret_cast<const CUpti_ActivityAPI*>(record);
            const char* name = nullptr;
            check(cuptiGetCallbackName(CUPTI_CB_DOMAIN_RUNTIME_API, call->cbid, &name));
            return r.add(r.found.calls, name, call->start, call->end);
        }
        case CUPTI_ACTIVITY_KIND_SYNCHRONIZATION: {
            const auto* s = reinterpret_cast<const CUpti_ActivitySynchronization2*>(record);
            return r.add(r.found.waits, what_was_waited_for(s->type), s->start, s->end);
        }
        case CUPTI_ACTIVITY_KIND_MEMORY2:
            ++r.found.allocations;
            return;
        default:
            return;
    }
}

void CUPTIAPI hand_out_buffer(std::uint8_t** buffer, std::size_t* size, std::size_t* most_records) {
    *size = 8 << 20;
    *buffer = static_cast<std::uint8_t*>(std::aligned_alloc(8, *size));
    *most_records = 0;
}

void CUPTIAPI take_buffer(CUcontext, std::uint32_t, std::uint8_t* buffer, std::size_t, std::size_t valid) {
    records& r = all_records();
    const std::lock_guard lock(r.guard);
    CUpti_Activity* record = nullptr;
    while (cuptiActivityGetNextRecord(buffer, valid, &record) == CUPTI_SUCCESS) note(r, record);
    std::free(buffer);
}

/// The length of the union.
std::uint64_t covered(std::vector<interval> intervals) {
    std::ranges::sort(intervals);
    std::uint64_t sum = 0, until = 0;
    for (const auto& [start, end] : intervals) {
        sum += end > until ? end - std::max(start, until) : 0;
        until = std::max(until, end);
    }
    return sum;
}

}  // namespace

gpu_trace::gpu_trace() {
    all_records().found = {};
    all_records().intervals.clear();
    check(cuptiActivityRegisterCallbacks(hand_out_buffer, take_buffer));
    for (const auto kind : kinds) check(cuptiActivityEnable(kind));
}

gpu_trace::~gpu_trace() {
    for (const auto kind : kinds) cuptiActivityDisable(kind);
}

gpu_trace::result gpu_trace::stop() {
    for (const auto kind : kinds) check(cuptiActivityDisable(kind));
    check(cuptiActivityFlushAll(CUPTI_ACTIVITY_FLAG_FLUSH_FORCED));
    records& r = all_records();
    const std::lock_guard lock(r.guard);
    r.found.busy = covered(r.intervals);
    if (!r.intervals.empty()) {
        const auto last = std::ranges::max(r.intervals, {}, &interval::second);
        r.found.wall = last.second - std::ranges::min(r.intervals).first;
    }
    return r.found;
}
