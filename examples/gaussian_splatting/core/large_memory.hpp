// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gs {

/// Resizes a vector for images. Loses its contents. Asks Linux for pages of 2 MiB for new memory: with
/// pages of 4 KiB, the first access to memory takes as long as decoding a photo.
template <class T>
void resize_for_image(std::vector<T>& values, std::size_t count) {
    if (count > values.capacity()) {
        values.clear();
        values.reserve(count);
        constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
        const auto first = reinterpret_cast<std::uintptr_t>(values.data());
        const std::uintptr_t begin = (first + page - 1) / page * page,
                             end = (first + count * sizeof(T)) / page * page;
        // A kernel that refuses uses small pages.
        if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
    }
    values.resize(count);
}

}  // namespace gs
