#include "testbed/sensors/sun_maps.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/core/hash.hpp"
#include "engine/graph/access.hpp"
#include "testbed/sensors/view_sensor.hpp"

namespace neritic::testbed {
namespace {

// Texels across below which a thing throws no shadow into a map: the rings of taps blur it away,
// and a school of fish would be drawn once more a map.
constexpr double kLeastCaster_px = 3.0;

// Hash of what a layer shows; never 0.
std::uint64_t content_of(std::uint64_t still, const render::ViewSet& set, double mesh_error_px) {
  const render::ViewDesc& view = set.views.front();
  Hash64 hash;
  hash.add(still);
  hash.add(view.world_from_view);
  hash.add(view.tangents.left);
  hash.add(view.near_m);
  hash.add(mesh_error_px);
  return hash.value() | 1;
}

}  // namespace

Result<graph::ImageHandle> SunMaps::declare(const FrameParts& frame, const std::string& prefix,
                                            ViewsWork& work) {
  NERITIC_CHECK(!work.cascades.empty(), "{}no cascades", prefix);
  Kept& kept = kept_[work.owner];
  const std::uint32_t size = work.cascades.front().width;
  const auto layers = static_cast<std::uint32_t>(work.cascades.size());
  if (!kept.image || kept.image.desc().width != size || kept.image.desc().layers != layers) {
    if (kept.image) frame.device.wait_idle();  // a frame in flight may still read it
    kept.drawn.assign(layers, 0);
    NERITIC_TRY(
        kept.image,
        gpu::Image::create(frame.device,
                           {.name = prefix + "sun shadows",
                            .format = render::kDepthFormat,
                            .width = size,
                            .height = size,
                            .layers = layers,
                            .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                            .array_view = true}));
  }
  const auto draws = [&](std::span<const std::uint8_t> objects) {
    return render::DrawListOptions{.objects = objects,
                                   .mesh_error_px = work.mesh_error_px,
                                   .least_px = work.mesh_error_px > 0.0 ? kLeastCaster_px : 0.0,
                                   .deform_need = &frame.deform_need};
  };
  const std::uint64_t still = frame.light.still_of(frame);
  // Every frame leaves all layers as shading reads them; before the first they have no content.
  const bool fresh = std::ranges::all_of(kept.drawn, [](std::uint64_t d) { return d == 0; });
  const graph::ImageHandle image = frame.graph.import_image(
      kept.image, {.layout = fresh ? VK_IMAGE_LAYOUT_UNDEFINED
                                   : graph::access_info(graph::Access::kSampledCompute).layout});
  graph::ImageHandle maps = image;
  std::vector<render::ViewSet> stale;
  std::vector<std::uint32_t> stale_layers;
  std::vector<std::uint64_t> content;
  for (std::uint32_t i = 0; i < layers; ++i) {
    content.push_back(content_of(still, work.cascades[i], work.mesh_error_px));
    if (kept.drawn[i] == content[i]) continue;
    stale.push_back(work.cascades[i]);
    stale_layers.push_back(i);
  }
  if (!stale.empty()) {
    work.still_maps = render::shadow_maps(frame.scene, frame.gpu_scene, frame.state,
                                          std::move(stale), draws(frame.still));
    for (std::size_t i = 0; i < stale_layers.size(); ++i)
      work.still_maps[i].layer = stale_layers[i];
    NERITIC_TRY(maps, frame.renderer.declare_shadow_maps(
                          frame.graph, prefix + "sun shadows", frame.gpu_scene, frame.deformed,
                          work.still_maps,
                          {.image = image, .drawn = [&kept, content] { kept.drawn = content; }}));
  }
  frame.graph.output(maps, graph::Access::kSampledCompute);
  work.moving_maps = render::shadow_maps(frame.scene, frame.gpu_scene, frame.state, work.cascades,
                                         draws(frame.moving));
  std::erase_if(work.moving_maps,
                [](const render::ShadowMap& map) { return map.draws.opaque.empty(); });
  if (work.moving_maps.empty()) return maps;
  const std::string name = prefix + "moving shadows";
  return frame.renderer.declare_shadow_maps(
      frame.graph, name, frame.gpu_scene, frame.deformed, work.moving_maps,
      {.image =
           render::Renderer::declare_shadow_copy(frame.graph, name + " copy", maps, size, layers),
       .over = true});
}

}  // namespace neritic::testbed
