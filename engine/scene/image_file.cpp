// Reading pictures: which decoder for which file. See image_file.hpp. The decoders are libpng,
// libwebp and libjpeg-turbo, since stb_image 2.27 did not survive fuzzing (image_file_jpeg.hpp);
// OpenEXR is in image_file_exr.cpp, writing in image_file_write.cpp.
#include "engine/scene/image_file.hpp"

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/image_file_jpeg.hpp"
#include "engine/scene/image_file_png.hpp"
#include "engine/scene/image_file_webp.hpp"

namespace neritic::scene {

Result<ImageU8> decode_image8(std::span<const std::byte> bytes, const std::string& name,
                              std::uint32_t channels) {
  if (is_png(bytes)) return decode_png8(bytes, name, channels);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, name, channels);
  if (is_webp(bytes)) return decode_webp(bytes, name, channels);
  return refusal(name, fmt::format("{} bytes of another kind", bytes.size()),
                 "a PNG, JPEG or WebP picture");
}

PictureSize peek_size(std::span<const std::byte> bytes) {
  if (is_png(bytes)) return png_size(bytes);
  if (is_jpeg(bytes)) return jpeg_size(bytes);
  if (is_webp(bytes)) return webp_size(bytes);
  return {};
}

Result<ImageU8> read_image8(const std::filesystem::path& path, std::uint32_t channels) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return decode_image8(bytes, path.string(), channels);
}

Result<PngNumbers> read_png_numbers(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return decode_png_numbers(bytes, path.string());
}

Result<ImageU16> decode_image16(std::span<const std::byte> bytes, const std::string& name) {
  return decode_png16(bytes, name);
}

Result<ImageU16> read_image16(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  return decode_png16(bytes, path.string());
}

bool is_png16(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  return bytes.ok() && is_png(*bytes) && png_bits(*bytes) == 16;
}

}  // namespace neritic::scene
