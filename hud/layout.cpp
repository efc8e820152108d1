#include "hud/layout.hpp"

#include <array>

#include "engine/core/check.hpp"

namespace neritic::hud {
namespace {

// The screen lies on the back of the left wrist. Its right is towards the fingers (-y of the hand),
// its top on the little finger's side (z), as an arm across the chest holds it upright.
Quat hand_from_wrist_panel() {
  return glm::quat_cast(Mat3(Vec3(0.0, -1.0, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(-1.0, 0.0, 0.0)));
}

const std::array<Layout, 4>& all() {
  static const std::array<Layout, 4> table{
      {{.name = "wrist",
        .kind = LayoutKind::kWrist,
        .width_px = 480,
        .height_px = 460,
        .lock = Lock::kWrist,
        .lock_from_panel = {{-0.035, 0.06, 0.0}, hand_from_wrist_panel()},
        .head_from_panel = {{-0.165, -0.15, -0.269}, from_yaw_pitch_roll(0.55, -0.443, 0.0)},
        .size_m = {0.084, 0.0805},
        .viewing_m = 0.35,
        .window = {.height = 0.53, .across = 0.02, .down = 0.96}},
       {.name = "mask",
        .kind = LayoutKind::kMask,
        .width_px = 960,
        .height_px = 140,
        .lock = Lock::kHead,
        .lock_from_panel = {{0.0, -0.384, -0.923}, from_yaw_pitch_roll(0.0, -0.394, 0.0)},
        .head_from_panel = {{0.0, -0.384, -0.923}, from_yaw_pitch_roll(0.0, -0.394, 0.0)},
        .size_m = {0.72, 0.105},
        .radius_m = 1.0,
        .viewing_m = 1.0,
        .window = {.height = 0.155, .across = 0.5, .down = 0.97}},
       {.name = "corner",
        .kind = LayoutKind::kCorner,
        .width_px = 400,
        .height_px = 358,
        .lock = Lock::kHead,
        .lock_from_panel = {{0.26, -0.18, -0.945}, from_yaw_pitch_roll(-0.27, -0.18, 0.0)},
        .head_from_panel = {{0.26, -0.18, -0.945}, from_yaw_pitch_roll(-0.27, -0.18, 0.0)},
        .size_m = {0.28, 0.2506},
        .viewing_m = 1.0,
        .window = {.height = 0.43, .across = 0.98, .down = 0.96}},
       {.name = "console",
        .kind = LayoutKind::kConsole,
        .width_px = 1280,
        .height_px = 720,
        .lock = Lock::kWorld,
        .lock_from_panel = {{0.0, 1.5, -1.6}},
        .head_from_panel = {{0.0, 0.0, -1.6}},
        .size_m = {1.44, 0.81},
        .radius_m = 1.6,
        .viewing_m = 1.6,
        .window = {.height = 1.0, .across = 0.5, .down = 0.5}}}};
  return table;
}

}  // namespace

std::span<const Layout> layouts() {
  return all();
}

const Layout& layout_of(LayoutKind kind) {
  return all()[static_cast<std::size_t>(kind)];
}

std::optional<LayoutKind> layout_named(std::string_view name) {
  for (const Layout& layout : all())
    if (layout.name == name) return layout.kind;
  return std::nullopt;
}

double pixels_a_degree(const Layout& layout) {
  const double m_per_px = layout.size_m.x / layout.width_px;
  return layout.viewing_m * std::tan(radians(1.0)) / m_per_px;
}

}  // namespace neritic::hud
