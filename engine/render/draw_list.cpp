#include "engine/render/draw_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include "engine/core/parallel.hpp"

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
  std::uint32_t level;  // 0: the mesh itself
  bool mirrored;
  bool hides_back_faces;
  double order_m;
  const DrawnLarger* larger = nullptr;
};

// Indices that culling must save before an instance gets a draw of its own: a draw command costs
// llvmpipe as much as 270 triangles outside the picture (cluster_culling.cpp).
constexpr std::uint32_t kLeastSaved = 3 * 256;  // indices

// Appearances that are looked at on one core: fewer take less time than a thread's start.
constexpr std::size_t kLeastLookedAt = 2000;

// Sort key of opaque draws: the least distance of their surface, or the centre's for those that lie
// around the eye. By the centre alone the seabed under the eye would come last, or first.
double nearness(double center_m, double radius_m) {
  return std::max(0.0, center_m - radius_m) + 1e-3 * center_m;
}

// True where no near plane's corner of any view comes to the box of a closed primitive.
bool all_eyes_outside(const ViewSet& views, const GpuPrimitive& primitive,
                      const Mat4& origin_from_primitive) {
  const Mat4 primitive_from_origin = glm::inverse(origin_from_primitive);
  const double shrink = largest_stretch(primitive_from_origin);
  const double size_m = glm::length(Vec3(origin_from_primitive[3])) +
                        largest_stretch(origin_from_primitive) *
                            (glm::length(primitive.center_m) + primitive.radius_m);
  return std::all_of(views.views.begin(), views.views.end(), [&](const ViewDesc& view) {
    const Vec3 eye_m = view.world_from_view.position_m - views.origin_m();
    const FrustumTangents& t = view.tangents;
    const double high = std::max(std::abs(t.bottom), std::abs(t.top));
    const Vec3 corner(std::max(std::abs(t.left), std::abs(t.right)) + std::abs(view.lean) * high,
                      high, 1.0);
    const double reach_m =
        view.near_m * glm::length(corner) + kFloatError * (size_m + glm::length(eye_m));
    const Vec3 at = Vec3(primitive_from_origin * Vec4(eye_m, 1.0)) - primitive.center_m;
    const Vec3 beyond = glm::max(glm::abs(at) - primitive.half_m, Vec3(0.0));
    return glm::length(beyond) > reach_m * shrink;  // NaN, of a flattened one, is not
  });
}

class DrawListBuilder {
 public:
  DrawListBuilder(const scene::Scene& scene, const GpuScene& gpu_scene, const FrameState& state,
                  const ViewSet& views, const DrawListOptions& options)
      : scene_(scene),
        gpu_scene_(gpu_scene),
        state_(state),
        views_(views),
        options_(options),
        origin_(views.origin_m()),
        culling_(views),
        spheres_(views) {
    for (const ViewDesc& view : views.views) {
      const FrustumTangents& t = view.tangents;
      eyes_.push_back(
          {view.world_from_view.position_m - origin_,
           view.world_from_view.rotation * Vec3(0.0, 0.0, -1.0),
           std::max(views.width / (t.right - t.left), views.height / (t.top - t.bottom)),
           view.near_m});
    }
    if (options.deform_need) options.deform_need->resize(state.deforms.size(), 0);
  }

  DrawList build() {
    out_.all_triangles = gpu_scene_.triangles();
    if (options_.least_drawn) {
      out_.larger = drawn_larger(scene_, gpu_scene_, state_, origin_, *options_.least_drawn);
      for (const DrawnLarger& larger : out_.larger) {  // by ascending labels
        larger_of_.resize(larger.label + std::size_t{1}, nullptr);
        larger_of_.back() = &larger;
      }
    }
    for (std::uint32_t g = 0; g < gpu_scene_.groups().size(); ++g) add_group(g);
    std::stable_sort(out_.opaque.begin(), out_.opaque.end(),
                     [](const Draw& a, const Draw& b) { return a.order_m < b.order_m; });
    std::stable_sort(out_.blended.begin(), out_.blended.end(),
                     [](const Draw& a, const Draw& b) { return a.order_m > b.order_m; });
    return std::move(out_);
  }

