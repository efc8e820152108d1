// A scene on a device, ready to give frames: what `render`, `dive`, `tools/bench` and the golden
// tests share. One call declares one graph for the sensors asked for (and nothing else), runs it
// and brings the results to the host in the conventions of the file contract. Rendering thread
// only.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/intrinsics.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/motion.hpp"
#include "sonar/beam_grid.hpp"
#include "sonar/label_energy.hpp"
#include "sonar/quality.hpp"
#include "sonar/reference.hpp"
#include "testbed/sensors/readback.hpp"

namespace neritic::testbed {

// One eye's images at the host. Empty where they were not asked for.
struct ViewImages {
  Pose world_from_view;
  Intrinsics intrinsics;
  double near_m = 0.0;
  std::uint32_t width = 0, height = 0;
  ImageF32 depth;    // planar metres, +inf where nothing is hit
  ImageF32 normals;  // 3 channels, view axes; 0 where nothing is hit
  ImageU16 labels;   // class
  ImageU16 instances;
  ImageU8 color;    // RGB, sRGB
  ImageF32 motion;  // 2 channels, pixels to the next frame
};

struct CameraFrame {
  std::string name;
  std::vector<ViewImages> eyes;  // one, or left and right
};

// What one head of a sonar heard (a side-scan has two).
struct SonarFrame {
  std::string name, head;  // head: "" or "port", "starboard"
  scene::SonarKind kind = scene::SonarKind::kImaging;
  std::string gather;
  sonar::BeamGrid grid;  // of the image: azimuth bins are beams
  // Intensity: the plain cosine's mean over elevation, or, with level, the power that leaves the
  // receiver (times its gains), 1 being 1 uPa^2.
  sonar::SonarImage image;
  bool level = false;
  scene::SonarTerms terms;
  std::optional<sonar::LabelImage> label_energy;  // where labels by energy are named
  Pose world_from_sonar, world_from_head;
  double heading_rad = 0.0;  // of a mechanical scanner's beam, sonar axes, positive to starboard
  double sound_speed_m_s = 0.0, absorption_db_per_m = 0.0;  // with terms
  std::vector<float> noise_power;  // mean of the noise in each range row; empty: none is named
  const sonar::QualityLevel* quality = nullptr;  // that it is sampled by, if any
  double max_error = 0.0;                        // what asked for it; 0: its name
  double fixed_scale = 1.0;
  std::uint32_t gbuffer_width = 1, gbuffer_height = 1;  // of one sector's arrays
  // Of the view that it was gathered from: rows of pixels each shifted by so much against the next
  // (sonar::leaning_view), by the published gather not.
  std::uint32_t sampled_width = 1, sampled_height = 1;
  double shift_px = 0.0;
  double pixels_per_cell = 1.0;          // asked for, linear
  glm::dvec2 pixels_per_cell_used{1.0};  // azimuth, elevation; less where the device's images end
  // The incidence is multiplied by, by instance label; empty: all are 1, or a level has its own.
  std::vector<float> reflectivity;
  std::vector<ViewImages> sectors;  // geometry only; one for apertures up to 100 degrees
};

struct Capture {
  bool color = true;     // of cameras
  bool geometry = true;  // depth, normals, labels, instances, of cameras and sonars
  bool motion = true;    // of cameras
  bool to_host = true;  // false: declared only, for who draws with it on the GPU (Session::declare)
};

struct FrameRequest {
  double time_s = 0.0;
  double next_time_s = 1.0 / 30.0;
  std::uint32_t frame = 0;
  std::vector<std::size_t> cameras, sonars;  // indices into the scene's
  // Which of its pings each of the sonars makes: noise and a scanner's step follow from it. Empty:
  // all the frame-th.
  std::vector<std::uint32_t> pings;
  Capture capture;
  // What moves by physics, and where to; nullptr: all moves by tracks and clips.
  const scene::SimulatedMotion* simulated = nullptr;
};

struct FrameResult {
  std::vector<CameraFrame> cameras;
  std::vector<SonarFrame> sonars;
  std::vector<gpu::PassTime> passes;
  double frame_ms = 0.0;  // declare, record, run, read back
};

struct CameraWork;
struct FrameWork;
class SonarStation;

// One frame's sensors in a graph that the caller runs: what other passes may read, nothing brought
// to the host. Keeps what the passes borrow, so it must live until Executor::run has returned.
class LiveFrame {
 public:
  struct Camera {
    std::size_t index = 0;     // into the scene's
    graph::ImageHandle color;  // render::kColorFormat, a layer an eye
    std::uint32_t width = 1, height = 1, layers = 1;
  };
  // A head of a sonar.
  struct Sonar {
    std::size_t index = 0;
    sonar::BeamGrid grid;
    // [n_range][n_azimuth]: uint32 sums of the plain cosine, image_scale each; or floats of power.
    graph::BufferHandle image;
    bool is_float = false;
    double image_scale = 1.0;
  };
  std::vector<Camera> cameras;
  std::vector<Sonar> sonars;
  LiveFrame();
  ~LiveFrame();

