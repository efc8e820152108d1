// Draws with their pipelines looked up, ready to record. Private to the renderer.
#pragma once

#include <vector>

#include "engine/render/renderer.hpp"

namespace neritic::render {

struct PreparedDraw {
  Draw draw;
  const gpu::Pipeline* pipeline = nullptr;
  bool surface = false;     // uses stream 1, the material and push constants
  bool both_sides = false;  // no face culling
  const GpuMaterial* material = nullptr;
};

struct Renderer::PreparedDraws {
  std::vector<PreparedDraw> draws;
};

// The draws of one rendering, which shows the views of its mask.
struct Renderer::MaskedDraws {
  std::uint32_t view_mask = 0;
  PreparedDraws prepared;
};

}  // namespace neritic::render
