// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "base64.hpp"

#include <algorithm>
#include <streambuf>
#include <vector>

namespace gs::pages {
namespace {

constexpr std::size_t part_size = 3U << 20;  ///< bytes; a multiple of three, so that no part is padded

/// Collects bytes and writes them to another stream in parts.
class base64_buffer : public std::streambuf {
  public:
    base64_buffer(std::ostream& out, std::string_view before, std::string_view after)
        : out_(out), before_(before), after_(after), bytes_(part_size) {
        reset();
    }

    void write_part() {
        const auto count = static_cast<std::size_t>(pptr() - pbase());
        if (count > 0)
            out_ << before_ << base64({reinterpret_cast<const std::uint8_t*>(bytes_.data()), count})
                 << after_;
        reset();
    }

  protected:
    int_type overflow(int_type c) override {
        write_part();
        if (!out_) return traits_type::eof();
        return traits_type::eq_int_type(c, traits_type::eof()) ? traits_type::not_eof(c)
                                                               : sputc(traits_type::to_char_type(c));
    }

  private:
    void reset() { setp(bytes_.data(), bytes_.data() + bytes_.size()); }

    std::ostream& out_;
    std::string_view before_, after_;
    std::vector<char> bytes_;
};

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
    static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text(base64_size(bytes.size()), '=');
    for (std::size_t i = 0, to = 0; i < bytes.size(); i += 3, to += 4) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k <= count; ++k) text[to + k] = letters[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

void write_base64(std::ostream& out, const std::function<void(std::ostream&)>& fill, std::string_view before,
                  std::string_view after) {
    base64_buffer buffer(out, before, after);
    std::ostream encoded(&buffer);
    fill(encoded);
    buffer.write_part();
    if (!encoded) out.setstate(std::ios::badbit);
}

}  // namespace gs::pages
