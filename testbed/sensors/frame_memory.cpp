#include "testbed/sensors/frame_memory.hpp"

#include <algorithm>

#include "engine/core/memory.hpp"

namespace neritic::testbed {
namespace {

struct Picture {
  std::string name;
  std::uint32_t width = 1, height = 1, views = 1;
  Capture capture;
  std::uint64_t pixels() const { return std::uint64_t{width} * height; }
};

std::vector<Picture> pictures_of(const scene::Scene& scene, const FrameRequest& request) {
  std::vector<Picture> pictures;
  for (std::size_t i = 0; i < request.cameras.size(); ++i) {
    const scene::Camera& camera = scene.cameras[request.cameras[i]];
    pictures.push_back({"camera " + camera.name, camera.width, camera.height,
                        camera.stereo_baseline_m > 0.0 ? 2u : 1u, request.camera_capture(i)});
  }
  for (const ViewsRequest& set : request.views)
    pictures.push_back(
        {"views " + set.name, set.views.width, set.views.height, set.views.layers(), set.capture});
  return pictures;
}

}  // namespace

std::uint64_t host_bytes(const gpu::Device& device, const scene::Scene& scene,
                         const FrameRequest& request) {
  // Measured, a pixel: the device's images and read-backs; the host's arrays and their files.
  constexpr std::uint64_t kDevice_bytes = 36;
  std::uint64_t bytes = 0;
  for (const Picture& picture : pictures_of(scene, request)) {
    const Capture& capture = picture.capture;
    const std::uint64_t at_host = capture.color * 16 + capture.depth * 8 + capture.normals * 24 +
                                  capture.labels * 4 + capture.instances * 4 + capture.motion * 16;
    bytes += picture.pixels() * picture.views *
             ((device.info().kind == "CPU" ? kDevice_bytes : 0) + (capture.to_host ? at_host : 0));
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
