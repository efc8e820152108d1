#include "testbed/sensors/frame_memory.hpp"

#include <algorithm>

#include "engine/core/memory.hpp"
#include "shared/caustics.h"
#include "testbed/sensors/session.hpp"

namespace neritic::testbed {
namespace {

struct Picture {
  std::string name;
  std::uint32_t width = 1, height = 1, views = 1;
  Capture capture;
  scene::PictureDetail detail;
  std::uint64_t pixels() const { return std::uint64_t{width} * height; }
};

std::vector<Picture> pictures_of(const scene::Scene& scene, const FrameRequest& request) {
  std::vector<Picture> pictures;
  for (std::size_t i = 0; i < request.cameras.size(); ++i) {
    const scene::Camera& camera = scene.cameras[request.cameras[i]];
    const auto lens = lens_view_of(camera);
    pictures.push_back({"camera " + camera.name, lens ? lens->width : camera.width,
                        lens ? lens->height : camera.height,
                        camera.stereo_baseline_m > 0.0 ? 2u : 1u, request.camera_capture(i),
                        camera.detail});
  }
  for (const ViewsRequest& set : request.views)
    pictures.push_back({"views " + set.name, set.views.width, set.views.height, set.views.layers(),
                        set.capture, set.detail});
  return pictures;
}

// The sun's maps of a picture are held twice where something moves over the kept ones.
std::uint64_t sun_map_bytes(const scene::Scene& scene, const Picture& picture) {
  if (!picture.capture.color || !scene.sun || !scene.sun->shadows) return 0;
  const double side = scene.sun->shadows->size * picture.detail.shadow_size;
  const auto layers = std::min(scene.sun->shadows->cascades, picture.detail.cascades);
  return static_cast<std::uint64_t>(2.0 * 4.0 * side * side) * layers;
}

// A pixel's, of what the scene's terms add: visibility, what forward scatter spreads.
std::uint64_t term_bytes(const scene::Scene& scene) {
  std::uint64_t bytes = 0;
  if ((scene.sun && scene.sun->shadows) || (scene.ambient && scene.ambient->occlusion_m > 0.0))
    bytes += 8;
  if (scene.ambient && scene.ambient->skylight) bytes += 1;
  if (scene.water && scene.water->forward_scatter) bytes += 9;
  return bytes;
}

// All pictures share the lamps' maps and the caustics' tile.
std::uint64_t shared_light_bytes(const scene::Scene& scene) {
  std::uint64_t bytes = 0, lamps = 0, side = 0;
  for (const scene::Lamp& lamp : scene.lamps) {
    if (!lamp.shadows) continue;
    ++lamps;
    side = std::max<std::uint64_t>(side, lamp.shadow_size);
  }
  bytes += lamps * 4 * side * side;
  if (scene.sun && scene.sun->caustics) {
    const std::uint64_t texels = scene.sun->caustics->texels;
    // Sums of all levels, and layers of halves.
    bytes += texels * texels * (4 * shared::kCausticLevels + 8 * shared::kCausticLayers);
  }
  // The grid at the host and at the device, and what light goes through while it is made.
  if (scene.ambient && scene.ambient->skylight) {
    const auto [nx, ny, nz] = scene::cells_of(*scene.ambient->skylight);
    bytes += std::uint64_t{20} * nx * ny * nz;
  }
  return bytes;
}

}  // namespace

std::uint64_t host_bytes(const gpu::Device& device, const scene::Scene& scene,
                         const FrameRequest& request) {
  // Measured, a pixel: the device's images and read-backs; the host's arrays and their files.
  constexpr std::uint64_t kDevice_bytes = 36;
  const bool on_cpu = device.info().kind == "CPU";
  std::uint64_t bytes = on_cpu ? shared_light_bytes(scene) : 0;
  for (const Picture& picture : pictures_of(scene, request)) {
    if (on_cpu) bytes += sun_map_bytes(scene, picture);
    const Capture& capture = picture.capture;
    const std::uint64_t at_host = capture.color * 16 + capture.depth * 8 + capture.normals * 24 +
                                  capture.labels * 4 + capture.instances * 4 + capture.motion * 16;
    // A picture of averaged pixels is shaded in more of them.
    const double fine = capture.color ? std::max(picture.detail.resolution, 1.0) : 1.0;
    const double on_device =
        on_cpu ? fine * fine * double(kDevice_bytes + (capture.color ? term_bytes(scene) : 0))
               : 0.0;
    bytes += picture.pixels() * picture.views *
             (static_cast<std::uint64_t>(on_device) + (capture.to_host ? at_host : 0));
  }
  return bytes;
}

Status check_room(std::uint64_t bytes) {
  const std::uint64_t available = available_memory_bytes();
  if (available == 0 || bytes <= available) return {};
  return failure(ErrorCode::kOutOfMemory, "{:.1f} GB are needed, the machine has {:.1f} left",
                 double(bytes) * 1e-9, double(available) * 1e-9);
}

Error advised(const Error& error, const scene::Scene& scene, const FrameRequest& request) {
  const std::vector<Picture> pictures = pictures_of(scene, request);
  if (error.code != ErrorCode::kOutOfMemory || pictures.empty()) return error;
  const Picture& largest = *std::ranges::max_element(pictures, {}, &Picture::pixels);
  const std::size_t others = pictures.size() + request.sonars.size() - 1;
  return failure(error.code,
                 "{} of {}x{}{}: too large for this device: {}; a smaller size{} will do",
                 largest.name, largest.width, largest.height,
                 others > 0 ? fmt::format(" (and {} more sensors in the frame)", others) : "",
                 error.message, others > 0 ? " or fewer sensors at once" : "");
}

}  // namespace neritic::testbed
