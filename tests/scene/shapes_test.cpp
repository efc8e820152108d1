// Shapes: closed surfaces that face outwards, with the areas, volumes and counts of their formulas.
#include "engine/scene/shapes.hpp"

#include <gtest/gtest.h>

namespace neritic::scene {
namespace {

struct Measure {
  double area_m2 = 0.0, volume_m3 = 0.0;
};

const Primitive& only_primitive(const Model& model) {
  return model.meshes.at(0).primitives.at(0);
}

// Area, and the volume by the divergence theorem: positive where faces turn outwards.
Measure measure(const Model& model) {
  const Primitive& p = only_primitive(model);
  Measure out;
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const Vec3 a(p.positions[p.indices[i]]), b(p.positions[p.indices[i + 1]]),
        c(p.positions[p.indices[i + 2]]);
    out.area_m2 += 0.5 * glm::length(glm::cross(b - a, c - a));
    out.volume_m3 += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return out;
}

// The smallest cosine between a face's winding normal and its vertices' normals.
double worst_agreement(const Model& model) {
  const Primitive& p = only_primitive(model);
  double worst = 1.0;
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const Vec3 a(p.positions[p.indices[i]]), b(p.positions[p.indices[i + 1]]),
        c(p.positions[p.indices[i + 2]]);
    const Vec3 face = glm::normalize(glm::cross(b - a, c - a));
    for (std::size_t k = 0; k < 3; ++k)
      worst = std::min(worst, glm::dot(face, Vec3(p.normals[p.indices[i + k]])));
  }
  return worst;
}

void expect_sound(const Model& model) {
  const Primitive& p = only_primitive(model);
  ASSERT_EQ(p.normals.size(), p.positions.size());
  ASSERT_EQ(p.uv0.size(), p.positions.size());
  for (const std::uint32_t index : p.indices) ASSERT_LT(index, p.positions.size());
  for (const Vec3f& normal : p.normals) EXPECT_NEAR(glm::length(normal), 1.0f, 1e-5f);
  Bounds bounds;
  for (const Vec3f& position : p.positions) bounds.add(Vec3(position));
  EXPECT_EQ(bounds.min, p.bounds.min);
  EXPECT_EQ(bounds.max, p.bounds.max);
}

TEST(Shapes, SphereHasItsAreaVolumeAndOutwardFaces) {
  const Model model = make_sphere(2.0, 128);
  expect_sound(model);
  const Measure m = measure(model);
  EXPECT_NEAR(m.area_m2, 4.0 * kPi * 4.0, 0.1);
  EXPECT_NEAR(m.volume_m3, 4.0 / 3.0 * kPi * 8.0, 0.1);
  EXPECT_GT(worst_agreement(model), 0.99);
  for (const Vec3f& p : only_primitive(model).positions) EXPECT_NEAR(glm::length(p), 2.0f, 1e-5f);
}

TEST(Shapes, TriangleCountsFollowTheSegments) {
  EXPECT_EQ(triangle_count(make_sphere(1.0, 48)), 2u * 48u * 23u);
  EXPECT_EQ(triangle_count(make_sphere(1.0, 3)), 6u);
  EXPECT_EQ(triangle_count(make_cylinder(1.0, 1.0, 30)), 120u);
  EXPECT_EQ(triangle_count(make_box(Vec3(1.0))), 12u);
  EXPECT_EQ(triangle_count(make_plane(1.0, 1.0)), 2u);
}

TEST(Shapes, BoxHasItsSizeAndTextureInMetres) {
  const Model model = make_box({2.0, 3.0, 5.0});
  expect_sound(model);
  const Measure m = measure(model);
  EXPECT_NEAR(m.area_m2, 2.0 * (6.0 + 10.0 + 15.0), 1e-6);
  EXPECT_NEAR(m.volume_m3, 30.0, 1e-6);
  EXPECT_NEAR(worst_agreement(model), 1.0, 1e-6);
  const Primitive& p = only_primitive(model);
  for (std::size_t i = 0; i < p.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = p.indices[i + k], b = p.indices[i + (k + 1) % 3];
      EXPECT_NEAR(glm::length(p.positions[a] - p.positions[b]), glm::length(p.uv0[a] - p.uv0[b]),
                  1e-5f);
    }
}

TEST(Shapes, PlaneFacesUp) {
  const Model model = make_plane(4.0, 6.0);
  expect_sound(model);
  EXPECT_NEAR(measure(model).area_m2, 24.0, 1e-6);
  EXPECT_NEAR(worst_agreement(model), 1.0, 1e-6);
  for (const Vec3f& normal : only_primitive(model).normals) EXPECT_EQ(normal, Vec3f(0, 1, 0));
  EXPECT_EQ(only_primitive(model).bounds.max, Vec3(2.0, 0.0, 3.0));
}

TEST(Shapes, CylinderIsClosedAndFacesOutwards) {
  const Model model = make_cylinder(0.5, 2.0, 256);
  expect_sound(model);
  const Measure m = measure(model);
  EXPECT_NEAR(m.volume_m3, kPi * 0.25 * 2.0, 1e-3);
  EXPECT_NEAR(m.area_m2, 2.0 * kPi * 0.25 + 2.0 * kPi * 0.5 * 2.0, 1e-2);
  EXPECT_GT(worst_agreement(model), 0.99);
}

TEST(Shapes, InsideOutTurnsFacesAndNormals) {
  Model model = make_sphere(1.0, 64);
  const double volume = measure(model).volume_m3;
  turn_inside_out(model);
  EXPECT_NEAR(measure(model).volume_m3, -volume, 1e-9);
  EXPECT_GT(worst_agreement(model), 0.98);
}

TEST(Shapes, TooFewSegmentsAreRaisedToASolid) {
  EXPECT_GT(measure(make_sphere(1.0, 0)).volume_m3, 0.0);
  EXPECT_GT(measure(make_cylinder(1.0, 1.0, -5)).volume_m3, 0.0);
}

}  // namespace
}  // namespace neritic::scene
