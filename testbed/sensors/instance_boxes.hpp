// Boxes of what a camera sees, in three dimensions and in its picture, by the vertices as they are
// drawn. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/intrinsics.hpp"
#include "engine/core/math.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::render {
struct FrameState;
}

namespace neritic::testbed {

struct PixelBox {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;  // edges, pixels
  double area() const {
    return right > left && bottom > top ? (right - left) * (bottom - top) : 0.0;
  }
};

// One object, or one of its copies.
struct InstanceBox {
  std::uint16_t class_id = 0, instance = 0;
  std::string object;  // its name
  // About the axes of the object: the tightest box there; its middle, and its sides along x, y, z.
  Pose world_from_box;
  Vec3 size_m{0.0};
  // About the view's y axis, its z along the heading (-z) of the object: KITTI's kind. View axes.
  Vec3 upright_middle_m{0.0}, upright_size_m{0.0};
  double upright_yaw_rad = 0.0;  // of the heading about the view's y: 0 looks along the view's -z
  PixelBox whole;                // as if nothing stood before it, beyond the picture's edges too
  PixelBox seen;                 // of its visible pixels
  std::uint32_t seen_px = 0;
  double truncated = 0.0;     // share of `whole` outside of the picture
  double occluded = 0.0;      // share of its surface in the picture that something else hides
  std::vector<Vec3f> points;  // of that surface, even over the picture; view axes
};

// How points in view axes come into the picture.
struct PictureMap {
  Intrinsics intrinsics;
  std::optional<scene::Lens> lens;
  double near_m = 0.05;
  std::uint32_t width = 1, height = 1;
  glm::dvec2 pixel_of(const Vec3& view_m) const;  // of a point ahead
};

// Boxes of everything that has a class and can be in the picture. The fields that only pixels tell
// stay empty.
std::vector<InstanceBox> instance_boxes(const scene::Scene& scene, const render::FrameState& state,
                                        const Pose& world_from_view, const PictureMap& map);
// Adds what pixels tell, and drops the boxes of which no pixel is seen.
void judge_boxes(std::vector<InstanceBox>& boxes, const PictureMap& map, const ImageF32& depth,
                 const ImageU16& instances);

}  // namespace neritic::testbed
