// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "memory_options.hpp"

namespace gs::cli {

std::vector<options::option> memory_options(settings& s) {
    using namespace options;
    using enum command;
    return {{.names = "--photo-memory",
             .commands = {train},
             .value = byte_size(s.photo_memory),
             .help = "Largest size of decoded photos in memory, of host and device together; above it, "
                     "photos stay in their files and threads decode them ahead of training",
             .default_text = "a share of the memory that is available"},
            {.names = "--gpu-memory",
             .commands = {train},
             .value = byte_size(s.gpu_memory),
             .help = "Device memory to use; if full, SH coefficients go to the host, and growth ends",
             .default_text = "a share, or none with --deterministic"},
            {.names = "--precision",
             .commands = {train},
             .value = choice(s.precision),
             .help = "Precision of Adam's moments: compact takes a quarter of their memory",
             .default_text = "compact if --max-cap Gaussians do not fit into memory otherwise; float with "
                             "--deterministic",
             .is_rare = true}};
}

}  // namespace gs::cli
