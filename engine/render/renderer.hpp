// The passes that make pictures, as free-standing declarations on a frame graph: deform, G-buffer
// (full or geometry only), shade, forward, tonemap. Each is declared only if needed: a scene
// without skins has no deform pass, a sonar's view no albedo. Rendering thread only.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/needed_formats.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/render/caustic_waves.hpp"
#include "engine/render/draw_list.hpp"
#include "engine/render/frame_pictures.hpp"
#include "engine/render/shadow_maps.hpp"
#include "engine/render/water_passes.hpp"
#include "shared/camera.h"
#include "shared/exposure.h"
#include "shared/lighting.h"
#include "shared/shafts.h"
#include "shared/skylight.h"
#include "shared/waves.h"

namespace neritic::render {

// Formats of the G-buffer.
inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat kNormalFormat = VK_FORMAT_R16G16_SNORM;  // octahedral, world axes
inline constexpr VkFormat kLabelFormat = VK_FORMAT_R16G16_UINT;    // class, instance
// Square roots of the linear albedo: as even to the eye as sRGB, and a processor writes it for half
// the cost of one.
inline constexpr VkFormat kAlbedoFormat = VK_FORMAT_R8G8B8A8_UNORM;
inline constexpr VkFormat kMaterialFormat =
    VK_FORMAT_R8G8B8A8_UNORM;  // roughness, metal, occlusion, unlit
inline constexpr VkFormat kEmissiveFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kMotionFormat = VK_FORMAT_R32G32_SFLOAT;     // pixels to the next frame
inline constexpr VkFormat kHdrFormat = VK_FORMAT_R16G16B16A16_SFLOAT;  // exposed radiance
inline constexpr VkFormat kColorFormat = VK_FORMAT_R8G8B8A8_UNORM;  // sRGB-encoded by the tonemap

// A device that is chosen has them all, as they are used.
static_assert(gpu::is_needed(kDepthFormat,
                             VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | gpu::kTexture));
static_assert(gpu::is_needed(kNormalFormat, gpu::kColorTarget | gpu::kTexture));
static_assert(gpu::is_needed(kLabelFormat, gpu::kColorTarget | gpu::kTexture));
static_assert(gpu::is_needed(kAlbedoFormat, gpu::kColorTarget | gpu::kTexture));
static_assert(gpu::is_needed(kMaterialFormat, gpu::kColorTarget | gpu::kTexture));
static_assert(gpu::is_needed(kEmissiveFormat, gpu::kColorTarget | gpu::kTexture));
static_assert(gpu::is_needed(kMotionFormat, gpu::kColorTarget));
static_assert(gpu::is_needed(kHdrFormat, gpu::kColorTarget | gpu::kTexture | gpu::kStorageImage |
                                             VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
                                             VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT));
static_assert(gpu::is_needed(kColorFormat, gpu::kTexture | gpu::kStorageImage));

// Images of one view set; absent ones are empty handles.
struct GBuffer {
  graph::ImageHandle depth, normal, label;                // always
  graph::ImageHandle albedo, material, emissive, motion;  // as asked for
  std::uint32_t width = 0, height = 0, layers = 1;
};

// Vertices of this frame's skinned and morphed primitives; empty handles where there are none.
struct DeformedGeometry {
  graph::BufferHandle positions, next_positions;
};

// Inputs of light shafts: the sun's maps and the caustics, either of which may be empty.
struct ShaftInputs {
  shared::VisibilityParams sun{};
  std::uint32_t cascade_count = 0;
  graph::ImageHandle cascades, caustics;
  shared::ShaftParams params{};
  std::uint32_t samples = 1;  // along a sight
};

// Inputs of skylight: its grid's cells as floats (engine/render/skylight.hpp), and where they lie.
struct SkylightInputs {
  const gpu::Buffer* grid = nullptr;
  shared::SkylightParams params{};
  std::uint32_t samples = 1;  // along a sight
};

// Images of what stands in the light's way to the surfaces of one view set. A handle is empty where
// the scene does not name the term.
struct LightImages {
  graph::ImageHandle seen;  // of sun, sky and surroundings (shaders/visibility.comp)
  graph::ImageHandle caustics;
  graph::ImageHandle shafts;                // of the sun's light in the water (shaders/shafts.comp)
  std::optional<ShaftInputs> shaft_inputs;  // where there are shafts: what lights particles too
  graph::ImageHandle skylight;              // of the light from above (shaders/skylight.comp)
  graph::ImageHandle lamp_maps;
  shared::LampShadows lamp_shadows{};  // of lamp_maps
};

// Inputs of shading. An effect that shading uses adds its image here as a handle that may be
// empty, as GBuffer::emissive is: an empty handle is not declared, and its bit in Lighting::terms
// is 0.
struct ShadeInputs {
  const GBuffer& gbuffer;  // of kind kSurface
  const ViewSet& views;
  const shared::Lighting& lighting;
  LightImages light = {};
  // Gets what forward scatter spreads, where the term kLightForwardScatter is on.
  graph::ImageHandle* scattered = nullptr;
  const shared::Waves* waves = nullptr;  // with the term kLightWaves
  std::uint32_t visibility_step = 2;     // of light.seen
  std::uint32_t inscatter_samples = 4;   // of a lamp's beam along a sight
};

// Where depth maps of lights are drawn: into layers of an image that is there, over what it has or
// over nothing.
struct ShadowTarget {
  graph::ImageHandle image;  // all layers; empty: a new one, with as many layers as maps
  bool over = false;
  std::function<void()> drawn;  // called once the maps are recorded; may be empty
};

// Constants that the shader of visibility_ is compiled with.
struct VisibilityKnobs {
  std::uint32_t cascades = 0;        // 0: no shadows
  std::uint32_t shadow_samples = 9;  // rings of taps
  std::uint32_t occlusion_taps = 0;  // 0: none
  std::uint32_t step = 2;            // pixels of the picture to one of visibility, a side
  auto operator<=>(const VisibilityKnobs&) const = default;
};

enum class GBufferKind {
  kGeometry,  // depth, normal, label: a sonar's
  kShape,     // the same as kSurface has, bit for bit, and motion: a camera's without a picture
  kSurface,   // and what shading needs: a camera's
};

// The images that are kept of a geometry or shape G-buffer beside its depth. The rest has no image.
struct GBufferParts {
  bool normal = true, label = true;
  auto operator<=>(const GBufferParts&) const = default;
};

class Renderer {
 public:
  static Result<std::unique_ptr<Renderer>> create(gpu::Device& device);

