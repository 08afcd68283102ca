// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "../../support/temporary_folder.hpp"
#include "training/cuda_report.hpp"

using gs::train::cuda_report;
using gs::train::reason_against_gpu;
using gs_test::says;

namespace {

const cuda_report usable{.needed_version = 13000,
                         .driver_version = 13000,
                         .devices = 1,
                         .name = "NVIDIA Example",
                         .major = 9,
                         .minor = 0,
                         .program_has_its_code = true};

}  // namespace

TEST_CASE("cuda report: a GPU with a recent driver can be used") {
    CHECK(reason_against_gpu(usable) == "");
    cuda_report newer = usable;
    newer.driver_version = 14020;
    CHECK(reason_against_gpu(newer) == "");
}

TEST_CASE("cuda report: a driver of an earlier minor version can be used") {
    cuda_report report = usable;
    report.needed_version = 13020;
    CHECK(reason_against_gpu(report) == "");
}

TEST_CASE("cuda report: a missing or older driver is the reason, whatever else CUDA reports") {
    cuda_report report{.needed_version = 13000, .error = "driver version is insufficient"};
    CHECK(says(reason_against_gpu(report), {"no NVIDIA driver", "CUDA 13.0"}));
    report.driver_version = 12040;
    CHECK(says(reason_against_gpu(report), {"supports CUDA 12.4", "needs 13.0", "update the driver"}));
}

TEST_CASE("cuda report: a driver without a GPU, an old GPU and other errors have reasons of their own") {
    cuda_report no_gpu = usable, old_gpu = usable, broken = usable;
    no_gpu.devices = 0;
    CHECK(says(reason_against_gpu(no_gpu), {"found no GPU"}));
    old_gpu.program_has_its_code = false;
    old_gpu.major = 6;
    old_gpu.minor = 1;
    CHECK(says(reason_against_gpu(old_gpu), {"NVIDIA Example", "compute capability 6.1", "no code"}));
    broken.error = "unknown error";
    CHECK(says(reason_against_gpu(broken), {"unknown error"}));
}
