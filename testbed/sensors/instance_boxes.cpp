#include "testbed/sensors/instance_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "engine/render/frame_state.hpp"

namespace neritic::testbed {
namespace {

constexpr std::size_t kMostPoints = 256;
// A surface point is hidden where something else is nearer by more than this.
constexpr double kHidden_m = 0.05;

// The vertices of a model as it is drawn in that pose, model's frame.
std::vector<Vec3> model_points(const scene::Model& model, const scene::ModelPose& pose) {
  std::vector<Vec3> out;
  const std::function<void(int)> add = [&](int index) {
    const scene::Node& node = model.nodes[static_cast<std::size_t>(index)];
    for (const int child : node.children) add(child);
    if (node.mesh < 0) return;
    const std::vector<float>& weights = pose.morph_weights[static_cast<std::size_t>(index)];
    std::vector<Mat4> joints;
    if (node.skin >= 0) joints = scene::joint_matrices(model, pose, node.skin);
    std::vector<Mat4> places{Mat4(1.0)};
    if (!node.instances.empty() && joints.empty()) places = node.instances;
    for (const scene::Primitive& part :
         model.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
      const bool skinned = !joints.empty() && !part.joints.empty();
      for (std::size_t v = 0; v < part.positions.size(); ++v) {
        Vec3 at(part.positions[v]);
        for (std::size_t t = 0; t < part.targets.size() && t < weights.size(); ++t)
          if (v < part.targets[t].positions.size())
            at += double(weights[t]) * Vec3(part.targets[t].positions[v]);
        if (skinned) {
          Vec4 sum(0.0);
          for (int j = 0; j < 4; ++j)
            sum += double(part.weights[v][j]) *
                   (joints[part.joints[v][static_cast<std::size_t>(j)]] * Vec4(at, 1.0));
          out.push_back(Vec3(sum));
        } else {
          for (const Mat4& place : places)
            out.push_back(Vec3(pose.model_from_node[static_cast<std::size_t>(index)] * place *
                               Vec4(at, 1.0)));
        }
      }
    }
  };
  for (const int root : model.roots) add(root);
  return out;
}

scene::Bounds bounds_of(const std::vector<Vec3>& points) {
  scene::Bounds bounds;
  for (const Vec3& p : points) bounds.add(p);
  return bounds;
}

// Whether the box can be seen: some corner is ahead, and not all are beyond the same edge.
bool may_be_seen(const scene::Bounds& box, const Mat4& view_from_model, const PictureMap& map) {
  int behind = 0, left = 0, right = 0, above = 0, below = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                      i & 4 ? box.max.z : box.min.z);
    const Vec3 p(view_from_model * Vec4(corner, 1.0));
    if (!(-p.z > map.near_m)) {
      ++behind;
      continue;
    }
    const glm::dvec2 at = map.pixel_of(p);
    left += at.x < 0.0;
    right += at.x > map.width;
    above += at.y < 0.0;
    below += at.y > map.height;
  }
  if (behind > 0) return behind < 8;
  return left < 8 && right < 8 && above < 8 && below < 8;
}

void grow(PixelBox& box, bool& first, const glm::dvec2& at) {
  if (std::exchange(first, false)) {
    box = {at.x, at.y, at.x, at.y};
    return;
  }
  box = {std::min(box.left, at.x), std::min(box.top, at.y), std::max(box.right, at.x),
         std::max(box.bottom, at.y)};
}

InstanceBox box_of(const std::vector<Vec3>& model_points, const Mat4& world_from_model,
                   const Pose& world_from_view, const PictureMap& map) {
  InstanceBox box;
  const Mat3 world_from_axes(glm::normalize(Vec3(world_from_model[0])),
                             glm::normalize(Vec3(world_from_model[1])),
                             glm::normalize(Vec3(world_from_model[2])));
  const Mat3 axes_from_world = glm::transpose(world_from_axes);
  const Quat view_from_world = glm::conjugate(world_from_view.rotation);
  // The heading about the view's y. An object that looks along that axis keeps yaw 0.
  const Vec3 heading = view_from_world * -world_from_axes[2];
  box.upright_yaw_rad =
      std::hypot(heading.x, heading.z) > 1e-6 ? std::atan2(-heading.x, -heading.z) : 0.0;
  const Quat upright_from_view = glm::angleAxis(-box.upright_yaw_rad, Vec3(0, 1, 0));
  scene::Bounds own, upright;
  bool first = true;
  const std::size_t stride = std::max<std::size_t>(1, model_points.size() / kMostPoints);
  for (std::size_t i = 0; i < model_points.size(); ++i) {
    const Vec3 world(world_from_model * Vec4(model_points[i], 1.0));
    const Vec3 view = view_from_world * (world - world_from_view.position_m);
    own.add(axes_from_world * (world - world_from_view.position_m));
    upright.add(upright_from_view * view);
    if (-view.z > map.near_m) grow(box.whole, first, map.pixel_of(view));
    if (i % stride == 0) box.points.push_back(Vec3f(view));
  }
  box.size_m = own.max - own.min;
  box.world_from_box = {world_from_view.position_m + world_from_axes * (0.5 * (own.min + own.max)),
                        glm::normalize(glm::quat_cast(world_from_axes))};
  box.upright_size_m = upright.max - upright.min;
  box.upright_middle_m = glm::conjugate(upright_from_view) * (0.5 * (upright.min + upright.max));
  const PixelBox inside{std::max(box.whole.left, 0.0), std::max(box.whole.top, 0.0),
                        std::min(box.whole.right, double(map.width)),
                        std::min(box.whole.bottom, double(map.height))};
  box.truncated = box.whole.area() > 0.0 ? 1.0 - inside.area() / box.whole.area() : 0.0;
  return box;
}

}  // namespace

