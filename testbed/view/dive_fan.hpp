// Live sonar pictures on the GPU: two small passes after a sonar's gather turn its sums into a fan
// that stays until the next ping. Only sonars that pinged in a frame have passes in it. Rendering
// thread.
#pragma once

#include <map>
#include <memory>

#include "engine/gpu/device.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/graph/frame_graph.hpp"
#include "sonar/beam_grid.hpp"
#include "testbed/sensors/sensor_frame.hpp"

namespace neritic::testbed {

// Where the fan lies in its picture. The sonar is at the origin, starboard x, ahead y, metres.
struct FanShape {
  std::uint32_t width = 1, height = 1;
  double left_m = 0.0, top_m = 0.0, m_per_px = 1.0;
  // Position in the picture, 0 to 1 from its left and its top.
  Vec2 place(double range_m, double bearing_rad) const;
};
FanShape fan_shape(const sonar::Limits& limits, std::uint32_t longest_side_px);

class SonarFans {
 public:
  static Result<std::unique_ptr<SonarFans>> create(gpu::Device& device);
  // From the next ping on: amplitudes times the gain, and the near part of the range alone.
  void show(double gain, double range_part);
  // A new graph: handles of the last are forgotten.
  void begin_frame();
  // Declares the passes that draw a ping. name: the sonar's, unique in the scene.
  Status declare(graph::FrameGraph& graph, const std::string& name, const SensorFrame::Sonar& ping);
  // The newest picture for this frame's passes to read (kSampledFragment); empty before the first.
  graph::ImageHandle picture(graph::FrameGraph& graph, std::size_t sonar);
  const FanShape* shape(std::size_t sonar) const;        // nullptr before the first
  const sonar::BeamGrid* grid(std::size_t sonar) const;  // the same; its limits are those shown

 private:
  struct Fan {
    FanShape shape;
    sonar::BeamGrid grid;  // limits: those that are shown
    double range_part = 1.0;
    gpu::Image picture;
    gpu::Buffer scale;         // one float
    graph::ImageHandle drawn;  // in this frame's graph; empty where an earlier frame drew it
  };
  explicit SonarFans(gpu::Device& device) : device_(device) {}
  Status shape_fan(Fan& fan, const std::string& name, const sonar::BeamGrid& grid);
  Result<Fan*> fan_of(std::size_t sonar, const std::string& name, const sonar::BeamGrid& grid);
  graph::BufferHandle declare_scale(graph::FrameGraph& graph, const std::string& name,
                                    const SensorFrame::Sonar& ping, const Fan& fan);
  gpu::Device& device_;
  gpu::Pipeline scale_, draw_;
  double gain_ = 1.0, range_part_ = 1.0;
  std::map<std::size_t, std::unique_ptr<Fan>> fans_;
};

}  // namespace neritic::testbed
