// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "budget.hpp"

#include <algorithm>

// Of <sanitizer/allocator_interface.h>; null in a program without AddressSanitizer.
extern "C" {
[[gnu::weak]] int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t),
                                                            void (*)(const volatile void*));
[[gnu::weak]] std::size_t __sanitizer_get_allocated_size(const volatile void*);
}

namespace gs_fuzz {
namespace {

thread_local bool counting = false;
thread_local std::ptrdiff_t live = 0, most = 0;

void on_malloc(const volatile void*, std::size_t size) {
    if (!counting) return;
    live += static_cast<std::ptrdiff_t>(size);
    most = std::max(most, live);
}

void on_free(const volatile void* block) {
    if (counting && block) live -= static_cast<std::ptrdiff_t>(__sanitizer_get_allocated_size(block));
}

}  // namespace

bool budget::is_counting() {
    static const bool installed = __sanitizer_install_malloc_and_free_hooks &&
                                  __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0;
    return installed;
}

budget::budget() {
    live = most = 0;
    counting = is_counting();
}

budget::~budget() { counting = false; }

std::size_t budget::peak() const { return static_cast<std::size_t>(most); }

}  // namespace gs_fuzz
