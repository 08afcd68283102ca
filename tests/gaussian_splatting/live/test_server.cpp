// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <thread>

#include "../../support/temporary_folder.hpp"
#include "core/error.hpp"
#include "image/image.hpp"
#include "live/access.hpp"
#include "live/live_view.hpp"
#include "serve.hpp"

using namespace gs_test;

TEST_CASE("server: every path needs the token, in the URL or in a header") {
    const fake_server s;
    const std::string token = "token=" + s.server.token();
    for (const std::string path : {"/", "/scene", "/status", frame_path.c_str(), "/nothing"}) {
        CAPTURE(path);
        const std::string mark = path.find('?') == std::string::npos ? "?" : "&";
        CHECK(s.client().Get(path)->status == 403);
        CHECK(s.client().Get(path + mark + "token=" + std::string(32, '0'))->status == 403);
        CHECK(s.client().Get(path + mark + token)->status == (path == "/nothing" ? 404 : 200));
        CHECK(s.get(path) == (path == "/nothing" ? 404 : 200));
    }
    CHECK(s.frames == 2);
}

TEST_CASE("server: tokens differ between runs and have 128 bits") {
    CHECK(gs::live::random_token() != gs::live::random_token());
    CHECK(gs::live::random_token().size() == 32);
}

TEST_CASE("server: the page loads nothing from elsewhere, and no other site may show it") {
    const fake_server s;
    const auto page = s.client().Get("/?token=" + s.server.token());
    const std::string policy = page->get_header_value("Content-Security-Policy");
    CHECK(says(policy, {"default-src 'none'", "connect-src 'self'", "frame-ancestors 'none'"}));
    CHECK(page->get_header_value_count("Access-Control-Allow-Origin") == 0);
    CHECK(page->get_header_value("Referrer-Policy") == "no-referrer");
    const std::string nonce = policy.substr(policy.find("'nonce-") + 7, 32);
    CHECK(page->body.find("<script nonce=\"" + nonce + "\">") != std::string::npos);
    CHECK(page->body.find("@nonce@") == std::string::npos);
    for (const char* external : {"http://", "https://", "//cdn", "@import"})
        CHECK(page->body.find(external) == std::string::npos);
}

TEST_CASE("server: buttons need POST and the headers of the page") {
    const fake_server s;
    const auto post = [&](const httplib::Headers& headers) {
        return s.client().Post("/pause", headers, "", "text/plain")->status;
    };
    const std::string token = s.server.token(), good = s.origin();
    CHECK(post({{"X-Token", token}}) == 403);
    CHECK(post({{"X-Token", token}, {"Origin", "null"}}) == 403);
    CHECK(post({{"X-Token", token}, {"Origin", "http://evil.example"}}) == 403);
    CHECK(post({{"X-Token", token}, {"Origin", good + "0"}}) == 403);
    CHECK(post({{"X-Token", token}, {"Origin", "https" + good.substr(4)}}) == 403);
    CHECK(post({{"Origin", good}}) == 403);
    CHECK(post({{"X-Token", token}, {"Origin", good}, {"Host", "evil.example"}}) == 403);
    CHECK(post({{"X-Token", token}, {"Origin", "http://evil.example"}, {"Host", "evil.example"}}) == 403);
    CHECK(s.get("/pause") == 404);
    CHECK(s.client().Put("/pause", s.headers(), "", "text/plain")->status == 405);
    CHECK(s.client().Options("/pause", s.headers())->status == 405);
    CHECK(s.presses == 0);
    CHECK(post(s.headers()) == 200);
    CHECK(s.presses == 1);
}

TEST_CASE("server: a GET from another site or for another host is refused") {
    const fake_server s;
    const std::string token = s.server.token();
    CHECK(s.client().Get("/status", {{"X-Token", token}, {"Origin", "http://evil.example"}})->status == 403);
    CHECK(s.client().Get("/status", {{"X-Token", token}, {"Host", "evil.example"}})->status == 403);
}

TEST_CASE("server: only names of the server are allowed in the header Host") {
    const gs::live::access_control loopback("127.0.0.1", 8080), all("0.0.0.0", 8080), six("::1", 80);
    CHECK(loopback.allows_host("127.0.0.1:8080"));
    CHECK(loopback.allows_host("localhost:8080"));
    for (const char* wrong : {"", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:18080", "evil.example:8080",
                              "127.0.0.1.evil.example:8080", "192.168.0.7:8080", "[::1]:8080"})
        CHECK_FALSE(loopback.allows_host(wrong));
    CHECK(all.allows_host("192.168.0.7:8080"));
    CHECK(all.allows_host("[fe80::1]:8080"));
    CHECK_FALSE(all.allows_host("evil.example:8080"));
    // Browsers write names in small letters.
    CHECK(gs::live::access_control("Server.Example", 8080).allows_host("server.example:8080"));
    CHECK(six.allows_host("[::1]"));
    CHECK(six.url().starts_with("http://[::1]:80/?token="));
    CHECK(gs::live::is_loopback("127.0.0.1"));
    CHECK_FALSE(gs::live::is_loopback("0.0.0.0"));
}

