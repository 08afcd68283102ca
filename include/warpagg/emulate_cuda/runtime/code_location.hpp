// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <dlfcn.h>
#include <elf.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "../../core/call_site.hpp"

namespace warpagg::emulator::detail::runtime {

/// Returns the call site of a plain access, of which only the return address of its report is known.
/// `locate` finds its file and line. The caller must not print it before.
inline call_site plain_access(const void* return_address) {
    return {nullptr, static_cast<const char*>(return_address), 0};
}

/// Returns what addr2line prints about an address in a program or library, as "kernel.cu:12", or nothing.
inline std::string run_addr2line(const Dl_info& module, std::uintptr_t address) {
    Elf64_Ehdr header;
    std::memcpy(&header, module.dli_fbase, sizeof header);
    if (header.e_type == ET_DYN) address -= reinterpret_cast<std::uintptr_t>(module.dli_fbase);
    std::string file = module.dli_fname;
    if (::access(file.c_str(), R_OK) != 0) file = "/proc/" + std::to_string(getpid()) + "/exe";
    char number[32];
    std::snprintf(number, sizeof number, "' 0x%llx", static_cast<unsigned long long>(address));
    std::FILE* pipe = popen(("addr2line -e '" + file + number + " 2>/dev/null").c_str(), "r");
    if (pipe == nullptr) return "";
    char line[4096] = "";
    if (std::fgets(line, sizeof line, pipe) == nullptr) line[0] = '\0';
    pclose(pipe);
    return line;
}

/// Completes a call site from `plain_access`; leaves others as they are. Cost: one run of addr2line for
/// each new address.
inline call_site locate(const call_site& site) {
    if (site.function != nullptr || site.file == nullptr) return site;
    static std::mutex mutex;
    static std::map<const void*, std::pair<std::string, unsigned>> known;
    const std::lock_guard lock(mutex);
    auto [place, is_new] = known.try_emplace(site.file, "an unknown file", 0u);
    auto& [file, line] = place->second;
    Dl_info module;
    if (is_new && dladdr(site.file, &module) != 0) {
        // The access comes right before the return address.
        const std::string found = run_addr2line(module, reinterpret_cast<std::uintptr_t>(site.file) - 1);
        const std::size_t colon = found.rfind(':');
        if (colon != std::string::npos && found[0] != '?') {
            file = found.substr(0, colon);
            line = static_cast<unsigned>(std::strtoul(found.c_str() + colon + 1, nullptr, 10));
        }
    }
    return {"plain access", file.c_str(), line};
}

}  // namespace warpagg::emulator::detail::runtime
