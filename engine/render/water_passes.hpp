// The passes of a scene's water beside shading: forward scatter and particles. Each is declared
// only where the scene names it. Pipelines are created at first use. Rendering thread only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/render/views.hpp"
#include "engine/scene/scene_water.hpp"
#include "shared/forward_scatter.h"
#include "shared/lighting.h"
#include "shared/shimmer.h"

namespace neritic::render {

struct GBuffer;
struct ShaftInputs;
struct ViewParticles;

class WaterPasses {
 public:
  explicit WaterPasses(gpu::Device& device) : device_(device) {}

  // The picture with the light that water scatters forwards. scattered: what shading wrote beside
  // hdr.
  Result<graph::ImageHandle> declare_forward_scatter(
      graph::FrameGraph& graph, const std::string& prefix, graph::ImageHandle hdr,
      graph::ImageHandle scattered, const GBuffer& gbuffer, const ViewSet& views,
      const shared::Lighting& lighting, const scene::ForwardScatter& settings);
  // The picture behind layers of water that bend sight (shared/shimmer.h). Only where the scene's
  // column has layers.
  Result<graph::ImageHandle> declare_shimmer(graph::FrameGraph& graph, const std::string& prefix,
                                             graph::ImageHandle hdr, const GBuffer& gbuffer,
                                             const ViewSet& views, const WaterColumn& column,
                                             double time_s, std::uint64_t seed);
  // Particles over the picture, in their order. They must live until the graph has run. Makes the
  // pipelines of all their kinds, so that no later frame waits for one. shutter: share of the time
  // to the next frame that the exposure lasts. shafts: of the sun's light, which particles then
  // stand in; nullptr: none.
  Result<graph::ImageHandle> declare_particles(graph::FrameGraph& graph, const std::string& prefix,
                                               graph::ImageHandle hdr, const GBuffer& gbuffer,
                                               const ViewSet& views,
                                               const shared::Lighting& lighting,
                                               const ViewParticles& particles, float shutter,
                                               const ShaftInputs* shafts = nullptr);

 private:
  Status make_particle_pipeline(std::uint32_t view_mask, std::uint32_t kind,
                                const ShaftInputs* shafts);

  gpu::Device& device_;
  gpu::Pipeline scatter_first_, scatter_down_, scatter_up_, scatter_add_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, gpu::Pipeline> shimmer_;  // layers, waves
  std::map<std::uint32_t, gpu::Pipeline> particles_;  // by view mask, kind and light
  gpu::Sampler tile_sampler_;                         // linear, repeating; with shafts
};

// The column's transitions as a view about the origin sees them at a time. The waves are a sum of
// kShimmerWaves sines of even slopes, lengths spread evenly in the logarithm, drawn from the seed.
shared::ShimmerParams shimmer_params(const WaterColumn& column, const Vec3& origin_m, double time_s,
                                     std::uint64_t seed);
// Angular frequency of a wave of this number on the transition below `above`, 1/s: between two
// still waters (Lamb, "Hydrodynamics", art. 231), slowed where the transition is thick: no wave
// swings faster than the buoyancy frequency (Phillips 1977, section 5.2, the limits joined).
double internal_wave_s(const SeaWater& above, const WaterLayer& layer, double number_m);

// A level of the forward scatter's pyramid: its size, and its octave in cycles a radian.
struct ScatterLevel {
  std::uint32_t width = 1, height = 1;
  shared::ScatterPush push{};
};
// From the finest to the coarsest, as many as the picture has room for, at most settings.levels.
std::vector<ScatterLevel> scatter_levels(const scene::ForwardScatter& settings,
                                         const shared::Lighting& lighting, std::uint32_t width,
                                         std::uint32_t height, double pixels_rad);

}  // namespace neritic::render
