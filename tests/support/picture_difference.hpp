// How far two pictures of one size and number of channels are apart.
#pragma once

#include <cstdlib>

#include "engine/core/image.hpp"

namespace neritic::test {

// Mean of the absolute differences, of 255.
inline double mean_difference(const ImageU8& a, const ImageU8& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.data.size(); ++i) sum += std::abs(int(a.data[i]) - int(b.data[i]));
  return sum / static_cast<double>(a.data.size());
}

}  // namespace neritic::test
