// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <future>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "../../cluster/codebook.hpp"
#include "../../core/atomic_file_write.hpp"
#include "../../core/error.hpp"
#include "../../core/parallel.hpp"
#include "../../model/morton_order.hpp"
#include "../quantize.hpp"
#include "../require_writable.hpp"
#include "../smallest_three.hpp"
#include "sog.hpp"
#include "sog_files.hpp"
#include "sog_images.hpp"
#include "zip_bundle.hpp"

namespace gs {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t entries_per_row = 64;  ///< of the image of the palette
constexpr std::size_t largest_side = 16383;  ///< of WebP images
constexpr std::uint8_t first_rotation_tag = 252, opaque = 255;

double log_transform(float x) { return std::copysign(std::log1p(std::abs(double(x))), double(x)); }

/// Returns the number of entries of the palette: all colors of small models, and a power of two times
/// 1024 for larger ones, up to the 65536 that labels can tell apart.
std::size_t palette_size(std::size_t count) {
    constexpr std::size_t unit = 1024, most = 65536;
    return count < unit ? count : std::min(most, unit * std::bit_floor(count / unit));
}

class sog_output {
  public:
    sog_output(const gaussians& model, int sh_degree, cluster::k_means_function k_means)
        : model_(model), sh_degree_(sh_degree), k_means_(k_means) {
        const double side = std::sqrt(static_cast<double>(std::max<std::size_t>(model.count(), 1)));
        width_ = 4 * static_cast<std::size_t>(std::ceil(side / 4));
        height_ = 4 * ((std::max<std::size_t>(model.count(), 1) + 4 * width_ - 1) / (4 * width_));
    }

    bool fits() const { return width_ <= largest_side && height_ <= largest_side; }

    std::string bundle() {
        meta_ = {{"version", 2}, {"asset", {{"generator", "warpagg"}}}, {"count", model_.count()}};
        if (model_.antialiased) {
            meta_["antialias"] = true;
            meta_["model"] = "antialiased";  // newer programs read only this
        }
        // The palette takes longest, and a GPU that computes it leaves the CPU idle. A codebook, and the
        // encoder of an image, mostly use one thread. So they run while this thread goes on.
        const bool has_palette = sh_degree_ > 0 && model_.count() > 0;
        std::future<cluster::clustering> colors;
        if (has_palette) colors = std::async(std::launch::async, [this] { return clustered_colors(); });
        auto scale_book = begin_codebook(model_.log_scale), color_book = begin_codebook(model_.sh_constant);
        order_ = morton_order(model_.mean);
        add_means();
        add_scales(scale_book.get());
        add_rotations();
        add_colors(color_book.get());
        if (has_palette) add_palette(colors.get());
        std::vector<bundled_file> files{{"meta.json", meta_.dump()}};
        for (std::future<bundled_file>& file : files_) files.push_back(file.get());
        return zip_of(files);
    }

  private:
    static std::future<cluster::codebook> begin_codebook(const std::vector<float>& values) {
        return std::async(std::launch::async, [&values] { return cluster::codebook(values); });
    }

    /// Begins to encode an image.
    void add_file(const std::string& name, rgba_image image) {
        files_.push_back(std::async(std::launch::async, [name, image = std::move(image)] {
            return bundled_file{name, webp_of(image)};
        }));
    }

    /// Adds an image with a pixel for each Gaussian, which `fill(i, pixel)` sets.
    void add_image(const std::string& name, const auto& fill) {
        rgba_image image(width_, height_);
        for_each_index_in_parallel(order_.size(), [&](std::size_t i) { fill(order_[i], image.pixel(i)); });
        add_file(name, std::move(image));
    }

    void add_means() {
        std::array<double, 3> low{}, high{};
        for (std::size_t i = 0; i < model_.mean.size(); ++i) {
            const double x = model_.mean[i];
            low[i % 3] = i < 3 ? x : std::min(low[i % 3], x);
            high[i % 3] = i < 3 ? x : std::max(high[i % 3], x);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = log_transform(static_cast<float>(low[k]));
            high[k] = log_transform(static_cast<float>(high[k]));
        }
        const auto add_byte = [&](const char* name, int shift) {
            add_image(name, [&, shift](std::size_t i, std::uint8_t* pixel) {
                for (std::size_t k = 0; k < 3; ++k) {
                    const double range = high[k] - low[k];
                    const double share =
                        range > 0 ? (log_transform(model_.mean[3 * i + k]) - low[k]) / range : 0;
                    pixel[k] = static_cast<std::uint8_t>(to_unorm(share, 65535) >> shift & 255);
                }
                pixel[3] = opaque;
            });
        };
        add_byte("means_l.webp", 0);
        add_byte("means_u.webp", 8);
        meta_["means"] = {{"mins", low}, {"maxs", high}, {"files", {"means_l.webp", "means_u.webp"}}};
    }

    void add_scales(const cluster::codebook& book) {
        add_image("scales.webp", [&](std::size_t i, std::uint8_t* pixel) {
            for (std::size_t k = 0; k < 3; ++k) pixel[k] = book.nearest(model_.log_scale[3 * i + k]);
            pixel[3] = opaque;
        });
        meta_["scales"] = {{"codebook", book.values()}, {"files", {"scales.webp"}}};
    }

    void add_rotations() {
        add_image("quats.webp", [&](std::size_t i, std::uint8_t* pixel) {
            const float* const q = &model_.quaternion[4 * i];
            const smallest_three three = smallest_three_of({q[0], q[1], q[2], q[3]});
            for (std::size_t k = 0; k < 3; ++k) pixel[k] = to_byte(255 * (three.others[k] + 1) / 2);
            pixel[3] = static_cast<std::uint8_t>(first_rotation_tag + three.largest);
        });
        meta_["quats"] = {{"files", {"quats.webp"}}};
    }

