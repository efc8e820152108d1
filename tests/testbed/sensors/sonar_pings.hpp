// Scenes and pings for tests of the sonar's terms, end to end.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {

inline scene::Object object_of(scene::Scene& scene, scene::Model model, const Vec3& at) {
  scene.models.push_back(std::make_shared<scene::Model>(std::move(model)));
  scene::Object object;
  object.name = fmt::format("object_{}", scene.objects.size());
  object.model = static_cast<int>(scene.models.size()) - 1;
  object.mount.pose.position_m = at;
  object.class_id = 12;
  object.instance = static_cast<std::uint16_t>(scene.objects.size() + 1);
  return object;
}

inline scene::Sonar sonar_of(double range_min, double range_max, std::uint32_t bins) {
  scene::Sonar sonar;
  sonar.name = "sonar";
  sonar.range_min_m = range_min;
  sonar.range_max_m = range_max;
  sonar.azimuth_rad = radians(20.0);
  sonar.elevation_rad = radians(20.0);
  sonar.bins_range = bins;
  sonar.bins_azimuth = sonar.bins_elevation = 128;
  return sonar;
}

inline scene::SonarLevel plain_level() {
  scene::SonarLevel level;
  level.source_level_db = 200.0;
  level.absorption = scene::SonarLevel::Absorption::kFixed;
  level.absorption_db_per_m = 0.3;
  return level;
}

// The echoes of every head of the scene's first sonar.
inline std::vector<SonarFrame> pings(gpu::Device& device, const scene::Scene& scene,
                                     std::uint32_t number = 0) {
  FrameRequest request;
  request.sonars = {0};
  request.frame = number;
  request.capture = request.capture.without_geometry();
  auto session = Session::create(device, scene);
  if (!session.ok()) {
    ADD_FAILURE() << session.error().message;
    return {};
  }
  auto result = (*session)->render(request);
  if (!result.ok()) {
    ADD_FAILURE() << result.error().message;
    return {};
  }
  return std::move(result->sonars);
}

inline SonarFrame ping(gpu::Device& device, const scene::Scene& scene, std::uint32_t number = 0) {
  auto frames = pings(device, scene, number);
  return frames.empty() ? SonarFrame{} : std::move(frames.front());
}

// One session that pings again and again, its first sonar in worlds of other seeds or with other
// settings: most of a small ping is the session's making.
class Pinger {
 public:
  Pinger(gpu::Device& device, const scene::Scene& scene) {
    auto session = Session::create(device, scene);
    if (session.ok())
      session_ = std::move(*session);
    else
      ADD_FAILURE() << session.error().message;
  }
  void replace(const scene::Sonar& sonar) {
    if (session_) session_->replace_sonar(0, sonar);
  }
  SonarFrame ping(std::uint64_t seed) {
    if (!session_) return {};
    FrameRequest request;
    request.sonars = {0};
    request.seed = seed;
    request.capture = request.capture.without_geometry();
    auto result = session_->render(request);
    if (result.ok()) return std::move(result->sonars.front());
    ADD_FAILURE() << result.error().message;
    return {};
  }

 private:
  std::unique_ptr<Session> session_;
};

inline double total(const SonarFrame& frame) {
  return std::accumulate(frame.image.intensity.begin(), frame.image.intensity.end(), 0.0);
}

// Mean range of the energy.
inline double mean_range_m(const SonarFrame& frame) {
  double sum = 0.0, weighted = 0.0;
  for (std::uint32_t row = 0; row < frame.image.n_range; ++row)
    for (std::uint32_t c = 0; c < frame.image.n_azimuth; ++c) {
      const double v = frame.image.intensity[std::size_t{row} * frame.image.n_azimuth + c];
      sum += v;
      weighted += v * frame.grid.range_m(row);
    }
  return weighted / sum;
}

// A wall 20 m wide, across the axis, and far enough to fill the wedge.
inline scene::Scene wall(double distance_m, scene::Sonar sonar) {
  scene::Scene scene;
  scene.objects.push_back(
      object_of(scene, scene::make_box(Vec3(60.0, 60.0, 1.0)), {0.0, 0.0, -distance_m - 0.5}));
  scene.sonars = {std::move(sonar)};
  return scene;
}

}  // namespace neritic::testbed
