#include "testbed/sensors/instance_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "engine/render/frame_state.hpp"

namespace neritic::testbed {
namespace {

// Samples of a picture's surface: one in so many pixels of it, within these.
constexpr std::size_t kLeastSamples = 16, kMostSamples = 512;
constexpr double kPixelsASample = 4.0;
// A surface point is hidden where something else is nearer by more than this.
constexpr double kHidden_m = 0.05;
// Behind a lens: how far off the axis a picture reaches, as a tangent (scene::lens_view: 80
// degrees).
constexpr double kFarthestTangent = 6.0;

// A model as it is drawn in some pose, model's frame.
struct ModelShape {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

std::vector<Vec3> posed_vertices(const scene::Primitive& part, const std::vector<float>& weights,
                                 const std::vector<Mat4>& joints) {
  std::vector<Vec3> out;
  out.reserve(part.positions.size());
  for (std::size_t v = 0; v < part.positions.size(); ++v) {
    Vec3 at(part.positions[v]);
    for (std::size_t t = 0; t < part.targets.size() && t < weights.size(); ++t)
      if (v < part.targets[t].positions.size())
        at += double(weights[t]) * Vec3(part.targets[t].positions[v]);
    if (!joints.empty()) {
      Vec4 sum(0.0);
      for (int j = 0; j < 4; ++j)
        sum += double(part.weights[v][j]) *
               (joints[part.joints[v][static_cast<std::size_t>(j)]] * Vec4(at, 1.0));
      at = Vec3(sum);
    }
    out.push_back(at);
  }
  return out;
}

ModelShape shape_of(const scene::Model& model, const scene::ModelPose& pose) {
  ModelShape out;
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
      const std::vector<Vec3> own =
          posed_vertices(part, weights, skinned ? joints : std::vector<Mat4>());
      for (const Mat4& place : places) {
        const Mat4 m =
            skinned ? Mat4(1.0) : pose.model_from_node[static_cast<std::size_t>(index)] * place;
        const auto first = static_cast<std::uint32_t>(out.points.size());
        for (const Vec3& at : own) out.points.push_back(Vec3(m * Vec4(at, 1.0)));
        if (part.topology != scene::Topology::kTriangles) continue;
        for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3)
          out.triangles.push_back(
              {first + part.indices[i], first + part.indices[i + 1], first + part.indices[i + 2]});
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

// The part of a polygon on the inner side of a plane through the eye, or parallel to the picture:
// where dot(normal, p) >= least.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& normal, double least) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double in_a = glm::dot(normal, a) - least, in_b = glm::dot(normal, b) - least;
    if (in_a >= 0.0) out.push_back(a);
    if ((in_a < 0.0) != (in_b < 0.0)) out.push_back(a + (b - a) * (in_a / (in_a - in_b)));
  }
  return out;
}

// The edges of what the picture sees, as tangents: left, right, bottom, top.
std::array<double, 4> edges_of(const PictureMap& map) {
  if (map.lens) return {-kFarthestTangent, kFarthestTangent, -kFarthestTangent, kFarthestTangent};
  const Intrinsics& k = map.intrinsics;
  return {-k.cx / k.fx, (map.width - k.cx) / k.fx, -(map.height - k.cy) / k.fy, k.cy / k.fy};
}

// Triangles as the picture has them, within it: points of it are drawn evenly over its pixels,
// front and back sides alike.
class Silhouette {
 public:
  explicit Silhouette(const PictureMap& map) : map_(map), edges_(edges_of(map)) {}

  // View axes; ahead of the near plane.
  void add(std::vector<Vec3> part) {
    for (const Vec3& inward : {Vec3(1.0, 0.0, edges_[0]), Vec3(-1.0, 0.0, -edges_[1]),
                               Vec3(0.0, 1.0, edges_[2]), Vec3(0.0, -1.0, -edges_[3])})
      if (std::ranges::any_of(part, [&](const Vec3& p) { return glm::dot(inward, p) < 0.0; }))
        part = clipped(part, inward, 0.0);
    for (std::size_t i = 2; i < part.size(); ++i) {
      Piece piece{{part[0], part[i - 1], part[i]}, 0.0};
      const auto plane = [](const Vec3& p) { return glm::dvec2(p) / -p.z; };
      const glm::dvec2 a = plane(piece.corners[0]), b = plane(piece.corners[1]),
                       c = plane(piece.corners[2]);
      area_ += 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
      piece.area_until = area_;
      pieces_.push_back(piece);
    }
  }

