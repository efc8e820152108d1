#include "engine/sim/static_world.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "engine/core/random.hpp"
#include "engine/sim/contact_memory.hpp"
#include "engine/sim/triangle_mesh.hpp"
#include "tests/sim/bodies.hpp"
#include "tests/sim/spring.hpp"

namespace neritic::sim {
namespace {

using test::box_mesh, test::kNan, test::Mesh, test::sheet_mesh, test::world_of;

const Vec3 kHalf(0.2, 0.15, 0.3);

BodyShape box_shape(const Vec3& half_m = kHalf) {
  BodyShape shape;
  shape.add_box({}, half_m);
  return shape;
}
BodyShape ball_shape(double radius_m) {
  BodyShape shape;
  shape.add_sphere(Vec3(0.0), radius_m);
  return shape;
}
std::vector<Contact> contacts_of(const StaticWorld& world, const BodyShape& shape, const Pose& pose,
                                 double margin_m = 0.02) {
  ContactMemory memory;
  world.contacts(shape, pose, margin_m, memory);
  return memory.contacts;
}
Pose at(double x, double y, double z) {
  return {Vec3(x, y, z), Quat(1.0, 0.0, 0.0, 0.0)};
}

TEST(StaticWorld, ABallsGapIsItsDistanceToEveryFeatureOfABox) {
  const StaticWorld world = world_of(box_mesh(Vec3(1.0)));
  const BodyShape ball = ball_shape(0.1);
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto uniform = [&](std::uint64_t n) { return random_uniform({4, 0, n}, i) * 2.6 - 1.3; };
    const Vec3 p(uniform(0), uniform(1), uniform(2));
    const Vec3 nearest = glm::clamp(p, Vec3(-1.0), Vec3(1.0));
    const double gap_m = glm::length(p - nearest) - 0.1;
    if (gap_m < -0.099 || gap_m > 0.15) continue;
    const auto contacts = contacts_of(world, ball, {p, Quat(1.0, 0.0, 0.0, 0.0)}, 0.16);
    ASSERT_FALSE(contacts.empty()) << i;
    double least_m = 1.0;
    for (const Contact& contact : contacts) {
      if (contact.gap_m >= least_m) continue;
      least_m = contact.gap_m;
      EXPECT_LT(glm::length(contact.point_m - nearest), 1e-6);
      EXPECT_GT(glm::dot(contact.normal, glm::normalize(p - nearest)), 1.0 - 1e-9);
    }
    EXPECT_NEAR(least_m, gap_m, 1e-7) << i;
  }
}

TEST(StaticWorld, ABoxLyingFlatTouchesAtItsFourCornersHoweverFineTheMesh) {
  for (const int cuts : {1, 3, 50}) {
    const auto contacts =
        contacts_of(world_of(sheet_mesh(5.0, 5.0, cuts)), box_shape(), at(0.013, 0.151, -0.02));
    EXPECT_EQ(contacts.size(), 4u) << cuts;
    for (const Contact& contact : contacts) {
      EXPECT_NEAR(contact.gap_m, 0.001, 1e-7);
      EXPECT_NEAR(contact.normal.y, 1.0, 1e-12);
      // The core's corners: the edges are round.
      EXPECT_NEAR(std::abs(contact.point_m.x - 0.013), 0.195, 1e-6);
      EXPECT_NEAR(std::abs(contact.point_m.z + 0.02), 0.295, 1e-6);
    }
  }
}

TEST(StaticWorld, ABoxOnANarrowPostTouchesAtThePostsCorners) {
  const auto contacts = contacts_of(world_of(box_mesh(Vec3(0.05, 1.0, 0.08))), box_shape(),
                                    at(0.0, 1.15, 0.0), 0.005);
  EXPECT_EQ(contacts.size(), 4u);
  for (const Contact& contact : contacts) {
    EXPECT_NEAR(std::abs(contact.point_m.x), 0.05, 1e-6);
    EXPECT_NEAR(std::abs(contact.point_m.z), 0.08, 1e-6);
    EXPECT_NEAR(contact.normal.y, 1.0, 1e-9);
  }
}

TEST(StaticWorld, ABoxAcrossARidgeTouchesAlongItsEdge) {
  // A roof whose ridge runs along x at y = 0.
  const Mesh roof{{{-2, 0, 0}, {2, 0, 0}, {-2, -1, 1}, {2, -1, 1}, {-2, -1, -1}, {2, -1, -1}},
                  {0, 2, 1, 1, 2, 3, 0, 1, 4, 1, 5, 4}};
  const auto contacts = contacts_of(world_of(roof), box_shape(), at(0.0, 0.15, 0.0), 0.005);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR(contacts[0].point_m.x + contacts[1].point_m.x, 0.0, 1e-6);
  EXPECT_NEAR(std::abs(contacts[0].point_m.x), 0.195, 1e-6);
  for (const Contact& contact : contacts) EXPECT_NEAR(contact.normal.y, 1.0, 1e-6);
}

TEST(StaticWorld, SeamsOfASmoothSurfaceCatchNothing) {
  // Over a finely cut plane, at any height within the margin, no contact may point sideways.
  const StaticWorld world = world_of(sheet_mesh(3.0, 3.0, 60));
  for (std::uint64_t i = 0; i < 300; ++i) {
    const auto uniform = [&](std::uint64_t n) { return random_uniform({5, 0, n}, i); };
    const Quat turn = glm::angleAxis(uniform(0) * 6.0,
                                     glm::normalize(Vec3(uniform(1) - 0.5, 1.0, uniform(2) - 0.5)));
    const Mat3 axes = glm::mat3_cast(turn);
    double lowest_m = 0.005;
    for (int k = 0; k < 3; ++k) lowest_m += std::abs(axes[k].y) * (kHalf[k] - 0.005);
    const Pose pose{Vec3(uniform(3), lowest_m + 0.01 * uniform(4) - 0.004, uniform(5)), turn};
    const auto contacts = contacts_of(world, box_shape(), pose, 0.03);
    ASSERT_FALSE(contacts.empty());
    double least_m = 1.0;
    for (const Contact& contact : contacts) {
      EXPECT_GT(contact.normal.y, 0.999999) << i;
      least_m = std::min(least_m, contact.gap_m);
    }
    EXPECT_NEAR(least_m, pose.position_m.y - lowest_m, 1e-6) << i;
  }
}

TEST(StaticWorld, ContactsHaveOneOrderAndTheSameBitsEveryTime) {
  Mesh bumps = sheet_mesh(3.0, 3.0, 40);
  for (std::size_t i = 0; i < bumps.vertices_m.size(); ++i)
    bumps.vertices_m[i].y = 0.05f * static_cast<float>(random_uniform({6, 0, 0}, i));
  const StaticWorld world = world_of(bumps);
  const Pose pose{Vec3(0.1, 0.18, 0.2), glm::angleAxis(0.1, Vec3(1.0, 0.0, 0.0))};
  const auto first = contacts_of(world, box_shape(), pose);
  ASSERT_GT(first.size(), 3u);
  for (std::size_t i = 1; i < first.size(); ++i)
    EXPECT_LE(first[i - 1].triangle, first[i].triangle);
  for (int again = 0; again < 10; ++again) {
    const auto contacts = contacts_of(world_of(bumps), box_shape(), pose);
    ASSERT_EQ(contacts.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(contacts[i].point_m, first[i].point_m);
      EXPECT_EQ(contacts[i].gap_m, first[i].gap_m);
    }
  }
}

TEST(StaticWorld, AHundredKilometresOutContactsAreTheSame) {
  const Mesh mesh = box_mesh(Vec3(1.0), 6);
  const Vec3 far_m(1.0e5, -40.0, -7.0e4);
  const Quat turn = glm::angleAxis(0.4, glm::normalize(Vec3(0.2, 1.0, 0.1)));
  const Pose near_pose{Vec3(0.1, 1.16, 0.2), glm::angleAxis(0.3, Vec3(0.0, 1.0, 0.0))};
  const auto near_contacts =
      contacts_of(world_of(mesh, {{Vec3(0.0), turn}}), box_shape(), near_pose);
  const auto far_contacts = contacts_of(world_of(mesh, {{far_m, turn}}), box_shape(),
                                        {near_pose.position_m + far_m, near_pose.rotation});
  ASSERT_EQ(near_contacts.size(), far_contacts.size());
  ASSERT_FALSE(near_contacts.empty());
  for (std::size_t i = 0; i < near_contacts.size(); ++i) {
    EXPECT_NEAR(near_contacts[i].gap_m, far_contacts[i].gap_m, 1e-9);
    EXPECT_LT(glm::length(near_contacts[i].point_m + far_m - far_contacts[i].point_m), 1e-6);
    EXPECT_LT(glm::length(near_contacts[i].normal - far_contacts[i].normal), 1e-9);
  }
}

// Flat ground, planes, boxes and hulls are not creased; uneven ground may have inner edges.
TEST(StaticWorld, ThingsWithInnerEdgesAreCounted) {
  const Mesh box = box_mesh(Vec3(1.0));
  const auto creased = [&](float bump_m) {
    StaticWorldBuilder builder;
    builder.place(builder.add_mesh(box.vertices_m, box.indices, "box").value(), {}, {});
    const std::vector<float> heights_m{0.0f, 0.0f, bump_m, 0.0f};
    builder.place(builder.add_heights(2, 2, 1.0, heights_m, "bed").value(), {}, {});
    return builder.build().counts().creased;
  };
  EXPECT_EQ(creased(0.0f), 0u);
  EXPECT_EQ(creased(0.1f), 1u);
}

TEST(StaticWorld, ScaledAndTurnedCopiesShareAShape) {
  StaticWorldBuilder builder;
  const Mesh mesh = box_mesh(Vec3(1.0));
  const auto shape = builder.add_mesh(mesh.vertices_m, mesh.indices, "box");
  ASSERT_TRUE(shape.ok());
  builder.place(*shape, {at(0.0, 0.0, 0.0), 0.5}, {});
  builder.place(*shape,
                {{Vec3(10.0, 0.0, 0.0), glm::angleAxis(kPi / 4.0, Vec3(0.0, 1.0, 0.0))}, 2.0},
                {.label = 7});
  const StaticWorld world = builder.build();
  EXPECT_EQ(world.counts().things, 2u);
  EXPECT_EQ(world.counts().triangles, 24u);
  const auto small = contacts_of(world, ball_shape(0.1), at(0.0, 0.61, 0.0));
  ASSERT_EQ(small.size(), 1u);
  EXPECT_NEAR(small[0].gap_m, 0.01, 1e-7);
  // The large one, turned by 45 degrees, has an edge at 10 - 2 sqrt 2.
  const double edge_x = 10.0 - 2.0 * std::sqrt(2.0);
  const auto large = contacts_of(world, ball_shape(0.1), at(edge_x - 0.11, 0.0, 0.0));
  ASSERT_FALSE(large.empty());
  EXPECT_NEAR(large[0].gap_m, 0.01, 1e-6);
  EXPECT_EQ(large[0].surface.label, 7u);
}

TEST(StaticWorld, APartInsideAClosedMeshIsShownTheNearestWayOut) {
  const StaticWorld world = world_of(box_mesh(Vec3(1.0), 4));
  const auto contacts = contacts_of(world, ball_shape(0.1), at(0.7, 0.1, -0.2));
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_TRUE(contacts[0].inside);
  EXPECT_NEAR(contacts[0].normal.x, 1.0, 1e-9);
  EXPECT_NEAR(contacts[0].gap_m, -0.4, 1e-6);
  EXPECT_TRUE(contacts_of(world, ball_shape(0.1), at(1.2, 0.1, -0.2)).empty());
}

TEST(StaticWorld, BelowTheSeabedTheWayOutIsUp) {
  const StaticWorld world = test::flat_seabed();
  const auto contacts = contacts_of(world, ball_shape(0.1), at(3.3, -4.0, 2.1));
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_TRUE(contacts[0].inside);
  EXPECT_NEAR(contacts[0].normal.y, 1.0, 1e-12);
  EXPECT_NEAR(contacts[0].gap_m, -4.1, 1e-9);
  // Beside the field nothing is below.
  EXPECT_TRUE(contacts_of(world, ball_shape(0.1), at(30.0, -4.0, 0.0)).empty());
}

TEST(StaticWorld, AThickHullsCavityIsNotInside) {
  // A box within a box, the inner one turned inwards: between them is solid, within is not.
  Mesh hull = box_mesh(Vec3(1.0));
  Mesh cavity = box_mesh(Vec3(0.8));
  const auto base = static_cast<std::uint32_t>(hull.vertices_m.size());
  hull.vertices_m.insert(hull.vertices_m.end(), cavity.vertices_m.begin(), cavity.vertices_m.end());
  for (std::size_t i = 0; i < cavity.indices.size(); i += 3)
    for (const std::size_t j : {i + 1, i, i + 2}) hull.indices.push_back(base + cavity.indices[j]);
  const auto mesh = TriangleMesh::build(hull.vertices_m, hull.indices, "hull");
  ASSERT_TRUE(mesh.ok());
  EXPECT_TRUE(mesh->has_inside());
  EXPECT_FALSE(mesh->inside(Vec3(0.1, 0.2, 0.3)));
  EXPECT_TRUE(mesh->inside(Vec3(0.9, 0.2, 0.3)));
  EXPECT_FALSE(mesh->inside(Vec3(1.1, 0.2, 0.3)));
}

TEST(StaticWorld, AnOpenMeshHasNoInsideAndAnInvertedOneHas) {
  Mesh box = box_mesh(Vec3(1.0));
  Mesh open = box;
  open.indices.resize(open.indices.size() - 3);
  EXPECT_FALSE(TriangleMesh::build(open.vertices_m, open.indices, "open")->has_inside());
  for (std::size_t i = 0; i < box.indices.size(); i += 3)
    std::swap(box.indices[i], box.indices[i + 1]);
  const auto inverted = TriangleMesh::build(box.vertices_m, box.indices, "inverted");
  EXPECT_TRUE(inverted->inside(Vec3(0.0)));
  EXPECT_FALSE(inverted->inside(Vec3(0.0, 1.5, 0.0)));
}

TEST(StaticWorld, TrianglesWithoutAreaAndRepeatedOnesAreDroppedAndCounted) {
  Mesh mesh = sheet_mesh(1.0, 1.0, 1);
  mesh.vertices_m.insert(mesh.vertices_m.end(), {{0, 0, 0}, {0.5f, 0, 0}, {1, 0, 0}});
  mesh.indices.insert(mesh.indices.end(), {4, 5, 6, 0, 0, 1, 0, 2, 1, 2, 0, 1});
  const auto built = TriangleMesh::build(mesh.vertices_m, mesh.indices, "mesh");
  ASSERT_TRUE(built.ok());
  EXPECT_EQ(built->triangle_count(), 2u);
  EXPECT_EQ(built->dropped_count(), 4u);
}

TEST(StaticWorld, MeshesOfNothingAreInNobodysWay) {
  const StaticWorld empty = world_of({});
  EXPECT_TRUE(contacts_of(empty, box_shape(), at(0.0, 0.0, 0.0)).empty());
  ContactMemory memory;
  EXPECT_EQ(empty.sweep(box_shape(), at(0.0, 0.0, 0.0), at(9.0, 0.0, 0.0), 0.001, {}, memory), 1.0);
  EXPECT_FALSE(empty.cast(Vec3(0.0), Vec3(0.0, -1.0, 0.0), 100.0).has_value());
  // All triangles without area, and a world without things.
  const Mesh lines{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 1, 2, 0, 0, 0}};
  EXPECT_TRUE(contacts_of(world_of(lines), box_shape(), at(0.0, 0.0, 0.0)).empty());
  EXPECT_TRUE(contacts_of(StaticWorldBuilder().build(), box_shape(), at(0.0, 0.0, 0.0)).empty());
}

