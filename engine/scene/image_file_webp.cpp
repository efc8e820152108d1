// See image_file_webp.hpp.
#include "engine/scene/image_file_webp.hpp"

#include <webp/decode.h>

#include <cstring>

#include "engine/core/refusal.hpp"
#include "engine/scene/image_file_limits.hpp"

namespace neritic::scene {
namespace {

const std::uint8_t* data_of(std::span<const std::byte> bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

bool read_features(std::span<const std::byte> bytes, WebPBitstreamFeatures& out) {
  return WebPGetFeatures(data_of(bytes), bytes.size(), &out) == VP8_STATUS_OK && out.width > 0 &&
         out.height > 0;
}

// ITU-R BT.601: luma is 0.299 R + 0.587 G + 0.114 B.
ImageU8 luma_of(const ImageU8& rgb) {
  ImageU8 out(rgb.width, rgb.height, 1);
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const std::uint8_t* p = &rgb.data[3 * i];
    out.data[i] = static_cast<std::uint8_t>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
  }
  return out;
}

}  // namespace

bool is_webp(std::span<const std::byte> bytes) {
  return bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 &&
         std::memcmp(bytes.data() + 8, "WEBP", 4) == 0;
}

PictureSize webp_size(std::span<const std::byte> bytes) {
  WebPBitstreamFeatures features{};
  if (!read_features(bytes, features)) return {};
  return {static_cast<std::uint32_t>(features.width), static_cast<std::uint32_t>(features.height)};
}

Result<ImageU8> decode_webp(std::span<const std::byte> bytes, const std::string& name,
                            std::uint32_t channels) {
  const auto broken = [&] {
    return refusal(name, fmt::format("a broken WebP of {} bytes", bytes.size()), "a whole picture");
  };
  WebPBitstreamFeatures features{};
  if (!read_features(bytes, features)) return broken();
  if (features.has_animation) return refusal(name, "an animated WebP", "a still picture");
  const auto [width, height] = webp_size(bytes);  // at most 16383 a side: within the limits
  note_if_heavy(name, width, height);
  if (channels == 0) channels = features.has_alpha ? 4 : 3;
  ImageU8 image(width, height, channels == 4 ? 4 : 3);
  const auto decode = channels == 4 ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  const int stride = static_cast<int>(width * image.channels);
  if (!decode(data_of(bytes), bytes.size(), image.data.data(), image.data.size(), stride))
    return broken();
  return channels == 1 ? luma_of(image) : image;
}

}  // namespace neritic::scene
