// What one view set draws: instances that some view can see, as few draws as there are primitives.
// Plain data made on the CPU.
#pragma once

#include <vector>

#include "engine/render/frame_state.hpp"
#include "engine/render/views.hpp"

namespace neritic::render {

struct Draw {
  const GpuPrimitive* primitive = nullptr;
  std::uint32_t first_instance = 0, instance_count = 0;
  std::uint32_t deformed = kNone;  // first vertex in the deformed stream
  bool mirrored = false;           // negative determinant: front faces turn round
  double distance_m = 0.0;         // of the nearest instance's centre, for sorting
};

struct DrawList {
  std::vector<shared::Instance> instances;
  std::vector<shared::NextInstance> next_instances;  // empty without motion
  std::vector<Draw> opaque;                          // front to back
  std::vector<Draw> blended;                         // back to front, one instance a draw
  std::uint64_t triangles = 0;
};

DrawList build_draw_list(const scene::Scene& scene, const GpuScene& gpu_scene,
                         const FrameState& state, const ViewSet& views);

}  // namespace neritic::render
