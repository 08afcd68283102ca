// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <httplib.h>

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace gs::live {

/// Threads that answer connections. If all are busy and the queue is full, no more connections are
/// accepted, so that they cannot use up the files of the process.
class worker_threads final : public httplib::TaskQueue {
  public:
    static constexpr std::size_t count = 32, longest_queue = 32;

    worker_threads() {
        for (std::size_t i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
    }

    void enqueue(std::function<void()> task) override {
        std::unique_lock held(lock_);
        changed_.wait(held, [this] { return tasks_.size() < longest_queue; });
        tasks_.push_back(std::move(task));
        changed_.notify_all();
    }
    void shutdown() override {
        {
            const std::lock_guard held(lock_);
            ends_ = true;
        }
        changed_.notify_all();
        for (std::thread& t : threads_) t.join();
    }

  private:
    void work() {
        while (true) {
            std::unique_lock held(lock_);
            changed_.wait(held, [this] { return ends_ || !tasks_.empty(); });
            if (tasks_.empty()) return;
            const std::function<void()> task = std::move(tasks_.front());
            tasks_.pop_front();
            changed_.notify_all();
            held.unlock();
            task();
        }
    }

    std::mutex lock_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;
    bool ends_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace gs::live
