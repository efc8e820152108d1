#include "testbed/output/datasets.hpp"

#include <algorithm>
#include <array>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::testbed {

bool Datasets::of_cameras() const {
  using enum Dataset;
  return std::ranges::any_of(std::array{kColor, kDepth, kNormals, kLabels, kInstances, kMotion,
                                        kCoco, kLinear, kRaw, kBoxes, kKitti, kPanoptic},
                             [&](Dataset one) { return has(one); });
}

bool Datasets::of_sonars() const {
  using enum Dataset;
  return std::ranges::any_of(std::array{kDepth, kNormals, kLabels, kInstances, kSonar},
                             [&](Dataset one) { return has(one); });
}

Result<Datasets> parse_datasets(std::string_view flag, std::span<const std::string> lists) {
  Datasets out;
  for (const std::string& list : lists)
    for (std::size_t at = 0; at <= list.size();) {
      const std::size_t comma = std::min(list.find(',', at), list.size());
      const std::string_view word = std::string_view(list).substr(at, comma - at);
      const auto* found = std::ranges::find(kDatasetNames, word);
      if (found == std::end(kDatasetNames))
        return refusal(flag, fmt::format("'{}'", printable(word)),
                       fmt::format("one or more of {}", join(kDatasetNames)));
      out.add(static_cast<Dataset>(found - std::begin(kDatasetNames)));
      at = comma + 1;
    }
  return out;
}

Capture capture_of(const Datasets& datasets) {
  using enum Dataset;
  const bool linear = datasets.has(kLinear) || datasets.has(kRaw);
  const bool boxes = datasets.has(kBoxes) || datasets.has(kKitti);
  const bool segments = datasets.has(kCoco) || datasets.has(kPanoptic);
  return {.color = linear || datasets.has(kColor),
          .depth = boxes || datasets.has(kDepth),
          .normals = datasets.has(kNormals),
          .labels = segments || datasets.has(kLabels),
          .instances = boxes || segments || datasets.has(kInstances),
          .motion = datasets.has(kMotion),
          .echoes = datasets.has(kSonar),
          .poses = datasets.has(kTrajectory),
          .linear = linear,
          .boxes = boxes};
}

}  // namespace neritic::testbed
