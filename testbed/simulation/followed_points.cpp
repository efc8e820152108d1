#include "testbed/simulation/followed_points.hpp"

#include <algorithm>

namespace neritic::testbed {
namespace {

// The slowest bubble rises faster than this, dragged up by its plume.
constexpr double kSlowestBubble_m_s = 0.1;
// Silt of an older puff has faded.
constexpr double kHangs = 2.0;
constexpr double kPause_s = 1.0;

bool moves(const scene::Scene& scene, const Movers& movers, int object) {
  for (; object >= 0; object = scene.objects[static_cast<std::size_t>(object)].mount.object)
    for (const auto* of_object :
         {&movers.vehicle_of_object, &movers.human_of_object, &movers.tracked_of_object})
      if ((*of_object)[static_cast<std::size_t>(object)] >= 0) return true;
  return false;
}

}  // namespace

std::vector<FollowedPoint> followed_points(const scene::Scene& scene, const Movers& movers) {
  std::vector<FollowedPoint> points;
  const auto follow = [&](const auto& source, double kept_s, std::optional<double> bed_depth_m) {
    if (!moves(scene, movers, source.object)) return;
    const scene::Mount mount{.object = source.object,
                             .pose = {source.position_m, Quat(1.0, 0.0, 0.0, 0.0)},
                             .joint = source.joint};
    points.push_back({static_cast<std::size_t>(source.object), source.joint, source.position_m,
                      kept_s, bed_depth_m, scene::CarriedThing(scene, mount)});
  };
  if (!scene.water) return points;
  for (const scene::BubbleSource& source : scene.water->bubbles)
    follow(source, source.height_m / kSlowestBubble_m_s + std::max(source.breath_s, kPause_s), {});
  for (const scene::SiltSource& source : scene.water->silt)
    follow(source, kHangs * source.hang_s + kPause_s, source.bed_depth_m);
  return points;
}

}  // namespace neritic::testbed
