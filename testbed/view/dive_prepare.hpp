// What a view draws unseen before its display's first frame, and what it tells about that. Pure
// functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/xr/display.hpp"
#include "testbed/view/quality_governor.hpp"

namespace neritic::testbed {

// One picture of all groups of views.
struct UnseenPicture {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes;  // by group: width, height, pixels
  std::uint32_t light = 0;
  friend bool operator==(const UnseenPicture&, const UnseenPicture&) = default;
};
// As few and as small as make the pipelines of views of these groups at any of the rungs.
std::vector<UnseenPicture> unseen_pictures(std::span<const xr::ViewGroup> groups,
                                           std::span<const Quality> rungs);

struct PrepareTimes {
  double took_s = 0.0;
  double made_s = 0.0;      // of that, in the driver's calls that make pipelines
  double again_s = 0.0;     // the same pictures once more
  bool cache_grew = false;  // the driver's, so that those calls compiled
};
// A line for the user where the pictures took long, most of it to compile shaders; else empty.
std::string prepare_note(const PrepareTimes& times);
// Those that took no longer have no line.
inline constexpr double kWorthALine_s = 10.0;

}  // namespace neritic::testbed