glm::dvec2 PictureMap::pixel_of(const Vec3& view_m) const {
  glm::dvec2 plane(view_m.x / -view_m.z, -view_m.y / -view_m.z);
  // Far outside its picture a lens's polynomial turns back: the pinhole's place is outside too.
  if (lens && scene::unfolded(*lens, plane)) plane = scene::through_lens(*lens, plane);
  return {intrinsics.fx * plane.x + intrinsics.cx, intrinsics.fy * plane.y + intrinsics.cy};
}

std::vector<InstanceBox> instance_boxes(const scene::Scene& scene, const render::FrameState& state,
                                        const Pose& world_from_view, const PictureMap& map) {
  std::vector<InstanceBox> out;
  const Mat4 view_from_world = to_matrix(inverse(world_from_view));
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const scene::Object& object = scene.objects[o];
    if (object.model < 0 || object.class_id == 0) continue;
    const std::vector<Vec3> points =
        model_points(*scene.models[static_cast<std::size_t>(object.model)], state.poses[o]);
    if (points.empty()) continue;
    const scene::Bounds bounds = bounds_of(points);
    const std::vector<Mat4>& copies = state.flock[o].empty() ? object.copies : state.flock[o];
    for (std::size_t c = 0; c < object.instance_count(); ++c) {
      Mat4 world_from_model = to_matrix(state.world_from_object[o]);
      if (!copies.empty()) world_from_model = world_from_model * copies[c];
      world_from_model = glm::scale(world_from_model, object.scale);
      if (!may_be_seen(bounds, view_from_world * world_from_model, map)) continue;
      InstanceBox box = box_of(points, world_from_model, world_from_view, map);
      box.class_id = object.class_id;
      box.instance = static_cast<std::uint16_t>(object.instance + c);
      box.object = object.name;
      out.push_back(std::move(box));
    }
  }
  return out;
}

void judge_boxes(std::vector<InstanceBox>& boxes, const PictureMap& map, const ImageF32& depth,
                 const ImageU16& instances) {
  std::vector<InstanceBox*> by_instance(1u << 16, nullptr);
  for (InstanceBox& box : boxes) by_instance[box.instance] = &box;
  for (std::uint32_t y = 0; y < instances.height; ++y)
    for (std::uint32_t x = 0; x < instances.width; ++x) {
      InstanceBox* const found = by_instance[instances.at(x, y)];
      if (!found) continue;
      InstanceBox& box = *found;
      bool first = box.seen_px++ == 0;
      grow(box.seen, first, {x, y});
      grow(box.seen, first, {x + 1.0, y + 1.0});
    }
  for (InstanceBox& box : boxes) {
    std::size_t inside = 0, hidden = 0;
    for (const Vec3f& point : box.points) {
      const Vec3 p(point);
      if (!(-p.z > map.near_m)) continue;
      const glm::dvec2 at = map.pixel_of(p);
      if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < depth.width && at.y < depth.height)) continue;
      const auto x = static_cast<std::uint32_t>(at.x), y = static_cast<std::uint32_t>(at.y);
      ++inside;
      hidden += instances.at(x, y) != box.instance && double(depth.at(x, y)) < -p.z - kHidden_m;
    }
    box.occluded = inside > 0 ? double(hidden) / double(inside) : 0.0;
  }
  std::erase_if(boxes, [](const InstanceBox& box) { return box.seen_px == 0; });
}

}  // namespace neritic::testbed
