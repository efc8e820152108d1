#include "engine/render/halved.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::render {

ImageU8 halved(const ImageU8& image, bool srgb) {
  ImageU8 out(std::max(image.width / 2, 1u), std::max(image.height / 2, 1u), image.channels);
  for (std::uint32_t y = 0; y < out.height; ++y)
    for (std::uint32_t x = 0; x < out.width; ++x)
      for (std::uint32_t c = 0; c < image.channels; ++c) {
        const bool squares = srgb && c < 3;
        double sum = 0.0;
        for (const std::uint32_t i : {0u, 1u})
          for (const std::uint32_t j : {0u, 1u}) {
            const double value = image.at(std::min(2 * x + i, image.width - 1),
                                          std::min(2 * y + j, image.height - 1), c);
            sum += squares ? value * value : value;
          }
        const double mean = squares ? std::sqrt(sum / 4.0) : sum / 4.0;
        out.at(x, y, c) = static_cast<std::uint8_t>(mean + 0.5);
      }
  return out;
}

}  // namespace neritic::render