  VkDescriptorSetLayout material_layout() const { return material_layout_.handle(); }

  // Each declares its pass under a name that starts with prefix. References must live until the
  // graph has run. Errors: a pipeline cannot be made.
  // need: how many vertices of each job are drawn, complete when the graph runs; nullptr: all.
  Result<DeformedGeometry> declare_deform(graph::FrameGraph& graph, const GpuScene& scene,
                                          const FrameState& state,
                                          const std::vector<std::uint32_t>* need = nullptr);
  // pictures: the scene's, which surface G-buffers show; nullptr: it has none.
  Result<GBuffer> declare_gbuffer(graph::FrameGraph& graph, const std::string& prefix,
                                  GBufferKind kind, const GpuScene& scene, const FrameState& state,
                                  const DeformedGeometry& deformed, const ViewSet& views,
                                  const DrawList& draws, const GBufferParts& parts = {},
                                  FramePictures* pictures = nullptr);
  // Depth maps as lights see the scene, a layer each: R32's reversed depth, as a G-buffer's.
  Result<graph::ImageHandle> declare_shadow_maps(graph::FrameGraph& graph, const std::string& name,
                                                 const GpuScene& scene,
                                                 const DeformedGeometry& deformed,
                                                 const std::vector<ShadowMap>& maps,
                                                 const ShadowTarget& target = {});
  // A copy of depth maps, to draw over.
  static graph::ImageHandle declare_shadow_copy(graph::FrameGraph& graph, const std::string& name,
                                                graph::ImageHandle maps, std::uint32_t size,
                                                std::uint32_t layers);
  // The share of sun, sky and surroundings that surfaces see, by the sun's maps (an empty handle:
  // no shadows) and by ambient occlusion.
  Result<graph::ImageHandle> declare_visibility(graph::FrameGraph& graph, const std::string& prefix,
                                                const GBuffer& gbuffer, const ViewSet& views,
                                                const shared::VisibilityParams& params,
                                                graph::ImageHandle cascades,
                                                const VisibilityKnobs& knobs);
  // Light under waves on levels below a tile of the surface; once a frame and size. Which levels
  // may change until the graph runs.
  Result<graph::ImageHandle> declare_caustics(graph::FrameGraph& graph,
                                              const shared::CausticsParams& params,
                                              const std::string& name = "caustics");
  // How much of the sun's light gets to the water along sights, a pixel of every kShaftStep.
  Result<graph::ImageHandle> declare_shafts(graph::FrameGraph& graph, const std::string& prefix,
                                            const GBuffer& gbuffer, const ViewSet& views,
                                            const shared::Lighting& lighting,
                                            const ShaftInputs& inputs);
  // How much of the light from above still things let through to sights and their ends, a pixel of
  // every kSkylightStep.
  Result<graph::ImageHandle> declare_skylight(graph::FrameGraph& graph, const std::string& prefix,
                                              const GBuffer& gbuffer, const ViewSet& views,
                                              const shared::Lighting& lighting,
                                              const SkylightInputs& inputs);
  // HDR picture of a surface G-buffer.
  Result<graph::ImageHandle> declare_shade(graph::FrameGraph& graph, const std::string& prefix,
                                           const ShadeInputs& inputs);
  // Blended materials over the HDR picture; only declared where the draw list has some.
  Result<graph::ImageHandle> declare_forward(
      graph::FrameGraph& graph, const std::string& prefix, graph::ImageHandle hdr,
      const GBuffer& gbuffer, const GpuScene& scene, const DeformedGeometry& deformed,
      const ViewSet& views, const DrawList& draws, const shared::Lighting& lighting,
      std::uint32_t inscatter_samples = 4, FramePictures* pictures = nullptr);
  // The passes of the scene's water, between forward and the display picture.
  WaterPasses& water() { return water_; }
  // An HDR picture of fewer pixels: each is the mean of a square of `side` by `side` (2 to 4).
  Result<graph::ImageHandle> declare_average(graph::FrameGraph& graph, const std::string& prefix,
                                             graph::ImageHandle hdr, std::uint32_t side,
                                             std::uint32_t width, std::uint32_t height,
                                             std::uint32_t layers);
  // A display picture of another size: between its four nearest pixels.
  Result<graph::ImageHandle> declare_resize(graph::FrameGraph& graph, const std::string& prefix,
                                            graph::ImageHandle color, std::uint32_t width,
                                            std::uint32_t height, std::uint32_t layers);
  // Depth of field of the picture, by the G-buffer's depth; motion blur and rolling shutter, by its
  // motion.
  Result<graph::ImageHandle> declare_focus(graph::FrameGraph& graph, const std::string& prefix,
                                           graph::ImageHandle hdr, const GBuffer& gbuffer,
                                           const shared::FocusParams& params);
  Result<graph::ImageHandle> declare_shutter(graph::FrameGraph& graph, const std::string& prefix,
                                             graph::ImageHandle hdr, const GBuffer& gbuffer,
                                             const shared::ShutterParams& params);
  // The G-buffer with its albedo as reflectances of the three thirds of the spectrum
  // (engine/render/bands.hpp); and pictures of three bands each, joined by the camera's response.
  Result<GBuffer> declare_band_albedo(graph::FrameGraph& graph, const std::string& prefix,
                                      const GBuffer& gbuffer, const Mat3& bands_from_rgb);
  Result<graph::ImageHandle> declare_merge(graph::FrameGraph& graph, const std::string& prefix,
                                           const std::vector<graph::ImageHandle>& bands,
                                           const std::vector<Mat3>& rgb_from_bands,
                                           const GBuffer& gbuffer);
  // Applies a lens and an image sensor to the picture, for as many pixels as the camera has.
  // terms: kCamera... bits.
  Result<graph::ImageHandle> declare_camera(graph::FrameGraph& graph, const std::string& prefix,
                                            graph::ImageHandle hdr,
                                            const shared::CameraParams& params, std::uint32_t terms,
                                            std::uint32_t width, std::uint32_t height,
                                            std::uint32_t layers);
  // Display picture, kColorFormat: tonemap and, where asked for, antialias, which smooths edges.
  Result<graph::ImageHandle> declare_picture(graph::FrameGraph& graph, const std::string& prefix,
                                             graph::ImageHandle hdr, std::uint32_t width,
                                             std::uint32_t height, std::uint32_t layers,
                                             bool antialias);

