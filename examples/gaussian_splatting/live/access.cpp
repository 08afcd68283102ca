// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "access.hpp"

#include <arpa/inet.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "../core/error.hpp"

namespace gs::live {
namespace {

/// Host names have no case, and browsers write them in small letters.
std::string in_small_letters(std::string_view name) {
    std::string small(name);
    for (char& c : small)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return small;
}

bool is_any_address(std::string_view host) { return host == "0.0.0.0" || host == "::"; }

bool is_ip_address(const std::string& text) {
    std::array<unsigned char, sizeof(in6_addr)> parsed{};
    return inet_pton(AF_INET, text.c_str(), parsed.data()) == 1 ||
           inet_pton(AF_INET6, text.c_str(), parsed.data()) == 1;
}

std::string machine_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "localhost";
}

/// Returns an address as it appears in URLs.
std::string in_url(const std::string& host) {
    return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

}  // namespace

std::string random_token() {
    std::array<unsigned char, 16> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        throw error(std::string("cannot make a random token: ") + std::strerror(errno));
    constexpr std::string_view digits = "0123456789abcdef";
    std::string token;
    for (const unsigned char byte : bytes) {
        token += digits[byte >> 4];
        token += digits[byte & 15];
    }
    return token;
}

bool is_loopback(std::string_view host) {
    return host == "localhost" || host == "::1" || host.starts_with("127.");
}

bool access_control::knows(std::string_view token) const {
    if (token.size() != token_.size()) return false;
    unsigned differences = 0;
    for (std::size_t i = 0; i < token_.size(); ++i)
        differences |= static_cast<unsigned>(static_cast<unsigned char>(token[i] ^ token_[i]));
    return differences == 0;
}

bool access_control::names_server(std::string_view in_header) const {
    const std::string name = in_small_letters(in_header);
    if (name == in_small_letters(host_)) return true;
    if (is_loopback(host_)) return name == "localhost";
    return is_any_address(host_) &&
           (name == "localhost" || name == in_small_letters(machine_name()) || is_ip_address(name));
}

bool access_control::allows_host(std::string_view header) const {
    constexpr int default_port = 80;  // which browsers leave out
    const std::string suffix = ":" + std::to_string(port_);
    if (header.ends_with(suffix))
        header.remove_suffix(suffix.size());
    else if (port_ != default_port)
        return false;
    const bool has_brackets = header.size() > 2 && header.front() == '[' && header.back() == ']';
    return names_server(has_brackets ? header.substr(1, header.size() - 2) : header);
}

bool access_control::allows_origin(std::string_view origin, std::string_view host_header) const {
    constexpr std::string_view scheme = "http://";
    return origin.starts_with(scheme) && origin.substr(scheme.size()) == host_header;
}

std::string access_control::url() const {
    const std::string host = is_any_address(host_) ? machine_name() : in_url(host_);
    return "http://" + host + ":" + std::to_string(port_) + "/?token=" + token_;
}

}  // namespace gs::live
