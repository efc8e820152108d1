#include "testbed/motion/trails.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

constexpr double kRate_hz = 40.0;
// Steps are sums of rounded times.
constexpr double kSlack = 1e-6;

std::int64_t slot_of(double time_s) {
  return static_cast<std::int64_t>(std::floor(time_s * kRate_hz + kSlack));
}

}  // namespace

Trails::Trails(std::vector<FollowedPoint> points)
    : points_(std::move(points)), places_(points_.size()) {}

bool Trails::due(double time_s) const {
  return !points_.empty() && (!newest_ || slot_of(time_s) > *newest_);
}

void Trails::add(const scene::SimulatedMotion& moved, double time_s, const Wash& wash) {
  newest_ = slot_of(time_s);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    auto& places = places_[i];
    const Vec3 at = points_[i].thing.at(time_s, &moved).motion.pose.position_m;
    const auto& bed_depth_m = points_[i].bed_depth_m;
    places.push_back({time_s, {at, bed_depth_m ? wash(Vec3(at.x, -*bed_depth_m, at.z)) : 0.0}});
    while (places.size() > 2 && places[1].time_s < time_s - points_[i].kept_s) places.pop_front();
  }
}

void Trails::clear() {
  for (auto& places : places_) places.clear();
  newest_.reset();
}

std::optional<scene::FollowedPlace> Trails::at(std::size_t object, int joint,
                                               const Vec3& position_m, double time_s) const {
  const auto point = std::ranges::find_if(points_, [&](const FollowedPoint& p) {
    return p.object == object && p.joint == joint && p.position_m == position_m;
  });
  if (point == points_.end()) return std::nullopt;
  const auto& places = places_[static_cast<std::size_t>(point - points_.begin())];
  if (places.empty() || !(time_s < places.back().time_s)) return std::nullopt;
  const auto after = std::ranges::upper_bound(places, time_s, {}, &Place::time_s);
  if (after == places.begin()) return after->place;
  const Place& before = *(after - 1);
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  return scene::FollowedPlace{glm::mix(before.place.position_m, after->place.position_m, share),
                              glm::mix(before.place.wash_m_s, after->place.wash_m_s, share)};
}

}  // namespace neritic::testbed
