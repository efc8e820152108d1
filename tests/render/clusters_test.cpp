// Promises of clusters: the same triangles in a new order, bounds that hold them, and a culling
// that never drops a triangle of which a corner is in a view.
#include "engine/render/clusters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <set>

#include "engine/render/cluster_culling.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/support.hpp"

namespace neritic::render {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

std::vector<Triangle> triangles_of(const std::vector<std::uint32_t>& indices) {
  std::vector<Triangle> out;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    out.push_back({indices[i], indices[i + 1], indices[i + 2]});
  return out;
}

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices, ordered;
  std::vector<ClusterNode> nodes;
};

Mesh mesh_of(const scene::Model& model, const Vec3f& moved_m = Vec3f(0.0f)) {
  const scene::Primitive& p = model.meshes[0].primitives[0];
  Mesh mesh{p.positions, p.indices, p.indices, {}};
  for (Vec3f& position : mesh.positions) position += moved_m;
  mesh.nodes = build_clusters(mesh.positions, mesh.ordered);
  return mesh;
}

// A wavy sheet of 2 n n triangles, 100 m wide, its triangles in no order at all.
Mesh shuffled_sheet(std::uint32_t n, unsigned seed) {
  Mesh mesh;
  for (std::uint32_t z = 0; z <= n; ++z)
    for (std::uint32_t x = 0; x <= n; ++x)
      mesh.positions.push_back({100.0f * x / n - 50.0f, std::sin(0.3f * x) * std::cos(0.2f * z),
                                100.0f * z / n - 50.0f});
  std::vector<Triangle> triangles;
  for (std::uint32_t z = 0; z < n; ++z)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t i = z * (n + 1) + x;
      triangles.push_back({i, i + n + 1, i + 1});
      triangles.push_back({i + 1, i + n + 1, i + n + 2});
    }
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(seed));
  for (const Triangle& t : triangles) mesh.indices.insert(mesh.indices.end(), t.begin(), t.end());
  mesh.ordered = mesh.indices;
  mesh.nodes = build_clusters(mesh.positions, mesh.ordered);
  return mesh;
}

ViewSet views_of(const std::vector<Pose>& poses, const FrustumTangents& tangents, double near_m) {
  ViewSet set;
  set.width = 320;
  set.height = 180;
  for (const Pose& pose : poses) set.views.push_back({pose, tangents, near_m, 0.0, pose});
  return set;
}

std::uint32_t count_of(const std::vector<IndexRange>& ranges) {
  std::uint32_t count = 0;
  for (const IndexRange& range : ranges) count += range.index_count;
  return count;
}

TEST(Clusters, HoldEveryTriangleOnceWithinTheirBounds) {
  const Mesh mesh = shuffled_sheet(37, 1);  // 2738 triangles: no multiple of a cluster
  std::vector<Triangle> before = triangles_of(mesh.indices), after = triangles_of(mesh.ordered);
  EXPECT_NE(before, after);
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  EXPECT_EQ(before, after);
  std::uint32_t next_index = 0;
  for (std::uint32_t n = 0; n < mesh.nodes.size(); ++n) {
    const ClusterNode& node = mesh.nodes[n];
    if (node.end == n + 1) {
      EXPECT_EQ(node.first_index, next_index);
      EXPECT_LE(node.index_count, 3 * kClusterTriangles);
      next_index += node.index_count;
    } else {
      const ClusterNode& first = mesh.nodes[n + 1];
      const ClusterNode& second = mesh.nodes[first.end];
      EXPECT_EQ(first.first_index, node.first_index);
      EXPECT_EQ(second.first_index, first.first_index + first.index_count);
      EXPECT_EQ(first.index_count + second.index_count, node.index_count);
      EXPECT_EQ(second.end, node.end);
    }
    for (std::uint32_t i = node.first_index; i < node.first_index + node.index_count; ++i)
      ASSERT_LE(glm::length(Vec3(mesh.positions[mesh.ordered[i]]) - node.center_m), node.radius_m);
  }
  EXPECT_EQ(next_index, mesh.ordered.size());
}

TEST(Clusters, OrderDependsOnTheInputAlone) {
  EXPECT_EQ(shuffled_sheet(40, 3).ordered, shuffled_sheet(40, 3).ordered);
}

