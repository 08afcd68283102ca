// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <mutex>
#include <set>

#include "connection.hpp"

namespace gs::live {

/// A server that answers one request per connection, within the limits of `connection`.
class limited_server final : public httplib::Server {
  public:
    /// Lets connections of many pages wait until they are accepted; httplib lets only five wait.
    void let_connections_wait() { ::listen(svr_sock_, 64); }

    /// Ends the reading of all connections, so that silent clients do not delay the end.
    void hang_up() {
        const std::lock_guard held(lock_);
        has_hung_up_ = true;
        for (const socket_t socket : open_) ::shutdown(socket, SHUT_RD);
    }

  private:
    bool process_and_close_socket(socket_t socket) override {
        {
            const std::lock_guard held(lock_);
            open_.insert(socket);
            if (has_hung_up_) ::shutdown(socket, SHUT_RD);
        }
        connection client(socket);
        bool is_closed = false;
        // A request may name thousands of ranges, and httplib would send each of them.
        const bool answered =
            process_request(client, true, is_closed, [](httplib::Request& r) { r.ranges.clear(); });
        client.finish();
        {
            const std::lock_guard held(lock_);
            open_.erase(socket);
        }
        ::close(socket);
        return answered;
    }

    std::mutex lock_;
    std::set<socket_t> open_;
    bool has_hung_up_ = false;
};

}  // namespace gs::live
