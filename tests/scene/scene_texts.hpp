// Scenes from texts written in tests, and what is said of those that do not load.
#pragma once

#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/scene.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {

// The scene of text; the test fails with its message where it does not load.
inline Scene scene_of(const test::ScratchFolder& scratch, const std::string& text,
                      const SceneOptions& options = {}) {
  EXPECT_TRUE(write_text(scratch / "s.toml", text).ok());
  auto scene = load_scene(scratch / "s.toml", options);
  if (scene.ok()) return std::move(scene).value();
  ADD_FAILURE() << scene.error().message;
  return {};
}

inline void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-9) {
  EXPECT_NEAR(glm::length(a - b), 0.0, tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " against " << b.x << ' ' << b.y << ' ' << b.z;
}

inline Vec3 forward_of(const Pose& pose) {
  return pose.rotation * Vec3(0, 0, -1);
}

// The message of loading text as a scene, its folder left out; "loaded" where it loads.
inline std::string message_of(const test::ScratchFolder& scratch, const std::string& text,
                              const std::string& name = "s.toml") {
  EXPECT_TRUE(write_text(scratch / name, text).ok());
  const auto scene = load_scene(scratch / name);
  if (scene.ok()) return "loaded";
  EXPECT_EQ(scene.error().code, ErrorCode::kBadInput);
  std::string message = scene.error().message;
  const std::string folder = scratch.path().string() + "/";
  for (auto at = message.find(folder); at != std::string::npos; at = message.find(folder))
    message.erase(at, folder.size());
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  return message;
}

inline constexpr const char* kHill = R"(
seed = 5
[[objects]]
name = "hill"
terrain = "hill.npy"
cell_m = 2.0
position_m = [10, -20, 0]
[[objects]]
name = "rock"
shape = "sphere"
scatter = {count = 200, area_m = [0, -9, 20, 9], on = "hill", scale = [0.5, 2], sink_m = 0.1, keep_out_m = [[10, 0, 4]]}
[[objects]]
name = "stone"
shape = "sphere"
scatter = {count = 50, area_m = [0, -9, 20, 9], on = "hill", align = "surface"}
)";

// A plane that rises by 0.5 m a metre eastwards: y = 0.5 x.
inline void write_hill(const test::ScratchFolder& scratch) {
  std::vector<float> heights;
  for (int row = 0; row < 11; ++row)
    for (int column = 0; column < 11; ++column)
      heights.push_back(static_cast<float>(0.5 * 2.0 * (column - 5)));
  ASSERT_TRUE(write_npy(scratch / "hill.npy", heights, {11, 11}).ok());
}

}  // namespace neritic::scene