TEST(Clusters, SmallAndBrokenMeshesStayAsTheyAre) {
  const Mesh box = mesh_of(scene::make_box({1, 1, 1}));
  EXPECT_TRUE(box.nodes.empty());
  EXPECT_EQ(box.ordered, box.indices);
  Mesh sheet = shuffled_sheet(20, 1);
  sheet.positions[5].x = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::uint32_t> ordered = sheet.indices;
  EXPECT_TRUE(build_clusters(sheet.positions, ordered).empty());
  EXPECT_EQ(ordered, sheet.indices);
}

// Edges of one triangle only, of a run of indices.
std::set<std::pair<std::uint32_t, std::uint32_t>> border_of(
    const std::vector<std::uint32_t>& indices, std::uint32_t first, std::uint32_t count) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t i = first; i < first + count; i += 3)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = indices[i + k], b = indices[i + (k + 1) % 3];
      if (!edges.erase({b, a})) edges.insert({a, b});
    }
  return edges;
}

// The sheet as a primitive, with coarser clusters.
Mesh coarse_sheet(std::uint32_t n) {
  Mesh mesh = shuffled_sheet(n, 2);
  scene::Primitive sheet;
  sheet.positions = mesh.positions;
  sheet.normals.assign(mesh.positions.size(), Vec3f(0.0f, 1.0f, 0.0f));
  sheet.indices = mesh.indices;
  add_coarse_clusters(sheet, mesh.nodes, mesh.ordered);
  return mesh;
}

TEST(CoarseClusters, HaveTheBorderOfWhatTheyStandForAndErrMoreTheFewerTheyAre) {
  const Mesh mesh = coarse_sheet(60);
  std::size_t coarse = 0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const ClusterNode& node = mesh.nodes[i];
    if (node.coarse_count == 0) continue;
    ++coarse;
    EXPECT_LE(node.coarse_count, node.index_count * 3 / 4);
    EXPECT_EQ(border_of(mesh.ordered, node.coarse_first, node.coarse_count),
              border_of(mesh.ordered, node.first_index, node.index_count));
    EXPECT_GT(node.coarse_error_m, 0.0);
    for (std::uint32_t k = 0; k < node.coarse_count; ++k)
      EXPECT_LE(
          glm::distance(Vec3(mesh.positions[mesh.ordered[node.coarse_first + k]]), node.center_m),
          node.radius_m);
  }
  EXPECT_GT(coarse, mesh.nodes.size() / 8);
}

TEST(CoarseClusters, CoverEachPlaceOnceWhicheverVersionsMeet) {
  const Mesh mesh = coarse_sheet(120);
  // All of the sheet is seen; its far side is three times as far off as its near one.
  const ViewSet set = views_of({look_at({0.0, 30.0, 90.0}, {0.0, 0.0, 0.0})},
                               tangents_from_fov(radians(110.0), 16.0 / 9.0), 0.05);
  const ClusterCulling culling(set);
  const Mat4 origin_from_mesh = glm::translate(Mat4(1.0), -set.origin_m());
  const auto runs = [&](double mesh_error_px) {
    std::vector<IndexRange> ranges;
    culling.append_visible(mesh.nodes, 0, origin_from_mesh, ranges, mesh_error_px);
    return ranges;
  };
  const auto area_m2 = [&](const std::vector<IndexRange>& ranges) {
    double sum = 0.0;
    for (const IndexRange& range : ranges)
      for (std::uint32_t i = range.first_index; i < range.first_index + range.index_count; i += 3) {
        const Vec3f a = mesh.positions[mesh.ordered[i]], b = mesh.positions[mesh.ordered[i + 1]],
                    c = mesh.positions[mesh.ordered[i + 2]];
        sum += 0.5 * double(glm::cross(b - a, c - a).y);
      }
    return sum;
  };
  EXPECT_NEAR(area_m2(runs(0.0)), 1e4, 1.0);
  std::uint32_t before = count_of(runs(0.0));
  EXPECT_EQ(before, mesh.indices.size());
  for (const double error_px : {0.1, 0.2, 0.4, 0.8, 1.6}) {
    EXPECT_NEAR(area_m2(runs(error_px)), 1e4, 1.0) << error_px;
    EXPECT_LE(count_of(runs(error_px)), before) << error_px;
    before = count_of(runs(error_px));
  }
  EXPECT_LT(before, mesh.indices.size() / 2);
}

