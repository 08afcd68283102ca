// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../core/error.hpp"
#include "../../core/parse_json.hpp"
#include "../quantize.hpp"
#include "../require_writable.hpp"
#include "../smallest_three.hpp"
#include "sog_files.hpp"
#include "sog_images.hpp"
#include "zip_bundle.hpp"

namespace gs {
namespace {

using input_json = nlohmann::json;

constexpr std::uint64_t longest_meta = 1 << 20, gaussians_per_byte = 10;
constexpr std::size_t palette_columns = 64, largest_palette = 65536;

class sog_input {
  public:
    explicit sog_input(const std::filesystem::path& file)
        : name_(file.string()), bundle_(file), file_size_(std::filesystem::file_size(file)) {}

    gaussians read() {
        meta_ = parse_json<input_json>(bundle_.read("meta.json", longest_meta), name_ + ": its meta.json");
        if (whole(meta_, "version") != 2) fail("its version is not 2");
        const std::uint64_t count = whole(meta_, "count");
        if (count / gaussians_per_byte > file_size_)
            fail("its " + std::to_string(count) + " Gaussians are more than its " +
                 std::to_string(file_size_) + " bytes can hold");
        count_ = static_cast<std::size_t>(count);
        const bool has_sh = meta_.contains("shN") && count_ > 0;
        const std::uint64_t degree = has_sh ? whole(member(meta_, "shN"), "bands") : 0;
        if (degree > 3) fail("its SH degree is " + std::to_string(degree) + ", but 3 is the highest");
        // The first images confirm the count before memory is allocated for it.
        const rgba_image low = image("means", 0), high = image("means", 1);
        model_ = sized_model(count_, static_cast<int>(degree));
        model_.antialiased = has("antialias", true) || has("model", "antialiased");
        read_means(low, high);
        read_scales();
        read_rotations();
        read_colors();
        if (degree > 0) read_palette(static_cast<std::size_t>(sh_coefficients(model_.sh_degree) - 1));
        return std::move(model_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw error(name_ + ": " + what); }

    const input_json& member(const input_json& value, const char* name) const {
        if (!value.is_object() || !value.contains(name))
            fail("its meta.json has no '" + std::string(name) + "'");
        return value[name];
    }
    bool has(const char* name, const input_json& value) const {
        return meta_.contains(name) && meta_[name] == value;
    }
    std::uint64_t whole(const input_json& value, const char* name) const {
        const input_json& found = member(value, name);
        if (!found.is_number_unsigned()) fail("its '" + std::string(name) + "' is not a whole number");
        return found.get<std::uint64_t>();
    }

    /// Returns `count` finite numbers.
    std::vector<float> numbers(const input_json& value, const char* name, std::size_t count) const {
        const input_json& found = member(value, name);
        std::vector<float> all;
        if (found.is_array() && found.size() == count)
            for (const input_json& x : found)
                if (x.is_number() && std::isfinite(x.get<float>())) all.push_back(x.get<float>());
        if (all.size() != count)
            fail("its '" + std::string(name) + "' is not " + std::to_string(count) + " finite numbers");
        return all;
    }

    /// Returns an image, whose name is in the meta data.
    rgba_image any_image(const char* property, std::size_t index, std::size_t least_pixels) const {
        const input_json& files = member(member(meta_, property), "files");
        if (!files.is_array() || index >= files.size() || !files[index].is_string())
            fail("its '" + std::string(property) + "' has no file " + std::to_string(index));
        const auto file = files[index].get<std::string>();
        const std::string webp = bundle_.read(file, file_size_ * 2);
        const auto size = webp_size(webp);
        const auto refuse = [&](const std::string& what) { fail("its image '" + file + "' " + what); };
        if (!size) refuse("is not a WebP image");
        const std::size_t pixels = size->width * size->height;
        // The margin allows for whole blocks of pixels.
        constexpr std::size_t margin = 1 << 18;
        if (pixels < least_pixels || pixels / 2 > least_pixels + margin)
            refuse("has " + std::to_string(size->width) + "x" + std::to_string(size->height) +
                   " pixels for " + std::to_string(least_pixels) + " values");
        auto decoded = decoded_webp(webp);
        if (!decoded) refuse("is damaged");
        return std::move(*decoded);
    }
    rgba_image image(const char* property, std::size_t index) const {
        return any_image(property, index, count_);
    }

    void read_means(const rgba_image& low_bytes, const rgba_image& high_bytes) {
        const input_json& means = member(meta_, "means");
        const std::vector<float> low = numbers(means, "mins", 3), high = numbers(means, "maxs", 3);
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const double share = (low_bytes.pixel(i)[k] + 256 * high_bytes.pixel(i)[k]) / 65535.0;
                const double logarithm = double(low[k]) + share * (double(high[k]) - double(low[k]));
                const double x = std::copysign(std::expm1(std::abs(logarithm)), logarithm);
                if (!(std::abs(x) <= std::numeric_limits<float>::max()))
                    fail("the position of Gaussian " + std::to_string(i) + " is not finite");
                model_.mean[3 * i + k] = static_cast<float>(x);
            }
    }

