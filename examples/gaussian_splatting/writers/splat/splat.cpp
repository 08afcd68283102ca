// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "splat.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "../../core/atomic_file_write.hpp"
#include "../../core/error.hpp"
#include "../../core/file_bytes.hpp"
#include "../../model/spherical_harmonics.hpp"
#include "../quantize.hpp"

namespace gs {
namespace {

static_assert(std::endian::native == std::endian::little, "records are copied as they lie in memory");

/// The record of one Gaussian in the file.
struct record {
    float position[3];
    float scale[3];  ///< standard deviations
    std::uint8_t color[3];
    std::uint8_t alpha;
    std::uint8_t rotation[4];  ///< w x y z; -1 is stored as 0, and 0 as 128
};
static_assert(sizeof(record) == 32);

constexpr double zero_rotation = 128;

double log_sigmoid(double x) { return x < 0 ? x - std::log1p(std::exp(x)) : -std::log1p(std::exp(-x)); }

/// Returns the order of the Gaussians in the file: those that matter most for the image come first.
std::vector<std::size_t> by_opacity_and_volume(const gaussians& model) {
    std::vector<double> log_importance(model.count());
    for (std::size_t i = 0; i < model.count(); ++i) {
        const float* s = &model.log_scale[3 * i];
        log_importance[i] = double(s[0]) + double(s[1]) + double(s[2]) + log_sigmoid(model.opacity[i]);
    }
    std::vector<std::size_t> order(model.count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return log_importance[i]; });
    return order;
}

class splat_output {
  public:
    splat_output(const std::filesystem::path& file, const gaussians& model) : file_(file), model_(model) {}

    void check() const {
        for (std::size_t i = 0; i < model_.count(); ++i) record_of(i);
    }

    record record_of(std::size_t i) const {
        record r{};
        double length = 0;
        for (std::size_t k = 0; k < 4; ++k)
            length = std::hypot(length, finite(model_.quaternion[4 * i + k], "rotation", i));
        if (length == 0) fail("rotation", i, "zero");
        for (std::size_t k = 0; k < 4; ++k)
            r.rotation[k] = to_byte(zero_rotation + 128 * double(model_.quaternion[4 * i + k]) / length);
        for (std::size_t k = 0; k < 3; ++k) {
            r.position[k] = finite(model_.mean[3 * i + k], "position", i);
            finite(model_.log_scale[3 * i + k], "scale", i);
            r.scale[k] = finite(std::exp(model_.log_scale[3 * i + k]), "scale", i);
            const double color = sh_c0 * double(finite(model_.sh_constant[3 * i + k], "color", i));
            r.color[k] = to_byte(255 * (0.5 + color));
        }
        r.alpha = opacity_to_byte(finite(model_.opacity[i], "opacity", i));
        return r;
    }

  private:
    float finite(float value, const char* what, std::size_t i) const {
        if (!std::isfinite(value)) fail(what, i, "not finite");
        return value;
    }
    [[noreturn]] void fail(const char* what, std::size_t i, const char* is) const {
        throw error("cannot write " + file_.string() + ": the " + what + " of Gaussian " + std::to_string(i) +
                    " is " + is);
    }

    const std::filesystem::path& file_;
    const gaussians& model_;
};

class splat_input {
  public:
    explicit splat_input(const std::filesystem::path& file) : file_(file) {}

    gaussians read() {
        if (file_.size % sizeof(record) != 0)
            throw error(file_.name + ": its " + std::to_string(file_.size) +
                        " bytes are no multiple of 32, the size of a Gaussian in a .splat file");
        const std::size_t count = file_.size / sizeof(record);
        gaussians model;
        model.mean.resize(3 * count);
        model.log_scale.resize(3 * count);
        model.quaternion.resize(4 * count);
        model.opacity.resize(count);
        model.sh_constant.resize(3 * count);
        for (std::size_t i = 0; i < count; ++i) {
            record r;
            file_.in.read(reinterpret_cast<char*>(&r), sizeof r);
            if (!file_.in) throw error("cannot read " + file_.name);
            store(r, i, model);
        }
        return model;
    }

  private:
    void store(const record& r, std::size_t i, gaussians& model) const {
        for (std::size_t k = 0; k < 3; ++k) {
            if (!std::isfinite(r.position[k])) fail("position", i, "not finite");
            if (!std::isfinite(r.scale[k])) fail("scale", i, "not finite");
            if (r.scale[k] < 0) fail("scale", i, "negative");
            model.mean[3 * i + k] = r.position[k];
            // A flat Gaussian has a scale of zero, which has no logarithm.
            model.log_scale[3 * i + k] = std::log(std::max(r.scale[k], std::numeric_limits<float>::min()));
            model.sh_constant[3 * i + k] = sh_from_color(static_cast<float>(r.color[k]) / 255);
        }
        bool zero = true;
        for (std::size_t k = 0; k < 4; ++k) {
            model.quaternion[4 * i + k] = static_cast<float>((r.rotation[k] - zero_rotation) / 128);
            zero = zero && r.rotation[k] == zero_rotation;
        }
        if (zero) fail("rotation", i, "zero");
        model.opacity[i] = byte_to_opacity(r.alpha);
    }
    [[noreturn]] void fail(const char* what, std::size_t i, const char* is) const {
        throw error(file_.name + ": the " + what + " of Gaussian " + std::to_string(i) + " is " + is);
    }

    opened_file file_;
};

constexpr std::string_view endings[] = {".splat"};

}  // namespace

void write_splat(const std::filesystem::path& file, const gaussians& model, const write_options&) {
    const splat_output output(file, model);
    output.check();  // before sorting, which needs finite numbers
    atomic_file_write(file, [&](std::ostream& out) {
        for (const std::size_t i : by_opacity_and_volume(model)) {
            const record r = output.record_of(i);
            out.write(reinterpret_cast<const char*>(&r), sizeof r);
        }
    });
}

gaussians read_splat(const std::filesystem::path& file) { return splat_input(file).read(); }

constinit const writer splat_writer{.name = "SPLAT",
                                    .endings = endings,
                                    .write = write_splat,
                                    .read = read_splat,
                                    .max_sh_degree = 0,
                                    .holds_antialiasing = false,
                                    .holds_sky = false};

}  // namespace gs