 private:
  friend class Session;
  std::unique_ptr<FrameWork> work_;
};

class Session {
 public:
  static Result<std::unique_ptr<Session>> create(gpu::Device& device, scene::Scene scene);
  ~Session();

  const scene::Scene& scene() const { return scene_; }
  scene::Scene& scene() {
    return scene_;
  }  // poses and settings may change between frames, meshes not
  gpu::Device& device() { return device_; }
  gpu::Frames& frames() { return *frames_; }
  const render::GpuScene& gpu_scene() const { return *gpu_scene_; }

  Result<FrameResult> render(const FrameRequest& request);
  // Only declares (the request's capture does not count): the caller adds passes that use the
  // images, begins the frame, runs executor(), submits.
  Result<std::unique_ptr<LiveFrame>> declare(graph::FrameGraph& graph, FrameRequest request);
  graph::Executor& executor() { return *executor_; }
  // The newest frame's plan, as text or Graphviz; empty before the first.
  const std::string& plan_text() const { return plan_text_; }
  const std::string& plan_graphviz() const { return plan_graphviz_; }
  void keep_plan_dump(bool on) { keep_dump_ = on; }

 private:
  explicit Session(gpu::Device& device);
  Result<FrameResult> render_frame(const FrameRequest& request);
  Status check_memory(const FrameRequest& request);
  Error advised(const Error& error, const FrameRequest& request) const;
  gpu::Device& device_;
  scene::Scene scene_;
  std::unique_ptr<gpu::Frames> frames_;
  std::unique_ptr<graph::Executor> executor_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::GpuScene> gpu_scene_;
  Status check_size(const std::string& what, std::uint32_t width, std::uint32_t height) const;
  Status declare_camera(graph::FrameGraph& graph, const scene::MotionSource& motion,
                        const render::FrameState& state, const render::DeformedGeometry& deformed,
                        const Capture& capture, CameraWork& work);
  Status declare_sensors(graph::FrameGraph& graph, const FrameRequest& request, FrameWork& work);
  std::unique_ptr<SonarStation> sonars_;
  ReadbackPool readback_;
  std::string plan_text_, plan_graphviz_;
  bool keep_dump_ = false;
  std::uint64_t room_found_bytes_ = 0;  // for what the largest frame so far needs of the machine
};

// The documented defaults of a sonar (sonar/README.md: the knee of `neritic tradeoff sonar`).
inline constexpr double kDefaultGBufferScale = 0.5;
inline constexpr const char* kDefaultGather = "plane";

// The views of a camera of the scene: one, or two for a stereo pair, half the baseline to each
// side; where it is at time_s and, for motion, at next_time_s.
render::ViewSet camera_views(const scene::MotionSource& motion, const scene::Camera& camera,
                             double time_s = 0.0, double next_time_s = 0.0);

}  // namespace neritic::testbed
