// One image as the content of a PNG or JPEG file.
#include <spng.h>
#include <turbojpeg.h>
#include <zlib.h>

#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "io/video_format.h"

namespace aspic {
namespace {

/// As near to the image as the encoder before this one was at 92.
constexpr int jpeg_quality = 93;

/// For C's ways to give something back.
template <auto Release>
struct Releaser {
  template <class T>
  void operator()(T* item) const {
    Release(item);
  }
};

Error encode_error(std::string_view format, const ImageSize& size, const char* reason) {
  return fail(ErrorCode::io,
              "Cannot encode an image of {} x {} pixels as {} ({}): there may not be enough memory. Choose a "
              "smaller image.",
              size.width, size.height, format, reason);
}

/// Differences to the left neighbor are mostly runs of zeros: to encode runs alone takes a fifth of the time
/// of a search for repeats, and the files of drawn images are as small.
Result<std::string> png(const ImageSize& size, std::span<const std::byte> pixels, spng_color_type type) {
  const std::unique_ptr<spng_ctx, Releaser<spng_ctx_free>> context(spng_ctx_new(SPNG_CTX_ENCODER));
  if (!context) return encode_error("PNG", size, "no encoder");
  spng_ihdr header = {};
  header.width = static_cast<std::uint32_t>(size.width);
  header.height = static_cast<std::uint32_t>(size.height);
  header.bit_depth = 8;
  header.color_type = static_cast<std::uint8_t>(type);
  int failed = spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  if (failed == 0) failed = spng_set_option(context.get(), SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_SUB);
  if (failed == 0) failed = spng_set_option(context.get(), SPNG_IMG_COMPRESSION_STRATEGY, Z_RLE);
  if (failed == 0) failed = spng_set_ihdr(context.get(), &header);
  if (failed == 0)
    failed =
        spng_encode_image(context.get(), pixels.data(), pixels.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  std::size_t bytes = 0;
  const std::unique_ptr<void, Releaser<std::free>> file(
      failed == 0 ? spng_get_png_buffer(context.get(), &bytes, &failed) : nullptr);
  if (!file) return encode_error("PNG", size, spng_strerror(failed));
  return std::string(static_cast<const char*>(file.get()), bytes);
}

[[maybe_unused]] std::size_t pixels_of(const ImageSize& size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

}  // namespace

Result<std::string> encode_png(const ImageSize& size, std::span<const std::byte> rgb) {
  assert(rgb.size() == 3 * pixels_of(size));
  return png(size, rgb, SPNG_COLOR_TYPE_TRUECOLOR);
}

Result<std::string> encode_clear_png(const ImageSize& size, std::span<const std::byte> rgba) {
  assert(rgba.size() == 4 * pixels_of(size));
  return png(size, rgba, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA);
}

Result<std::string> encode_jpeg(const ImageSize& size, std::span<const std::byte> rgb) {
  assert(rgb.size() == 3 * pixels_of(size));
  const std::unique_ptr<void, Releaser<tjDestroy>> encoder(tjInitCompress());
  if (!encoder) return encode_error("JPEG", size, tjGetErrorStr2(nullptr));
  unsigned char* content = nullptr;
  unsigned long bytes = 0;
  const int failed =
      tjCompress2(encoder.get(), reinterpret_cast<const unsigned char*>(rgb.data()), size.width, 0,
                  size.height, TJPF_RGB, &content, &bytes, TJSAMP_444, jpeg_quality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, Releaser<tjFree>> file(content);
  if (failed != 0) return encode_error("JPEG", size, tjGetErrorStr2(encoder.get()));
  return std::string(reinterpret_cast<const char*>(content), bytes);
}

}  // namespace aspic
