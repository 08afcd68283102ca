// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "progress_bar.hpp"

#include <unistd.h>

#include <cstdio>
#include <string>

namespace gs::cli {

progress_bar::progress_bar(bool quiet) : quiet_(quiet), terminal_(isatty(STDOUT_FILENO) != 0) {}

progress_bar::~progress_bar() {
    if (open_) std::printf("\n");
    std::fflush(stdout);
}

void progress_bar::show(const train::progress& p) {
    if (quiet_) return;
    const bool last = p.iteration == p.iterations;
    if (!terminal_ && !last) {
        // Prints at most twenty lines in total.
        if (p.iteration * 20LL < static_cast<long long>(lines_ + 1) * p.iterations) return;
        lines_ = static_cast<int>(p.iteration * 20LL / p.iterations);
    }
    const double rate = p.iteration / p.seconds;
    const int left = static_cast<int>((p.iterations - p.iteration) / rate);
    char text[200];
    std::snprintf(text, sizeof text, "%d/%d  %.1f it/s  loss %.4f  PSNR %.2f  %zu Gaussians  %d:%02d left",
                  p.iteration, p.iterations, rate, p.loss, p.psnr, p.gaussians, left / 60, left % 60);
    if (terminal_) {
        constexpr int width = 24;
        const int full = static_cast<int>(static_cast<long long>(width) * p.iteration / p.iterations);
        const std::string bar = std::string(static_cast<std::size_t>(full), '#') +
                                std::string(static_cast<std::size_t>(width - full), '.');
        std::printf("\r[%s] %s\x1b[K%s", bar.c_str(), text, last ? "\n" : "");
        open_ = !last;
    } else {
        std::printf("%s\n", text);
    }
    std::fflush(stdout);
}

void progress_bar::clear() {
    if (open_) std::printf("\r\x1b[K");
    open_ = false;
}

}  // namespace gs::cli
