#include "testbed/simulation/gaze_targets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace neritic::testbed {
namespace {

// If the sight passes two, the nearer to it counts alone if it is nearer by this.
constexpr double kTold_rad = radians(1.0);
// A thing may be solid itself: what is as near as its box hides nothing.
constexpr double kOwnSurface_m = 0.05;

struct Passing {
  double off_rad = 0.0, distance_m = 0.0;
  Vec3 place_m{0.0};  // of the box, nearest to the sight
};

// Nothing: the eyes are within.
std::optional<Passing> passing(const scene::Bounds& box, const Vec3& eyes_m, const Vec3& gaze) {
  if (glm::all(glm::greaterThan(eyes_m, box.min)) && glm::all(glm::lessThan(eyes_m, box.max)))
    return std::nullopt;
  // Whether the sight enters the box, by its three slabs.
  double enters_m = 0.0, leaves_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double a = (box.min[i] - eyes_m[i]) / gaze[i], b = (box.max[i] - eyes_m[i]) / gaze[i];
    if (gaze[i] == 0.0) {
      if (eyes_m[i] < box.min[i] || eyes_m[i] > box.max[i]) leaves_m = -1.0;
      continue;
    }
    enters_m = std::max(enters_m, std::min(a, b));
    leaves_m = std::min(leaves_m, std::max(a, b));
  }
  if (enters_m <= leaves_m) return Passing{0.0, enters_m, eyes_m + enters_m * gaze};
  // Else by turns the nearest of the box to a point of the sight, and of the sight to that: both
  // are convex, so that this ends at the nearest of both.
  Vec3 place = 0.5 * (box.min + box.max);
  for (int turn = 0; turn < 64; ++turn) {
    const double along_m = std::max(glm::dot(place - eyes_m, gaze), 0.0);
    const Vec3 next = glm::clamp(eyes_m + along_m * gaze, box.min, box.max);
    const bool still = glm::distance(next, place) < 1e-6;
    place = next;
    if (still) break;
  }
  const Vec3 way = place - eyes_m;
  return Passing{std::atan2(glm::length(glm::cross(way, gaze)), glm::dot(way, gaze)),
                 glm::length(way), place};
}

bool is_bed(const scene::Scene& scene, const scene::Object& object) {
  const auto found = scene.class_names.find(object.class_id);
  return found != scene.class_names.end() && found->second == "seabed";
}

}  // namespace

GazeTargets::GazeTargets(const scene::Scene& scene, const Movers& movers) : movers_(&movers) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const scene::Object& object = scene.objects[i];
    if (object.model < 0 || object.instance_count() != 1 || is_bed(scene, object)) continue;
    const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
    const scene::Bounds model_box =
        scene::model_bounds(model, scene::evaluate_pose(model, object.clip, object.clip_offset_s));
    if (model_box.empty()) continue;
    scene::Bounds box;
    box.add(object.scale * model_box.min);
    box.add(object.scale * model_box.max);
    std::vector<std::size_t> carriers;
    for (int by = object.mount.object; by >= 0;
         by = scene.objects[static_cast<std::size_t>(by)].mount.object)
      carriers.push_back(static_cast<std::size_t>(by));
    targets_.push_back(
        {i, std::move(carriers), scene::CarriedThing(scene, {.object = static_cast<int>(i)}), box});
  }
}

GazeTargets::Seen GazeTargets::look(const PhysicsState& state, const sim::StaticWorld& solid,
                                    std::size_t diver, const Vec3& eyes_m, const Vec3& gaze,
                                    double time_s) const {
  struct Candidate {
    std::uint64_t object = 0;
    Passing passing{kPi, 0.0};
  };
  Candidate first, second;
  const StateMotion moved(*movers_, state);
  for (const Target& target : targets_) {
    if (target.object == diver ||
        std::ranges::find(target.carriers, diver) != target.carriers.end())
      continue;
    const Pose pose = target.thing.at(time_s, &moved).motion.pose;
    const Quat back = glm::conjugate(pose.rotation);
    const auto found = passing(target.bounds, back * (eyes_m - pose.position_m), back * gaze);
    if (!found) continue;
    const Candidate candidate{target.object + 1, *found};
    // First that which the sight meets soonest; else that which it passes at the smallest angle.
    const auto before = [](const Candidate& a, const Candidate& b) {
      return a.passing.off_rad != b.passing.off_rad ? a.passing.off_rad < b.passing.off_rad
                                                    : a.passing.distance_m < b.passing.distance_m;
    };
    if (!before(candidate, second)) continue;
    const Vec3 way = pose * found->place_m - eyes_m;
    const double far_m = glm::length(way);
    if (far_m > kOwnSurface_m)
      if (const auto hit = solid.cast(eyes_m, way / far_m, far_m);
          hit && hit->distance_m < far_m - kOwnSurface_m)
        continue;
    if (before(candidate, first)) {
      second = first;
      first = candidate;
    } else {
      second = candidate;
    }
  }
  Seen out{0, first.passing.off_rad, first.passing.distance_m, false};
  if (first.object == 0 || first.passing.off_rad > kWithin_rad) return out;
  out.object = first.object;
  out.doubtful = second.object != 0 && first.passing.off_rad > 0.0 &&
                 second.passing.off_rad - first.passing.off_rad < kTold_rad;
  return out;
}

}  // namespace neritic::testbed
