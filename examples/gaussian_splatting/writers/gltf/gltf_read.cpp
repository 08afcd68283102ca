// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "gltf_read.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "../../core/error.hpp"
#include "../../core/file_bytes.hpp"
#include "../../core/parse_json.hpp"
#include "../require_writable.hpp"
#include "gltf_layout.hpp"

namespace gs {
namespace {

using input_json = nlohmann::json;

constexpr std::uint32_t longest_json = 1 << 20;

class gltf_input {
  public:
    explicit gltf_input(const std::filesystem::path& file) : file_(file) {}

    gaussians read() {
        read_json();
        const input_json* const attributes = find_attributes();
        if (!attributes) return {};
        require_no_transformation();
        int sh_degree = 0;
        for (int degree = 1; degree <= 3; ++degree)
            if (attributes->contains(gltf_attributes(degree, degree).back().name)) sh_degree = degree;
        const auto layout = gltf_attributes(sh_degree, sh_degree);
        std::vector<source> sources;
        for (const gltf_attribute& a : layout) sources.push_back(source_of(a, *attributes));
        for (const source& s : sources)
            if (s.count != sources.front().count) fail("its attributes have different counts");
        document_ = {};
        gaussians model = sized_model(static_cast<std::size_t>(sources.front().count), sh_degree);
        for (std::size_t i = 0; i < layout.size(); ++i) read_attribute(layout[i], sources[i], model);
        return model;
    }

  private:
    /// The place of an attribute in the file.
    struct source {
        std::uint64_t count = 0, offset = 0, stride = 0;
    };

    [[noreturn]] void fail(const std::string& what) const { throw error(file_.name + ": " + what); }

    template <class T>
    void read_raw(T* values, std::size_t count) {
        file_.in.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
        if (!file_.in) throw error("cannot read " + file_.name);
    }

    void read_json() {
        glb_header header;
        glb_chunk text, binary;
        constexpr std::size_t least = sizeof header + sizeof text;
        if (file_.size < least) fail("it is too short for a .glb file");
        read_raw(&header, 1);
        read_raw(&text, 1);
        if (header.magic != glb_header{}.magic) fail("it is not a .glb file, which begins with glTF");
        if (header.version != 2)
            fail("its glTF version is " + std::to_string(header.version) + ", but only 2 can be read");
        if (header.size != file_.size)
            fail("its header specifies " + std::to_string(header.size) + " bytes, but it has " +
                 std::to_string(file_.size));
        if (text.type != glb_json) fail("its first chunk is not JSON");
        if (text.size > longest_json || text.size > file_.size - least)
            fail("its JSON has " + std::to_string(text.size) + " bytes, which is too much");
        std::string bytes(text.size, '\0');
        read_raw(bytes.data(), bytes.size());
        document_ = parse_json<input_json>(bytes, file_.name + ": its first chunk");
        const std::uint64_t rest = file_.size - least - text.size;
        if (rest == 0) return;
        if (rest < sizeof binary) fail("its second chunk is too short");
        read_raw(&binary, 1);
        if (binary.type != glb_binary || binary.size > rest - sizeof binary)
            fail("its second chunk is not binary data within the file");
        binary_offset_ = least + text.size + sizeof binary;
        binary_size_ = binary.size;
    }

    /// Returns a member, or null if the value is no object or has no such member.
    static const input_json* member(const input_json* value, const char* name) {
        if (!value || !value->is_object()) return nullptr;
        const auto found = value->find(name);
        return found == value->end() ? nullptr : &*found;
    }
    /// Returns an element of the array that is a member of the document, or null.
    const input_json* element(const char* array, std::uint64_t index) const {
        const input_json* const all = member(&document_, array);
        return all && all->is_array() && index < all->size() ? &(*all)[index] : nullptr;
    }
    /// Returns a member that is a whole number, or `otherwise`.
    static std::uint64_t whole(const input_json* value, const char* name, std::uint64_t otherwise) {
        const input_json* const found = member(value, name);
        return found && found->is_number_unsigned() ? found->get<std::uint64_t>() : otherwise;
    }

    /// Returns the attributes of the first primitive with the extension, or null for a file that
    /// uses the extension but has no mesh.
    const input_json* find_attributes() const {
        const input_json* const meshes = member(&document_, "meshes");
        if (meshes && meshes->is_array())
            for (const input_json& mesh : *meshes) {
                const input_json* const primitives = member(&mesh, "primitives");
                if (!primitives || !primitives->is_array()) continue;
                for (const input_json& primitive : *primitives) {
                    if (!member(member(&primitive, "extensions"), gltf_extension)) continue;
                    const input_json* const attributes = member(&primitive, "attributes");
                    if (!attributes || !attributes->is_object()) fail("its primitive has no attributes");
                    return attributes;
                }
            }
        const input_json* const used = member(&document_, "extensionsUsed");
        if (!meshes && used && std::ranges::find(*used, gltf_extension) != used->end()) return nullptr;
        fail("it has no mesh with " + std::string(gltf_extension));
    }