  // The depth of a set's hidden triangles, nearest of all, before its G-buffer. Empty: it has none.
  Result<graph::ImageHandle> declare_hidden(graph::FrameGraph& graph, const std::string& prefix,
                                            const ViewSet& views);

 private:
  // A pass that turns one picture into another.
  struct PictureFilter {
    const char* name;    // of the pass
    const char* result;  // of the image
    std::span<const std::uint32_t> code;
    std::vector<gpu::SpecConstant> constants;
    std::uint32_t block = 1;         // pixels of the result a side to an invocation
    VkFormat format = kColorFormat;  // of the result
  };
  Result<graph::ImageHandle> declare_filter(graph::FrameGraph& graph, const std::string& prefix,
                                            const PictureFilter& filter, gpu::Pipeline& pipeline,
                                            graph::ImageHandle in, std::uint32_t width,
                                            std::uint32_t height, std::uint32_t layers);
  // The mean of each 4 x 4 pixels of an image of shares, whose alpha tells distances.
  Result<graph::ImageHandle> declare_visibility_blur(graph::FrameGraph& graph,
                                                     const std::string& name, graph::ImageHandle in,
                                                     std::uint32_t width, std::uint32_t height,
                                                     std::uint32_t layers);
  // A pass of focus or shutter: images, each at its binding, and numbers make another image.
  struct ExposurePass {
    const char* name;    // of the pass
    const char* result;  // of the image
    std::span<const std::uint32_t> code;
    std::vector<std::pair<std::uint32_t, graph::ImageHandle>> reads;
    graph::TransientImage out;
    std::uint32_t width, height;  // invocations
  };
  template <class Params>
  Result<graph::ImageHandle> declare_exposure(graph::FrameGraph& graph, const std::string& prefix,
                                              const ExposurePass& exposure, gpu::Pipeline& pipeline,
                                              const Params& params);
  // Sorts the tiles of a picture of one layer for shading.
  Result<graph::BufferHandle> declare_shade_tiles(graph::FrameGraph& graph,
                                                  const std::string& prefix, const GBuffer& gbuffer,
                                                  const shared::ShadeTilesPush& push);
  enum class RasterStage { kDepth, kGeometry, kGeometryMasked, kShape, kSurface, kForward };
  // The forward stage's shader is compiled with these: the terms of light, the number of lamps,
  // samples of inscatter. Other stages have none of them.
  struct ForwardLight {
    std::uint32_t terms = 0, lamps = 0, inscatter_samples = 0;
    auto operator<=>(const ForwardLight&) const = default;
  };
  // stage, topology, motion, emissive, clipped, view mask, the material's flags, parts.
  using RasterKey = std::tuple<RasterStage, VkPrimitiveTopology, bool, bool, bool, std::uint32_t,
                               std::uint32_t, GBufferParts, ForwardLight>;
  explicit Renderer(gpu::Device& device) : device_(device), water_(device) {}
  Result<const gpu::Pipeline*> raster_pipeline(const RasterKey& key);
  // The pipelines that a list of draws needs, made before the pass records.
  struct PreparedDraws;
  struct MaskedDraws;
  // This frame's instances; next is the same as now where there is no motion, drawn where each is
  // drawn as it is.
  struct InstanceStreams {
    gpu::UploadSlice now, next, drawn;
  };
  static InstanceStreams upload_instances(gpu::Commands& commands, const DrawList& draws,
                                          bool motion);
  // emissive: the draws that glow, else those that do not (of a surface G-buffer).
  Result<PreparedDraws> prepare(const GpuScene& scene, const DrawList& list,
                                const std::vector<Draw>& draws, GBufferKind kind, bool forward,
                                bool motion, bool emissive, std::uint32_t view_mask,
                                const GBufferParts& parts, const ForwardLight& light);
  // Images of the changing pictures that a list of draws shows.
  static std::vector<graph::ImageHandle> pictures_in(const GpuScene& scene,
                                                     const std::vector<Draw>& draws,
                                                     FramePictures* pictures);
  // Objects that draw passes borrow until the graph has run.
  struct RasterInputs {
    const GpuScene& scene;
    const ViewSet& views;
    const DrawList& draws;
    DeformedGeometry deformed;
  };
  // load: of all images but the emission's, which is cleared.
  struct GBufferLoads {
    VkAttachmentLoadOp colors, depth;
  };
  Result<const gpu::Pipeline*> hidden_pipeline(std::uint32_t view_mask);
  void record_gbuffer(const GBuffer& gbuffer, GBufferLoads loads,
                      std::span<const MaskedDraws> masked, const RasterInputs& inputs,
                      graph::PassContext& context) const;
  static void record_draws(const PreparedDraws& prepared, const GpuScene& scene,
                           const gpu::Buffer* deformed, const InstanceStreams& instances,
                           const Vec2f& target_size, std::span<const gpu::BoundResource> set0,
                           gpu::Commands& commands);

