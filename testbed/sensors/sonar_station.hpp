// The sonars of a session: what each keeps from frame to frame, its part of a frame's graph, and
// its results at the host. Private to Session; rendering thread.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/render/renderer.hpp"
#include "sonar/backscatter.hpp"
#include "sonar/head.hpp"
#include "sonar/ping.hpp"
#include "testbed/sensors/session.hpp"
#include "testbed/sensors/session_work.hpp"

namespace neritic::testbed {

// What a head keeps while its settings stay.
struct HeadState {
  sonar::Head head;
  std::vector<sonar::Sector> sectors;
  sonar::RangeCorrections corrections;
  std::vector<sonar::RangeCorrections> ghost_corrections;  // by mirror
  sonar::LeaningView upright;                              // a plain pinhole: of the arrays
  sonar::LeaningView
      sampled;  // what is gathered from: leaning, but of cones and by the published gather
  std::unique_ptr<sonar::SonarGather> gather, ghosts;  // ghosts: where mirrors are named
  std::unique_ptr<sonar::Receiver> receiver;           // where terms are named
  gpu::Buffer sums, keys, power, records;              // host-readable, those that are wanted
  std::vector<gpu::Buffer> ghost_records;              // a mirror
};

struct SonarState {
  scene::Sonar made_from;
  sonar::Gather mode = sonar::Gather::kPlane;
  double pixels_per_cell = 1.0;  // asked for; the device's largest image may allow less
  std::vector<sonar::Mirror> mirrors;
  std::vector<std::unique_ptr<HeadState>> heads;
};

// One head in one frame.
struct HeadWork : ViewWork {
  HeadState* state = nullptr;
  std::size_t place = 0;  // among its sonar's heads
  sonar::Ping ping;
  double heading_rad = 0.0;
  Pose world_from_sonar;
  struct Ghost {
    sonar::Ping ping;
    ViewWork view;
  };
  std::vector<std::unique_ptr<Ghost>> ghosts;
  ViewWork sampled;  // what is gathered from
  graph::BufferHandle sums, power;
};

struct SonarWork {
  std::size_t index = 0;
  SonarState* state = nullptr;
  std::vector<std::unique_ptr<HeadWork>> heads;
};

class SonarStation {
 public:
  // The scene must outlive it; what its objects send back is read now.
  static Result<std::unique_ptr<SonarStation>> create(gpu::Device& device,
                                                      const scene::Scene& scene);

  struct Frame {
    graph::FrameGraph& graph;
    render::Renderer& renderer;
    const render::GpuScene& gpu_scene;
    const scene::MotionSource& motion;
    const render::FrameState& state;
    const render::DeformedGeometry& deformed;
    ReadbackPool& readback;
    Capture capture;
    double time_s = 0.0;
    std::uint32_t ping = 0;
  };
  // Adds one sonar: a geometry G-buffer a head (and a mirror), the gathers, the receiver.
  Status declare(const Frame& frame, SonarWork& work);
  // A result a head, after the frame is done.
  std::vector<SonarFrame> decode(const SonarWork& work) const;

 private:
  SonarStation(gpu::Device& device, const scene::Scene& scene) : device_(device), scene_(scene) {}
  Result<SonarState*> state_of(std::size_t index);
  Result<std::unique_ptr<HeadState>> make_head(const scene::Sonar& sonar, const SonarState& state,
                                               sonar::Head head);
  Status declare_head(const Frame& frame, const SonarWork& work, HeadWork& head);
  Status declare_ghosts(const Frame& frame, const SonarWork& work, HeadWork& head,
                        const sonar::PingState& ping, const sonar::SonarGather::Inputs& direct,
                        sonar::SonarGather::Outputs& out);
  sonar::PingState ping_state(const Frame& frame, const HeadWork& head, const scene::Motion& sonar,
                              const Pose& world_from_head) const;
  const gpu::Buffer* table_of(const scene::Sonar& sonar) const;

  gpu::Device& device_;
  const scene::Scene& scene_;
  std::vector<float> reflectivities_;       // by instance label; empty: all are 1
  gpu::Buffer reflectivity_, backscatter_;  // by instance label; empty where nothing needs them
  double backscatter_scale_ = 1.0;
  std::map<std::size_t, std::unique_ptr<SonarState>> sonars_;
};

}  // namespace neritic::testbed
