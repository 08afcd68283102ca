// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "device/cpu/cpu.hpp"

namespace {

using gs::device::cpu;
using gs::device::device;

struct complete : cpu {};
struct without_sort : cpu {
    void sort_pairs() = delete;
};
struct without_times : cpu {
    void times() = delete;
};
struct without_sums_over_ranks : cpu {
    void sum_over_ranks() = delete;
};
struct without_gather : cpu {
    void gather() = delete;
};
struct without_uploads_beside_kernels : cpu {
    void begin_upload() = delete;
};
struct without_narrow_warp : cpu {
    using narrow_warp = void;
};
struct with_buffers_of_constant_size : cpu {
    template <class T>
    struct buffer {
        T* data() const;
        std::size_t size() const;
    };
};

}  // namespace

TEST_CASE("device: a type that lacks one member is no model") {
    CHECK(device<complete>);
    CHECK_FALSE(device<without_sort>);
    CHECK_FALSE(device<without_times>);
    CHECK_FALSE(device<without_sums_over_ranks>);
    CHECK_FALSE(device<without_gather>);
    CHECK_FALSE(device<without_uploads_beside_kernels>);
    CHECK_FALSE(device<without_narrow_warp>);
    CHECK_FALSE(device<with_buffers_of_constant_size>);
    CHECK_FALSE(device<int>);
}
