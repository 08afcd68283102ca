// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <string>

namespace gs::live {

/// A connection with limits on its whole duration and size. The timeouts of httplib hold for each
/// byte only, and it accepts any number of headers.
class connection final : public httplib::Stream {
    using clock = std::chrono::steady_clock;

  public:
    static constexpr std::size_t most_bytes = 64 * 1024;  ///< of a request
    static constexpr std::chrono::seconds longest_read{5}, longest_write{10};

    explicit connection(socket_t socket) : socket_(socket), read_until_(clock::now() + longest_read) {}

    bool is_readable() const override { return begin_ < end_ || waits_for(POLLIN, read_until_); }
    bool is_writable() const override { return waits_for(POLLOUT, clock::now() + longest_write); }

    ssize_t read(char* to, std::size_t size) override {
        if (begin_ == end_ && !fill()) return -1;
        const std::size_t count = std::min(size, end_ - begin_);
        std::memcpy(to, buffer_.data() + begin_, count);
        begin_ += count;
        return static_cast<ssize_t>(count);
    }
    ssize_t write(const char* from, std::size_t size) override {
        if (!is_writing_) write_until_ = clock::now() + longest_write;
        is_writing_ = true;
        if (!waits_for(POLLOUT, write_until_)) return -1;
        return ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    }

    /// Ends the response. Discards what the client still sends, for a short time, because closing a
    /// socket with unread bytes can destroy the response on its way.
    void finish() {
        ::shutdown(socket_, SHUT_WR);
        const auto until = clock::now() + std::chrono::seconds(1);
        while (waits_for(POLLIN, until) && ::recv(socket_, buffer_.data(), buffer_.size(), 0) > 0) {
        }
    }

    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    socket_t socket() const override { return socket_; }

  private:
    bool waits_for(short event, clock::time_point until) const {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - clock::now());
        pollfd waits{socket_, event, 0};
        return left.count() > 0 && ::poll(&waits, 1, static_cast<int>(left.count())) > 0;
    }
    bool fill() {
        if (received_ >= most_bytes || !waits_for(POLLIN, read_until_)) return false;
        const ssize_t count = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
        begin_ = 0;
        end_ = count > 0 ? static_cast<std::size_t>(count) : 0;
        received_ += end_;
        return count > 0;
    }

    socket_t socket_;
    clock::time_point read_until_, write_until_{};
    bool is_writing_ = false;
    std::array<char, 4096> buffer_;
    std::size_t begin_ = 0, end_ = 0, received_ = 0;
};

}  // namespace gs::live
