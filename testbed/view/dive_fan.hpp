// Live sonar pictures on the GPU: two small passes after a sonar's gather turn its sums into a fan
// that stays until the next ping. Only sonars that pinged in a frame have passes in it. Rendering
// thread.
#pragma once

#include <map>
#include <memory>
#include <string>

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
  // opaque: around each fan is its darkest colour, for pictures that are copied; else it is clear.
  static Result<std::unique_ptr<SonarFans>> create(gpu::Device& device, bool opaque = false);
  // Amplitudes times the gain, and the near part of the range alone: of the next ping, or of the
  // newest one at once (redraw).
  void show(double gain, double range_part);
  // A new graph: handles of the last are forgotten.
  void begin_frame();
  // Declares the passes that draw a ping. name: the sonar's, unique in the scene.
  Status declare(graph::FrameGraph& graph, const std::string& name, const SensorFrame::Sonar& ping);
  // Draws the newest pings again that were drawn as was asked for before, as while time stands
  // still.
  Status redraw(graph::FrameGraph& graph);
  // The newest picture for this frame's passes to read (kSampledFragment); empty before the first.
  graph::ImageHandle picture(graph::FrameGraph& graph, std::size_t sonar);
  const FanShape* shape(std::size_t sonar) const;        // nullptr before the first
  const sonar::BeamGrid* grid(std::size_t sonar) const;  // the same; its limits are those shown

 private:
  struct Fan {
    FanShape shape;
    sonar::BeamGrid grid;  // limits: those that are shown
    sonar::Limits limits;  // of the sonar itself
    double gain = 1.0, range_part = 1.0;
    std::string name;
    bool is_power = false;
    gpu::Image picture;
    gpu::Buffer scale;         // one float
    gpu::Buffer sums;          // of the newest ping, kept
    graph::ImageHandle drawn;  // in this frame's graph; empty where an earlier frame drew it
  };
  SonarFans(gpu::Device& device, bool opaque) : device_(device), opaque_(opaque) {}
  Status shape_fan(Fan& fan);
  Result<Fan*> fan_of(std::size_t sonar, const std::string& name, const sonar::BeamGrid& grid);
  graph::BufferHandle declare_scale(graph::FrameGraph& graph, const std::string& name,
                                    const SensorFrame::Sonar& ping, const Fan& fan);
  static graph::BufferHandle declare_sums(graph::FrameGraph& graph, const SensorFrame::Sonar& ping,
                                          Fan& fan);
  void declare_picture(graph::FrameGraph& graph, Fan& fan, graph::BufferHandle sums,
                       graph::BufferHandle scale);
  gpu::Device& device_;
  bool opaque_;
  gpu::Pipeline scale_, draw_;
  double gain_ = 1.0, range_part_ = 1.0;
  std::map<std::size_t, std::unique_ptr<Fan>> fans_;
};

}  // namespace neritic::testbed
