#include <cmath>

#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/intrinsics.hpp"
#include "testbed/loop/loop.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

template <class T>
void add(Hash64& hash, const std::vector<T>& values) {
  hash.add_span(std::span<const T>(values));
}

void add(Hash64& hash, const testbed::ViewImages& view) {
  add(hash, view.depth.data);
  add(hash, view.normals.data);
  add(hash, view.labels.data);
  add(hash, view.instances.data);
  add(hash, view.color.data);
  add(hash, view.motion.data);
}

// The time from its making to a frame's results, and their hash.
class Stopwatch final : public testbed::FrameSink {
 public:
  Status accept(const testbed::FrameResult& frame) override {
    const double ms = to_ms(now_ns() - begun_ns_);
    sample_ = {ms, parts_of(frame.passes), hash_of(frame)};
    double known = 0.0;
    for (const auto& [part, part_ms] : sample_.parts) known += part_ms;
    sample_.parts["(evaluate, draw lists, decode, waits)"] = ms - known;
    return {};
  }
  Status finish() override { return {}; }
  const Sample& sample() const { return sample_; }

 private:
  TimeNs begun_ns_ = now_ns();
  Sample sample_;
};

}  // namespace

Result<std::unique_ptr<testbed::Session>> open_scene(
    const Suite& suite, gpu::Device& device, const std::string& file,
    const std::function<void(scene::Scene&)>& change) {
  NERITIC_TRY(scene::Scene scene, scene::load_scene(suite.options().assets + "/scenes/" + file));
  if (change) change(scene);
  return testbed::Session::create(device, std::move(scene));
}

std::string hash_of(const sonar::SonarImage& image) {
  Hash64 hash;
  add(hash, image.intensity);
  add(hash, image.labels);
  return hash.hex();
}

std::string hash_of(const testbed::FrameResult& result) {
  Hash64 hash;
  for (const testbed::CameraFrame& camera : result.cameras)
    for (const testbed::ViewImages& eye : camera.eyes) add(hash, eye);
  for (const testbed::SonarFrame& sonar : result.sonars) {
    add(hash, sonar.image.intensity);
    add(hash, sonar.image.labels);
    for (const testbed::ViewImages& view : sonar.sectors) add(hash, view);
  }
  return hash.hex();
}

std::map<std::string, double> parts_of(const std::vector<gpu::PassTime>& passes) {
  std::map<std::string, double> parts;
  for (const gpu::PassTime& pass : passes) parts[pass.name] += pass.ms;
  return parts;
}

Contender frames_of(const std::string& name, testbed::Session& session,
                    const testbed::FrameRequest& request) {
  const testbed::LoopSensors sensors{&session, request.cameras, request.sonars, request.capture};
  const auto clock =
      testbed::Clock::simulated(request.time_s, request.next_time_s - request.time_s);
  return {name, [sensors, clock]() -> Result<Sample> {
            Stopwatch stopwatch;
            testbed::Loop loop({.clock = clock,
                                .sensors = sensors,
                                .frame_sinks = {&stopwatch},
                                .stop = {.frames = 1}});
            NERITIC_TRY_STATUS(loop.run());
            return stopwatch.sample();
          }};
}

sonar::SonarInput relief_input(const sonar::BeamGrid& grid, std::uint32_t width,
                               std::uint32_t height) {
  const sonar::Sector sector = sonar::plan_sectors(grid).front();
  sonar::SonarInput in;
  in.width = width;
  in.height = height;
  in.intrinsics = intrinsics_of(sector.tangents, width, height);
  const auto point = [](double tx, double ty) {
    const double range_m =
        3.0 + 0.8 * std::sin(4.0 * tx) * std::cos(7.0 * ty) + 0.2 * std::sin(31.0 * tx + 17.0 * ty);
    return glm::normalize(Vec3(tx, ty, -1.0)) * range_m;
  };
  constexpr double kStep = 1e-5;
  for (std::uint32_t v = 0; v < height; ++v)
    for (std::uint32_t u = 0; u < width; ++u) {
      const double tx = (u + 0.5 - in.intrinsics.cx) / in.intrinsics.fx;
      const double ty = -(v + 0.5 - in.intrinsics.cy) / in.intrinsics.fy;
      const Vec3 p = point(tx, ty);
      Vec3 n = glm::normalize(glm::cross(point(tx + kStep, ty) - point(tx - kStep, ty),
                                         point(tx, ty + kStep) - point(tx, ty - kStep)));
      if (glm::dot(n, p) > 0.0) n = -n;
      in.depth.push_back(-p.z);
      in.normals.insert(in.normals.end(), {n.x, n.y, n.z});
    }
  return in;
}

}  // namespace neritic::bench
