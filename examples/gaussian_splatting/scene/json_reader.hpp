// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gs {

/// Reads JSON value by value from a text in memory, and keeps nothing of it: who reads says what each value
/// is for, or skips it. A document tree of numbers takes ten times its text. NaN and the infinities, which
/// Python writes, are numbers. Throws `error` naming the file, line and byte where the text is no JSON, a
/// number is beyond double, or values nest deeper than 100.
class json_reader {
  public:
    /// Both are kept by reference. `text` has a character after its end, as every std::string.
    json_reader(const std::string& file, const std::string& text) : file_(file), text_(text) {}

    bool at_object() { return next() == '{'; }
    bool at_array() { return next() == '['; }
    bool at_string() { return next() == '"'; }
    bool at_number();

    /// Calls `member(key)` for each of the object's; it must read or skip the value.
    template <class Member>
    void object(const Member& member) {
        open('{');
        if (next() != '}') {
            do {
                const std::string key = string();
                expect(':');
                member(key);
            } while (take(','));
        }
        close('}');
    }

    /// Calls `element(i)` for each of the array's; it must read or skip the value.
    template <class Element>
    void array(const Element& element) {
        open('[');
        if (next() != ']') {
            std::size_t i = 0;
            do element(i++);
            while (take(','));
        }
        close(']');
    }

    std::string string();
    double number();
    void skip();

    /// Nothing but blanks may follow.
    void end();

  private:
    char next();  ///< the next character that is no blank; 0 at the end
    bool take(char wanted);
    bool take_word(std::string_view word);
    void expect(char wanted);
    void open(char bracket);
    void close(char bracket);
    std::size_t digits();
    void escape(std::string& into);
    unsigned hex4();
    [[noreturn]] void refuse(const char* why) const;

    const std::string& file_;
    const std::string& text_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

}  // namespace gs
