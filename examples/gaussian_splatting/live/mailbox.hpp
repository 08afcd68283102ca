// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "view_request.hpp"

namespace gs::live {

/// A frame as 8-bit RGB, row by row from the top.
struct picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// The frames that pages ask for. The threads of the server leave requests, and the thread that owns
/// the engine answers them when it has time.
class mailbox {
  public:
    enum class outcome {
        drawn,
        failed,    ///< `error` has the reason
        replaced,  ///< by a later request of the same page
        busy,      ///< too many pages wait
        too_late   ///< not drawn in time, or the mailbox is closed
    };
    struct answer {
        mailbox::outcome outcome = outcome::too_late;
        live::picture picture{};
        std::string error{};
    };

    static constexpr std::size_t most_pages = 32;  ///< pages that wait at the same time

    /// @name For the threads of the server
    /// @{
    /// Asks for a frame, and waits until it is drawn, at most for `patience`. A page has one request
    /// at a time: a later one replaces it.
    answer ask(const std::string& page, const view_request& request, std::chrono::milliseconds patience);
    /// Wakes the thread of the engine.
    void ring();
    /// @}

    /// @name For the thread of the engine
    /// @{
    /// Returns the number of requests that wait. Takes no lock.
    std::size_t requests() const { return waiting_.load(std::memory_order_relaxed); }
    /// Answers all waiting requests. A request for which `draw` throws an exception fails.
    void serve(const std::function<picture(const view_request&)>& draw);
    /// Waits until requests wait or `ring` is called, at most for `patience`.
    void wait(std::chrono::milliseconds patience);
    /// Ends all waiting requests, and refuses later ones.
    void close();
    /// @}

  private:
    struct slot {
        view_request request;
        bool done = false;
        live::mailbox::answer answer;
    };

    void finish(slot& s, answer with);

    std::mutex lock_;
    std::condition_variable answered_, asked_;
    std::map<std::string, std::shared_ptr<slot>> slots_;  ///< by page
    std::atomic<std::size_t> waiting_ = 0;                ///< size of `slots_`
    bool rung_ = false, closed_ = false;
};

}  // namespace gs::live
