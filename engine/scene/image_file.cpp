// Reading PNG and JPEG through stb_image, behind checks of the header. See image_file.hpp; OpenEXR
// is in image_file_exr.cpp, writing in image_file_write.cpp.
#include "engine/scene/image_file.hpp"

#include <algorithm>
#include <cstring>
#include <memory>

#include "engine/core/files.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_FAILURE_STRINGS  // they are built in a static buffer, which threads would share
#define STBI_MAX_DIMENSIONS 32768
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace neritic::scene {
namespace {

constexpr std::uint64_t kMaxSide = 32768, kMaxPixels = std::uint64_t{1} << 28;
// Largest ratio that deflate reaches (zlib technical details, J. Gailly, M. Adler: 1032:1).
constexpr std::uint64_t kMaxDeflateRatio = 1032;
// A JPEG block of 8 x 8 pixels needs at least a bit for its DC value, in one component.
constexpr std::uint64_t kMaxJpegPixelsPerByte = 8 * 64;

struct FreeStb {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

struct Header {
  int width = 0, height = 0, channels = 0;
  bool sixteen = false;
};

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
  return value;
}

constexpr std::byte kPngSignature[] = {std::byte{0x89}, std::byte{'P'},  std::byte{'N'},
                                       std::byte{'G'},  std::byte{'\r'}, std::byte{'\n'},
                                       std::byte{0x1a}, std::byte{'\n'}};

bool is_png(std::span<const std::byte> bytes) {
  return bytes.size() >= 33 &&
         std::equal(std::begin(kPngSignature), std::end(kPngSignature), bytes.begin());
}
bool is_jpeg(std::span<const std::byte> bytes) {
  return bytes.size() >= 4 && bytes[0] == std::byte{0xff} && bytes[1] == std::byte{0xd8};
}

// Bits a pixel as stored, from the IHDR chunk (PNG specification, section 11.2.2).
std::uint64_t png_bits_per_pixel(std::span<const std::byte> bytes) {
  const auto depth = std::to_integer<std::uint64_t>(bytes[24]);
  switch (std::to_integer<int>(bytes[25])) {
    case 2:
      return depth * 3;
    case 4:
      return depth * 2;
    case 6:
      return depth * 4;
    default:
      return depth;
  }
}

// Refuses what is no picture, too large, or forged: more pixels than its bytes can hold.
Result<Header> read_header(std::span<const std::byte> bytes, const std::string& name) {
  const bool png = is_png(bytes);
  if (!png && !is_jpeg(bytes))
    return bad_input("{}: no PNG or JPEG picture ({} bytes)", name, bytes.size());
  if (bytes.size() > kMaxFileBytes / 2)
    return bad_input("{}: {} bytes, at most {} are accepted", name, bytes.size(),
                     kMaxFileBytes / 2);
  Header header;
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  if (!stbi_info_from_memory(data, size, &header.width, &header.height, &header.channels)) {
    if (png && (big_endian(bytes, 16) > kMaxSide || big_endian(bytes, 20) > kMaxSide))
      return bad_input("{}: {} x {} pixels, at most {} x {} are accepted", name,
                       big_endian(bytes, 16), big_endian(bytes, 20), kMaxSide, kMaxSide);
    return bad_input("{}: a broken {} header", name, png ? "PNG" : "JPEG");
  }
  const std::uint64_t width = header.width, height = header.height, pixels = width * height;
  if (width == 0 || height == 0 || width > kMaxSide || height > kMaxSide || pixels > kMaxPixels)
    return bad_input("{}: {} x {} pixels, at most {} x {} and 2^28 in all are accepted", name,
                     width, height, kMaxSide, kMaxSide);
  const bool forged = png ? pixels * png_bits_per_pixel(bytes) / 8 > bytes.size() * kMaxDeflateRatio
                          : pixels > bytes.size() * kMaxJpegPixelsPerByte + 64 * 64;
  if (forged)
    return bad_input("{}: {} x {} pixels cannot come from {} bytes", name, width, height,
                     bytes.size());
  header.sixteen = png && stbi_is_16_bit_from_memory(data, size);
  return header;
}

template <class T, class Load>
Result<Raster<T>> decode(std::span<const std::byte> bytes, const std::string& name,
                         std::uint32_t channels, Load load) {
  int width = 0, height = 0, stored = 0;
  // stb decides the layout, so the caller's wish goes in unchanged.
  const std::unique_ptr<T, FreeStb> pixels(load(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                                static_cast<int>(bytes.size()), &width, &height,
                                                &stored, static_cast<int>(channels)));
  if (!pixels) return bad_input("{}: a broken or unfinished picture", name);
  Raster<T> image;
  image.width = static_cast<std::uint32_t>(width);
  image.height = static_cast<std::uint32_t>(height);
  image.channels = channels != 0 ? channels : static_cast<std::uint32_t>(stored);
  image.data.assign(pixels.get(),
                    pixels.get() + std::size_t{image.width} * image.height * image.channels);
  return image;
}

}  // namespace

Result<ImageU8> decode_image8(std::span<const std::byte> bytes, const std::string& name,
                              std::uint32_t channels) {
  NERITIC_TRY(const Header header, read_header(bytes, name));
  (void)header;
  return decode<std::uint8_t>(bytes, name, channels, stbi_load_from_memory);
}

Result<ImageU8> read_image8(const std::filesystem::path& path, std::uint32_t channels) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return decode_image8(bytes, path.string(), channels);
}

Result<ImageU16> decode_image16(std::span<const std::byte> bytes, const std::string& name) {
  NERITIC_TRY(const Header header, read_header(bytes, name));
  if (!header.sixteen)
    return bad_input("{}: 8 bits a channel found, a 16-bit PNG is accepted", name);
  return decode<std::uint16_t>(bytes, name, 0, stbi_load_16_from_memory);
}

Result<ImageU16> read_image16(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return decode_image16(bytes, path.string());
}

bool is_png16(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  return bytes.ok() && is_png(*bytes) && (*bytes)[24] == std::byte{16};
}

}  // namespace neritic::scene
