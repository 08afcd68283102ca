// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "write_json.hpp"

#include <nlohmann/json.hpp>

#include "atomic_file_write.hpp"

namespace gs {

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
    atomic_file_write(file, [&](std::ostream& out) {
        out << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
    });
}

}  // namespace gs