TEST_CASE("server: large bodies are refused and not kept") {
    const fake_server s;
    const std::string large(std::size_t{64} << 20, 'x');
    const auto refused = s.client().Post("/save", s.headers(), large, "text/plain");
    // The client may still be sending when the server closes the connection.
    if (refused) CHECK(refused->status == 413);
    const raw_connection announced(s.server.port());
    announced.send("POST /save HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(s.server.port()) +
                   "\r\nOrigin: " + s.origin() + "\r\nX-Token: " + s.server.token() +
                   "\r\nContent-Length: 18446744073709551615\r\n\r\n");
    CHECK(announced.receive().starts_with("HTTP/1.1 413"));
    const raw_connection chunked(s.server.port());
    chunked.send("POST /save HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(s.server.port()) +
                 "\r\nOrigin: " + s.origin() + "\r\nX-Token: " + s.server.token() +
                 "\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n");
    CHECK(chunked.receive().starts_with("HTTP/1.1 411"));
    CHECK(s.presses == 0);
    CHECK(s.get("/status") == 200);
}

TEST_CASE("server: no path leads to a file") {
    const fake_server s;
    for (const char* path :
         {"/../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/..%2f..%2fetc%2fpasswd",
          "/page.html", "/etc/passwd", "/frame/../../etc/passwd"}) {
        CAPTURE(path);
        CHECK(s.get(path) == 404);
    }
}

TEST_CASE("server: parameters of frames are checked") {
    fake_server s;
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string path = frame_path;
        path.replace(path.find(from), from.size(), to);
        return s.client().Get(path, {{"X-Token", s.server.token()}});
    };
    const auto refused = [&](const std::string& from, const std::string& to, const char* culprit) {
        const auto r = with(from, to);
        CAPTURE(to);
        CHECK(r->status == 400);
        CHECK(says(r->body, {culprit}));
    };
    refused("width=32", "width=wide", "width");
    refused("width=32", "width=nan", "width");
    refused("width=32", "width=-3", "width");
    refused("height=24", "height=1e99", "height");
    refused("height=24", "", "height");
    refused("overlay=none", "overlay=all", "overlay");
    refused("overlay=none", "overlay=error", "view");
    refused("position=0,0,0", "position=0,0", "position");
    refused("position=0,0,0", "position=0,0,0,0", "position");
    refused("position=0,0,0", "position=0,inf,0", "position");
    refused("position=0,0,0", "position=0,1e30,0", "position");
    refused("forward=0,0,1", "forward=0,0,0", "forward");
    refused("up=0,-1,0", "up=0,0,2", "up");
    refused("field_of_view=1", "field_of_view=0", "field_of_view");
    refused("field_of_view=1", "field_of_view=1x", "field_of_view");
    refused("page=a", "page=../a", "page");
    refused("page=a", "page=" + std::string(41, 'a'), "page");
    refused("overlay=none", "overlay=none&view=3", "view");
    CHECK(s.frames == 0);
    CHECK(with("width=32", "width=999999")->status == 200);
    CHECK(s.last.width == gs::live::most_side);
    CHECK(with("width=32", "width=0")->status == 200);
    CHECK(s.last.width == gs::live::least_side);
    CHECK(with("overlay=none", "overlay=error&view=2")->status == 200);
    CHECK(s.last.view == 2);
}

TEST_CASE("server: a frame is a JPEG of the size that was asked for") {
    const fake_server s;
    const auto frame = s.client().Get(frame_path, {{"X-Token", s.server.token()}});
    CHECK(frame->get_header_value("Content-Type") == "image/jpeg");
    const temporary_folder folder;
    write_file(folder / "frame.jpg", frame->body);
    const gs::image image = gs::read_image(folder / "frame.jpg");
    CHECK(image.width == 32);
    CHECK(image.height == 24);
    CHECK(int{image.rgba[0]} == doctest::Approx(128).epsilon(0.02));
}

