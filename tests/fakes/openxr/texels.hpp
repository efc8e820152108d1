// Pictures in linear light for the compositor: decoded from what swapchains hold, sampled, written.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace neritic::fakes {

struct Texels {
  std::uint32_t width = 0, height = 0;
  std::vector<glm::vec4> data;  // rows from the top, linear light; depth in x

  // Bilinear, at x and y in texels from the upper left corner; the edge goes on outside.
  glm::vec4 at(double x, double y) const;
};

// The stored bytes of one layer of an image. sRGB formats are decoded; all others are linear, as
// the specification says of their values.
Texels decode(const std::vector<std::uint8_t>& bytes, std::int64_t format, std::uint32_t width,
              std::uint32_t height);

// 8 bits a channel in sRGB, without alpha. False: the file could not be written.
bool write_png(const std::string& path, const Texels& picture);
// The x channel as float32 [height, width].
bool write_npy(const std::string& path, const Texels& picture);

}  // namespace neritic::fakes
