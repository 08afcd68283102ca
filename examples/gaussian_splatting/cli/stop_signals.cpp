// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "stop_signals.hpp"

#include <csignal>

namespace gs::cli {
namespace {

volatile std::sig_atomic_t received_signal = 0;

void record(int number) { received_signal = number; }

/// Sets a handler, unless the process ignores the signal, as programs do in the background.
void set_handler(int number, void (*handler)(int)) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    if (action.sa_handler == SIG_IGN) return;
    action.sa_handler = handler;
    action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);  // the second signal ends the process
    sigaction(number, &action, nullptr);
}

}  // namespace

stop_signals::stop_signals() {
    received_signal = 0;
    set_handler(SIGINT, record);
    set_handler(SIGTERM, record);
}

stop_signals::~stop_signals() {
    set_handler(SIGINT, SIG_DFL);
    set_handler(SIGTERM, SIG_DFL);
}

int stop_signals::received() const { return received_signal; }

}  // namespace gs::cli