    void add_colors(const cluster::codebook& book) {
        add_image("sh0.webp", [&](std::size_t i, std::uint8_t* pixel) {
            for (std::size_t k = 0; k < 3; ++k) pixel[k] = book.nearest(model_.sh_constant[3 * i + k]);
            pixel[3] = opacity_to_byte(model_.opacity[i]);
        });
        meta_["sh0"] = {{"codebook", book.values()}, {"files", {"sh0.webp"}}};
    }

    std::size_t coefficients() const { return static_cast<std::size_t>(sh_coefficients(sh_degree_) - 1); }

    void add_palette(const cluster::clustering& colors) {
        const std::size_t entries = colors.centroids.size() / (3 * coefficients());
        auto future_book = begin_codebook(colors.centroids);
        add_image("shN_labels.webp", [&](std::size_t i, std::uint8_t* pixel) {
            pixel[0] = static_cast<std::uint8_t>(colors.labels[i] & 255);
            pixel[1] = static_cast<std::uint8_t>(colors.labels[i] >> 8 & 255);
            pixel[3] = opaque;
        });
        const cluster::codebook book = future_book.get();
        rgba_image palette(entries_per_row * coefficients(),
                           (entries + entries_per_row - 1) / entries_per_row);
        for_each_index_in_parallel(entries * coefficients(), [&](std::size_t i) {
            for (std::size_t k = 0; k < 3; ++k)
                palette.pixel(i)[k] = book.nearest(colors.centroids[3 * i + k]);
            palette.pixel(i)[3] = opaque;
        });
        add_file("shN_centroids.webp", std::move(palette));
        meta_["shN"] = {{"count", entries},
                        {"bands", sh_degree_},
                        {"codebook", book.values()},
                        {"files", {"shN_centroids.webp", "shN_labels.webp"}}};
    }

    /// Returns how much each Gaussian affects images, relative to the largest possible effect. The
    /// minimum lets invisible Gaussians have colors, too.
    std::vector<float> visibilities() const {
        constexpr double least = 1e-12;
        const double largest = std::ranges::max(model_.log_scale);
        std::vector<float> all(model_.count());
        for_each_index_in_parallel(all.size(), [&](std::size_t i) {
            const float* const s = &model_.log_scale[3 * i];
            const double half_log_size = (std::max({s[0], s[1], s[2]}) - largest) / 2;
            all[i] =
                static_cast<float>(std::max(least, sigmoid(model_.opacity[i]) * std::exp(half_log_size)));
        });
        return all;
    }

    /// Clusters the SH coefficients up to the degree of the file.
    cluster::clustering clustered_colors() const {
        const auto stride = static_cast<std::size_t>(model_.rest_width());
        const std::size_t width = 3 * coefficients(), most = palette_size(model_.count());
        if (stride == width) return k_means_(model_.sh_rest, width, visibilities(), most);
        std::vector<float> sh;
        sh.reserve(width * model_.count());
        for (std::size_t i = 0; i < model_.count(); ++i) {
            const auto first = model_.sh_rest.begin() + static_cast<std::ptrdiff_t>(i * stride);
            sh.insert(sh.end(), first, first + static_cast<std::ptrdiff_t>(width));
        }
        return k_means_(sh, width, visibilities(), most);
    }

    const gaussians& model_;
    int sh_degree_;
    cluster::k_means_function k_means_;
    std::vector<std::uint32_t> order_;
    std::size_t width_ = 0, height_ = 0;
    json meta_;
    std::vector<std::future<bundled_file>> files_;  ///< without the meta data
};

/// Throws `error` for colors up to `sh_degree` that `k_means` cannot cluster.
void require_clusterable(const std::filesystem::path& file, const gaussians& model, int sh_degree) {
    constexpr float end = 1e9f;
    const auto stride = static_cast<std::size_t>(model.rest_width());
    const auto width = static_cast<std::size_t>(3 * (sh_coefficients(sh_degree) - 1));
    for_each_index_in_parallel(model.count(), [&](std::size_t i) {
        for (std::size_t k = 0; k < width; ++k)
            if (std::abs(model.sh_rest[i * stride + k]) >= end)
                throw error("cannot write " + file.string() + ": the view-dependent color of Gaussian " +
                            std::to_string(i) + " is beyond the range of SOG files, which ends at 10^9; " +
                            "use another format or --max-sh-degree 0");
    });
}

constexpr std::string_view endings[] = {".sog"};

}  // namespace

void write_sog(const std::filesystem::path& file, const gaussians& model, const write_options& options) {
    const int sh_degree = std::min(model.sh_degree, options.max_sh_degree);
    require_writable(file, model, sh_degree);
    require_clusterable(file, model, sh_degree);
    sog_output output(model, sh_degree, options.k_means);
    if (!output.fits())
        throw error("cannot write " + file.string() +
                    ": its images would have more than 16383 pixels per side; "
                    "use another format or --decimate");
    const std::string bundle = output.bundle();
    atomic_file_write(file, [&](std::ostream& out) {
        out.write(bundle.data(), static_cast<std::streamsize>(bundle.size()));
    });
}

constinit const writer sog_writer{.name = "SOG",
                                  .endings = endings,
                                  .write = write_sog,
                                  .read = read_sog,
                                  .holds_sky = false,
                                  .clusters_colors = true};

}  // namespace gs
