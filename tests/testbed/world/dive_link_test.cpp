// Samples on their way from a dive's steps to the programs that it serves.
#include "testbed/world/dive_link.hpp"

#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "testbed/motion/live_physics.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

// A frame may last longer than there is room for what comes meanwhile: the oldest go, and each of
// them is counted.
TEST(DiveLink, WhatAFrameIsTooSlowForIsCountedAsDropped) {
  const test::ScratchFolder scratch;
  const auto path = scratch / "s.toml";
  NERITIC_ASSERT_STATUS(write_text(
      path,
      "[physics]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = \"" +
          (test::source_dir() / "assets/vehicles/bluerov2_heavy_survey_dynamics.toml").string() +
          "\"\nposition_m = [0, -6, 0]\n"));
  NERITIC_ASSERT_OK(const scene::Scene scene, scene::load_scene(path));
  auto physics = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
  NERITIC_ASSERT_OK(const auto link, DiveLink::create(*physics, scene, path.string(), nullptr));
  World& world = link->world();
  const std::uint32_t stream = world.stream("rov/pressure").value();
  NERITIC_ASSERT_STATUS(world.keep(stream, true));

  OutputSamples outputs(physics->world(),
                        {physics->world().streams().find("rov/pressure").value()});
  physics->start();
  // One real reading, then as many copies of it as do not fit.
  std::vector<Sample> one;
  while (one.empty()) {
    physics->advance();
    const auto samples = outputs.of(physics->newest());
    one.assign(samples.begin(), samples.end());
  }
  const std::size_t sent = DiveLink::kMostWaiting + 5;
  for (std::size_t i = 0; i < sent; ++i) {
    one.front().header.sequence = i;
    NERITIC_ASSERT_STATUS(link->accept(physics->newest(), std::span(one).first(1)));
  }
  SampleInbox& inbox = physics->inbox();
  NERITIC_ASSERT_STATUS(link->poll(inbox, 0.0));
  EXPECT_EQ(world.dropped(), DiveLink::kMostWaiting / 2);
  EXPECT_EQ(world.arrived() + world.dropped(), sent);
  NERITIC_ASSERT_STATUS(link->poll(inbox, 0.0));
  EXPECT_EQ(world.dropped(), DiveLink::kMostWaiting / 2);
}

}  // namespace
}  // namespace neritic::testbed