 private:
  void add_group(std::uint32_t g) {
    const GpuPrimitive& primitive = gpu_scene_.groups()[g].primitive;
    if (primitive.index_count == 0) return;
    // Instances that share vertices and winding follow each other, front to back, however many
    // draws they become: the order decides between equal depths.
    const std::span<const Looked> looked = look_at(g);
    const std::span<const Seen* const> seen = sorted(looked);
    if (seen.empty()) return;
    const GpuMaterial& material = gpu_scene_.materials()[primitive.material];
    const bool clusters = options_.clusters && !primitive.clusters.empty() &&
                          (material.blend || seen.size() <= kMostSplitInstances);
    for (std::size_t i = 0; i < seen.size();) {
      std::size_t end = i + 1;
      if (!material.blend)
        while (end < seen.size() && seen[end]->deformed == seen[i]->deformed &&
               seen[end]->mirrored == seen[i]->mirrored && seen[end]->level == seen[i]->level)
          ++end;
      const std::span<const Seen* const> alike(seen.data() + i, end - i);
      add_alike(primitive, alike, clusters && seen[i]->deformed == kNone && seen[i]->level == 0,
                material.blend ? out_.blended : out_.opaque);
      i = end;
    }
  }

  // The visible ones of a run of a group's appearances, and their heights (DrawList::lowest_m).
  struct Looked {
    std::vector<Seen> seen;
    double lowest_m = 0.0, highest_m = 0.0;
  };

  // In the order of the appearances; until the next call.
  std::span<const Looked> look_at(std::uint32_t g) {
    const DrawGroup& group = gpu_scene_.groups()[g];
    const std::span<const Appearance> all(group.appearances);
    // Deforming meshes write into options_.deform_need: one thread looks at them.
    const std::size_t ranges =
        group.primitive.deforms() ? 1 : ranges_of(all.size(), kLeastLookedAt);
    if (looked_.size() < ranges) looked_.resize(ranges);
    in_ranges(all.size(), ranges, [&](std::size_t range, std::size_t begin, std::size_t end) {
      look_at(g, all.subspan(begin, end - begin), looked_[range]);
    });
    const std::span<const Looked> looked(looked_.data(), ranges);
    for (const Looked& part : looked) {
      out_.lowest_m = std::min(out_.lowest_m, part.lowest_m);
      out_.highest_m = std::max(out_.highest_m, part.highest_m);
    }
    return looked;
  }

  void look_at(std::uint32_t g, std::span<const Appearance> appearances, Looked& looked) const {
    const GpuPrimitive& primitive = gpu_scene_.groups()[g].primitive;
    const bool blend = gpu_scene_.materials()[primitive.material].blend;
    looked.seen.clear();
    looked.lowest_m = std::numeric_limits<double>::infinity();
    looked.highest_m = -std::numeric_limits<double>::infinity();
    School school;
    for (const Appearance& a : appearances) {
      const std::uint16_t class_id = scene_.objects[a.object].class_id;
      if (class_id != 0 && class_id == options_.without_class) continue;
      if (!options_.objects.empty() && !options_.objects[a.object]) continue;
      const DeformJob* job =
          primitive.deforms() ? state_.job_of(g, a.object, a.node, a.object == views_.worn_object)
                              : nullptr;
      const std::uint32_t deformed = job ? job->push.first_out : kNone;
      const bool skinned = primitive.first_skin != kNone && job;
      Mat4 m = world_from(a, skinned, school);
      m[3] -= Vec4(origin_, 0.0);
      // The rest shape bounds nothing that deforms: without a bound of its own such is drawn.
      const bool bounded = !job || job->radius_m >= 0.0;
      const Vec3 own_center_m = job && bounded ? job->center_m : primitive.center_m;
      const double own_radius_m = job && bounded ? job->radius_m : primitive.radius_m;
      const Vec3 center = Vec3(m * Vec4(own_center_m, 1.0));
      const double center_m = glm::length(center), stretch = largest_stretch(m);
      const double error_m = kFloatError * (glm::length(Vec3(m[3])) +
                                            stretch * (glm::length(own_center_m) + own_radius_m));
      const DrawnLarger* larger = a.label < larger_of_.size() ? larger_of_[a.label] : nullptr;
      const Vec3 own_half_m = job ? job->half_m : primitive.half_m;
      if (bounded && !larger &&
          !spheres_.may_see_box(
              center, own_radius_m * stretch + error_m,
              {Vec3(m[0]) * own_half_m.x, Vec3(m[1]) * own_half_m.y, Vec3(m[2]) * own_half_m.z},
              error_m))
        continue;
      const double order_m = blend ? center_m : nearness(center_m, own_radius_m * stretch);
      std::uint32_t level = 0;
      if (options_.mesh_error_px > 0.0 && bounded && !blend) {
        const double px_m = pixels_a_metre(m, center, own_half_m);
        if (2.0 * own_radius_m * stretch * px_m <
            std::max(0.5 * options_.mesh_error_px, options_.least_px))
          continue;
        while (level < primitive.levels.size() &&
               primitive.levels[level].error_m * stretch * px_m <= options_.mesh_error_px)
          ++level;
      }
      if (job && options_.deform_need) {
        std::uint32_t& need =
            (*options_.deform_need)[static_cast<std::size_t>(job - state_.deforms.data())];
        need = std::max(need,
                        level ? primitive.levels[level - 1].vertex_count : primitive.vertex_count);
      }
      add_heights(looked, bounded, m, center, job ? Vec3(own_radius_m) : primitive.half_m);
      const bool hides =
          options_.hide_back_faces && primitive.closed && all_eyes_outside(views_, primitive, m);
      looked.seen.push_back(
          {&a, m, deformed, level, glm::determinant(glm::dmat3(m)) < 0.0, hides, order_m, larger});
    }
  }

