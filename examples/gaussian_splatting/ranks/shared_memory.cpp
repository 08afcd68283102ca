// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "shared_memory.hpp"

#include <sys/mman.h>

#include <algorithm>

#include "../core/error.hpp"

namespace gs::ranks {

shared_memory::owner shared_memory::make() {
    void* const memory = mmap(nullptr, sizeof(shared_memory), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw error("cannot share memory between ranks: give fewer --ranks");
    return owner(static_cast<shared_memory*>(memory));
}

void shared_memory::unmap::operator()(shared_memory* memory) const { munmap(memory, sizeof(shared_memory)); }

std::span<const transport::bytes> shared_memory_transport::show(const exchange_label& label, bytes own) {
    const std::size_t which = exchanges_++ % 2;
    shared_memory::slot& slot = memory_.slots[static_cast<std::size_t>(rank_)][which];
    slot.label = label;
    slot.size = own.size();
    std::ranges::copy(own, slot.bytes);
    wait_for_all();
    for (int r = 0; r < count_; ++r) {
        const shared_memory::slot& other = memory_.slots[static_cast<std::size_t>(r)][which];
        if (other.label != label) throw disagreement(rank_, r);
        shown_[static_cast<std::size_t>(r)] = {other.bytes, other.size};
    }
    return shown_;
}

void shared_memory_transport::wait_for_all() {
    const std::uint64_t all = exchanges_ * static_cast<std::uint64_t>(count_);
    memory_.arrived.fetch_add(1);
    // A rank may arrive and end while this one waits. It has ended early only if some are still missing.
    for (patient_wait wait; memory_.arrived.load() < all;)
        if (wait.after_test() && memory_.has_ended.load() && memory_.arrived.load() < all) throw peer_ended();
}

}  // namespace gs::ranks
