// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "table.hpp"

namespace gs::features {

const std::vector<std::unique_ptr<const feature>>& all_features() {
    static const auto all = []<class... Features>(std::tuple<Features...>*) {
        std::vector<std::unique_ptr<const feature>> made;
        (made.push_back(std::make_unique<const Features>()), ...);
        return made;
    }(static_cast<table*>(nullptr));
    return all;
}

}  // namespace gs::features
