// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "../../core/call_site.hpp"

namespace warpagg::emulator::detail {

enum class access_kind : std::uint8_t { read, write, atomic };

struct access {
    unsigned block, thread;  ///< the accessing thread, by its block and its index within the block
    unsigned phase;          ///< number of barriers that the block had passed
    unsigned clock;          ///< number of synchronizations of the lane within its warp
    access_kind kind;
    std::uint8_t bytes;  ///< bit i is set if byte i of the word was accessed
    call_site at;
};

/// Remembers the accesses to each 4-byte word of memory: at most the last 128 relevant ones per word.
class shadow_memory {
  public:
    /// Records an access to `size` bytes. Returns an earlier access that conflicts with it and for
    /// which `ordered(earlier)` is false, or null. Two accesses to common bytes conflict if one is a
    /// plain write, or if one is plain and the other atomic.
    template <class Ordered>
    const access* note(const void* address, std::size_t size, access a, Ordered ordered) {
        const auto first = reinterpret_cast<std::uintptr_t>(address), end = first + size;
        for (std::uintptr_t word = first / 4; word * 4 < end; ++word) {
            a.bytes = 0;
            for (unsigned i = 0; i < 4; ++i)
                if (word * 4 + i >= first && word * 4 + i < end)  // mutate: bytes_of_a_word_not_told_apart
                    a.bytes |= static_cast<std::uint8_t>(1u << i);
            if (const access* conflict = note_word(word, a, ordered)) return conflict;
        }
        return nullptr;
    }

    /// Forgets all accesses to these bytes.
    void forget(const void* address, std::size_t size) {
        const auto first = reinterpret_cast<std::uintptr_t>(address);
        for (std::uintptr_t word = first / 4; word * 4 < first + size; ++word) *newest(word) = none;
    }

  private:
    static constexpr std::uint32_t none = 0;  // no node; nodes_[0] is not used
    static constexpr unsigned words_per_page = 1024, remembered = 128;
    struct node {
        access a;
        std::uint32_t next;
    };
    using page = std::array<std::uint32_t, words_per_page>;

    std::uint32_t* newest(std::uintptr_t word) {
        const std::uintptr_t number = word / words_per_page;
        if (last_page_ == nullptr || number != last_number_) {
            std::unique_ptr<page>& p = pages_[number];
            if (p == nullptr) p = std::make_unique<page>();
            last_page_ = p.get();
            last_number_ = number;
        }
        return &(*last_page_)[word % words_per_page];
    }

    /// Returns whether the earlier access can be dropped, because every access that conflicts with it
    /// also conflicts with `now`.
    static bool covered(const access& before, const access& now) {
        return (now.kind == access_kind::write || now.kind == before.kind) &&
               (before.bytes & ~now.bytes) == 0;
    }

    template <class Ordered>
    const access* note_word(std::uintptr_t word, const access& a, Ordered& ordered) {
        std::uint32_t* head = newest(word);
        std::uint32_t reuse = none;
        unsigned length = 0;
        for (std::uint32_t* link = head; *link != none;) {
            const std::uint32_t index = *link;
            node& earlier = nodes_[index];
            const bool before = ordered(earlier.a);
            const bool conflict = (earlier.a.bytes & a.bytes) != 0 &&
                                  // mutate: atomic_and_plain_do_not_conflict
                                  (earlier.a.kind == access_kind::write || earlier.a.kind != a.kind);
            if (!before && (conflict || (a.kind == access_kind::write && (earlier.a.bytes & a.bytes) != 0)))
                return &earlier.a;
            if ((before && covered(earlier.a, a)) || ++length >= remembered) {
                *link = earlier.next;
                reuse = index;
            } else {
                link = &earlier.next;
            }
        }
        if (reuse == none) {
            reuse = static_cast<std::uint32_t>(nodes_.size());
            nodes_.push_back({});
        }
        nodes_[reuse] = {a, *head};
        *head = reuse;
        return nullptr;
    }

    std::unordered_map<std::uintptr_t, std::unique_ptr<page>> pages_;
    std::uintptr_t last_number_ = 0;
    page* last_page_ = nullptr;
    std::vector<node> nodes_ = std::vector<node>(1);
};

}  // namespace warpagg::emulator::detail
