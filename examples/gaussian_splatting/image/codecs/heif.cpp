// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <libheif/heif.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <string_view>

#include "../../core/sanitize_for_message.hpp"
#include "codec.hpp"

namespace gs {
namespace {

template <auto release>
struct deleter {
    void operator()(auto* object) const { release(object); }
};
using heif_file = std::unique_ptr<heif_context, deleter<heif_context_free>>;
using heif_photo = std::unique_ptr<heif_image_handle, deleter<heif_image_handle_release>>;
using heif_pixels = std::unique_ptr<heif_image, deleter<heif_image_release>>;
using heif_options = std::unique_ptr<heif_decoding_options, deleter<heif_decoding_options_free>>;

bool is_heif(std::span<const std::uint8_t> start) {
    constexpr std::string_view brands[] = {"heic", "heix", "heim", "heis", "mif1", "avif"};
    constexpr std::size_t brand = 8, size = 4;
    if (start.size() < brand + size || std::memcmp(start.data() + size, "ftyp", size) != 0) return false;
    const std::string_view major(reinterpret_cast<const char*>(start.data()) + brand, size);
    return std::ranges::find(brands, major) != std::end(brands);
}

void check(const image_file& file, const heif_error& result) {
    if (result.code == heif_error_Ok) return;
    if (result.subcode == heif_suberror_Unsupported_codec || result.code == heif_error_Plugin_loading_error)
        file.refuse(
            "libheif has no decoder for it; install libheif-plugin-libde265 for HEIC or "
            "libheif-plugin-dav1d for AVIF, or convert the photo to JPEG");
    std::string_view why = result.message;
    if (why.ends_with('\n')) why.remove_suffix(1);
    file.refuse("it is damaged, truncated or of an unknown kind (" + sanitize_for_message(why) + ")");
}

/// Loads the decoders of libheif once, before threads decode images.
void load_decoders() {
    static const struct decoders {
        decoders() { heif_init(nullptr); }
        ~decoders() { heif_deinit(); }
    } loaded;
}

std::uint64_t side(int length) { return static_cast<std::uint64_t>(std::max(length, 0)); }

// Encoders pad small images to tiles, which may be larger than the image.
constexpr std::uint64_t largest_tile_side = 4096;

/// Refuses images that are huge before the file's own cropping. Bounds the size of tiles and of the
/// grid that joins them, which need not agree with the header.
void limit_coded_size(const image_file& file, heif_context* context, const heif_image_handle* photo) {
    const image_size coded{side(heif_image_handle_get_ispe_width(photo)),
                           side(heif_image_handle_get_ispe_height(photo))};
    file.check_size(coded);
    file.check_density(coded);
    const std::uint64_t limit = std::max({coded.width, coded.height, largest_tile_side});
    heif_context_set_maximum_image_size_limit(context, static_cast<int>(limit));
}

/// Returns the photo that a file contains. It keeps the file open.
heif_photo primary_image(const image_file& file) {
    load_decoders();
    const heif_file context(heif_context_alloc());
    if (!context) throw std::bad_alloc();
    heif_context_set_maximum_image_size_limit(context.get(), static_cast<int>(largest_side));
    heif_context_set_max_decoding_threads(context.get(), 0);  // images are decoded in parallel already
    check(file, heif_context_read_from_file(context.get(), file.path().c_str(), nullptr));
    heif_image_handle* photo = nullptr;
    check(file, heif_context_get_primary_image_handle(context.get(), &photo));
    heif_photo owned(photo);
    limit_coded_size(file, context.get(), photo);
    return owned;
}

// After the rotation and mirroring that the file itself specifies, which decoding applies. EXIF data
// repeats them, so this codec reads no orientation.
image_size read_heif_size(const image_file& file) {
    const heif_photo photo = primary_image(file);
    return {side(heif_image_handle_get_width(photo.get())), side(heif_image_handle_get_height(photo.get()))};
}

heif_pixels decode(const image_file& file, const heif_photo& photo) {
    const heif_options options(heif_decoding_options_alloc());
    if (!options) throw std::bad_alloc();
    options->convert_hdr_to_8bit = 1;
    options->strict_decoding = 1;
    heif_image* decoded = nullptr;
    check(file, heif_decode_image(photo.get(), &decoded, heif_colorspace_RGB, heif_chroma_interleaved_RGBA,
                                  options.get()));
    heif_pixels pixels(decoded);
    heif_error warning;
    if (heif_image_get_decoding_warnings(decoded, 0, &warning, 1) > 0) check(file, warning);
    return pixels;
}

/// Colors that are premultiplied already may exceed alpha, because lossy coding changes both.
void accept_premultiplied(image& pixels) {
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
        const std::uint8_t alpha = pixels.rgba[i + 3];
        pixels.has_alpha |= alpha != 255;
        for (std::size_t channel = i; channel < i + 3; ++channel)
            pixels.rgba[channel] = std::min(pixels.rgba[channel], alpha);
    }
}

void read_heif(const image_file& file, image& pixels) {
    const heif_photo photo = primary_image(file);
    const heif_pixels decoded = decode(file, photo);
    file.check_decoded_size({side(heif_image_get_width(decoded.get(), heif_channel_interleaved)),
                             side(heif_image_get_height(decoded.get(), heif_channel_interleaved))},
                            size_of(pixels));
    int stride = 0;
    const std::uint8_t* rows =
        heif_image_get_plane_readonly(decoded.get(), heif_channel_interleaved, &stride);
    const std::size_t row_bytes = std::size_t{4} * static_cast<std::size_t>(pixels.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(pixels.height); ++y)
        std::copy_n(rows + y * static_cast<std::size_t>(stride), row_bytes, &pixels.rgba[y * row_bytes]);
    if (heif_image_handle_is_premultiplied_alpha(photo.get()))
        accept_premultiplied(pixels);
    else
        premultiply(pixels);
}

constexpr std::string_view heif_endings[] = {".heic", ".heif", ".avif"};

}  // namespace

extern constinit const image_codec heif_codec{"HEIF (HEIC, AVIF)", heif_endings, is_heif,
                                              read_heif_size,      nullptr,      read_heif};

}  // namespace gs