  gpu::Device& device_;
  WaterPasses water_;
  gpu::SetLayout material_layout_;
  std::map<RasterKey, gpu::Pipeline> raster_;
  // By terms, number of lamps, visibility's step, inscatter's samples, whether the sea is seen.
  std::map<std::array<std::uint32_t, 5>, gpu::Pipeline> shade_;
  std::map<VisibilityKnobs, gpu::Pipeline> visibility_;
  gpu::Pipeline visibility_blur_, caustics_, caustics_resolve_, shade_tiles_;
  // By terms and number of the sun's maps.
  std::map<std::array<std::uint32_t, 3>, gpu::Pipeline> shafts_;
  std::map<std::array<std::uint32_t, 2>, gpu::Pipeline> skylight_;  // by terms and samples
  gpu::Pipeline shafts_blur_, focus_, shutter_, shutter_tiles_, shutter_reach_;
  gpu::Pipeline band_albedo_;
  std::map<std::uint32_t, gpu::Pipeline> merge_;             // by pictures
  std::map<std::uint32_t, gpu::Pipeline> average_;           // by pixels a side
  std::map<std::uint32_t, gpu::Pipeline> camera_;            // by terms
  gpu::Sampler tile_sampler_;                                // linear, repeating
  std::map<std::uint32_t, gpu::Pipeline> hidden_pipelines_;  // by view mask
  gpu::Pipeline deform_, tonemap_, tonemap_luma_, antialias_, resize_;
  // Bound where a shader declares a buffer that this frame does not use: one to read, one to write,
  // since what is bound counts as read or written.
  gpu::Buffer nothing_, nowhere_;
};

}  // namespace neritic::render