    void require_no_transformation() const {
        const input_json* const nodes = member(&document_, "nodes");
        if (!nodes || !nodes->is_array()) return;
        for (const input_json& node : *nodes)
            for (const char* name : {"matrix", "translation", "rotation", "scale"})
                if (member(&node, name)) fail("a node has a " + std::string(name) + ", which cannot be read");
    }

    source source_of(const gltf_attribute& a, const input_json& attributes) const {
        constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
        const std::string where = "its attribute " + a.name + " ";
        const input_json* const accessor = element("accessors", whole(&attributes, a.name.c_str(), none));
        if (!accessor) fail(where + "has no accessor");
        const input_json* const type = member(accessor, "type");
        if (whole(accessor, "componentType", 0) != gltf_float || !type || *type != a.type)
            fail(where + "is not a " + a.type + " of floats");
        if (member(accessor, "sparse")) fail(where + "is sparse, which cannot be read");
        const input_json* const view = element("bufferViews", whole(accessor, "bufferView", none));
        if (!view || whole(view, "buffer", none) != 0) fail(where + "has no view of the binary data");
        const std::uint64_t row = sizeof(float) * a.width;
        source s{.count = whole(accessor, "count", none), .stride = whole(view, "byteStride", row)};
        const std::uint64_t first = whole(accessor, "byteOffset", 0),
                            view_first = whole(view, "byteOffset", 0);
        const std::uint64_t length = whole(view, "byteLength", 0);
        // Divides instead of multiplying, because a product may overflow.
        const bool fits =
            view_first <= binary_size_ && length <= binary_size_ - view_first && first <= length &&
            s.stride >= row &&
            (s.count == 0 || (length - first >= row && s.count - 1 <= (length - first - row) / s.stride));
        if (!fits) fail(where + "exceeds the binary data");
        s.offset = binary_offset_ + view_first + first;
        return s;
    }

    void read_attribute(const gltf_attribute& a, const source& s, gaussians& model) {
        constexpr std::size_t bytes_at_once = 1 << 14;
        const auto stride = static_cast<std::size_t>(s.stride), row = sizeof(float) * a.width;
        // A stride beyond the buffer is possible, with few rows.
        const std::size_t rows_at_once = std::max<std::size_t>(bytes_at_once / stride, 1);
        std::vector<char> bytes;
        for (std::size_t first = 0; first < model.count(); first += rows_at_once) {
            const std::size_t rows = std::min(rows_at_once, model.count() - first);
            bytes.resize((rows - 1) * stride + row);
            file_.in.seekg(static_cast<std::streamoff>(s.offset + first * s.stride));
            read_raw(bytes.data(), bytes.size());
            for (std::size_t i = 0; i < rows; ++i) {
                std::array<float, 4> values{};
                std::memcpy(values.data(), bytes.data() + i * stride, row);
                store(a, values, first + i, model);
            }
        }
    }

    void store(const gltf_attribute& a, const std::array<float, 4>& values, std::size_t i,
               gaussians& model) const {
        const auto refuse = [&](const char* what) {
            fail("its attribute " + a.name + " of Gaussian " + std::to_string(i) + " is " + what);
        };
        float* const to = &(model.*a.array)[i * a.model_width + a.first];
        for (std::size_t k = 0; k < a.width; ++k)
            if (!std::isfinite(values[k])) refuse("not finite");
        for (std::size_t k = 0; k < a.width; ++k) switch (a.encoding) {
                case gltf_encoding::plain:
                    to[k] = a.sign[k] * values[k];
                    break;
                case gltf_encoding::exponential:
                    if (values[k] < 0) refuse("negative");
                    to[k] = std::log(std::max(values[k], std::numeric_limits<float>::min()));
                    break;
                case gltf_encoding::sigmoid: {
                    constexpr double least = 1e-7;  // opacities of 0 and 1 have no logit
                    const double alpha = std::clamp(double(values[k]), least, 1 - least);
                    to[k] = static_cast<float>(std::log(alpha / (1 - alpha)));
                    break;
                }
                case gltf_encoding::rotation:  // x y z w becomes w x y z
                    to[(k + 1) % 4] = a.sign[k] * values[k];
                    break;
            }
        if (a.encoding == gltf_encoding::rotation &&
            std::ranges::all_of(values, [](float x) { return x == 0; }))
            refuse("zero");
    }

    opened_file file_;
    input_json document_;
    std::uint64_t binary_offset_ = 0, binary_size_ = 0;
};

}  // namespace

gaussians read_gltf(const std::filesystem::path& file) { return gltf_input(file).read(); }

}  // namespace gs