  // By which instances follow each other.
  struct Key {
    std::uint32_t deformed, level;
    bool mirrored;
    double order_m;
    std::size_t place;
    const Seen* seen;
    auto tie() const { return std::tie(deformed, mirrored, level, order_m, place); }
  };

  // By what they share, then by distance; those that are alike in all keep their order. Until the
  // next call.
  std::span<const Seen* const> sorted(std::span<const Looked> looked) {
    keys_.clear();
    for (const Looked& part : looked)
      for (const Seen& s : part.seen)
        keys_.push_back({s.deformed, s.level, s.mirrored, s.order_m, keys_.size(), &s});
    std::ranges::sort(keys_, [](const Key& a, const Key& b) { return a.tie() < b.tie(); });
    sorted_.clear();
    for (const Key& key : keys_) sorted_.push_back(key.seen);
    return sorted_;
  }

  // The copies of a school share this.
  struct School {
    std::uint32_t object = kNone, node = kNone;
    Mat4 world_from_object{1.0}, copy_from_primitive{1.0};
  };

  Mat4 world_from(const Appearance& a, bool skinned, School& school) const {
    const std::vector<Mat4>& flock = state_.flock[a.object];
    if (flock.empty() || a.copy < 0 || a.node_instance >= 0)
      return world_from_appearance(scene_, state_.world_from_object[a.object],
                                   state_.poses[a.object], a, skinned, flock);
    if (school.object != a.object || school.node != a.node) {
      Appearance first = a;
      first.copy = -1;
      school = {a.object, a.node, to_matrix(state_.world_from_object[a.object]),
                world_from_appearance(scene_, Pose{}, state_.poses[a.object], first, skinned)};
    }
    return school.world_from_object * flock[static_cast<std::size_t>(a.copy)] *
           school.copy_from_primitive;
  }

  // Widens the heights by a box round a centre; a ball's box turns like any other.
  static void add_heights(Looked& looked, bool bounded, const Mat4& m, const Vec3& center,
                          const Vec3& half_m) {
    const double reach_m = bounded ? std::abs(m[0][1]) * half_m.x + std::abs(m[1][1]) * half_m.y +
                                         std::abs(m[2][1]) * half_m.z
                                   : std::numeric_limits<double>::infinity();
    looked.lowest_m = std::min(looked.lowest_m, center.y - reach_m);
    looked.highest_m = std::max(looked.highest_m, center.y + reach_m);
  }

  // The most pixels that a metre takes at the nearest part of a box round a centre, in any view.
  double pixels_a_metre(const Mat4& m, const Vec3& center, const Vec3& half_m) const {
    double most = 0.0;
    for (const Eye& eye : eyes_) {
      const double reach_m = std::abs(glm::dot(eye.ahead, Vec3(m[0]))) * half_m.x +
                             std::abs(glm::dot(eye.ahead, Vec3(m[1]))) * half_m.y +
                             std::abs(glm::dot(eye.ahead, Vec3(m[2]))) * half_m.z;
      const double near_m = glm::dot(center - eye.position_m, eye.ahead) - reach_m;
      most = std::max(most, eye.pixels / std::max(near_m, eye.near_m));
    }
    return most;
  }