    void read_scales() {
        const rgba_image indices = image("scales", 0);
        const std::vector<float> book = numbers(member(meta_, "scales"), "codebook", 256);
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t k = 0; k < 3; ++k) model_.log_scale[3 * i + k] = book[indices.pixel(i)[k]];
    }

    void read_rotations() {
        const rgba_image rotations = image("quats", 0);
        for (std::size_t i = 0; i < count_; ++i) {
            const std::uint8_t* const pixel = rotations.pixel(i);
            if (pixel[3] < 252)
                fail("the rotation of Gaussian " + std::to_string(i) + " has the tag " +
                     std::to_string(pixel[3]) + " instead of 252 to 255");
            smallest_three three{pixel[3] - std::size_t{252}, {}};
            for (std::size_t k = 0; k < 3; ++k) three.others[k] = pixel[k] / 127.5 - 1;
            const std::array<double, 4> q = quaternion_of(three);
            std::ranges::transform(q, &model_.quaternion[4 * i],
                                   [](double x) { return static_cast<float>(x); });
        }
    }

    void read_colors() {
        const rgba_image colors = image("sh0", 0);
        const std::vector<float> book = numbers(member(meta_, "sh0"), "codebook", 256);
        for (std::size_t i = 0; i < count_; ++i) {
            for (std::size_t k = 0; k < 3; ++k) model_.sh_constant[3 * i + k] = book[colors.pixel(i)[k]];
            model_.opacity[i] = byte_to_opacity(colors.pixel(i)[3]);
        }
    }

    void read_palette(std::size_t coefficients) {
        const input_json& meta = member(meta_, "shN");
        const std::vector<float> book = numbers(meta, "codebook", 256);
        const std::uint64_t entries = whole(meta, "count");
        if (entries == 0 || entries > largest_palette)
            fail("its palette has " + std::to_string(entries) + " entries instead of 1 to 65536");
        const rgba_image palette = any_image("shN", 0, static_cast<std::size_t>(entries) * coefficients);
        if (palette.width != palette_columns * coefficients)
            fail("the image of its palette is " + std::to_string(palette.width) + " pixels wide instead of " +
                 std::to_string(palette_columns * coefficients));
        const rgba_image labels = image("shN", 1);
        for (std::size_t i = 0; i < count_; ++i) {
            const std::size_t label = labels.pixel(i)[0] + std::size_t{256} * labels.pixel(i)[1];
            if (label >= entries)
                fail("the color of Gaussian " + std::to_string(i) + " is entry " + std::to_string(label) +
                     " of a palette of " + std::to_string(entries));
            for (std::size_t j = 0; j < coefficients; ++j)
                for (std::size_t k = 0; k < 3; ++k)
                    model_.sh_rest[3 * (i * coefficients + j) + k] =
                        book[palette.pixel(label * coefficients + j)[k]];
        }
    }

    std::string name_;
    zip_bundle bundle_;
    std::uint64_t file_size_;
    input_json meta_;
    std::size_t count_ = 0;
    gaussians model_;
};

}  // namespace

gaussians read_sog(const std::filesystem::path& file) { return sog_input(file).read(); }

}  // namespace gs
