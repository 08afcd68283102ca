// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "json_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "../error.hpp"

namespace gs {
namespace {

constexpr int deepest = 100;
constexpr std::string_view not_a_number = "NaN", infinity = "Infinity", minus_infinity = "-Infinity";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

void put_utf8(std::string& into, unsigned code) {
    const auto put = [&](unsigned byte) { into.push_back(static_cast<char>(byte)); };
    const auto put_rest = [&](int shift) { put(0x80U | (code >> shift & 0x3FU)); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xC0U | code >> 6);
        put_rest(0);
    } else if (code < 0x10000) {
        put(0xE0U | code >> 12);
        put_rest(6);
        put_rest(0);
    } else {
        put(0xF0U | code >> 18);
        put_rest(12);
        put_rest(6);
        put_rest(0);
    }
}

}  // namespace

void json_reader::refuse(const char* why) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw error(file_ + why + ": line " + std::to_string(line) + ", byte " + std::to_string(at_ + 1));
}

constexpr const char* invalid = " is not valid JSON";

char json_reader::next() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
        ++at_;
    return text_[at_];
}

bool json_reader::take(char wanted) {
    if (next() != wanted) return false;
    ++at_;
    return true;
}

bool json_reader::take_word(std::string_view word) {
    next();
    if (text_.compare(at_, word.size(), word) != 0) return false;
    at_ += word.size();
    return true;
}

void json_reader::expect(char wanted) {
    if (!take(wanted)) refuse(invalid);
}

void json_reader::open(char bracket) {
    expect(bracket);
    if (++depth_ > deepest) refuse(" nests values more than 100 deep");
}

void json_reader::close(char bracket) {
    expect(bracket);
    --depth_;
}

bool json_reader::at_number() {
    const char c = next();
    return c == '-' || is_digit(c) || c == not_a_number[0] || c == infinity[0];
}

std::size_t json_reader::digits() {
    const std::size_t first = at_;
    while (is_digit(text_[at_])) ++at_;
    if (at_ == first) refuse(invalid);
    return at_ - first;
}

double json_reader::number() {
    if (take_word(not_a_number)) return std::numeric_limits<double>::quiet_NaN();
    if (take_word(infinity)) return std::numeric_limits<double>::infinity();
    if (take_word(minus_infinity)) return -std::numeric_limits<double>::infinity();
    const std::size_t first = at_;
    if (text_[at_] == '-') ++at_;
    const bool leading_zero = text_[at_] == '0';
    if (digits() > 1 && leading_zero) refuse(invalid);
    if (text_[at_] == '.') {
        ++at_;
        digits();
    }
    if (text_[at_] == 'e' || text_[at_] == 'E') {
        ++at_;
        if (text_[at_] == '+' || text_[at_] == '-') ++at_;
        digits();
    }
    double value = 0;
    const auto read = std::from_chars(text_.data() + first, text_.data() + at_, value);
    // Which does not tell too large from too small; strtod does.
    if (read.ec == std::errc::result_out_of_range) value = std::strtod(text_.data() + first, nullptr);
    if (!std::isfinite(value)) refuse(" holds a number that is too large");
    return value;
}

std::string json_reader::string() {
    expect('"');
    std::size_t end = at_;
    while (end < text_.size() && text_[end] != '"') end += text_[end] == '\\' ? 2 : 1;
    std::string value;
    value.reserve(std::min(end, text_.size()) - at_);  // an escape is longer than what it stands for
    while (text_[at_] != '"') {
        const char c = text_[at_];
        if (static_cast<unsigned char>(c) < 0x20) refuse(invalid);  // the end too
        ++at_;
        if (c == '\\')
            escape(value);
        else
            value.push_back(c);
    }
    ++at_;
    return value;
}

void json_reader::escape(std::string& into) {
    constexpr std::string_view letters = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
    const char letter = text_[at_];
    if (const auto found = letters.find(letter); found != std::string_view::npos) {
        ++at_;
        return into.push_back(meanings[found]);
    }
    if (letter != 'u') refuse(invalid);
    ++at_;
    unsigned code = hex4();
    if (code >= 0xD800 && code < 0xDC00) {  // the first half of a pair
        if (text_.compare(at_, 2, "\\u") != 0) refuse(invalid);
        at_ += 2;
        const unsigned second = hex4();
        if (second < 0xDC00 || second > 0xDFFF) refuse(invalid);
        code = 0x10000 + ((code - 0xD800) << 10) + (second - 0xDC00);
    } else if (code >= 0xDC00 && code <= 0xDFFF) {
        refuse(invalid);
    }
    put_utf8(into, code);
}

unsigned json_reader::hex4() {
    unsigned code = 0;
    const char* const first = text_.data() + at_;
    const char* const last = first + std::min<std::size_t>(4, text_.size() - at_);
    const auto read = std::from_chars(first, last, code, 16);
    if (read.ec != std::errc() || read.ptr != first + 4) refuse(invalid);
    at_ += 4;
    return code;
}

void json_reader::skip() {
    if (at_object())
        object([this](const std::string&) { skip(); });
    else if (at_array())
        array([this](std::size_t) { skip(); });
    else if (at_string())
        string();
    else if (at_number())
        number();
    else if (!take_word("true") && !take_word("false") && !take_word("null"))
        refuse(invalid);
}

void json_reader::end() {
    next();
    if (at_ != text_.size()) refuse(invalid);
}

}  // namespace gs
