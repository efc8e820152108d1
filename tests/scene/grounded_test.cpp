// The things that lie or stand on the ground in the places of assets/scenes are seen and do not
// float.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/scene/animation.hpp"
#include "engine/scene/scene.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

using GroundTriangle = std::array<Vec3, 3>;

// Models whose things lie or stand on what they are put on.
constexpr std::string_view kLying[] = {"relics.glb",   "reef.glb",     "corals.glb",
                                       "seagrass.glb", "eelgrass.glb", "giant_kelp.glb",
                                       "kelp.glb"};
// Models that others stand on, beside terrains and shapes of the class seabed.
constexpr std::string_view kGround[] = {"seabed.glb", "berth.glb", "cave.glb", "rocks.glb",
                                        "submarine.glb"};

bool is_of(const Model& model, std::span<const std::string_view> files) {
  return std::ranges::any_of(
      files, [&](std::string_view file) { return model.name.find(file) != std::string::npos; });
}

bool is_ground(const Scene& scene, const Object& object) {
  const Model& model = *scene.models[static_cast<std::size_t>(object.model)];
  return model.heights || is_of(model, kGround) || object.class_id == 1;
}

// Visits each primitive that is drawn at rest, with world_from_primitive.
template <class Visit>
void for_each_primitive(const Scene& scene, const Object& object, std::size_t copy, Visit visit) {
  const Model& model = *scene.models[static_cast<std::size_t>(object.model)];
  const ModelPose pose = evaluate_pose(model, -1, 0.0);
  const Mat4 world_from_copy = scene.world_from_copy(object, copy);
  std::vector<int> open = model.roots;
  while (!open.empty()) {
    const auto at = static_cast<std::size_t>(open.back());
    open.pop_back();
    const Node& node = model.nodes[at];
    open.insert(open.end(), node.children.begin(), node.children.end());
    if (node.mesh < 0) continue;
    for (const Primitive& primitive : model.meshes[static_cast<std::size_t>(node.mesh)].primitives)
      visit(primitive, world_from_copy * pose.model_from_node[at]);
  }
}

// The triangles of the ground by cells of the plane x z, so that each thing asks only those around
// it.
class Ground {
 public:
  explicit Ground(const Scene& scene) {
    for (const Object& object : scene.objects) {
      if (object.model < 0 || !is_ground(scene, object)) continue;
      for (std::size_t copy = 0; copy < object.instance_count(); ++copy)
        for_each_primitive(scene, object, copy, [&](const Primitive& primitive, const Mat4& world) {
          std::vector<Vec3> points;
          points.reserve(primitive.positions.size());
          for (const auto& position : primitive.positions)
            points.push_back(Vec3(world * Vec4(Vec3(position), 1.0)));
          for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
            add({points[primitive.indices[i]], points[primitive.indices[i + 1]],
                 points[primitive.indices[i + 2]]});
        });
    }
  }
  bool empty() const { return triangles_.empty(); }
  // The height of the highest face under the point, or nothing.
  std::optional<double> below(const Vec3& point) const {
    std::optional<double> best;
    for_each_cell(point.x, point.x, point.z, point.z, [&](const Cell& cell) {
      const auto found = cells_.find(cell);
      if (found == cells_.end()) return;
      for (const std::uint32_t index : found->second) {
        const GroundTriangle& t = triangles_[index];
        const Vec3 &a = t[0], &b = t[1], &c = t[2];
        const double area = (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z);
        if (area == 0.0) continue;
        const double wb = ((point.x - a.x) * (c.z - a.z) - (c.x - a.x) * (point.z - a.z)) / area;
        const double wc = ((b.x - a.x) * (point.z - a.z) - (point.x - a.x) * (b.z - a.z)) / area;
        if (wb < 0.0 || wc < 0.0 || wb + wc > 1.0) continue;
        const double y = a.y + wb * (b.y - a.y) + wc * (c.y - a.y);
        if (y <= point.y && (!best || y > *best)) best = y;
      }
    });
    return best;
  }

 private:
  using Cell = std::pair<int, int>;
  static constexpr double kCell_m = 0.5;

  template <class Visit>
  static void for_each_cell(double x0, double x1, double z0, double z1, Visit visit) {
    const auto cell = [](double at_m) { return static_cast<int>(std::floor(at_m / kCell_m)); };
    for (int x = cell(x0); x <= cell(x1); ++x)
      for (int z = cell(z0); z <= cell(z1); ++z) visit(Cell{x, z});
  }
  void add(const GroundTriangle& t) {
    const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [z0, z1] = std::minmax({t[0].z, t[1].z, t[2].z});
    const auto index = static_cast<std::uint32_t>(triangles_.size());
    triangles_.push_back(t);
    for_each_cell(x0, x1, z0, z1, [&](const Cell& cell) { cells_[cell].push_back(index); });
  }

  std::vector<GroundTriangle> triangles_;
  std::map<Cell, std::vector<std::uint32_t>> cells_;
};

struct Lying {
  double out = 0.0;      // share of its points that are over the ground
  double under_m = 1e9;  // between the ground and its lowest point; below 0: it is sunk in
};

Lying lying_of(const Ground& ground, const std::vector<Vec3>& points) {
  Bounds box;
  for (const Vec3& point : points) box.add(point);
  Lying out;
  const std::size_t step = std::max<std::size_t>(points.size() / 150, 1);
  double count = 0.0, over = 0.0;
  for (std::size_t i = 0; i < points.size(); i += step) {
    // From the thing's top, so that what lies in the ground is known from what floats.
    const auto below = ground.below({points[i].x, box.max.y, points[i].z});
    ++count;
    if (!below) continue;
    over += points[i].y > *below ? 1.0 : 0.0;
    out.under_m = std::min(out.under_m, points[i].y - *below);
  }
  out.out = over / count;
  return out;
}

class Grounded : public testing::TestWithParam<std::string> {};

TEST_P(Grounded, WhatLiesOnTheGroundIsSeenAndTouchesIt) {
  const auto loaded = load_scene(test::source_dir() / "assets/scenes" / GetParam());
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  const Scene& scene = *loaded;
  const Ground ground(scene);
  ASSERT_FALSE(ground.empty());
  std::size_t things = 0;
  for (const Object& object : scene.objects) {
    if (object.model < 0 || object.flock) continue;
    const Model& model = *scene.models[static_cast<std::size_t>(object.model)];
    if (!is_of(model, kLying)) continue;
    for (std::size_t copy = 0; copy < object.instance_count(); ++copy) {
      std::vector<Vec3> points;
      for_each_primitive(scene, object, copy, [&](const Primitive& primitive, const Mat4& world) {
        for (const auto& position : primitive.positions)
          points.push_back(Vec3(world * Vec4(Vec3(position), 1.0)));
      });
      const Lying lies = lying_of(ground, points);
      ++things;
      EXPECT_GT(lies.out, 0.05) << object.name << " " << copy;
      EXPECT_LT(lies.under_m, 0.02) << object.name << " " << copy;
    }
  }
  EXPECT_GT(things, 0u);
}

INSTANTIATE_TEST_SUITE_P(Places, Grounded,
                         testing::Values("wreck.toml", "reef.toml", "kelp.toml", "quay.toml",
                                         "cave.toml", "murk.toml", "seabed.toml"),
                         [](const auto& info) {
                           return info.param.substr(0, info.param.find('.'));
                         });

}  // namespace
}  // namespace neritic::scene
