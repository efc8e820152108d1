#include "tests/fakes/openxr/texels.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/gtc/packing.hpp>

#include "tests/fakes/openxr/vulkan.hpp"

namespace neritic::fakes {
namespace {

// IEC 61966-2-1.
float from_srgb(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}
float to_srgb(float v) {
  v = std::clamp(v, 0.0f, 1.0f);
  return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

template <class T>
T read(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

glm::vec4 rgba8(const std::uint8_t* from) {
  return glm::vec4(from[0], from[1], from[2], from[3]) / 255.0f;
}

glm::vec4 decode_one(const std::uint8_t* from, std::int64_t format) {
  glm::vec4 c(0);
  switch (format) {
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_SRGB:
      c = rgba8(from);
      for (int i = 0; i < 3; ++i) c[i] = from_srgb(c[i]);
      break;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_UNORM:
      c = rgba8(from);
      break;
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
      c = glm::unpackUnorm3x10_1x2(read<std::uint32_t>(from));
      break;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      c = glm::unpackHalf4x16(read<std::uint64_t>(from));
      break;
    case VK_FORMAT_R5G6B5_UNORM_PACK16:
      // Red in the upper bits; glm's lowest bits are its first channel.
      c = glm::vec4(glm::unpackUnorm1x5_1x6_1x5(read<std::uint16_t>(from)), 1);
      std::swap(c.x, c.z);
      break;
    case VK_FORMAT_D16_UNORM:
      c.x = read<std::uint16_t>(from) / 65535.0f;
      break;
    case VK_FORMAT_D24_UNORM_S8_UINT:
      c.x = static_cast<float>(read<std::uint32_t>(from) & 0xFFFFFFu) / 16777215.0f;
      break;
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      c.x = read<float>(from);
      break;
    default:
      break;
  }
  if (format == VK_FORMAT_B8G8R8A8_SRGB || format == VK_FORMAT_B8G8R8A8_UNORM) std::swap(c.x, c.z);
  return c;
}

}  // namespace

glm::vec4 Texels::at(double x, double y) const {
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
  const auto fx = static_cast<float>(x - 0.5 - left), fy = static_cast<float>(y - 0.5 - top);
  const auto one = [&](double column, double row) {
    const auto i = static_cast<std::size_t>(std::clamp(column, 0.0, width - 1.0));
    const auto j = static_cast<std::size_t>(std::clamp(row, 0.0, height - 1.0));
    return data[j * width + i];
  };
  return glm::mix(glm::mix(one(left, top), one(left + 1, top), fx),
                  glm::mix(one(left, top + 1), one(left + 1, top + 1), fx), fy);
}

Texels decode(const std::vector<std::uint8_t>& bytes, std::int64_t format, std::uint32_t width,
              std::uint32_t height) {
  Texels decoded{width, height, {}};
  const std::size_t step = texel_bytes(format);
  decoded.data.resize(std::size_t{width} * height);
  for (std::size_t i = 0; i < decoded.data.size(); ++i) {
    decoded.data[i] = decode_one(bytes.data() + i * step, format);
  }
  return decoded;
}

bool write_png(const std::string& path, const Texels& picture) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.data.size() * 3);
  for (const glm::vec4& texel : picture.data) {
    for (int i = 0; i < 3; ++i) {
      bytes.push_back(static_cast<std::uint8_t>(std::lround(to_srgb(texel[i]) * 255)));
    }
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = picture.width;
  image.height = picture.height;
  image.format = PNG_FORMAT_RGB;
  return png_image_write_to_file(&image, path.c_str(), 0, bytes.data(), 0, nullptr) != 0;
}

bool write_npy(const std::string& path, const Texels& picture) {
  std::string header =
      fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", picture.height,
                  picture.width);
  header.resize((header.size() + 11 + 63) / 64 * 64 - 11, ' ');  // with the first ten bytes, 64 n
  header += '\n';
  std::ofstream file(path, std::ios::binary);
  const auto length = static_cast<std::uint16_t>(header.size());
  file << "\x93NUMPY\x01" << '\0' << static_cast<char>(length & 255)
       << static_cast<char>(length >> 8) << header;
  for (const glm::vec4& texel : picture.data) {
    file.write(reinterpret_cast<const char*>(&texel.x), sizeof(float));
  }
  return file.good();
}

}  // namespace neritic::fakes
