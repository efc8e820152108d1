#include "engine/render/draw_list.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::render {
namespace {

template <class Row>
void set_rows(Row& out, const Mat4& m) {
  out.row0 = Vec4f(m[0][0], m[1][0], m[2][0], m[3][0]);
  out.row1 = Vec4f(m[0][1], m[1][1], m[2][1], m[3][1]);
  out.row2 = Vec4f(m[0][2], m[1][2], m[2][2], m[3][2]);
}

struct Seen {
  const Appearance* appearance;
  Mat4 origin_from_primitive;
  std::uint32_t deformed;
  bool mirrored;
  double distance_m;
};

// No length grows by more than this (the Frobenius norm bounds every stretch, sheared or not).
double largest_scale(const Mat4& m) {
  return std::sqrt(glm::dot(Vec3(m[0]), Vec3(m[0])) + glm::dot(Vec3(m[1]), Vec3(m[1])) +
                   glm::dot(Vec3(m[2]), Vec3(m[2])));
}

class Builder {
 public:
  Builder(const scene::Scene& scene, const GpuScene& gpu_scene, const FrameState& state,
          const ViewSet& views)
      : scene_(scene),
        gpu_scene_(gpu_scene),
        state_(state),
        views_(views),
        origin_(views.origin_m()) {}

  DrawList build() {
    for (std::uint32_t g = 0; g < gpu_scene_.groups().size(); ++g) add_group(g);
    std::stable_sort(out_.opaque.begin(), out_.opaque.end(),
                     [](const Draw& a, const Draw& b) { return a.distance_m < b.distance_m; });
    std::stable_sort(out_.blended.begin(), out_.blended.end(),
                     [](const Draw& a, const Draw& b) { return a.distance_m > b.distance_m; });
    return std::move(out_);
  }

 private:
  void add_group(std::uint32_t g) {
    const DrawGroup& group = gpu_scene_.groups()[g];
    const GpuPrimitive& primitive = group.primitive;
    if (primitive.index_count == 0) return;
    std::vector<Seen> seen;
    for (const Appearance& a : group.appearances) {
      const std::uint32_t deformed =
          primitive.deforms() ? state_.deformed_at(g, a.object, a.node) : kNone;
      const bool skinned = primitive.first_skin != kNone && deformed != kNone;
      Mat4 m = world_from_appearance(scene_, state_.world_from_object[a.object],
                                     state_.poses[a.object], a, skinned);
      m[3] -= Vec4(origin_, 0.0);
      const Vec3 center = Vec3(m * Vec4(primitive.center_m, 1.0));
      // The rest shape bounds nothing that deforms: such are always drawn.
      if (deformed == kNone &&
          !any_view_sees(views_, center, primitive.radius_m * largest_scale(m)))
        continue;
      seen.push_back({&a, m, deformed, glm::determinant(glm::dmat3(m)) < 0.0, glm::length(center)});
    }
    const bool blend = gpu_scene_.materials()[primitive.material].blend;
    // Instances that share vertices and winding share a draw; blended ones are sorted one by one.
    std::stable_sort(seen.begin(), seen.end(), [](const Seen& a, const Seen& b) {
      return std::pair(a.deformed, a.mirrored) < std::pair(b.deformed, b.mirrored);
    });
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const bool joins = i > 0 && !blend && seen[i].deformed == seen[i - 1].deformed &&
                         seen[i].mirrored == seen[i - 1].mirrored;
      add_instance(primitive, seen[i], blend, joins);
    }
  }

  void add_instance(const GpuPrimitive& primitive, const Seen& seen, bool blend, bool joins) {
    const Appearance& a = *seen.appearance;
    std::vector<Draw>& draws = blend ? out_.blended : out_.opaque;
    if (joins) {
      ++draws.back().instance_count;
      draws.back().distance_m = std::min(draws.back().distance_m, seen.distance_m);
    } else {
      draws.push_back({&primitive, static_cast<std::uint32_t>(out_.instances.size()), 1,
                       seen.deformed, seen.mirrored, seen.distance_m});
    }
    shared::Instance instance{};
    set_rows(instance, seen.origin_from_primitive);
    instance.label = scene_.objects[a.object].class_id | std::uint32_t{a.label} << 16;
    instance.deformed = seen.deformed;
    out_.instances.push_back(instance);
    if (state_.motion) {
      Mat4 next = world_from_appearance(scene_, state_.next_world_from_object[a.object],
                                        state_.next_poses[a.object], a,
                                        primitive.first_skin != kNone && seen.deformed != kNone);
      next[3] -= Vec4(origin_, 0.0);
      shared::NextInstance next_instance{};
      set_rows(next_instance, next);
      out_.next_instances.push_back(next_instance);
    }
    if (primitive.topology == scene::Topology::kTriangles)
      out_.triangles += primitive.index_count / 3;
  }

  const scene::Scene& scene_;
  const GpuScene& gpu_scene_;
  const FrameState& state_;
  const ViewSet& views_;
  const Vec3 origin_;
  DrawList out_;
};

}  // namespace

DrawList build_draw_list(const scene::Scene& scene, const GpuScene& gpu_scene,
                         const FrameState& state, const ViewSet& views) {
  return Builder(scene, gpu_scene, state, views).build();
}

}  // namespace neritic::render