// Corners that lie in a view, by the projection that the vertex stage uses.
void expect_no_corner_lost(const Mesh& mesh, const ViewSet& set, const Mat4& origin_from_mesh) {
  std::vector<IndexRange> ranges;
  ClusterCulling(set).append_visible(mesh.nodes, 0, origin_from_mesh, ranges);
  std::vector<bool> drawn(mesh.ordered.size(), false);
  for (const IndexRange& range : ranges)
    std::fill_n(drawn.begin() + range.first_index, range.index_count, true);
  const auto views = gpu_views(set);
  std::size_t lost = 0;
  for (std::size_t v = 0; v < set.views.size(); ++v)
    for (std::size_t i = 0; i < mesh.ordered.size(); ++i) {
      const Vec4 at = origin_from_mesh * Vec4(Vec3(mesh.positions[mesh.ordered[i]]), 1.0);
      const Vec4f clip = views[v].clip_from_origin * Vec4f(at);
      const bool inside =
          std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z <= clip.w;
      lost += inside && clip.w > 0.0f && !drawn[i];
    }
  EXPECT_EQ(lost, 0u);
}

TEST(ClusterCulling, NeverDropsATriangleWithACornerInAView) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Mesh sheet = shuffled_sheet(60, 2), ball = mesh_of(scene::make_sphere(3.0, 60)),
             far_ball = mesh_of(scene::make_sphere(3.0, 60), Vec3f(1e5f, 0.0f, 0.0f));
  const auto vector = [&](double size) {
    return size * Vec3(unit(random), unit(random), unit(random));
  };
  for (int round = 0; round < (test::is_thorough() ? 200 : 60); ++round) {
    const Vec3 eye = vector(8.0);
    const Pose pose = look_at(eye, eye + vector(1.0));
    const Pose other = look_at(eye + vector(0.2), eye + vector(9.0));
    const double wide = std::pow(10.0, 1.2 * unit(random) - 1.0), high = wide * 0.5;
    const FrustumTangents tangents{-wide, wide * (1.0 + 0.5 * unit(random)), -high, high};
    const ViewSet set =
        round % 2 ? views_of({pose}, tangents, 0.05) : views_of({pose, other}, tangents, 0.5);
    Mat4 m(1.0);
    for (int c = 0; c < 3; ++c)  // turned, sheared, flattened, mirrored
      m[c] = Vec4(vector(1.0 + round % 3), 0.0);
    m[3] = Vec4(vector(5.0) - set.origin_m(), 1.0);
    expect_no_corner_lost(sheet, set, m);
    expect_no_corner_lost(ball, set, m);
    m[3] -= m * Vec4(1e5, 0.0, 0.0, 0.0);
    expect_no_corner_lost(far_ball, set, m);
  }
}

TEST(ClusterCulling, NarrowViewsPayForWhatTheySee) {
  const Mesh sheet = shuffled_sheet(316, 5);  // 199 712 triangles, 100 m x 100 m
  const auto drawn = [&](double half_angle_x, double half_angle_y) {
    const double x = std::tan(half_angle_x), y = std::tan(half_angle_y);
    const ViewSet set =
        views_of({look_at({0.0, 20.0, 0.0}, {0.3, 0.0, 0.1})}, {-x, x, -y, y}, 0.05);
    Mat4 m(1.0);
    m[3] = Vec4(-set.origin_m(), 1.0);
    std::vector<IndexRange> ranges;
    ClusterCulling(set).append_visible(sheet.nodes, 0, m, ranges);
    return count_of(ranges) / 3;
  };
  EXPECT_EQ(drawn(radians(85.0), radians(85.0)), 199712u);
  EXPECT_LT(drawn(radians(0.25), radians(0.25)), 2000u);  // a profiler's beam
  EXPECT_GT(drawn(radians(0.25), radians(0.25)), 1u);
  EXPECT_LT(drawn(radians(0.5), radians(60.0)), 20000u);  // a side-scan's slice
}

}  // namespace
}  // namespace neritic::render
