// Pictures of other sensors that a view shows beside its own: the panels' inset, and on the HUD's
// console the vehicle's camera and a sonar's fan. Rendering thread.
#include <algorithm>

#include "testbed/view/dive_view.hpp"

namespace neritic::testbed {
namespace {

bool is_on_vehicle(const scene::Scene& scene, const PhysicsWorld& world,
                   const scene::Mount& mount) {
  const int carrier = carrier_of(scene, mount);
  return std::ranges::any_of(world.vehicles(), [&](const PhysicsVehicle& vehicle) {
    return static_cast<int>(vehicle.object) == carrier;
  });
}

// The first of the running sonars with a fan that a vehicle carries, else the first with a fan.
std::optional<std::size_t> vehicle_sonar(const scene::Scene& scene, const PhysicsWorld& world,
                                         const std::vector<std::size_t>& running) {
  std::optional<std::size_t> out;
  for (const std::size_t i : running) {
    const scene::Sonar& sonar = scene.sonars[i];
    if (sonar.kind != scene::SonarKind::kImaging && sonar.kind != scene::SonarKind::kProfiling)
      continue;
    if (is_on_vehicle(scene, world, sonar.mount)) return i;
    if (!out) out = i;
  }
  return out;
}

// The first camera that a vehicle carries.
std::optional<std::size_t> vehicle_camera(const scene::Scene& scene, const PhysicsWorld& world) {
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    if (is_on_vehicle(scene, world, scene.cameras[i].mount)) return i;
  return std::nullopt;
}

// A camera's picture beside the views, no larger than it is shown, and within the governor's budget
// as they are.
ViewsRequest beside_views(std::string name, const scene::Camera& camera,
                          const scene::MotionSource& motion, double time_s,
                          const Quality& quality) {
  constexpr double kMostSide_px = 384.0;
  const double scale =
      quality.view_scale * std::min(1.0, kMostSide_px / std::max(camera.width, camera.height));
  ViewsRequest views{.name = std::move(name),
                     .exposure = camera.exposure,
                     .detail = detail_at(camera.detail, quality.light),
                     .thrift = thrift_at(quality.light)};
  views.views.width = scaled(camera.width, scale);
  views.views.height = scaled(camera.height, scale);
  const Pose pose = motion.world_from(camera.mount, time_s);
  views.views.views.push_back(
      {.world_from_view = pose,
       .tangents = tangents_from_fov(camera.vertical_fov_rad,
                                     static_cast<double>(camera.width) / camera.height),
       .near_m = camera.near_m,
       .next_world_from_view = pose});
  views.views.worn_object = worn_by(motion, camera.mount, pose.position_m, time_s);
  return views;
}

}  // namespace

// The sensors of the HUD's console, which the options of the HUD name then.
DiveHudOptions DiveView::choose_console_sensors() {
  const scene::Scene& scene = session_.scene();
  console_sonar_ = vehicle_sonar(scene, physics_->world(), options_.sonars);
  console_camera_ = vehicle_camera(scene, physics_->world());
  DiveHudOptions hud = *options_.hud;
  if (console_sonar_) hud.sonar = scene.sonars[*console_sonar_].name;
  if (console_camera_) hud.camera = scene.cameras[*console_camera_].name;
  return hud;
}

// The inset of the panels, which a person asks for.
void DiveView::add_inset(FrameRequest& request, const scene::MotionSource& motion) {
  inset_view_.reset();
  const bool drawn = shown() && (frame_.mirror || !watched());
  const auto inset = console_ && drawn ? console_->inset() : std::nullopt;
  if (!inset) return;
  inset_view_ = request.views.size();
  const scene::Camera& camera = session_.scene().cameras[*inset];
  request.views.push_back(
      beside_views("inset " + camera.name, camera, motion, request.time_s, quality()));
}

// The vehicle's camera, for the pictures of the HUD's console that take a new one.
void DiveView::add_console_camera(FrameRequest& request, const scene::MotionSource& motion) {
  camera_view_.reset();
  if (!hud_ || !console_camera_ || !shown() || !hud_->wants_pictures(seen_s(request.time_s)))
    return;
  camera_view_ = request.views.size();
  const scene::Camera& camera = session_.scene().cameras[*console_camera_];
  request.views.push_back(
      beside_views("hud " + camera.name, camera, motion, request.time_s, quality()));
}

// The fan of the HUD's console, of each ping while that is shown.
Status DiveView::declare_console_sonar(graph::FrameGraph& graph, const SensorFrame& frame) {
  if (!hud_ || !console_sonar_ || !hud_->shows_console()) return {};
  if (!console_fans_) {
    NERITIC_TRY(console_fans_, SonarFans::create(session_.device(), true));
  }
  console_fans_->begin_frame();
  for (const SensorFrame::Sonar& ping : frame.sonars)
    if (ping.index == *console_sonar_)
      NERITIC_TRY_STATUS(
          console_fans_->declare(graph, "hud " + session_.scene().sonars[ping.index].name, ping));
  return {};
}

}  // namespace neritic::testbed
