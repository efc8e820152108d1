// The skin of a solid: every edge passed both ways, every part wound outwards.
#include "engine/render/closed_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/scene/gltf_loader.hpp"
#include "tests/support/support.hpp"

namespace neritic::render {
namespace {

struct Solid {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices;
  bool closed() const { return is_closed(positions, indices); }
};

// A box whose faces share no vertices, as one with flat normals has them.
void add_faces(Solid& mesh, const Vec3f& at, float half_m, bool inwards = false) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const auto& [u, v] :
           {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
        Vec3f corner;
        corner[axis] = side;
        corner[(axis + 1) % 3] = u;
        corner[(axis + 2) % 3] = v;
        mesh.positions.push_back(at + half_m * corner);
      }
      const bool turned = (side < 0.0f) != inwards;
      for (const std::uint32_t i : turned ? std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2}
                                          : std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3})
        mesh.indices.push_back(first + i);
    }
}

Solid cube() {
  Solid mesh;
  add_faces(mesh, Vec3f(0.0f), 1.0f);
  return mesh;
}

TEST(ClosedSurface, ABoxOfSixFacesIs) {
  EXPECT_TRUE(cube().closed());
}

TEST(ClosedSurface, ABoxThatLacksATriangleIsNot) {
  for (std::size_t t = 0; t < 12; ++t) {
    Solid mesh = cube();
    mesh.indices.erase(mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * t),
                       mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
    EXPECT_FALSE(mesh.closed()) << t;
  }
}

TEST(ClosedSurface, ATurnedTriangleOpensIt) {
  Solid mesh = cube();
  std::swap(mesh.indices[7], mesh.indices[8]);
  EXPECT_FALSE(mesh.closed());
}

TEST(ClosedSurface, ARoomSeenFromInsideIsNot) {
  Solid mesh;
  add_faces(mesh, Vec3f(0.0f), 1.0f, true);
  EXPECT_FALSE(mesh.closed());
}

TEST(ClosedSurface, EveryPartCounts) {
  Solid mesh = cube();
  add_faces(mesh, Vec3f(1000.0f, 0.0f, 0.0f), 3.0f);
  EXPECT_TRUE(mesh.closed());
  add_faces(mesh, Vec3f(0.0f, 50.0f, 0.0f), 0.01f, true);  // small, but its backs are seen
  EXPECT_FALSE(mesh.closed());
}

TEST(ClosedSurface, APartThatOnlyTouchesAnotherCountsToo) {
  Solid mesh = cube();
  add_faces(mesh, Vec3f(1.5f), 0.5f, true);  // a corner at the cube's corner
  EXPECT_FALSE(mesh.closed());
  Solid touching = cube();
  add_faces(touching, Vec3f(1.5f), 0.5f);
  EXPECT_TRUE(touching.closed());
}

TEST(ClosedSurface, AnEdgeOfFourTrianglesIsNoSkin) {
  Solid mesh = cube();
  add_faces(mesh, Vec3f(2.0f, 2.0f, 0.0f), 1.0f);
  EXPECT_FALSE(mesh.closed());
}

TEST(ClosedSurface, FarFromTheMeshsOriginToo) {
  Solid mesh;
  add_faces(mesh, Vec3f(65536.0f), 0.5f);
  EXPECT_TRUE(mesh.closed());
}

TEST(ClosedSurface, TrianglesWithoutAreaChangeNothing) {
  Solid mesh = cube();
  mesh.indices.insert(mesh.indices.end(), {0, 0, 1, 2, 2, 2});
  EXPECT_TRUE(mesh.closed());
}

// Where its back is seen, so is the front of its other side.
TEST(ClosedSurface, ASheetWithTwoSidesIs) {
  const std::vector<Vec3f> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_TRUE((Solid{corners, {0, 1, 2, 0, 2, 1}}.closed()));
  EXPECT_TRUE((Solid{corners, {1, 2, 0, 1, 0, 2}}.closed()));
  EXPECT_FALSE((Solid{corners, {0, 1, 2}}.closed()));
  EXPECT_FALSE((Solid{corners, {0, 1, 2, 1, 2, 0}}.closed()));
  EXPECT_FALSE((Solid{corners, {0, 1, 2, 0, 2, 1, 1, 2, 0}}.closed()));
}

TEST(ClosedSurface, AFinOfTwoSidesLeavesABoxClosed) {
  Solid mesh = cube();
  const auto root = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {{1, 1, 1}, {1, 1, -1}, {2, 2, 0}});
  mesh.indices.insert(mesh.indices.end(), {root, root + 1, root + 2, root + 2, root + 1, root});
  EXPECT_TRUE(mesh.closed());
  mesh.indices.resize(mesh.indices.size() - 3);
  EXPECT_FALSE(mesh.closed());
}

TEST(ClosedSurface, NothingAndWhatIsNotFiniteAreNot) {
  EXPECT_FALSE(Solid{}.closed());
  Solid mesh = cube();
  mesh.positions[3].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(mesh.closed());
  mesh.positions[3].y = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(mesh.closed());
}

// What throws shadows by the thousand, and is heard by the thousand, is drawn by its front alone.
TEST(ClosedSurface, TheSardineIs) {
  const auto model = scene::load_gltf(test::source_dir() / "assets/models/school_fish.glb");
  ASSERT_TRUE(model.ok());
  const auto mesh = std::ranges::find(model->meshes, "sardine", &scene::Mesh::name);
  ASSERT_NE(mesh, model->meshes.end());
  for (const scene::Primitive& p : mesh->primitives) EXPECT_TRUE(is_closed(p.positions, p.indices));
}

}  // namespace
}  // namespace neritic::render
