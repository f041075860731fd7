#include "io/image/jpeg.h"

#include <fmt/format.h>

#include <csetjmp>
#include <cstdio>
// libjpeg's headers rely on <cstdio> standing before them
#include <jpeglib.h>

#include <jerror.h>

#include <array>

#include "base/error.h"

namespace skybake::io {
namespace {

/// libjpeg with its errors turned into a jump: only functions without objects to destroy may stand between setjmp and
/// the library.
struct Decoder {
    jpeg_decompress_struct info{};
    jpeg_error_mgr errors{};
    std::jmp_buf jump{};
    std::array<char, JMSG_LENGTH_MAX> message{};
    bool is_cut_off = false;
    bool is_created = false;

    ~Decoder() {
        if (is_created) jpeg_destroy_decompress(&info);
    }
};

Decoder& decoder_of(j_common_ptr info) {
    return *static_cast<Decoder*>(info->client_data);
}

extern "C" void skybake_jpeg_fail(j_common_ptr info) {
    Decoder& decoder = decoder_of(info);
    info->err->format_message(info, decoder.message.data());
    std::longjmp(decoder.jump, 1);
}

/// Warnings go unheard but for those that mean missing picture: libjpeg fills what is missing with grey.
extern "C" void skybake_jpeg_message(j_common_ptr info, int level) {
    if (level >= 0) return;
    const int code = info->err->msg_code;
    if (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER) {
        Decoder& decoder = decoder_of(info);
        info->err->format_message(info, decoder.message.data());
        decoder.is_cut_off = true;
    }
}

extern "C" void skybake_jpeg_silence(j_common_ptr) {}

/// False, with Decoder::message set, when the header is broken.
bool read_header(Decoder& d, const std::uint8_t* bytes, unsigned long size) {
    if (setjmp(d.jump) != 0) return false;
    jpeg_create_decompress(&d.info);
    d.is_created = true;
    jpeg_mem_src(&d.info, bytes, size);
    jpeg_read_header(&d.info, TRUE);
    if (d.info.jpeg_color_space == JCS_CMYK || d.info.jpeg_color_space == JCS_YCCK) {
        d.info.out_color_space = JCS_CMYK;
    } else if (d.info.jpeg_color_space != JCS_GRAYSCALE) {
        d.info.out_color_space = JCS_RGB;
    }
    jpeg_calc_output_dimensions(&d.info);
    return true;
}

/// `rows` has room for all rows. False, with Decoder::message set, when the picture is broken.
bool read_rows(Decoder& d, std::uint8_t* rows) {
    if (setjmp(d.jump) != 0) return false;
    jpeg_start_decompress(&d.info);
    const std::size_t stride =
        static_cast<std::size_t>(d.info.output_width) * static_cast<std::size_t>(d.info.output_components);
    while (d.info.output_scanline < d.info.output_height) {
        JSAMPROW row = rows + stride * d.info.output_scanline;
        jpeg_read_scanlines(&d.info, &row, 1);
    }
    jpeg_finish_decompress(&d.info);
    return !d.is_cut_off;
}

/// Four inks to RGB. Adobe writes them inverted, as light that passes.
std::vector<std::uint8_t> rgb_from_cmyk(const std::vector<std::uint8_t>& cmyk, bool is_inverted) {
    std::vector<std::uint8_t> rgb(cmyk.size() / 4 * 3);
    const auto light = [&](std::uint8_t ink) { return is_inverted ? ink : 255 - ink; };
    for (std::size_t i = 0; i < cmyk.size() / 4; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            rgb[3 * i + c] = static_cast<std::uint8_t>((light(cmyk[4 * i + c]) * light(cmyk[4 * i + 3]) + 127) / 255);
        }
    }
    return rgb;
}

}  // namespace

Image8 decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
    Decoder decoder;
    decoder.info.client_data = &decoder;
    decoder.info.err = jpeg_std_error(&decoder.errors);
    decoder.errors.error_exit = skybake_jpeg_fail;
    decoder.errors.emit_message = skybake_jpeg_message;
    decoder.errors.output_message = skybake_jpeg_silence;
    const auto fail = [&] {
        throw InputError(fmt::format("{}: broken JPEG ({}). Save the picture anew.", name, decoder.message.data()));
    };

    if (!read_header(decoder, bytes.data(), bytes.size())) fail();
    check_pixel_count(name, decoder.info.output_width, decoder.info.output_height, max_pixels);
    Image8 image;
    image.width = static_cast<int>(decoder.info.output_width);
    image.height = static_cast<int>(decoder.info.output_height);
    image.channels = decoder.info.out_color_components;
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                        static_cast<std::size_t>(image.channels));
    if (!read_rows(decoder, image.pixels.data())) fail();
    if (image.channels == 4) {
        image.pixels = rgb_from_cmyk(image.pixels, decoder.info.saw_Adobe_marker != FALSE);
        image.channels = 3;
    }
    return image;
}

}  // namespace skybake::io