TEST_CASE("server: garbage does not end it") {
    const fake_server s;
    const std::string host = "Host: 127.0.0.1:" + std::to_string(s.server.port()) + "\r\n";
    std::string ranges = "Range: bytes=0-0", headers;
    while (ranges.size() < 8000) ranges += ",0-0";
    for (int i = 0; i < 100000; ++i) headers += "X-" + std::to_string(i) + ": many\r\n";
    std::string noise;
    for (unsigned i = 0; i < 5000; ++i) noise += static_cast<char>(i * 2654435761U >> 24);
    for (const std::string& bytes :
         {std::string("\0\0\0\0", 4), std::string("GET"), std::string("GET / HTTP/9.9\r\n\r\n"),
          std::string("\r\n\r\n\r\n"), "GET /" + std::string(100000, 'a') + " HTTP/1.1\r\n\r\n",
          "GET / HTTP/1.1\r\n" + host + ranges + "\r\n\r\n", "GET / HTTP/1.1\r\n" + host + headers + "\r\n",
          "GET /?token=%ff%00%zz HTTP/1.1\r\n" + host + "\r\n", noise}) {
        const raw_connection c(s.server.port());
        CHECK(c.is_open());
        c.send(bytes);
    }
    CHECK(s.get("/status") == 200);
}

TEST_CASE("server: ranges do not multiply a response") {
    const fake_server s;
    std::string ranges = "Range: bytes=0-";
    while (ranges.size() < 8000) ranges += ",0-";
    const raw_connection c(s.server.port());
    c.send("GET /?token=" + s.server.token() +
           " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(s.server.port()) + "\r\n" + ranges + "\r\n\r\n");
    const std::string response = c.receive();
    CHECK(response.starts_with("HTTP/1.1 200"));
    CHECK(response.size() < 65536);
}

TEST_CASE("server: a request of endless headers is cut off") {
    const fake_server s;
    const raw_connection c(s.server.port());
    c.send("GET / HTTP/1.1\r\n");
    std::size_t sent = 0;
    const std::string line = "X-Endless: " + std::string(1000, 'x') + "\r\n";
    // Ends when the server stops reading and closes the connection.
    while (sent < (std::size_t{1} << 30) && c.send(line)) sent += line.size();
    CHECK(sent < (std::size_t{1} << 30));
    CHECK(s.get("/status") == 200);
}

TEST_CASE("server: silent clients and closed pages keep nobody from a frame") {
    const fake_server s;
    std::vector<std::unique_ptr<raw_connection>> silent;
    for (int i = 0; i < 20; ++i) {
        silent.push_back(std::make_unique<raw_connection>(s.server.port()));
        if (i % 2 == 0) silent.back()->send("GET / HT");
        raw_connection(s.server.port())
            .send("GET " + frame_path + "&token=" + s.server.token() +
                  " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(s.server.port()) + "\r\n\r\n");
    }
    CHECK(s.get(frame_path) == 200);
}

TEST_CASE("server: ten pages get their frames at the same time") {
    const fake_server s;
    std::atomic<int> received = 0;
    std::vector<std::thread> pages;
    for (int page = 0; page < 10; ++page)
        pages.emplace_back([&, page] {
            std::string path = frame_path;
            path.replace(path.find("page=a"), 6, "page=" + std::to_string(page));
            for (int i = 0; i < 5; ++i) received += s.get(path) == 200;
        });
    for (std::thread& p : pages) p.join();
    CHECK(received == 50);
}

TEST_CASE("server: a port in use is refused, or replaced by a free one") {
    const fake_server s;
    const auto start = [](const gs::live::server_address& at) { gs::live::http_server(at, {}); };
    try {
        start({.port = s.server.port()});
        FAIL("the port was used twice");
    } catch (const gs::error& e) {
        CHECK(says(e.what(), {std::to_string(s.server.port()), "in use", "leave out the port"}));
    }
    CHECK_THROWS_AS(start({.host = "192.0.2.1", .port = s.server.port()}), gs::error);
    const gs::live::http_server first({}, {}), second({}, {});  // at most one of them has the default
    CHECK(first.port() != second.port());
}

TEST_CASE("server: it ends while pages wait for frames") {
    std::thread page;
    int status = 0;
    {
        gs::live::live_view view({.port = fake_server::any_port()}, "{}", 3,
                                 {.draw = [](const auto&) { return gs::live::picture{}; }});
        page = std::thread([&status, port = view.port(), token = view.token()] {
            httplib::Client c("127.0.0.1", port);
            c.set_read_timeout(20);
            const auto r = c.Get(frame_path, {{"X-Token", token}});
            status = r ? r->status : -1;
        });
        while (!view.needs_attention()) std::this_thread::yield();
    }
    page.join();
    CHECK(status == 204);
}
