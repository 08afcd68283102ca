// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <arpa/inet.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <mutex>
#include <string>
#include <vector>

#include "live/http_server.hpp"

namespace gs_test {

/// A server whose frames come from the test instead of an engine.
struct fake_server {
    std::atomic<int> frames = 0, presses = 0;
    std::mutex lock{};
    gs::live::view_request last{};  ///< of the last frame; read it only when no request is running
    gs::live::http_server server{{.port = any_port()},
                                 {.scene = [] { return std::string(R"({"views":[]})"); },
                                  .status = [] { return std::string(R"({"state":"viewing"})"); },
                                  .views = 3,
                                  .draw = [this](const std::string&, const auto& r) { return draw(r); },
                                  .press = [this](gs::live::button) { ++presses; }}};

    /// Returns a port that was free just now.
    static int any_port() {
        const int probe = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        ::bind(probe, reinterpret_cast<sockaddr*>(&address), size);
        ::getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
        ::close(probe);
        return ntohs(address.sin_port);
    }

    gs::live::mailbox::answer draw(const gs::live::view_request& request) {
        ++frames;
        {
            const std::lock_guard held(lock);
            last = request;
        }
        const auto bytes = static_cast<std::size_t>(3 * request.width * request.height);
        return {gs::live::mailbox::outcome::drawn,
                {request.width, request.height, std::vector<std::uint8_t>(bytes, 128)},
                {}};
    }

    std::string origin() const { return "http://127.0.0.1:" + std::to_string(server.port()); }
    httplib::Headers headers() const { return {{"X-Token", server.token()}, {"Origin", origin()}}; }
    httplib::Client client() const {
        httplib::Client c("127.0.0.1", server.port());
        c.set_read_timeout(20);
        c.set_url_encode(false);
        return c;
    }
    /// Returns the status of a GET with the token, or -1 without a response.
    int get(const std::string& path) const {
        const auto r = client().Get(path, {{"X-Token", server.token()}});
        return r ? r->status : -1;
    }
};

inline const std::string frame_path =
    "/frame?page=a&width=32&height=24&overlay=none&position=0,0,0&forward=0,0,1&up=0,-1,0&field_of_view=1";

/// A connection that sends bytes as they are.
class raw_connection {
  public:
    explicit raw_connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        is_open_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    }
    raw_connection(const raw_connection&) = delete;
    raw_connection& operator=(const raw_connection&) = delete;
    ~raw_connection() { ::close(socket_); }

    bool is_open() const { return is_open_; }
    /// Returns whether the server accepted all bytes.
    bool send(const std::string& bytes) const {
        return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
               static_cast<ssize_t>(bytes.size());
    }
    /// Returns what the server sends until it closes the connection.
    std::string receive() const {
        std::string all;
        std::array<char, 4096> buffer;
        for (ssize_t n = 0; (n = ::recv(socket_, buffer.data(), buffer.size(), 0)) > 0;)
            all.append(buffer.data(), static_cast<std::size_t>(n));
        return all;
    }

  private:
    int socket_;
    bool is_open_ = false;
};

}  // namespace gs_test
