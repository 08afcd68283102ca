// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <webp/decode.h>
#include <webp/demux.h>

#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "codec.hpp"

namespace gs {
namespace {

bool is_webp(std::span<const std::uint8_t> start) {
    return start.size() >= 12 && std::memcmp(start.data(), "RIFF", 4) == 0 &&
           std::memcmp(start.data() + 8, "WEBP", 4) == 0;
}

image_size read_webp_size(const image_file& file) {
    // The header fits, however many of its chunks are optional.
    const std::vector<std::uint8_t> start = file.bytes(4096);
    WebPBitstreamFeatures found;
    if (WebPGetFeatures(start.data(), start.size(), &found) != VP8_STATUS_OK)
        file.refuse("it is damaged or truncated");
    if (found.has_animation) file.refuse("it is an animation; save one of its frames as an image");
    return {static_cast<std::uint64_t>(found.width), static_cast<std::uint64_t>(found.height)};
}

void read_webp(const image_file& file, image& pixels) {
    const std::vector<std::uint8_t> bytes = file.bytes();
    WebPBitstreamFeatures found;
    if (WebPGetFeatures(bytes.data(), bytes.size(), &found) != VP8_STATUS_OK)
        file.refuse("it is damaged or truncated");
    file.check_decoded_size(
        {static_cast<std::uint64_t>(found.width), static_cast<std::uint64_t>(found.height)}, size_of(pixels));
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), pixels.rgba.data(), pixels.rgba.size(),
                            4 * pixels.width))
        file.refuse("it is damaged or truncated");
    premultiply(pixels);
}

struct demuxer_deleter {
    void operator()(WebPDemuxer* demuxer) const { WebPDemuxDelete(demuxer); }
};

orientation read_webp_orientation(const image_file& file) {
    const std::vector<std::uint8_t> bytes = file.bytes();
    const WebPData data{bytes.data(), bytes.size()};
    const std::unique_ptr<WebPDemuxer, demuxer_deleter> demuxer(WebPDemux(&data));
    WebPChunkIterator chunk;
    if (!demuxer || !WebPDemuxGetChunk(demuxer.get(), "EXIF", 1, &chunk)) return {};
    const orientation found = orientation_in_exif({chunk.chunk.bytes, chunk.chunk.size});
    WebPDemuxReleaseChunkIterator(&chunk);
    return found;
}

constexpr std::string_view webp_endings[] = {".webp"};

}  // namespace

extern constinit const image_codec webp_codec{"WebP",         webp_endings,          is_webp,
                                              read_webp_size, read_webp_orientation, read_webp};

}  // namespace gs
