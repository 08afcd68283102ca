// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "mailbox.hpp"

#include <exception>
#include <utility>

namespace gs::live {

void mailbox::finish(slot& s, answer with) {
    s.answer = std::move(with);
    s.done = true;
    answered_.notify_all();
}

mailbox::answer mailbox::ask(const std::string& page, const view_request& request,
                             std::chrono::milliseconds patience) {
    const auto mine = std::make_shared<slot>(slot{request, false, {}});
    std::unique_lock held(lock_);
    if (closed_) return {};
    auto& of_page = slots_[page];
    if (of_page) finish(*of_page, {outcome::replaced});
    if (!of_page && slots_.size() > most_pages) {
        slots_.erase(page);
        return {outcome::busy};
    }
    of_page = mine;
    waiting_ = slots_.size();
    asked_.notify_all();
    answered_.wait_for(held, patience, [&] { return mine->done; });
    if (const auto left = slots_.find(page); left != slots_.end() && left->second == mine) {
        slots_.erase(left);
        waiting_ = slots_.size();
    }
    return std::move(mine->answer);
}

void mailbox::ring() {
    const std::lock_guard held(lock_);
    rung_ = true;
    asked_.notify_all();
}

void mailbox::serve(const std::function<picture(const view_request&)>& draw) {
    std::map<std::string, std::shared_ptr<slot>> taken;
    {
        const std::lock_guard held(lock_);
        taken.swap(slots_);
        waiting_ = 0;
    }
    for (const auto& [page, s] : taken) {
        answer drawn;
        try {
            drawn = {outcome::drawn, draw(s->request)};
        } catch (const std::exception& e) {
            drawn = {outcome::failed, {}, e.what()};
        }
        const std::lock_guard held(lock_);
        finish(*s, std::move(drawn));
    }
}

void mailbox::wait(std::chrono::milliseconds patience) {
    std::unique_lock held(lock_);
    asked_.wait_for(held, patience, [&] { return rung_ || !slots_.empty(); });
    rung_ = false;
}

void mailbox::close() {
    const std::lock_guard held(lock_);
    closed_ = true;
    for (const auto& [page, s] : slots_) finish(*s, {});
    slots_.clear();
    waiting_ = 0;
}

}  // namespace gs::live
