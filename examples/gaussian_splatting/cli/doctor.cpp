// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <array>
#include <cstdio>

#include "../poses/child_process.hpp"
#include "../ranks/mpi/mpi.hpp"
#include "commands.hpp"
#include "report.hpp"

namespace gs::cli {

namespace {

/// A program that the trainer can call.
struct helper_program {
    const char *name, *package, *purpose;
};
constexpr std::array helper_programs{
    helper_program{"colmap", "colmap", "computes the camera poses of photos (train --poses auto)"},
    helper_program{"ffmpeg", "ffmpeg",
                   "takes frames from videos (train --poses auto), and writes videos (render)"},
    helper_program{"ffprobe", "ffmpeg", "counts the frames of videos (train --poses auto)"}};

void print_row(const char* subject, const std::string& text) {
    std::printf("%-8s %s\n", subject, text.c_str());
}

double gibibytes_of_memory() {
    return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)) *
           0x1p-30;
}

}  // namespace

void doctor() {
    print_row("version", WARPAGG_VERSION);
    print_row("CPU", train::make_cpu_engine()->profile().device_name());
    print_row("memory", number("%.1f GiB", gibibytes_of_memory()));
    std::string reason;
    print_row("GPU", train::cuda_is_available(reason)
                         ? train::make_cuda_engine()->profile().device_name()
                         : "none, so the trainer computes on the CPU: " + reason);
    const std::string mpi = ranks::mpi_library();
    print_row("MPI", mpi.empty() ? "none, so train --mpi does not work: to get it, install libopenmpi-dev "
                                   "and build this program again"
                                 : mpi);
    for (const helper_program& p : helper_programs)
        print_row(p.name, (poses::is_installed(p.name)
                               ? std::string("installed, ")
                               : "missing (to get it: apt-get install " + std::string(p.package) + "), ") +
                              p.purpose);
}

}  // namespace gs::cli