  std::vector<Vec3f> points() const {
    std::vector<Vec3f> out;
    if (!(area_ > 0.0)) return out;
    const double pixels = area_ * map_.intrinsics.fx * map_.intrinsics.fy;
    const auto count = static_cast<std::size_t>(
        std::clamp(pixels / kPixelsASample, double(kLeastSamples), double(kMostSamples)));
    std::size_t piece = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double at = area_ * (double(i) + 0.5) / double(count);
      while (piece + 1 < pieces_.size() && pieces_[piece].area_until < at) ++piece;
      // The plastic number's sequence (Roberts 2018), folded into the triangle.
      double u = std::fmod(0.5 + 0.7548776662466927 * double(i), 1.0);
      double v = std::fmod(0.5 + 0.5698402909980532 * double(i), 1.0);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      // Even over the picture: the corners' shares of the distance's inverse.
      const std::array<Vec3, 3>& corners = pieces_[piece].corners;
      const Vec3 share =
          Vec3(1.0 - u - v, u, v) / Vec3(-corners[0].z, -corners[1].z, -corners[2].z);
      const double sum = share.x + share.y + share.z;
      out.push_back(
          Vec3f((share.x * corners[0] + share.y * corners[1] + share.z * corners[2]) / sum));
    }
    return out;
  }

 private:
  struct Piece {
    std::array<Vec3, 3> corners;
    double area_until;  // of this and all before it, of the plane at distance 1
  };
  const PictureMap& map_;
  std::array<double, 4> edges_;
  std::vector<Piece> pieces_;
  double area_ = 0.0;
};

InstanceBox box_of(const ModelShape& shape, const Mat4& world_from_model,
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
  std::vector<Vec3> seen_from;  // view axes
  seen_from.reserve(shape.points.size());
  for (const Vec3& point : shape.points) {
    const Vec3 world(world_from_model * Vec4(point, 1.0));
    const Vec3 view = view_from_world * (world - world_from_view.position_m);
    own.add(axes_from_world * (world - world_from_view.position_m));
    upright.add(upright_from_view * view);
    if (-view.z > map.near_m) grow(box.whole, first, map.pixel_of(view));
    seen_from.push_back(view);
  }
  Silhouette silhouette(map);
  const Vec3 ahead(0.0, 0.0, -1.0);
  for (const auto& [a, b, c] : shape.triangles) {
    std::vector<Vec3> polygon{seen_from[a], seen_from[b], seen_from[c]};
    const auto near =
        std::ranges::count_if(polygon, [&](const Vec3& p) { return !(-p.z > map.near_m); });
    if (near == 3) continue;
    if (near > 0) {
      polygon = clipped(polygon, ahead, map.near_m);
      for (const Vec3& p : polygon) grow(box.whole, first, map.pixel_of(p));
    }
    silhouette.add(std::move(polygon));
  }
  box.points = silhouette.points();
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
    const ModelShape shape =
        shape_of(*scene.models[static_cast<std::size_t>(object.model)], state.poses[o]);
    if (shape.points.empty()) continue;
    const scene::Bounds bounds = bounds_of(shape.points);
    const std::vector<Mat4>& copies = state.flock[o].empty() ? object.copies : state.flock[o];
    for (std::size_t c = 0; c < object.instance_count(); ++c) {
      Mat4 world_from_model = to_matrix(state.world_from_object[o]);
      if (!copies.empty()) world_from_model = world_from_model * copies[c];
      world_from_model = glm::scale(world_from_model, object.scale);
      if (!may_be_seen(bounds, view_from_world * world_from_model, map)) continue;
      InstanceBox box = box_of(shape, world_from_model, world_from_view, map);
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