  // Instances that may share a draw, in their order: those seen whole do with their neighbours.
  void add_alike(const GpuPrimitive& primitive, std::span<const Seen* const> alike, bool clusters,
                 std::vector<Draw>& draws) {
    const double order_m = alike.front()->order_m;  // the nearest's
    bool joins = false;
    for (const Seen* each : alike) {
      const Seen& s = *each;
      const auto first_range = static_cast<std::uint32_t>(out_.ranges.size());
      const bool part = clusters && !s.larger && add_visible_part(primitive, s);
      if (part && out_.ranges.size() == first_range) continue;  // nothing of it is seen
      if (part || !joins) {
        if (!part) out_.ranges.push_back(whole(primitive, s.level));
        draws.push_back({&primitive, static_cast<std::uint32_t>(out_.instances.size()), 0,
                         first_range, static_cast<std::uint32_t>(out_.ranges.size()) - first_range,
                         s.deformed, s.mirrored, true, order_m});
      }
      joins = !part;
      draws.back().hides_back_faces &= s.hides_back_faces;
      ++draws.back().instance_count;
      add_instance(primitive, s);
      if (primitive.topology != scene::Topology::kTriangles) continue;
      for (std::uint32_t r = 0; r < draws.back().range_count; ++r)
        out_.triangles += out_.ranges[draws.back().first_range + r].index_count / 3;
    }
  }

  static IndexRange whole(const GpuPrimitive& primitive, std::uint32_t level) {
    if (level == 0) return {primitive.first_index, primitive.index_count};
    return {primitive.levels[level - 1].first_index, primitive.levels[level - 1].index_count};
  }

  // Adds the ranges of an instance that some view can see. False, and nothing added, where that is
  // so nearly all that it is better drawn whole.
  bool add_visible_part(const GpuPrimitive& primitive, const Seen& seen) {
    const std::size_t before = out_.ranges.size();
    culling_.append_visible(primitive.clusters, primitive.first_index, seen.origin_from_primitive,
                            out_.ranges, options_.mesh_error_px);
    std::uint32_t count = 0;
    for (std::size_t r = before; r < out_.ranges.size(); ++r) count += out_.ranges[r].index_count;
    if (count == 0 || count + kLeastSaved <= primitive.index_count) return true;
    out_.ranges.resize(before);
    return false;
  }

  void add_instance(const GpuPrimitive& primitive, const Seen& seen) {
    const Appearance& a = *seen.appearance;
    shared::Instance instance{};
    set_rows(instance, seen.origin_from_primitive);
    instance.label = scene_.objects[a.object].class_id | std::uint32_t{a.label} << 16;
    instance.deformed = seen.deformed;
    out_.instances.push_back(instance);
    if (!out_.larger.empty()) {
      shared::NextInstance drawn{};
      set_rows(drawn, seen.larger ? seen.larger->drawn_from_true * seen.origin_from_primitive
                                  : seen.origin_from_primitive);
      out_.drawn_instances.push_back(drawn);
    }
    if (!state_.motion) return;
    Mat4 next = world_from_appearance(
        scene_, state_.next_world_from_object[a.object], state_.next_poses[a.object], a,
        primitive.first_skin != kNone && seen.deformed != kNone, state_.next_flock[a.object]);
    next[3] -= Vec4(origin_, 0.0);
    shared::NextInstance next_instance{};
    set_rows(next_instance, next);
    out_.next_instances.push_back(next_instance);
  }

  const scene::Scene& scene_;
  const GpuScene& gpu_scene_;
  const FrameState& state_;
  const ViewSet& views_;
  const DrawListOptions options_;
  const Vec3 origin_;
  std::vector<const DrawnLarger*> larger_of_;  // a label; those beyond are not
  const ClusterCulling culling_;
  const SphereCulling spheres_;
  struct Eye {
    Vec3 position_m, ahead;
    double pixels;  // a unit of tangent
    double near_m;
  };
  std::vector<Eye> eyes_;
  // Buffers of one group; kept, so that the next group allocates nothing.
  std::vector<Looked> looked_;
  std::vector<Key> keys_;
  std::vector<const Seen*> sorted_;
  DrawList out_;
};

}  // namespace

DrawList build_draw_list(const scene::Scene& scene, const GpuScene& gpu_scene,
                         const FrameState& state, const ViewSet& views,
                         const DrawListOptions& options) {
  DrawList list = DrawListBuilder(scene, gpu_scene, state, views, options).build();
  list.clipped = views.within.has_value();
  return list;
}

}  // namespace neritic::render
