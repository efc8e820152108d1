#include "testbed/sensors/sight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/animation.hpp"

namespace neritic::testbed {
namespace {

constexpr double kMostOfAPicture = 0.9;

struct Span {
  double min_m = std::numeric_limits<double>::infinity(), max_m = 0.0;
  std::size_t pixels = 0;
  void add(double range_m) {
    min_m = std::min(min_m, range_m);
    max_m = std::max(max_m, range_m);
    ++pixels;
  }
};

// The pixels that see something, by its owner and by range.
struct Seen {
  Span own, above, nearer, within, farther;  // others': out of the water, or by the limits
  std::size_t pixels = 0;                    // within the aperture
};

int root_of(const scene::Scene& scene, int object) {
  while (object >= 0 && scene.objects[object].mount.object >= 0)
    object = scene.objects[object].mount.object;
  return object;
}

// By instance: whether it is the carrier or moves with it.
std::vector<bool> own_instances(const scene::Scene& scene, int carrier) {
  std::vector<bool> own(std::numeric_limits<std::uint16_t>::max() + std::size_t{1});
  const int root = root_of(scene, carrier);
  for (std::size_t i = 0; i < scene.objects.size() && root >= 0; ++i) {
    const scene::Object& object = scene.objects[i];
    if (root_of(scene, static_cast<int>(i)) != root) continue;
    for (std::size_t copy = 0; copy < object.instance_count(); ++copy)
      own[std::min(object.instance + copy, own.size() - 1)] = true;
  }
  return own;
}

// Calls see(point in view axes, instance, whether anything is there) for each pixel.
template <class See>
void each_pixel(const ViewImages& view, See see) {
  const Intrinsics& k = view.intrinsics;
  for (std::uint32_t v = 0; v < view.height; ++v)
    for (std::uint32_t u = 0; u < view.width; ++u) {
      const std::size_t at = std::size_t{v} * view.width + u;
      const bool hit = std::isfinite(view.depth.data[at]);
      const double z = hit ? view.depth.data[at] : 1.0;
      see(z * Vec3((u + 0.5 - k.cx) / k.fx, (k.cy - v - 0.5) / k.fy, -1.0), view.instances.data[at],
          hit);
    }
}

// Counts the surfaces that a sonar's beams meet.
void look(const scene::Sonar& sonar, const SonarFrame& head, const std::vector<bool>& own,
          bool in_water, Seen& seen) {
  const sonar::Limits& l = head.grid.limits;
  for (const ViewImages& sector : head.sectors) {
    const Quat head_from_view =
        glm::conjugate(head.world_from_head.rotation) * sector.world_from_view.rotation;
    each_pixel(sector, [&](const Vec3& point, std::uint16_t instance, bool hit) {
      const Vec3 p = head_from_view * point;
      const double range_m = glm::length(p), azimuth = std::atan2(p.x, -p.z),
                   elevation = std::asin(p.y / range_m);
      if (azimuth < l.azimuth_min_rad || azimuth > l.azimuth_max_rad ||
          elevation < l.elevation_min_rad || elevation > l.elevation_max_rad)
        return;
      ++seen.pixels;
      if (!hit) return;
      const double y_m = (head.world_from_head.rotation * p).y + head.world_from_head.position_m.y;
      Span& of = in_water && y_m > 0.0         ? seen.above
                 : own[instance]               ? seen.own
                 : range_m < sonar.range_min_m ? seen.nearer
                 : range_m < sonar.range_max_m ? seen.within
                                               : seen.farther;
      of.add(range_m);
    });
  }
}

scene::Bounds rest_bounds(const scene::Model& model) {
  return scene::model_bounds(model, scene::evaluate_pose(model, -1, 0.0));
}

// The first place outside the carrier's bounds along the sensor's axis, in the carrier's frame.
std::optional<Vec3> way_out(const scene::Scene& scene, const scene::Mount& mount) {
  constexpr double kClear_m = 0.02;
  const scene::Object& carrier = scene.objects[mount.object];
  if (carrier.model < 0) return {};
  const scene::Bounds bounds = rest_bounds(*scene.models[carrier.model]);
  if (bounds.empty()) return {};
  const Vec3 at = mount.pose.position_m, ahead = mount.pose.rotation * Vec3(0, 0, -1);
  const Vec3 low = bounds.min * carrier.scale, high = bounds.max * carrier.scale;
  double along_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (at[i] < low[i] || at[i] > high[i]) return {};
    if (std::abs(ahead[i]) < 1e-6) continue;
    along_m = std::min(along_m, ((ahead[i] > 0.0 ? high[i] : low[i]) - at[i]) / ahead[i]);
  }
  return at + (along_m + kClear_m) * ahead;
}

// own: of the pixels that see anything, seen.
std::string behind_carrier(const scene::Scene& scene, const std::string& name,
                           const scene::Mount& mount, const Span& own, std::size_t seen) {
  std::string line =
      fmt::format("{}: sees {} its own carrier {}", name,
                  own.pixels == seen ? "only" : "little but", scene.objects[mount.object].name);
  if (own.pixels < seen)
    line += fmt::format(" ({:.3g} %)",
                        100.0 * static_cast<double>(own.pixels) / static_cast<double>(seen));
  line += fmt::format(", {:.2f} to {:.2f} m away; ", own.min_m, own.max_m);
  if (const auto out = way_out(scene, mount))
    return line + fmt::format("position_m = [{:.2f}, {:.2f}, {:.2f}] is before its hull", out->x,
                              out->y, out->z);
  return line + "move position_m or turn it";
}

}  // namespace

