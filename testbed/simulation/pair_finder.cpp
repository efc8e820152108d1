// The sweep (pair_finder.hpp).
#include "testbed/simulation/pair_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace neritic::testbed {
namespace {

// More than what rounding takes off distances 40 000 km from the origin.
constexpr double kSlack_m = 1e-6;
// Vehicles packed without gaps have about 15 neighbours each within reach.
constexpr std::size_t kPairsABody = 32;

// The axis along which the centres spread widest: fewest spheres overlap there.
int widest_axis(const std::vector<PairSphere>& spheres) {
  Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const PairSphere& sphere : spheres) {
    low = glm::min(low, sphere.centre_m);
    high = glm::max(high, sphere.centre_m);
  }
  const Vec3 spread_m = high - low;
  if (spread_m.x >= spread_m.y && spread_m.x >= spread_m.z) return 0;
  return spread_m.y >= spread_m.z ? 1 : 2;
}

}  // namespace

MeetingPair PairFinder::pair_of(std::size_t a, std::size_t b) const {
  const auto low = static_cast<std::uint32_t>(std::min(a, b)),
             high = static_cast<std::uint32_t>(std::max(a, b));
  return low < vehicles_ && high >= vehicles_ ? MeetingPair{high, low} : MeetingPair{low, high};
}

bool PairFinder::near(std::size_t a, std::size_t b) const {
  const Vec3 apart_m = spheres_[b].centre_m - spheres_[a].centre_m;
  const double reach_m = spheres_[a].reach_m + spheres_[b].reach_m + kSlack_m;
  return glm::dot(apart_m, apart_m) <= reach_m * reach_m;
}

void PairFinder::begin(std::size_t vehicles, std::size_t bodies) {
  vehicles_ = vehicles;
  taken_ = 0;
  pairs_.clear();
  if (order_.size() == bodies) return;
  spheres_.resize(bodies);
  order_.resize(bodies);
  std::iota(order_.begin(), order_.end(), 0u);
  // Room for a dense crowd: only a step with more pairs than any before it allocates.
  pairs_.reserve(std::min(kPairsABody * bodies, bodies * (bodies - 1) / 2));
}

void PairFinder::set(std::size_t body, const PairSphere& sphere) {
  spheres_[body].centre_m = sphere.centre_m;
  spheres_[body].reach_m =
      std::isfinite(sphere.reach_m) ? sphere.reach_m : std::numeric_limits<double>::infinity();
}

void PairFinder::find() {
  const int axis = widest_axis(spheres_);
  const auto begin_m = [&](std::uint32_t i) {
    return spheres_[i].centre_m[axis] - spheres_[i].reach_m;
  };
  std::ranges::sort(order_, {}, begin_m);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const PairSphere& sphere = spheres_[order_[i]];
    const double end_m = sphere.centre_m[axis] + sphere.reach_m + kSlack_m;
    for (std::size_t j = i + 1; j < order_.size() && begin_m(order_[j]) <= end_m; ++j)
      if (near(order_[i], order_[j])) pairs_.push_back(pair_of(order_[i], order_[j]));
  }
  std::ranges::sort(pairs_);
}

std::optional<MeetingPair> PairFinder::next() {
  if (taken_ == pairs_.size()) return std::nullopt;
  return pairs_[taken_++];
}

void PairFinder::set_reach(std::size_t body, double reach_m) {
  const double before_m = spheres_[body].reach_m;
  set(body, {spheres_[body].centre_m, reach_m});
  if (!(spheres_[body].reach_m > before_m)) return;
  const MeetingPair now = pairs_[taken_ - 1];
  for (std::size_t other = 0; other < spheres_.size(); ++other) {
    if (other == body || !near(body, other)) continue;
    const MeetingPair pair = pair_of(body, other);
    // Earlier ones were solved, or were passed by before the body reached so far.
    if (pair <= now) continue;
    const auto at =
        std::lower_bound(pairs_.begin() + static_cast<std::ptrdiff_t>(taken_), pairs_.end(), pair);
    if (at == pairs_.end() || *at != pair) pairs_.insert(at, pair);
  }
}

}  // namespace neritic::testbed
