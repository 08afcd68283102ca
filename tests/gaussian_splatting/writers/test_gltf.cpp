// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../support/bytes.hpp"
#include "../../support/temporary_folder.hpp"
#include "round_trip.hpp"
#include "writers/gltf/gltf.hpp"

namespace {

using gs_test::error_of;
using gs_test::random_model;
using gs_test::read_back;
using gs_test::temporary_folder;
using json = nlohmann::ordered_json;

/// A .glb file, taken apart.
struct glb {
    json document;
    std::string binary;

    explicit glb(const gs::gaussians& model) {
        const temporary_folder folder;
        gs::gltf_writer.write(folder / "a.glb", model, {});
        const std::string file = gs_test::read_file(folder / "a.glb");
        std::uint32_t words[5];
        std::memcpy(words, file.data(), sizeof words);
        CHECK(words[0] == 0x46546c67);
        CHECK(words[1] == 2);
        CHECK(words[2] == file.size());
        CHECK(words[3] % 4 == 0);
        CHECK(words[4] == 0x4e4f534a);
        document = json::parse(file.substr(20, words[3]));
        binary = file.substr(28 + words[3]);
        std::uint32_t chunk[2];
        std::memcpy(chunk, file.data() + 20 + words[3], sizeof chunk);
        CHECK(chunk[0] == binary.size());
        CHECK(chunk[1] == 0x004e4942);
    }

    std::string file() const {
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        gs_test::bytes all;
        const auto size = [](const std::string& s) { return static_cast<std::uint32_t>(s.size()); };
        all.put(std::uint32_t{0x46546c67}).put(std::uint32_t{2}).put(28 + size(text) + size(binary));
        all.put(size(text)).put(std::uint32_t{0x4e4f534a});
        gs_test::bytes chunk;
        chunk.put(size(binary)).put(std::uint32_t{0x004e4942});
        return all.data() + text + chunk.data() + binary;
    }

    json& accessor(const std::string& attribute) {
        const auto index = document["meshes"][0]["primitives"][0]["attributes"][attribute].get<std::size_t>();
        return document["accessors"][index];
    }
    json& view(const std::string& attribute) {
        return document["bufferViews"][accessor(attribute)["bufferView"].get<std::size_t>()];
    }
    std::vector<float> floats(const std::string& attribute, std::size_t count) {
        std::vector<float> values(count);
        std::memcpy(values.data(), binary.data() + view(attribute)["byteOffset"].get<std::size_t>(),
                    count * sizeof(float));
        return values;
    }
    void set_float(const std::string& attribute, std::size_t place, float value) {
        std::memcpy(binary.data() + view(attribute)["byteOffset"].get<std::size_t>() + 4 * place, &value,
                    sizeof value);
    }
};

gs::gaussians read_glb_bytes(const std::string& data) {
    const temporary_folder folder;
    gs_test::write_file(folder / "a.glb", data);
    return gs::gltf_writer.read(folder / "a.glb");
}

/// Returns the message without the name of the file.
std::string message_of_glb(const std::string& data) {
    const temporary_folder folder;
    const std::string file = (folder / "a.glb").string();
    gs_test::write_file(file, data);
    const std::string problem = error_of([&] { gs::gltf_writer.read(file); });
    REQUIRE(problem.starts_with(file + ": "));
    return problem.substr(file.size() + 2);
}

}  // namespace

TEST_CASE("gltf: attributes have y up, unit quaternions x y z w, and no logits or logarithms") {
    gs::gaussians model = random_model(1, 2);
    model.mean = {1, 2, 3};
    model.log_scale = {0, std::log(2.0f), -1};
    model.quaternion = {0, 3, 4, 0};
    model.opacity = {0};
    model.sh_constant = {0.5f, -2, 9};
    for (std::size_t k = 0; k < model.sh_rest.size(); ++k) model.sh_rest[k] = static_cast<float>(k + 1);
    glb file(model);
    CHECK(file.document["extensionsUsed"] == json::array({"KHR_gaussian_splatting"}));
    const json& primitive = file.document["meshes"][0]["primitives"][0];
    CHECK(primitive["mode"] == 0);
    CHECK(primitive["extensions"]["KHR_gaussian_splatting"]["kernel"] == "ellipse");
    CHECK(file.accessor("POSITION")["min"] == json::array({1, -2, -3}));
    CHECK(file.floats("POSITION", 3) == std::vector<float>{1, -2, -3});
    const std::string prefix = "KHR_gaussian_splatting:";
    CHECK(file.floats(prefix + "ROTATION", 4) == std::vector<float>{0.6f, -0.8f, 0, 0});
    CHECK(file.floats(prefix + "SCALE", 3) ==
          std::vector<float>{1, std::exp(std::log(2.0f)), std::exp(-1.0f)});
    CHECK(file.floats(prefix + "OPACITY", 1) == std::vector<float>{0.5f});
    CHECK(file.floats(prefix + "SH_DEGREE_0_COEF_0", 3) == model.sh_constant);
    CHECK(file.floats(prefix + "SH_DEGREE_1_COEF_0", 3) == std::vector<float>{-1, -2, -3});
    CHECK(file.floats(prefix + "SH_DEGREE_1_COEF_2", 3) == std::vector<float>{7, 8, 9});
    CHECK(file.floats(prefix + "SH_DEGREE_2_COEF_0", 3) == std::vector<float>{-10, -11, -12});
    CHECK(file.floats(prefix + "SH_DEGREE_2_COEF_1", 3) == std::vector<float>{13, 14, 15});
    const std::size_t color = file.view("COLOR_0")["byteOffset"];
    CHECK(file.binary.substr(color) == std::string("\xa3\x00\xff\x80", 4));
}

