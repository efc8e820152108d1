// A lit ball in the dark before a fake headset, and where each of its views must see it, by the
// pinhole equations alone.
#pragma once

#include <string>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "tests/support/support.hpp"
#include "tests/xr/fake_headset.hpp"
#include "tests/xr/shown.hpp"

namespace neritic::xr {

inline constexpr double kNear_m = 0.05, kRadius_m = 0.1;
inline const Vec3 kBall_m{30.3, -4.1, 8.0};
inline const Pose kStage{{30.0, -5.6, 10.0}, from_yaw_pitch_roll(-0.1, 0.0, 0.0)};

// more: further keys of the scene.
inline scene::Scene ball_scene(const std::string& more = {}) {
  const test::ScratchFolder scratch;
  EXPECT_TRUE(write_text(scratch / "ball.toml",
                         fmt::format("[sun]\nelevation_deg = 60\n[[objects]]\nname = \"ball\"\n"
                                     "shape = \"sphere\"\nradius_m = {}\n"
                                     "position_m = [{}, {}, {}]\n{}",
                                     kRadius_m, kBall_m.x, kBall_m.y, kBall_m.z, more))
                  .ok());
  return scene::load_scene(scratch / "ball.toml").value();
}

inline Pose head_at(std::uint64_t frame) {
  return {{0.0, 1.6, 0.02 * static_cast<double>(frame)}, from_yaw_pitch_roll(0.05, -0.1, 0.03)};
}

// The ball's middle and depth in each view of a group, as the headset got them.
inline void expect_ball(gpu::Device& device, const FakeHeadset& headset,
                        const Pose& world_from_head, const ViewGroup& group, std::size_t index) {
  const auto depth = read_layers(device, headset.depth(index));
  const auto* values = reinterpret_cast<const float*>(depth.data());
  const auto color = read_layers(device, headset.color(index));
  for (std::size_t v = 0; v < group.views.size(); ++v) {
    const View& view = group.views[v];
    const Vec3 ball = inverse(world_from_head * view.head_from_view) * kBall_m;
    double sum_x = 0.0, sum_y = 0.0, count = 0.0;
    float nearest = 0.0f;
    int lit = 0;
    for (std::uint32_t y = 0; y < group.height; ++y)
      for (std::uint32_t x = 0; x < group.width; ++x) {
        const std::size_t at = (v * group.height + y) * group.width + x;
        if (!(values[at] > 0.0f)) continue;
        sum_x += x + 0.5, sum_y += y + 0.5, count += 1.0;
        nearest = std::max(nearest, values[at]);
        lit = std::max(lit, static_cast<int>(color.data()[at * 4]));
      }
    ASSERT_GE(count, 15.0) << index << " " << v;
    const FrustumTangents& t = view.tangents;
    const double x = (ball.x / -ball.z - t.left) / (t.right - t.left) * group.width;
    const double y = (t.top - ball.y / -ball.z) / (t.top - t.bottom) * group.height;
    EXPECT_NEAR(sum_x / count, x, 0.35) << index << " " << v;
    EXPECT_NEAR(sum_y / count, y, 0.35) << index << " " << v;
    EXPECT_NEAR(kNear_m / nearest, -ball.z - kRadius_m, 0.01) << index << " " << v;
    EXPECT_GT(lit, 20) << index << " " << v;
  }
}

}  // namespace neritic::xr
