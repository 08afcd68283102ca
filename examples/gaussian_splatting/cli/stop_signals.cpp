// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "stop_signals.hpp"

#include <csignal>

namespace gs::cli {
namespace {

volatile std::sig_atomic_t received_signal = 0;

void record(int number) {
    if (received_signal != 0) {  // the second one ends the process
        std::signal(number, SIG_DFL);
        std::raise(number);
    }
    received_signal = number;
}

/// Sets a handler, unless the process ignores the signal, as programs do in the background.
void set_handler(int number, void (*handler)(int)) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    if (action.sa_handler == SIG_IGN) return;
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigaction(number, &action, nullptr);
}

}  // namespace

stop_signals::stop_signals() {
    received_signal = 0;
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) set_handler(number, record);
}

stop_signals::~stop_signals() {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) set_handler(number, SIG_DFL);
}

int stop_signals::received() const { return received_signal; }

}  // namespace gs::cli