TEST(StaticWorld, WhatCannotBeIsNamed) {
  StaticWorldBuilder builder;
  const std::vector<Vec3f> triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto message = [](const auto& result) {
    return result.ok() ? std::string("ok") : result.error().message;
  };
  const std::vector<std::uint32_t> past{0, 1, 3}, two{0, 1}, good{0, 1, 2};
  EXPECT_EQ(message(builder.add_mesh(triangle, past, "wreck.glb")),
            "wreck.glb: index 2: found 3; accepted: below 3, the number of vertices");
  EXPECT_EQ(message(builder.add_mesh(triangle, two, "wreck.glb")),
            "wreck.glb: found 2 indices; accepted: three a triangle");
  std::vector<Vec3f> bad = triangle;
  bad[1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(message(builder.add_mesh(bad, good, "wreck.glb")),
            "wreck.glb: found vertex 1, which is not finite; accepted: "
            "finite numbers");
  const std::vector<Vec3> flat{Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0),
                               Vec3(1.0, 1.0, 0.0)};
  EXPECT_EQ(message(builder.add_hull(flat, "rock")),
            "rock: found a hull of 4 points without volume; accepted: four "
            "points or more, not in a plane");
  const std::vector<float> heights(4, std::numeric_limits<float>::infinity());
  EXPECT_EQ(message(builder.add_heights(2, 2, 1.0, heights, "bed")),
            "bed: height 0: found infinity; accepted: numbers, NaN for none");
  EXPECT_EQ(message(builder.add_heights(3, 2, 1.0, heights, "bed")),
            "bed: found 4 heights for 2 x 3; accepted: at least 2 x 2, one each");
  BodyShape shape;
  EXPECT_EQ(message(shape.add_hull(flat, "hull")),
            "hull: found a hull of 4 points without volume; accepted: four "
            "points or more, not in a plane");
  const std::vector<Vec3> nowhere{Vec3(kNan), Vec3(1.0), Vec3(2.0), Vec3(3.0)};
  EXPECT_EQ(message(shape.add_hull(nowhere, "hull")),
            "hull: found point 0, which is not finite; accepted: finite numbers");
}

TEST(StaticWorld, HullsKeepTheirSizeButForTheirEdges) {
  BodyShape hull;
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? 0.2 : -0.2, i & 2 ? 0.15 : -0.15, i & 4 ? 0.3 : -0.3);
  corners.emplace_back(0.0);  // within
  ASSERT_TRUE(hull.add_hull(corners, "hull").ok());
  EXPECT_EQ(hull.parts()[0].core_m.size(), 8u);
  const auto contacts = contacts_of(test::flat_seabed(), hull, at(0.0, 0.152, 0.0));
  EXPECT_EQ(contacts.size(), 4u);
  for (const Contact& contact : contacts) EXPECT_NEAR(contact.gap_m, 0.002, 2e-5);
}

}  // namespace
}  // namespace neritic::sim
