// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "json_events.hpp"

#include <nlohmann/json.hpp>

#include "../core/error.hpp"
#include "json_text.hpp"

namespace gs {
namespace {

using nlohmann::json;

/// Turns the calls of nlohmann's parser into `json_events`. Neither recurses, so values may nest
/// deeply.
class translator final : public json::json_sax_t {
  public:
    /// Keeps references to `text` and `events`.
    translator(std::string where, const std::string& text, std::size_t deepest, json_events& events)
        : where_(std::move(where)), text_(text), deepest_(deepest), events_(events) {}

    bool null() override { return value({.is_null = true}); }
    bool boolean(bool) override { return value({}); }
    bool number_integer(number_integer_t x) override { return value({.number = static_cast<double>(x)}); }
    bool number_unsigned(number_unsigned_t x) override { return value({.number = static_cast<double>(x)}); }
    bool number_float(number_float_t x, const string_t&) override { return value({.number = x}); }
    bool string(string_t& text) override { return value({.text = &text}); }
    bool binary(binary_t&) override { return false; }  // does not occur in JSON
    bool start_object(std::size_t) override { return open(true); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(false); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        if (ignored_ == 0) path_.back().key = name;
        return true;
    }

    bool parse_error(std::size_t byte, const std::string&, const json::exception& problem) override {
        const bool is_range = dynamic_cast<const json::out_of_range*>(&problem) != nullptr;
        throw error(where_ + (is_range ? " holds a number that is too large" : " is not valid JSON") +
                    line_and_byte(text_, byte));
    }

  private:
    bool value(const json_value& one) {
        if (ignored_ > 0) return true;
        events_.value(path_, one);
        return next();
    }

    bool open(bool is_object) {
        if (ignored_ > 0 || path_.size() == deepest_) {
            if (ignored_++ == 0) events_.value(path_, {});
            return true;
        }
        events_.begin(path_, is_object);
        path_.emplace_back();
        return true;
    }

    bool close() {
        if (ignored_ > 0) {
            if (--ignored_ > 0) return true;
        } else {
            path_.pop_back();
            events_.end(path_);
        }
        return next();
    }

    bool next() {
        if (!path_.empty()) ++path_.back().index;
        return true;
    }

    std::string where_;
    const std::string& text_;
    std::size_t deepest_;
    json_events& events_;
    json_path path_;
    std::size_t ignored_ = 0;  ///< number of open brackets in an ignored value
};

}  // namespace

void read_json(const std::filesystem::path& file, std::size_t deepest, json_events& events) {
    const std::string text = json_text(file);
    translator all(file.string(), text, deepest, events);
    json::sax_parse(text, &all);
}

}  // namespace gs
