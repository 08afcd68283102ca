// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace gs_fuzz {

/// Whether the loader took the file. An error that is no `gs::error`, or memory beyond the bound, leaves as
/// another exception, which libFuzzer takes for a crash.
using run_function = bool(std::string_view input);

run_function colmap_binary;  ///< its first byte chooses the part
run_function colmap_text;    ///< its first byte chooses the part
run_function transforms;
run_function polycam;      ///< the file of one camera
run_function opensfm;      ///< reconstruction.json
run_function point_cloud;  ///< points in a PLY file
run_function archive;      ///< a .zip file, which is unpacked
run_function image;        ///< of any format; a PNG's checksums are put right first

/// A loader, and the name of its corpus.
struct harness {
    std::string name;
    std::function<run_function> run;
};

/// All loaders: the functions above, and each format of models that can be read, by its name in lower case,
/// with _ for blanks.
const std::vector<harness>& harnesses();

/// Returns the harness of this name. Throws `std::out_of_range` if the name is unknown.
const harness& harness_of(std::string_view name);

/// An allowance for buffers of streams and for messages.
inline constexpr std::size_t small_change = 64 << 10;

/// Has `load` read a file of these bytes. Throws `std::logic_error` if it allocates, at any time, more than
/// four times the file's size, `small_change`, and what `further` says afterwards.
bool load_within_budget(
    std::string_view bytes, const std::function<void(const std::filesystem::path&)>& load,
    const std::function<std::size_t()>& further = [] { return std::size_t{0}; });

}  // namespace gs_fuzz
