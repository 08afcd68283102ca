// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "gltf.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "../../core/atomic_file_write.hpp"
#include "../../core/error.hpp"
#include "../../model/spherical_harmonics.hpp"
#include "../quantize.hpp"
#include "../require_writable.hpp"
#include "gltf_layout.hpp"
#include "gltf_read.hpp"

namespace gs {
namespace {

using json = nlohmann::ordered_json;
static_assert(std::endian::native == std::endian::little, "floats are written as they lie in memory");

constexpr std::size_t color_bytes = 4;
constexpr int array_buffer = 34962, points = 0;

template <class T>
void write_raw(std::ostream& out, const T* values, std::size_t count) {
    out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

class gltf_output {
  public:
    gltf_output(const std::filesystem::path& file, const gaussians& model, int sh_degree)
        : file_(file), model_(model), attributes_(gltf_attributes(sh_degree, model.sh_degree)) {
        for (const gltf_attribute& a : attributes_) binary_size_ += sizeof(float) * a.width * model.count();
        binary_size_ += color_bytes * model.count();
        json_ = document().dump();
        json_.resize((json_.size() + 3) / 4 * 4, ' ');
        const std::uint64_t size =
            sizeof(glb_header) + 2 * sizeof(glb_chunk) + json_.size() + std::uint64_t{binary_size_};
        if (size > std::numeric_limits<std::uint32_t>::max())
            throw error("cannot write " + file.string() + ": it would have " + std::to_string(size) +
                        " bytes, but a .glb file has less than 2^32; use another format or --decimate");
        size_ = static_cast<std::uint32_t>(size);
    }

    void write(std::ostream& out) const {
        const glb_header header{.size = size_};
        const glb_chunk text{static_cast<std::uint32_t>(json_.size()), glb_json};
        const glb_chunk binary{static_cast<std::uint32_t>(binary_size_), glb_binary};
        write_raw(out, &header, 1);
        write_raw(out, &text, 1);
        out << json_;
        write_raw(out, &binary, 1);
        for (const gltf_attribute& a : attributes_)
            for (std::size_t i = 0; i < model_.count(); ++i) write_attribute(out, a, i);
        for (std::size_t i = 0; i < model_.count(); ++i) write_color(out, i);
    }

  private:
    /// glTF has no empty accessors, so an empty model has no mesh.
    json document() const {
        json d{{"asset", {{"version", "2.0"}, {"generator", "warpagg"}}},
               {"extensionsUsed", {gltf_extension}}};
        if (model_.count() == 0) return d;
        json views = json::array(), accessors = json::array(), names = json::object();
        std::size_t offset = 0;
        const auto add = [&](const std::string& name, std::size_t bytes, json accessor) {
            names[name] = accessors.size();
            accessor["bufferView"] = views.size();
            accessor["count"] = model_.count();
            accessors.push_back(std::move(accessor));
            views.push_back(
                {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}, {"target", array_buffer}});
            offset += bytes;
        };
        for (const gltf_attribute& a : attributes_) {
            json accessor{{"componentType", gltf_float}, {"type", a.type}};
            if (a.name == "POSITION") add_bounds(accessor, a);
            add(a.name, sizeof(float) * a.width * model_.count(), accessor);
        }
        add("COLOR_0", color_bytes * model_.count(),
            {{"componentType", gltf_unsigned_byte}, {"type", "VEC4"}, {"normalized", true}});
        const json extension{{"kernel", "ellipse"},
                             {"colorSpace", "srgb_rec709_display"},
                             {"projection", "perspective"},
                             {"sortingMethod", "cameraDistance"}};
        const json primitive{
            {"attributes", names}, {"mode", points}, {"extensions", {{gltf_extension, extension}}}};
        d["scene"] = 0;
        d["scenes"] = json::array({{{"nodes", {0}}}});
        d["nodes"] = json::array({{{"mesh", 0}}});
        d["meshes"] = json::array({{{"primitives", json::array({primitive})}}});
        d["buffers"] = json::array({{{"byteLength", binary_size_}}});
        d["bufferViews"] = views;
        d["accessors"] = accessors;
        return d;
    }

    void add_bounds(json& accessor, const gltf_attribute& position) const {
        std::array<float, 3> low{}, high{};
        for (std::size_t i = 0; i < model_.count(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const float x = position.sign[k] * model_.mean[3 * i + k];
                low[k] = i == 0 ? x : std::min(low[k], x);
                high[k] = i == 0 ? x : std::max(high[k], x);
            }
        accessor["min"] = low;
        accessor["max"] = high;
    }

    void write_attribute(std::ostream& out, const gltf_attribute& a, std::size_t i) const {
        const float* const values = &(model_.*a.array)[i * a.model_width + a.first];
        std::array<float, 4> written{};
        for (std::size_t k = 0; k < a.width; ++k) written[k] = a.sign[k] * values[k];
        switch (a.encoding) {
            case gltf_encoding::plain:
                break;
            case gltf_encoding::exponential:
                for (std::size_t k = 0; k < a.width; ++k) written[k] = scale(values[k], i);
                break;
            case gltf_encoding::sigmoid:
                written[0] = static_cast<float>(sigmoid(values[0]));
                break;
            case gltf_encoding::rotation:
                written = rotation(values, a);
                break;
        }
        write_raw(out, written.data(), a.width);
    }

    float scale(float logarithm, std::size_t i) const {
        const float value = std::exp(logarithm);
        if (!std::isfinite(value))
            throw error("cannot write " + file_.string() + ": the scale of Gaussian " + std::to_string(i) +
                        " is not finite");
        return value;
    }

    /// Returns the unit quaternion x y z w.
    static std::array<float, 4> rotation(const float* wxyz, const gltf_attribute& a) {
        double length = 0;
        for (std::size_t k = 0; k < 4; ++k) length = std::hypot(length, double(wxyz[k]));
        std::array<float, 4> xyzw{};
        for (std::size_t k = 0; k < 4; ++k)
            xyzw[k] = a.sign[k] * static_cast<float>(double(wxyz[(k + 1) % 4]) / length);
        return xyzw;
    }

    void write_color(std::ostream& out, std::size_t i) const {
        std::array<std::uint8_t, color_bytes> color{};
        for (std::size_t k = 0; k < 3; ++k)
            color[k] = to_byte(255 * (0.5 + sh_c0 * double(model_.sh_constant[3 * i + k])));
        color[3] = opacity_to_byte(model_.opacity[i]);
        write_raw(out, color.data(), color.size());
    }

    const std::filesystem::path& file_;
    const gaussians& model_;
    std::vector<gltf_attribute> attributes_;
    std::size_t binary_size_ = 0;
    std::string json_;
    std::uint32_t size_ = 0;
};

void write_gltf(const std::filesystem::path& file, const gaussians& model, const write_options& options) {
    const int sh_degree = std::min(model.sh_degree, options.max_sh_degree);
    require_writable(file, model, sh_degree);
    const gltf_output output(file, model, sh_degree);
    atomic_file_write(file, [&](std::ostream& out) { output.write(out); });
}

constexpr std::string_view endings[] = {".glb"};

}  // namespace

constinit const writer gltf_writer{.name = "glTF",
                                   .endings = endings,
                                   .write = write_gltf,
                                   .read = read_gltf,
                                   .holds_antialiasing = false,
                                   .holds_sky = false};

}  // namespace gs
