// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "http_server.hpp"

#include <atomic>
#include <exception>
#include <thread>
#include <utility>

#include "../core/error.hpp"
#include "../image/image.hpp"
#include "access.hpp"
#include "limited_server.hpp"
#include "worker_threads.hpp"

namespace gs::embedded {
extern const std::string_view live_page;
}

namespace gs::live {
namespace {

using httplib::Request, httplib::Response;
using handler_result = httplib::Server::HandlerResponse;

constexpr std::size_t most_body_bytes = 1024;
constexpr std::size_t longest_page_name = 40;
constexpr int jpeg_quality = 85;

void send_text(Response& response, int status, const std::string& sentence) {
    response.status = status;
    response.set_content(sentence + "\n", "text/plain; charset=utf-8");
}

std::string token_in(const Request& request) {
    return request.has_header("X-Token") ? request.get_header_value("X-Token")
                                         : request.get_param_value("token");
}

/// Replaces each `@nonce@` of the page, whose scripts and styles only run with this nonce.
std::string page_with(const std::string& nonce) {
    constexpr std::string_view placeholder = "@nonce@";
    std::string page(embedded::live_page);
    for (auto at = page.find(placeholder); at != std::string::npos; at = page.find(placeholder, at))
        page.replace(at, placeholder.size(), nonce);
    return page;
}

void send_page(Response& response) {
    const std::string nonce = random_token();
    response.set_header("Content-Security-Policy",
                        "default-src 'none'; connect-src 'self'; img-src data: blob:; script-src 'nonce-" +
                            nonce + "'; style-src 'nonce-" + nonce +
                            "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    response.set_content(page_with(nonce), "text/html; charset=utf-8");
}

/// The page starts a random word of letters and digits.
std::string page_of(const Request& request) {
    const std::string page = request.get_param_value("page");
    const bool is_word = !page.empty() && page.size() <= longest_page_name &&
                         page.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyz") == std::string::npos;
    if (!is_word) throw error("the parameter page must be a word of digits and small letters");
    return page;
}

void send_frame(const mailbox::answer& drawn, Response& response) {
    switch (drawn.outcome) {
        case mailbox::outcome::drawn: {
            const picture& p = drawn.picture;
            const auto bytes = encode_jpeg(p.width, p.height, p.rgb, jpeg_quality);
            response.set_content(reinterpret_cast<const char*>(bytes.data()), bytes.size(), "image/jpeg");
            return;
        }
        case mailbox::outcome::failed:
            return send_text(response, 500, drawn.error);
        case mailbox::outcome::replaced:
        case mailbox::outcome::too_late:
            response.status = 204;
            return;
        case mailbox::outcome::busy:
            return send_text(response, 503, "too many pages wait for a frame: close some of them");
    }
}

}  // namespace

class http_server::listener {
  public:
    listener(const server_address& address, page_source source)
        : source_(std::move(source)), access_(address.host, bind(address)) {
        server_.set_pre_routing_handler([this](const Request& q, Response& r) { return check(q, r); });
        server_.set_exception_handler([](const Request&, Response& r, std::exception_ptr) {
            send_text(r, 500, "the program failed to answer");
        });
        server_.set_payload_max_length(most_body_bytes);
        server_.set_default_headers({{"Cache-Control", "no-store"},
                                     {"Referrer-Policy", "no-referrer"},
                                     {"X-Content-Type-Options", "nosniff"},
                                     {"Cross-Origin-Resource-Policy", "same-origin"}});
        add_routes();
        server_.new_task_queue = [] { return new worker_threads; };
        server_.let_connections_wait();
        thread_ = std::thread([this] {
            server_.listen_after_bind();
            has_ended_ = true;
        });
    }
    listener(const listener&) = delete;
    listener& operator=(const listener&) = delete;
    ~listener() {
        // Before the server runs, `stop` would have no effect.
        while (!server_.is_running() && !has_ended_) std::this_thread::yield();
        server_.stop();
        server_.hang_up();
        thread_.join();
    }

    const access_control& access() const { return access_; }
    int port() const { return port_; }

  private:
    /// Begins to listen, and returns the port.
    int bind(const server_address& address) {
        // Without SO_REUSEPORT, which would let two programs share a port.
        server_.set_socket_options([](socket_t socket) {
            const int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        const int first = address.port.value_or(server_address::default_port);
        port_ = first;
        if (server_.bind_to_port(address.host, first)) return port_;
        if (!address.port) port_ = server_.bind_to_any_port(address.host);
        if (address.port || port_ <= 0)
            throw error("cannot listen on port " + std::to_string(first) + " of " + address.host +
                        ": the port is in use, or the address is not of this machine; leave out the "
                        "port to use a free one");
        return port_;
    }

    /// Answers requests that are not allowed, before their body is read.
    handler_result check(const Request& request, Response& response) const {
        const std::string host = request.get_header_value("Host");
        const bool posts = request.method == "POST";
        const bool has_origin = request.has_header("Origin");
        if (!access_.allows_host(host) || request.get_header_value_count("Host") != 1)
            send_text(response, 403, "the header Host does not name this server");
        else if ((posts || has_origin) && !access_.allows_origin(request.get_header_value("Origin"), host))
            send_text(response, 403, "the header Origin does not belong to this server");
        else if (!access_.knows(token_in(request)))
            send_text(response, 403,
                      "the token is missing or wrong: open the URL that the program has printed");
        else if (!posts && request.method != "GET")
            send_text(response, 405, "this server knows GET and POST only");
        else if (request.has_header("Transfer-Encoding") || request.has_header("Content-Encoding") ||
                 (posts && !request.has_header("Content-Length")))
            send_text(response, 411, "the request needs the header Content-Length, and no encoding");
        else if (request.get_header_value<std::uint64_t>("Content-Length") > most_body_bytes)
            send_text(response, 413, "the body of the request is too large");
        else
            return handler_result::Unhandled;
        return handler_result::Handled;
    }

    void add_routes() {
        server_.Get("/", [](const Request&, Response& r) { send_page(r); });
        server_.Get("/scene", [this](const Request&, Response& r) { send_json(r, source_.scene()); });
        server_.Get("/status", [this](const Request&, Response& r) { send_json(r, source_.status()); });
        server_.Get("/frame", [this](const Request& q, Response& r) { frame(q, r); });
        const auto names = names_of(button{});
        for (std::size_t i = 0; i < names.size(); ++i)
            server_.Post("/" + std::string(names[i]), [this, i](const Request&, Response& r) {
                source_.press(static_cast<button>(i));
                send_json(r, source_.status());
            });
    }

    static void send_json(Response& response, const std::string& json) {
        response.set_content(json, "application/json");
    }

    void frame(const Request& request, Response& response) const {
        try {
            const auto parameter = [&](const char* name) { return request.get_param_value(name); };
            const view_request wanted = read_view_request(parameter, source_.views);
            send_frame(source_.draw(page_of(request), wanted), response);
        } catch (const error& e) {
            send_text(response, 400, e.what());
        }
    }

    limited_server server_;
    page_source source_;
    int port_ = 0;
    access_control access_;
    std::atomic<bool> has_ended_ = false;
    std::thread thread_;
};

http_server::http_server(const server_address& address, page_source source)
    : listener_(std::make_unique<listener>(address, std::move(source))) {}
http_server::~http_server() = default;

std::string http_server::url() const { return listener_->access().url(); }
std::string http_server::token() const { return listener_->access().token(); }
int http_server::port() const { return listener_->port(); }

}  // namespace gs::live
