// One frame of sensors in a graph that the caller runs: handles for other passes of that graph, and
// what the host can read after the frame is done. Rendering thread.
//
// The passes borrow from it, and it pins its read-back buffers. So it must live until
// Executor::run has returned and, to be read, until Session::read; the session must outlive it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "sonar/beam_grid.hpp"

namespace neritic::testbed {

struct FrameWork;

class SensorFrame {
 public:
  // A camera of the scene, or a view set of the request.
  struct Views {
    std::size_t index = 0;  // into the scene's cameras, or the request's view sets
    // An array layer a view. color: render::kColorFormat; empty where it was not asked for.
    // depth: reversed Z with an infinite far plane: planar metres = near_m / depth.
    // normal: octahedral, world axes. label: class, instance.
    graph::ImageHandle color, depth, normal, label;
    double near_m = 0.0;
    std::uint32_t width = 1, height = 1, layers = 1;
  };
  // A head of a sonar.
  struct Sonar {
    std::size_t index = 0;  // into the scene's
    sonar::BeamGrid grid;
    // [n_range][n_azimuth]: uint32 sums of the plain cosine, image_scale each; or floats of power.
    graph::BufferHandle image;
    bool is_float = false;
    double image_scale = 1.0;
  };
  std::vector<Views> cameras, views;
  std::vector<Sonar> sonars;

  SensorFrame();
  ~SensorFrame();
  // value: what gpu::Frames::submit returned for the frame.
  void submitted(std::uint64_t value) { done_at_ = value; }
  std::uint64_t done_at() const { return done_at_; }  // 0 before submitted

 private:
  friend class Session;
  std::uint64_t done_at_ = 0;
  std::unique_ptr<FrameWork> work_;
};

}  // namespace neritic::testbed
