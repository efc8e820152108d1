#include "rov/bounds.hpp"

#include "engine/core/refusal.hpp"

namespace neritic::rov {

Status check_bounds(const char* table, std::span<const Bound> bounds) {
  for (const Bound& b : bounds)
    if (!(b.value >= b.least && b.value <= b.most))
      return refusal(fmt::format("{}.{}", table, b.name), fmt::format("{}", b.value),
                     fmt::format("[{}, {}]", b.least, b.most));
  return {};
}

}  // namespace neritic::rov
