// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace gs::live {

/// Returns 128 random bits of the operating system, as hexadecimal digits.
std::string random_token();

/// Returns whether only programs of this machine reach a server at this address.
bool is_loopback(std::string_view host);

/// Decides which requests the server answers. The token keeps out other users of the machine. The
/// headers Host and Origin keep out web pages of other sites, even if their name resolves to this
/// machine.
class access_control {
  public:
    /// `host`: the address that the server listens on.
    access_control(std::string host, int port)
        : host_(std::move(host)), port_(port), token_(random_token()) {}

    const std::string& token() const { return token_; }
    /// Compares in a time that does not depend on the content.
    bool knows(std::string_view token) const;
    /// Returns whether a Host header names the server: its address, "localhost" for a loopback
    /// address, or any address and the name of the machine if the server listens on all addresses.
    bool allows_host(std::string_view header) const;
    /// Returns whether an Origin header is that of the page itself.
    bool allows_origin(std::string_view origin, std::string_view host_header) const;
    /// Returns the URL of the page, with the token.
    std::string url() const;

  private:
    bool names_server(std::string_view in_header) const;

    std::string host_;
    int port_;
    std::string token_;
};

}  // namespace gs::live
