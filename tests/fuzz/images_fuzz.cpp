// Any bytes as a PNG, JPEG, WebP, OpenEXR or Netpbm picture: an Error in one line, or a picture of
// its own size. The checksums of PNG chunks are mended first, or no change would get past them.
#include <zlib.h>

#include <vector>

#include "engine/core/check.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/image_file_png.hpp"
#include "engine/scene/netpbm_file.hpp"
#include "tests/fuzz/replay.hpp"

namespace {
using namespace neritic;

constexpr std::uint64_t kMaxPixels = 1 << 20;

template <class T>
void check_picture(const Raster<T>& image, std::uint32_t channels) {
  NERITIC_CHECK(!image.empty() && (channels == 0 || image.channels == channels) &&
                    image.data.size() == std::size_t{image.width} * image.height * image.channels,
                "{} x {} x {}: {} values", image.width, image.height, image.channels,
                image.data.size());
}
void check_error(const Error& error) {
  NERITIC_CHECK(
      error.message.starts_with("fuzz.png: ") && error.message.find('\n') == error.message.npos,
      "{}", error.message);
}

std::vector<std::uint8_t> with_checksums(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> bytes(data, data + size);
  if (!scene::is_png(fuzz::as_bytes(data, size))) return bytes;
  for (std::size_t at = 8; at + 12 <= size;) {
    const std::size_t length =
        std::size_t{bytes[at]} << 24 | bytes[at + 1] << 16 | bytes[at + 2] << 8 | bytes[at + 3];
    if (length > size - at - 12) break;
    const auto sum = crc32(0, &bytes[at + 4], static_cast<uInt>(length + 4));
    for (int i = 0; i < 4; ++i)
      bytes[at + 8 + length + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    at += 12 + length;
  }
  return bytes;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A few bytes of WebP make 16383 x 16383 pixels, which take seconds.
  const scene::PictureSize stated = scene::peek_size(fuzz::as_bytes(data, size));
  if (std::uint64_t{stated.width} * stated.height > kMaxPixels) return 0;
  const std::vector<std::uint8_t> mended = with_checksums(data, size);
  const auto bytes = fuzz::as_bytes(mended.data(), mended.size());
  if (const auto image = scene::decode_image8(bytes, "fuzz.png", 4); image.ok())
    check_picture(*image, 4);
  else
    check_error(image.error());
  if (const auto numbers = scene::decode_png_numbers(bytes, "fuzz.png"); numbers.ok())
    check_picture(numbers->image, 0);
  else
    check_error(numbers.error());
  if (const auto image = scene::decode_image16(bytes, "fuzz.png"); image.ok())
    check_picture(*image, 0);
  else
    check_error(image.error());
  if (const auto map = scene::parse_netpbm(bytes, "fuzz.png"); map.ok())
    NERITIC_CHECK(map->values.size() == std::size_t{map->width} * map->height * map->channels,
                  "{} x {}: {} values", map->width, map->height, map->values.size());
  else
    check_error(map.error());
  if (const auto exr = scene::decode_exr(bytes, "fuzz.png"); exr.ok()) {
    check_picture(exr->image, 0);
    NERITIC_CHECK(exr->names.size() == exr->image.channels, "{} names", exr->names.size());
  } else {
    check_error(exr.error());
  }
  return 0;
}
