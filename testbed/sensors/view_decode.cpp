// The images of a view set, from the texels that a frame brought to the host.
#include <cstdint>
#include <future>
#include <span>

#include "testbed/sensors/decode.hpp"
#include "testbed/sensors/lens_arrays.hpp"
#include "testbed/sensors/view_sensor.hpp"

namespace neritic::testbed {
namespace {

template <class T>
std::span<const T> layer_of(const gpu::Buffer& buffer, std::size_t layer, std::size_t elements) {
  return std::span<const T>(buffer.mapped<T>()).subspan(layer * elements, elements);
}

// With fewer pixels a thread costs more than it saves (0.1 ms on the build machine).
constexpr std::size_t kWorthAThread = 1 << 16;

PictureMap picture_map(const ViewImages& eye) {
  return {eye.intrinsics, eye.lens, eye.near_m, eye.width, eye.height};
}

// The linear picture and the raw one, of a camera that names them.
void decode_unencoded(const ViewsWork& work, std::size_t i, std::size_t pixels, ViewImages& eye) {
  const auto texels = layer_of<std::uint64_t>(*work.linear, i, pixels);
  const scene::CameraTerms& terms = work.camera->terms;
  if (terms.linear) decode_linear(texels, eye);
  if (terms.sensor && terms.sensor->bayer != scene::Bayer::kNone)
    decode_raw(texels, *terms.sensor, work.white, eye);
}

ViewImages decode_view(const ViewsWork& work, std::size_t i) {
  const render::ViewDesc& view = work.views.views[i];
  const bool lens = work.camera && work.camera->lens;
  ViewImages eye;
  eye.world_from_view = view.world_from_view;
  eye.intrinsics = intrinsics_of(view.tangents, work.views.width, work.views.height);
  eye.near_m = view.near_m;
  eye.width = work.views.width;
  eye.height = work.views.height;
  // Arrays as the pinhole has them; the picture as the camera delivers it.
  ViewImages pinhole = eye;
  if (work.camera) {
    eye.sensor = work.camera->terms.sensor;
    eye.width = work.camera->width;
    eye.height = work.camera->height;
  }
  if (lens) {
    eye.lens = work.camera->terms.lens;
    eye.intrinsics = work.camera->lens->lens;
  }
  ViewImages& arrays = lens ? pinhole : eye;
  const std::size_t pixels = std::size_t{arrays.width} * arrays.height;
  const std::size_t picture_pixels = std::size_t{eye.width} * eye.height;
  // Two halves of about the same bytes, which share nothing but the sizes.
  const std::span<const float> depth =
      work.depth ? layer_of<float>(*work.depth, i, pixels) : std::span<const float>();
  const auto shape = [&] {
    if (work.capture.depth) decode_depth(depth, arrays);
    if (work.normal)
      decode_normals(layer_of<std::uint32_t>(*work.normal, i, pixels), depth, arrays);
  };
  const auto look = [&] {
    if (work.label)
      decode_labels(layer_of<std::uint32_t>(*work.label, i, pixels), work.capture.labels,
                    work.capture.instances, arrays);
    if (work.color) decode_color(layer_of<std::uint32_t>(*work.color, i, picture_pixels), eye);
    if (work.linear) decode_unencoded(work, i, picture_pixels, eye);
    if (work.motion)
      decode_motion(
          layer_of<float>(*work.motion, i, pixels * 2), depth,
          glm::conjugate(view.next_world_from_view.rotation) * view.world_from_view.rotation,
          arrays);
  };
  if (pixels < kWorthAThread || !(work.depth && (work.color || work.motion))) {
    shape();
    look();
  } else {
    auto other = std::async(std::launch::async, look);
    shape();
    other.get();
  }
  if (lens && work.camera->map)
    arrays_through_lens(pinhole, *eye.lens, *work.camera->lens, *work.camera->map, eye);
  if (!work.boxes.empty()) {
    eye.boxes = work.boxes[i];
    judge_boxes(eye.boxes, picture_map(eye), eye.depth, eye.instances);
  }
  return eye;
}

}  // namespace

std::vector<ViewImages> decode_views(const ViewsWork& work) {
  std::vector<ViewImages> views;
  for (std::size_t i = 0; i < work.views.views.size(); ++i) views.push_back(decode_view(work, i));
  return views;
}

}  // namespace neritic::testbed