TEST_CASE("gltf: attributes may be interleaved") {
    const gs::gaussians model = random_model(2, 0);
    glb file(model);
    const std::size_t at = file.binary.size();
    for (std::size_t i = 0; i < 2; ++i) {
        for (const float x : {1.0f, 2.0f, 3.0f}) {
            gs_test::bytes b;
            b.put(x + 10 * static_cast<float>(i));
            file.binary += b.data();
        }
        file.binary += "some other data.";
    }
    file.view("POSITION") = {{"buffer", 0}, {"byteOffset", at - 4}, {"byteLength", 60}, {"byteStride", 28}};
    file.accessor("POSITION")["byteOffset"] = 4;
    const gs::gaussians found = read_glb_bytes(file.file());
    CHECK(found.mean == std::vector<float>{1, -2, -3, 11, -12, -13});
    CHECK(found.log_scale[0] == doctest::Approx(model.log_scale[0]));
}

TEST_CASE("gltf: an opacity of 0 or 1 and a scale of 0 are read as finite values") {
    glb file(random_model(2, 0));
    file.set_float("KHR_gaussian_splatting:OPACITY", 0, 0);
    file.set_float("KHR_gaussian_splatting:OPACITY", 1, 1);
    file.set_float("KHR_gaussian_splatting:SCALE", 0, 0);
    const gs::gaussians found = read_glb_bytes(file.file());
    CHECK(found.opacity[0] < -15);
    CHECK(found.opacity[1] > 15);
    CHECK(std::isfinite(found.opacity[0]));
    CHECK(std::isfinite(found.log_scale[0]));
}

TEST_CASE("gltf: malformed files are refused with the field") {
    const glb whole(random_model(3, 1));
    const auto refused = [&](const auto& change) {
        glb file = whole;
        change(file);
        return message_of_glb(file.file());
    };
    const std::string scale = "KHR_gaussian_splatting:SCALE";
    CHECK(message_of_glb("glTF") == "it is too short for a .glb file");
    CHECK(message_of_glb("x" + whole.file().substr(1)) == "it is not a .glb file, which begins with glTF");
    CHECK(gs_test::says(message_of_glb(whole.file() + "    "), {"its header specifies"}));
    CHECK(refused([](glb& f) { f.document = json::array(); }) ==
          "it has no mesh with KHR_gaussian_splatting");
    CHECK(refused([](glb& f) { f.document["meshes"][0]["primitives"][0].erase("extensions"); }) ==
          "it has no mesh with KHR_gaussian_splatting");
    CHECK(refused([](glb& f) {
              f.document["nodes"][0]["scale"] = json::array({1, 1, 2});
          }) == "a node has a scale, which cannot be read");
    CHECK(refused([&](glb& f) { f.document["meshes"][0]["primitives"][0]["attributes"].erase(scale); }) ==
          "its attribute " + scale + " has no accessor");
    CHECK(refused([&](glb& f) { f.accessor(scale)["componentType"] = 5121; }) ==
          "its attribute " + scale + " is not a VEC3 of floats");
    CHECK(refused([&](glb& f) { f.accessor(scale)["bufferView"] = 99; }) ==
          "its attribute " + scale + " has no view of the binary data");
    CHECK(refused([&](glb& f) {
              f.accessor(scale)["sparse"] = {{"count", 1}};
          }) == "its attribute " + scale + " is sparse, which cannot be read");
    CHECK(refused([&](glb& f) { f.accessor(scale)["count"] = 4; }) ==
          "its attribute " + scale + " exceeds the binary data");
    CHECK(refused([&](glb& f) { f.accessor(scale)["count"] = std::uint64_t{1} << 62; }) ==
          "its attribute " + scale + " exceeds the binary data");
    CHECK(refused([&](glb& f) { f.view(scale)["byteOffset"] = f.binary.size(); }) ==
          "its attribute " + scale + " exceeds the binary data");
    CHECK(refused([&](glb& f) { f.accessor(scale)["count"] = 2; }) == "its attributes have different counts");
    CHECK(refused([&](glb& f) { f.set_float(scale, 4, -1); }) ==
          "its attribute " + scale + " of Gaussian 1 is negative");
    CHECK(refused([&](glb& f) { f.set_float("POSITION", 8, std::numeric_limits<float>::infinity()); }) ==
          "its attribute POSITION of Gaussian 2 is not finite");
    CHECK(refused([&](glb& f) {
              for (std::size_t k = 0; k < 4; ++k) f.set_float("KHR_gaussian_splatting:ROTATION", k, 0);
          }) == "its attribute KHR_gaussian_splatting:ROTATION of Gaussian 0 is zero");
}
