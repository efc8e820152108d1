// Coarser versions of a mesh: how much they leave wrong against the shape itself, and what they
// keep.
#include "engine/scene/mesh_levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/scene/gltf_loader.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

Primitive primitive_of(const Model& model) {
  return model.meshes.at(0).primitives.at(0);
}

// The largest distance of a triangle's corners, middle and edges' middles from a ball's surface.
double off_ball_m(const Primitive& p, const std::vector<std::uint32_t>& indices, double radius_m) {
  double most = 0.0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const Vec3 a(p.positions[indices[i]]), b(p.positions[indices[i + 1]]),
        c(p.positions[indices[i + 2]]);
    for (const Vec3& at : {a, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0})
      most = std::max(most, std::abs(glm::length(at) - radius_m));
  }
  return most;
}

TEST(MeshLevels, EachHasAboutHalfOfTheTrianglesAndLiesAsNearAsItSays) {
  const Primitive ball = primitive_of(make_sphere(1.0, 64));
  const auto levels = mesh_levels(ball);
  ASSERT_GE(levels.size(), 5u);
  std::size_t before = ball.indices.size();
  double error_m = 0.0;
  for (const MeshLevel& level : levels) {
    EXPECT_LE(level.indices.size(), before * 3 / 4);
    EXPECT_GT(level.error_m, error_m);
    EXPECT_LE(off_ball_m(ball, level.indices, 1.0), level.error_m + 0.002);
    before = level.indices.size();
    error_m = level.error_m;
  }
}

TEST(MeshLevels, HaveNoCracksAtSeamsOfTexture) {
  // The ball's texture has a seam from pole to pole, and a box's faces share no vertex.
  const Primitive ball = primitive_of(make_sphere(1.0, 32));
  for (const MeshLevel& level : mesh_levels(ball)) {
    using Place = std::tuple<float, float, float>;
    std::map<std::pair<Place, Place>, int> edges;
    const auto at = [&](std::uint32_t i) {
      const Vec3f& p = ball.positions[i];
      return Place(p.x + 0.0f, p.y + 0.0f, p.z + 0.0f);
    };
    for (std::size_t i = 0; i < level.indices.size(); i += 3)
      for (std::size_t k = 0; k < 3; ++k)
        ++edges[{at(level.indices[i + k]), at(level.indices[i + (k + 1) % 3])}];
    for (const auto& [edge, count] : edges)
      EXPECT_EQ(count, edges.contains({edge.second, edge.first})
                           ? edges.at({edge.second, edge.first})
                           : 0);
  }
}

TEST(MeshLevels, CornersTakeTheNormalsOfTheirOwnSide) {
  // A sheet of two sides that lie on each other: each keeps its own vertices.
  Primitive sheet = primitive_of(make_plane(4.0, 4.0));
  constexpr int kSide = 12;
  sheet.positions.clear();
  sheet.normals.clear();
  sheet.uv0.clear();
  sheet.tangents.clear();
  sheet.indices.clear();
  for (int side = 0; side < 2; ++side) {
    const auto first = static_cast<std::uint32_t>(sheet.positions.size());
    for (int z = 0; z <= kSide; ++z)
      for (int x = 0; x <= kSide; ++x) {
        sheet.positions.push_back({float(x), 0.0f, float(z)});
        sheet.normals.push_back({0.0f, side ? -1.0f : 1.0f, 0.0f});
      }
    const auto at = [&](int x, int z) {
      return first + static_cast<std::uint32_t>(z * (kSide + 1) + x);
    };
    for (int z = 0; z < kSide; ++z)
      for (int x = 0; x < kSide; ++x)
        for (const auto& corners : {std::array{at(x, z), at(x, z + 1), at(x + 1, z)},
                                    std::array{at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)}}) {
          sheet.indices.insert(sheet.indices.end(),
                               {corners[0], corners[side ? 2 : 1], corners[side ? 1 : 2]});
        }
  }
  const auto levels = mesh_levels(sheet);
  for (const MeshLevel& level : levels)
    for (std::size_t i = 0; i < level.indices.size(); i += 3) {
      const Vec3f a = sheet.positions[level.indices[i]], b = sheet.positions[level.indices[i + 1]],
                  c = sheet.positions[level.indices[i + 2]];
      const float up = glm::cross(b - a, c - a).y;
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_GE(sheet.normals[level.indices[i + k]].y * up, 0.0f);
    }
}

TEST(MeshLevels, SmallBrokenAndOtherMeshesHaveNone) {
  EXPECT_TRUE(mesh_levels(primitive_of(make_box(Vec3(1.0)))).empty());
  Primitive ball = primitive_of(make_sphere(1.0, 32));
  Primitive lines = ball;
  lines.topology = Topology::kLines;
  EXPECT_TRUE(mesh_levels(lines).empty());
  Primitive morphs = ball;
  morphs.targets.emplace_back();
  EXPECT_TRUE(mesh_levels(morphs).empty());
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Primitive broken = ball;
    broken.positions[7].y = bad;
    EXPECT_TRUE(mesh_levels(broken).empty());
  }
  // All at one place, all on a line, as large and as small as floats go.
  Primitive point = ball, line = ball, huge = ball, tiny = ball;
  for (Vec3f& p : point.positions) p = Vec3f(1.0f);
  for (Vec3f& p : line.positions) p = Vec3f(p.x, 0.0f, 0.0f);
  for (Vec3f& p : huge.positions) p *= 1e18f;
  for (Vec3f& p : tiny.positions) p *= 1e-30f;
  for (const Primitive* p : {&point, &line, &huge, &tiny})
    for (const MeshLevel& level : mesh_levels(*p))
      for (const std::uint32_t index : level.indices) EXPECT_LT(index, p->positions.size());
}

TEST(MeshLevels, AreTheSameEachTime) {
  const Primitive ball = primitive_of(make_sphere(0.3, 40));
  const auto first = mesh_levels(ball), second = mesh_levels(ball);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].indices, second[i].indices);
    EXPECT_EQ(first[i].error_m, second[i].error_m);
  }
}

// Drawn by the thousand: each version stays a fish, not a sliver.
TEST(MeshLevels, TheSardineKeepsItsLengthHeightAndBreadth) {
  const auto model = load_gltf(test::source_dir() / "assets/models/school_fish.glb");
  ASSERT_TRUE(model.ok());
  const auto mesh = std::ranges::find(model->meshes, "sardine", &Mesh::name);
  ASSERT_NE(mesh, model->meshes.end());
  ASSERT_EQ(mesh->primitives.size(), 1u);
  const Primitive& sardine = mesh->primitives[0];
  const auto levels = mesh_levels(sardine);
  ASSERT_GE(levels.size(), 2u);
  const Vec3 whole_m = sardine.bounds.max - sardine.bounds.min;
  for (const MeshLevel& level : levels) {
    Bounds box;
    for (std::size_t i = 0; i < level.indices.size(); ++i)
      box.add(Vec3(sardine.positions[level.indices[i]]));
    const Vec3 size_m = box.max - box.min;
    EXPECT_GT(size_m.x, 0.6 * whole_m.x) << level.indices.size() / 3;
    EXPECT_GT(size_m.y, 0.6 * whole_m.y) << level.indices.size() / 3;
    EXPECT_GT(size_m.z, 0.8 * whole_m.z) << level.indices.size() / 3;
  }
}

}  // namespace
}  // namespace neritic::scene
