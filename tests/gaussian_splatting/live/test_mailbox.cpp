// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <stdexcept>
#include <thread>
#include <vector>

#include "live/mailbox.hpp"

using gs::live::mailbox;
using outcome = mailbox::outcome;

namespace {

constexpr std::chrono::seconds long_time{30};

/// A page that waits for a frame in a thread of its own.
class waiting_page {
  public:
    waiting_page(mailbox& box, const std::string& name, int width = 1)
        : thread_([this, &box, name, width] {
              gs::live::view_request request;
              request.width = width;
              answer_ = box.ask(name, request, long_time);
          }) {}
    const mailbox::answer& answer() {
        if (thread_.joinable()) thread_.join();
        return answer_;
    }

  private:
    mailbox::answer answer_;
    std::thread thread_;
};

/// Draws until `count` frames are drawn.
void serve(mailbox& box, int count) {
    int drawn = 0;
    while (drawn < count) {
        box.wait(std::chrono::milliseconds(10));
        box.serve([&](const gs::live::view_request& request) {
            ++drawn;
            return gs::live::picture{request.width, 1, {}};
        });
    }
}

}  // namespace

TEST_CASE("mailbox: each page gets the frame that it asked for") {
    mailbox box;
    CHECK(box.requests() == 0);
    waiting_page a(box, "a", 10), b(box, "b", 20);
    serve(box, 2);
    CHECK(a.answer().outcome == outcome::drawn);
    CHECK(a.answer().picture.width == 10);
    CHECK(b.answer().picture.width == 20);
    CHECK(box.requests() == 0);
}

TEST_CASE("mailbox: a later request of a page replaces the earlier one") {
    mailbox box;
    waiting_page first(box, "a", 1);
    while (box.requests() == 0) std::this_thread::yield();
    waiting_page second(box, "a", 2);
    CHECK(first.answer().outcome == outcome::replaced);
    serve(box, 1);
    CHECK(second.answer().picture.width == 2);
}

TEST_CASE("mailbox: a failure is told to the page and does not reach the caller") {
    mailbox box;
    waiting_page page(box, "a");
    while (box.requests() == 0) std::this_thread::yield();
    box.serve([](const auto&) -> gs::live::picture { throw std::runtime_error("no memory"); });
    CHECK(page.answer().outcome == outcome::failed);
    CHECK(page.answer().error == "no memory");
}

TEST_CASE("mailbox: the number of waiting pages is limited") {
    mailbox box;
    std::vector<std::unique_ptr<waiting_page>> pages;
    for (std::size_t i = 0; i < mailbox::most_pages; ++i)
        pages.push_back(std::make_unique<waiting_page>(box, std::to_string(i)));
    while (box.requests() < pages.size()) std::this_thread::yield();
    CHECK(box.ask("late", {}, long_time).outcome == outcome::busy);
    serve(box, static_cast<int>(pages.size()));
    for (const auto& page : pages) CHECK(page->answer().outcome == outcome::drawn);
}

TEST_CASE("mailbox: pages do not wait longer than they want, or after the end") {
    mailbox box;
    CHECK(box.ask("a", {}, std::chrono::milliseconds(1)).outcome == outcome::too_late);
    CHECK(box.requests() == 0);
    waiting_page page(box, "a");
    while (box.requests() == 0) std::this_thread::yield();
    box.close();
    CHECK(page.answer().outcome == outcome::too_late);
    CHECK(box.ask("a", {}, long_time).outcome == outcome::too_late);
}
