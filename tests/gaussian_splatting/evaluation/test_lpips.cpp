// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

#include "evaluation/lpips/lpips.hpp"
#include "patterns.hpp"

using namespace gs_test;
using gs::evaluate::lpips_network;

namespace {

/// A file of weights in a folder of its own.
struct weights_file {
    temporary_folder folder;
    std::filesystem::path path = folder / "lpips.safetensors";

    explicit weights_file(const std::string& input_range) { write_lpips_weights(path, input_range); }
};

/// Returns the error for a file with this header and 4 bytes of values.
std::string refusal(const std::string& header) {
    const temporary_folder folder;
    const auto file = folder / "weights.safetensors";
    write_safetensors(file, header, std::string(4, '\0'));
    const std::string sentence = error_of([&] { const lpips_network network(file); });
    CHECK(says(sentence, {file.string()}));
    return sentence;
}

/// Returns the error for the right header with one entry changed.
std::string refusal_of_entry(const std::string& tensor, const std::string& key, const nlohmann::json& value) {
    auto header = weights_header(lpips_tensors(), "-1,1");
    header[tensor][key] = value;
    return refusal(header.dump());
}

}  // namespace

TEST_CASE("LPIPS has the distances of PyTorch in each layer") {
    const auto expected = reference_metrics("lpips");
    for (const auto& [range, black] : {std::pair{"-1,1", -1}, std::pair{"0,1", 0}}) {
        const weights_file file(range);
        const lpips_network network(file.path);
        CHECK(network.black() == black);
        for (const auto& [width, height] : {std::pair{37, 29}, std::pair{16, 16}}) {
            const std::string key =
                std::to_string(black) + " " + std::to_string(width) + "x" + std::to_string(height);
            CAPTURE(key);
            const pattern_images images = make_images(width, height);
            const auto layers = network.layer_distances(images.render, images.target, width, height);
            for (std::size_t i = 0; i < layers.size(); ++i) {
                CAPTURE(i);
                CHECK(layers[i] == doctest::Approx(expected.at(key).at(i).get<double>()).epsilon(2e-5));
            }
            CHECK(*network.distance(images.render, images.target, width, height) ==
                  std::accumulate(layers.begin(), layers.end(), 0.0));
        }
    }
}

TEST_CASE("LPIPS of equal images is 0, and images below 16 pixels have none") {
    const weights_file file("-1,1");
    const lpips_network network(file.path);
    const pattern_images images = make_images(33, 17), small = make_images(15, 40);
    CHECK(network.distance(images.target, images.target, 33, 17) == 0.0);
    CHECK_FALSE(network.distance(small.render, small.target, 15, 40));
    CHECK_FALSE(network.distance(small.render, small.target, 40, 15));
}

TEST_CASE("a file of LPIPS weights that is malformed is refused with its name and the reason") {
    const temporary_folder folder;
    CHECK(says(error_of([&] { const lpips_network n(folder / "none"); }), {"none"}));
    write_file(folder / "short", "1234567");
    CHECK(says(error_of([&] { const lpips_network n(folder / "short"); }), {"short", "header"}));
    write_file(folder / "long", std::string(8, '\x7f') + "{}");
    CHECK(says(error_of([&] { const lpips_network n(folder / "long"); }), {"long", "header"}));

    CHECK(says(refusal("[1]"), {"JSON object"}));
    CHECK(says(refusal("{\"a\": "), {"JSON object"}));
    CHECK(says(refusal("{}"), {"input_range", "convert_lpips_weights.py"}));
    CHECK(says(refusal(R"({"__metadata__": {"input_range": "0,255"}})"), {"0,255"}));
    CHECK(says(refusal(R"({"__metadata__": {"input_range": "-1,1"}})"), {"no tensor features.0.weight"}));
    CHECK(says(refusal_of_entry("features.0.weight", "shape", {64, 3, 1, 1}),
               {"features.0.weight", "[64,3,1,1]", "[64,3,3,3]"}));
    CHECK(says(refusal_of_entry("features.0.weight", "dtype", "F16"), {"features.0.weight", "F16", "F32"}));
    for (const nlohmann::json& offsets :
         {nlohmann::json{0, 4}, nlohmann::json{8, 4}, nlohmann::json{-8, 4}, nlohmann::json{"a"},
          nlohmann::json(nullptr), nlohmann::json{18446744073709551608U, 6904U}})
        CHECK(says(refusal_of_entry("features.0.weight", "data_offsets", offsets),
                   {"offsets", "features.0.weight"}));
    CHECK(says(refusal(weights_header(lpips_tensors(), "-1,1").dump()), {"features.0.weight", "exceed"}));
}

TEST_CASE("a weight that is not finite is refused with the tensor's name") {
    const weights_file file("-1,1");
    std::fstream bytes(file.path, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(-4, std::ios::end);
    bytes.write("\x00\x00\xc0\x7f", 4);  // NaN
    bytes.close();
    CHECK(says(error_of([&] { const lpips_network n(file.path); }),
               {file.path.string(), "lin4.model.1.weight", "not finite"}));
}
