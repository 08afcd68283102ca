// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "harness.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

#include "../image/known_leaks.hpp"
#include "budget.hpp"
#include "core/error.hpp"

namespace gs_fuzz {
namespace {

/// A file in memory that has a name. Making, reading and forgetting it takes microseconds.
class memory_file {
  public:
    explicit memory_file(std::string_view bytes) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
        if (descriptor_ < 0) throw std::runtime_error("cannot make a file in memory");
        for (std::size_t at = 0; at < bytes.size();) {
            const auto written = write(descriptor_, bytes.data() + at, bytes.size() - at);
            if (written <= 0) throw std::runtime_error("cannot write a file in memory");
            at += static_cast<std::size_t>(written);
        }
    }
    ~memory_file() { close(descriptor_); }
    memory_file(const memory_file&) = delete;
    memory_file& operator=(const memory_file&) = delete;

    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

}  // namespace

bool load_within_budget(std::string_view bytes, const std::function<void(const std::filesystem::path&)>& load,
                        const std::function<std::size_t()>& further) {
    const memory_file file(bytes);
    const std::filesystem::path path = file.path();
    std::size_t peak = 0;
    bool loaded = true;
    {
        const budget memory;
        try {
            load(path);
        } catch (const gs::error&) {
            loaded = false;
        }
        peak = memory.peak();
    }
    if (const std::size_t allowed = 4 * bytes.size() + small_change + further(); peak > allowed)
        throw std::logic_error("reading a file of " + std::to_string(bytes.size()) + " bytes allocated " +
                               std::to_string(peak) + " bytes, more than " + std::to_string(allowed));
    return loaded;
}

}  // namespace gs_fuzz
