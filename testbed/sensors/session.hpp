// A scene on a device, ready to give frames: `render`, `dive`, `tools/bench` and the golden tests
// share it. declare adds the passes of the sensors and views that a request names, and nothing
// else, to a graph that the caller runs; read gives what the host asked for once the frame is done.
// render does both for one frame. Rendering thread only.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/render/bubble_field.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/snow_field.hpp"
#include "testbed/sensors/frame_request.hpp"
#include "testbed/sensors/frame_result.hpp"
#include "testbed/sensors/readback.hpp"
#include "testbed/sensors/sensor_frame.hpp"

namespace neritic::testbed {

struct EchoTables;
class SonarSensor;
class SunMaps;
class Skylight;

class Session {
 public:
  // places: where objects show pictures that change.
  static Result<std::unique_ptr<Session>> create(gpu::Device& device, scene::Scene scene,
                                                 std::span<const scene::PicturePlace> places = {});
  ~Session();

  const scene::Scene& scene() const { return scene_; }
  gpu::Device& device() { return device_; }
  gpu::Frames& frames() { return *frames_; }
  const render::GpuScene& gpu_scene() const { return *gpu_scene_; }

  // Gives the scene's sonar of that index other settings and another mount, from the next declared
  // frame on; frames in flight keep theirs. Everything else of a scene stays as it was created.
  void replace_sonar(std::size_t index, scene::Sonar sonar);
  // Dims the scene's lamp of that index to a share of its intensity, 0 to 1, from the next declared
  // frame on.
  void dim_lamp(std::size_t index, double share);

  // Adds the request's passes. The caller may add others that use the frame's handles, then begins
  // the frame, runs executor(), submits and tells the SensorFrame.
  Result<std::unique_ptr<SensorFrame>> declare(graph::FrameGraph& graph,
                                               const FrameRequest& request);
  // Whether the frame was submitted and is done on the GPU. Does not wait.
  Result<bool> is_done(const SensorFrame& frame) const;
  // The results of a frame that is done, of the sensors and views that were to come to the host.
  Result<FrameResult> read(const SensorFrame& frame);
  // One frame by itself: declare, run, wait, read.
  Result<FrameResult> render(const FrameRequest& request);

  graph::Executor& executor() { return *executor_; }
  // The plan of the newest frame of render, as text or Graphviz; empty before the first.
  const std::string& plan_text() const { return plan_text_; }
  const std::string& plan_graphviz() const { return plan_graphviz_; }
  void keep_plan_dump(bool on) { keep_dump_ = on; }

 private:
  explicit Session(gpu::Device& device);
  Result<std::unique_ptr<SensorFrame>> declare_sensors(graph::FrameGraph& graph,
                                                       const FrameRequest& request);
  // The camera's terms beyond a pinhole; nothing where it names none.
  std::optional<CameraPicture> picture_of(std::size_t camera, const Capture& capture);
  Status run_to_end(graph::FrameGraph& graph, SensorFrame& frame);
  gpu::Device& device_;
  scene::Scene scene_;
  std::unique_ptr<gpu::Frames> frames_;
  std::unique_ptr<graph::Executor> executor_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::GpuScene> gpu_scene_;
  std::unique_ptr<EchoTables> echo_tables_;
  std::vector<std::unique_ptr<SonarSensor>> sonars_;          // the scene's, as far as asked for
  std::map<std::size_t, std::vector<glm::dvec2>> lens_maps_;  // by camera, as far as asked for
  ReadbackPool readback_;
  std::unique_ptr<SunMaps> sun_maps_;
  std::unique_ptr<Skylight> skylight_;
  std::unique_ptr<render::SnowField> snow_;
  std::unique_ptr<render::BubbleField> bubbles_;
  SeaWaves waves_;  // summed once: it takes as long as a tenth of a headset's frame
  std::vector<std::uint8_t> moving_, still_;  // flags by object
  std::vector<double> lamp_cd_;  // of lamps at their full intensity, once one was dimmed
  std::string plan_text_, plan_graphviz_;
  bool keep_dump_ = false;
  std::uint64_t room_found_bytes_ = 0;  // the largest frame so far that memory sufficed for
};

// The documented defaults of a sonar (sonar/README.md: the knee of `neritic tradeoff sonar`).
inline constexpr double kDefaultGBufferScale = 0.5;
inline constexpr const char* kDefaultGather = "plane";

// The pinhole from which a camera's lens makes its picture; nothing for a camera without a lens.
// Loading has checked the lens.
std::optional<scene::LensView> lens_view_of(const scene::Camera& camera);
// The views of a camera of the scene (through a lens: of its pinhole): one, or two for a stereo
// pair, half the baseline to each side; where it is at time_s and, for motion, at next_time_s.
render::ViewSet camera_views(const scene::MotionSource& motion, const scene::Camera& camera,
                             double time_s = 0.0, double next_time_s = 0.0);
// The object within whose head (the model's node "head") the eye is, of those that carry the mount:
// such a view is drawn without that head. ViewSet::kWornByNobody: none.
std::uint32_t worn_by(const scene::MotionSource& motion, const scene::Mount& mount,
                      const Vec3& eye_m, double time_s);

}  // namespace neritic::testbed
