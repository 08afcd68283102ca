// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mailbox.hpp"

namespace gs::live {

/// The buttons of the page.
enum class button { pause, resume, save, stop };
constexpr std::array<std::string_view, 4> names_of(button) { return {"pause", "resume", "save", "stop"}; }

/// The source of everything that the server sends. Several threads call these functions.
struct page_source {
    std::function<std::string()> scene;   ///< JSON: see `scene_json`
    std::function<std::string()> status;  ///< JSON: see `live_view::status_json`
    std::size_t views = 0;                ///< number of training views
    /// Draws a frame for a page, which a random word identifies.
    std::function<mailbox::answer(const std::string& page, const view_request&)> draw;
    std::function<void(button)> press;
};

/// Where a server listens.
struct server_address {
    static constexpr int default_port = 8080;

    std::string host = "127.0.0.1";
    std::optional<int> port{};  ///< if unset: `default_port`, or any port if it is in use
};

/// An HTTP server for the page of the live view, with threads of its own. Every request needs the
/// token, and POST requests also need the headers Host and Origin of the page: see `access_control`.
/// Limits the size, the time and the number of requests. Sends nothing that is not in the program.
class http_server {
  public:
    /// Begins to listen. Throws `error` if the port is in use or the address is not of this machine.
    http_server(const server_address& address, page_source source);
    http_server(const http_server&) = delete;
    http_server& operator=(const http_server&) = delete;
    /// Waits for requests that are being answered. `page_source::draw` must return soon.
    ~http_server();

    std::string url() const;  ///< with the token
    std::string token() const;
    int port() const;

  private:
    class listener;
    std::unique_ptr<listener> listener_;
};

}  // namespace gs::live
