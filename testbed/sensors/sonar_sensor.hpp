// One sonar of a session: its state from frame to frame, its part of a frame's graph, and its
// results at the host. Private to testbed/sensors; rendering thread.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sonar/head_gather.hpp"
#include "testbed/sensors/small_targets.hpp"
#include "testbed/sensors/view_sensor.hpp"

namespace neritic::testbed {

// Echo strengths of the scene's instances, for all its sonars: read once, with the session.
struct EchoTables {
  std::vector<float> reflectivities;      // by instance label; empty: all are 1
  gpu::Buffer reflectivity, backscatter;  // by instance label; empty where no sonar needs them
  std::vector<float> strengths;           // the backscatter's, by instance label
  double backscatter_scale = 1.0;         // strength that 1 in the table stands for
  double least_object_m = 0.0;            // small_targets.hpp

  static Result<EchoTables> create(gpu::Device& device, const scene::Scene& scene);
  const gpu::Buffer* of(const scene::Sonar& sonar) const;  // nullptr: all are 1
  const std::vector<float>& values_of(const scene::Sonar& sonar) const {
    return sonar.terms.level ? strengths : reflectivities;
  }
};

// A head as long as the settings stay.
struct HeadState {
  std::string name;  // of passes: the sonar's, and the head's where there are several
  std::vector<sonar::Sector> sectors;
  sonar::LeaningView upright;  // a plain pinhole, of the arrays
  sonar::BeamGrid shown;       // the cells that its pixels are counted by: beams where it can
  // The view that beams gather from: its rows are shifted, but for cones and the published gather.
  sonar::LeaningView sampled;
  // Where some of the scene's objects may be smaller than the cells: how large they are drawn.
  std::optional<render::LeastDrawn> least;
  std::unique_ptr<sonar::HeadGather> gather;
  Ring<sonar::HeadBuffers> buffers;
  const sonar::Head& head() const { return gather->head(); }
};

struct SonarState {
  scene::Sonar made_from;
  sonar::Gather mode = sonar::Gather::kPlane;
  double pixels_per_cell = 1.0;  // asked for; the device's largest image may allow less
  std::vector<sonar::Mirror> mirrors;
  std::vector<HeadState> heads;
};

// One head in one frame.
struct HeadWork {
  HeadState* state = nullptr;
  Pin<sonar::HeadBuffers> buffers;  // empty: nothing is brought to the host
  sonar::HeadPing ping;
  ViewsWork sampled, arrays;
  // Things that a gather of this ping draws larger: all strengths with theirs, and their places.
  struct Larger {
    std::vector<float> strengths;
    std::vector<shared::SonarDrawnLarger> places;
  };
  Larger larger;
  std::vector<Larger> ghosts_larger;               // a mirror
  std::vector<std::unique_ptr<ViewsWork>> ghosts;  // a mirror
  double heading_rad = 0.0;
  Pose world_from_sonar, world_from_head;
};

// One sonar in one frame. Keeps its settings from being replaced; heads, which borrow from them, go
// first.
struct SonarWork {
  std::size_t index = 0;
  Pin<SonarState> state;
  std::vector<std::unique_ptr<HeadWork>> heads;
};

class SonarSensor {
 public:
  // tables must outlive it. index: into the scene's sonars.
  SonarSensor(const EchoTables& tables, std::size_t index) : tables_(tables), index_(index) {}

  // Adds a geometry G-buffer a head (and a mirror), the gathers, the receiver. ping: its number.
  Result<std::unique_ptr<SonarWork>> declare(const FrameParts& frame, const Capture& capture,
                                             std::uint32_t ping);
  // A result a head, after the frame is done.
  std::vector<SonarFrame> decode(const SonarWork& work) const;

 private:
  Result<Pin<SonarState>> state_of(gpu::Device& device, scene::Sonar sonar);
  Result<HeadState> make_head(gpu::Device& device, const scene::Sonar& sonar,
                              const SonarState& state, sonar::Head head) const;
  Status declare_head(const FrameParts& frame, const Capture& capture, const SonarState& sonar,
                      HeadWork& work) const;
  Result<render::GBuffer> declare_echoes(const FrameParts& frame, const Capture& capture,
                                         const SonarState& sonar, HeadWork& work) const;
  Status declare_ghosts(const FrameParts& frame, const SonarState& sonar,
                        const sonar::HeadGather::Table& table, HeadWork& work) const;
  SonarFrame decode_head(const SonarState& sonar, const HeadWork& work) const;

  const EchoTables& tables_;
  std::size_t index_;
  // The newest settings last; earlier ones as long as a frame borrows them.
  std::vector<std::unique_ptr<PinSlot<SonarState>>> states_;
};

}  // namespace neritic::testbed