std::optional<std::string> blindness(const scene::Scene& scene, const scene::Camera& camera,
                                     const CameraFrame& frame) {
  const std::vector<bool> own = own_instances(scene, camera.mount.object);
  Seen seen;
  bool anything = scene.water && (scene.water->scattering || scene.water->surface);
  for (const ViewImages& eye : frame.eyes)
    each_pixel(eye, [&](const Vec3& point, std::uint16_t instance, bool hit) {
      ++seen.pixels;
      anything = anything || hit;
      if (hit && own[instance]) seen.own.add(-point.z);
    });
  if (!anything)
    return fmt::format("camera {}: black, since no opaque surface is in its view: turn or move it",
                       camera.name);
  if (seen.own.pixels < kMostOfAPicture * seen.pixels || seen.own.pixels == 0) return {};
  return behind_carrier(scene, "camera " + camera.name, camera.mount, seen.own, seen.pixels);
}

std::optional<std::string> blindness(const scene::Scene& scene, const scene::Sonar& sonar,
                                     std::span<const SonarFrame> heads, bool hears) {
  const std::vector<bool> own = own_instances(scene, sonar.mount.object);
  Seen seen;
  const std::string name = "sonar " + sonar.name;
  const bool in_water = scene.water.has_value();
  if (const double y_m = heads.empty() ? 0.0 : heads.front().world_from_sonar.position_m.y;
      in_water && y_m > 0.0)
    return fmt::format(
        "{}: no return, since it is out of the water, at y = {:.4g} m: the surface is "
        "y = 0; lower it",
        name, y_m);
  for (const SonarFrame& head : heads) look(sonar, head, own, in_water, seen);
  if (seen.within.pixels > 0) return {};
  const bool others = seen.nearer.pixels > 0 || seen.farther.pixels > 0;
  if (seen.own.pixels > 0 && (!others || 2 * seen.own.pixels > seen.pixels))
    return behind_carrier(scene, name, sonar.mount, seen.own,
                          seen.own.pixels + seen.nearer.pixels + seen.farther.pixels);
  if (hears) return {};  // what is too small for these pixels, or has no class
  const std::string limits =
      fmt::format("range_m = [{:g}, {:g}]", sonar.range_min_m, sonar.range_max_m);
  if (seen.farther.pixels > 0)
    return fmt::format("{}: no return, since all in its beams is farther than {}: from {:.4g} m on",
                       name, limits, seen.farther.min_m);
  if (seen.nearer.pixels > 0)
    return fmt::format(
        "{}: no return, since all in its beams is nearer than {}: {:.2g} to {:.2g} m", name, limits,
        seen.nearer.min_m, seen.nearer.max_m);
  if (seen.above.pixels > 0)
    return fmt::format(
        "{}: no return, since all in its beams is out of the water, above y = 0: turn or move it",
        name);
  return fmt::format("{}: no return, since nothing is in its beams: turn or move it", name);
}

}  // namespace neritic::testbed
