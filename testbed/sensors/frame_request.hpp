// One frame of a scene: which sensors and views, at what time, and what of each is wanted. Plain
// values; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/render/views.hpp"
#include "engine/scene/motion.hpp"
#include "engine/scene/object_pictures.hpp"

namespace neritic::testbed {

// Data whose flag is false is neither computed nor allocated.
struct Capture {
  bool color = true;  // of cameras and view sets
  // For cameras, view sets and sonars.
  bool depth = true, normals = true, labels = true, instances = true;
  bool motion = true;  // of cameras and view sets
  bool echoes = true;  // of sonars; without them a sonar's view gives its geometry alone
  bool poses = false;  // of every participant (participants.hpp)
  bool linear = true;  // of cameras that name them: the linear picture, and the raw one
  bool boxes = false;  // of cameras: of each instance; with depth and instances
  // Read-backs are declared, so that the frame can be read to a FrameResult. Else the frame's
  // handles are all there is, and nothing leaves the GPU.
  bool to_host = true;

  constexpr bool geometry() const { return depth || normals || labels || instances; }
  constexpr Capture without_geometry() const {
    Capture out = *this;
    out.depth = out.normals = out.labels = out.instances = false;
    return out;
  }
};
// Colour for passes that draw with it, nothing at the host: what a window asks for.
inline constexpr Capture kColorOnGpu =
    Capture{.color = true, .motion = false, .to_host = false}.without_geometry();

// A camera's terms beyond a pinhole.
struct CameraPicture {
  scene::CameraTerms terms;
  std::optional<scene::LensView> lens;  // with terms.lens: then the views are its pinhole's
  std::uint32_t width = 1, height = 1;  // of the picture
  double focal_px = 1.0;
  std::uint32_t stream = 0;                      // of its noise: the camera's number
  const std::vector<glm::dvec2>* map = nullptr;  // lens_map(), where arrays come to the host
};

// Terms that a view set does without, whatever its detail says: what a governor gives up on a
// machine that is too slow. No camera's file names these.
struct Thrift {
  bool forward_scatter = true;  // false: far outlines stay sharp
  double spot_px = 0.0;         // render::view_particles
  double mesh_error_px = 0.0;   // meshes may differ by at least so many pixels; not in shadows
};

// A view set that is no camera of the scene: a window's, a headset's views, the sides of a cube.
// One multiview pass draws all its views.
struct ViewsRequest {
  std::string name;  // of its passes; no sensor's or other view set's of the same frame
  render::ViewSet views;
  scene::Exposure exposure;
  bool antialias = false;
  scene::PictureDetail detail = {};  // what the camera's file says, or a governor
  Capture capture = kColorOnGpu;
  std::optional<CameraPicture> camera = {};  // absent: a pinhole's
  Thrift thrift = {};
  // One particle of each kind that the scene's water may show at any time, clear: for a picture
  // that makes a driver compile.
  bool each_particle = false;
};

struct FrameRequest {
  double time_s = 0.0;
  double next_time_s = 1.0 / 30.0;  // motion leads there
  std::uint32_t frame = 0;
  std::vector<std::size_t> cameras, sonars;  // indices into the scene's
  // The number of each sonar's ping: noise and a scanner's step follow from it. Empty: all are the
  // frame-th.
  std::vector<std::uint32_t> pings;
  // The seed of the sonars' noise and speckle; absent: the scene's.
  std::optional<std::uint64_t> seed = {};
  Capture capture;  // of cameras and sonars; poses
  // The capture of each camera and sonar, where they differ. Empty: all have `capture`.
  std::vector<Capture> camera_captures, sonar_captures;
  std::vector<ViewsRequest> views;
  // Moves some objects instead of their tracks and clips; nullptr: none.
  const scene::SimulatedMotion* simulated = nullptr;
  // The pictures that objects show, at the places that the session was created with; nullptr: it
  // has none, or they stay as they are.
  scene::ObjectPictures* pictures = nullptr;

  // By place in cameras and sonars.
  const Capture& camera_capture(std::size_t i) const {
    return camera_captures.empty() ? capture : camera_captures[i];
  }
  const Capture& sonar_capture(std::size_t i) const {
    return sonar_captures.empty() ? capture : sonar_captures[i];
  }
  // Whether a picture leads to the next frame.
  bool wants_motion() const;
};

inline bool FrameRequest::wants_motion() const {
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (camera_capture(i).motion) return true;
  for (const ViewsRequest& set : views)
    if (set.capture.motion) return true;
  return false;
}

}  // namespace neritic::testbed
