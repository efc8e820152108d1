// A world of a physics that another loop turns, as of a served dive: that loop computes its images.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "engine/core/files.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/sensors/image_consumer.hpp"
#include "testbed/world/world.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

// A vehicle that rises past a block, since nothing drives it.
class AttachedWorld : public test::GpuTest {
 protected:
  using Images = std::map<TimeNs, std::unique_ptr<WorldImage>>;

  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    const std::string dynamics =
        (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string();
    NERITIC_ASSERT_STATUS(write_text(
        path_,
        "[physics]\n[sun]\nelevation_deg = 60\n[water]\ntype = \"IB\"\n[[vehicles]]\nname = "
        "\"rov\"\nshape = \"box\"\n"
        "dynamics = \"" +
            dynamics +
            "\"\nposition_m = [0, -6, 0]\n[[vehicles.cameras]]\nname = \"eye\"\nwidth = 48\n"
            "height = 32\nfov_deg = 70\nrate_hz = 20\nposition_m = [0, 0, -0.5]\n[[objects]]\n"
            "name = \"block\"\nshape = \"box\"\nsize_m = [1, 1, 1]\nposition_m = [0, -6, -3]\n"));
    NERITIC_ASSERT_OK(scene_, scene::load_scene(path_));
    physics_ = LivePhysics::create(scene_, LivePhysics::Pace::kPicture).value();
    NERITIC_ASSERT_OK(world_, World::attach(*physics_, scene_, path_.string()));
    NERITIC_ASSERT_OK(session_, Session::create(device(), scene_));
  }
  // All images of half a second whose frames are the steps, as those of a world of its own.
  Images of_loop() {
    Loop loop({.clock = Clock::steps(1, world_->step_s()),
               .physics = physics_.get(),
               .sensors = LoopSensors{.session = session_.get(),
                                      .own_rates = true,
                                      .consumers = {world_->images()}},
               .stop = {.frames = 120}});
    const Status status = loop.run();
    EXPECT_TRUE(status.ok()) << status.error().message;
    return taken(*world_);
  }
  static Images taken(World& world) {
    Images out;
    for (auto& image : world.take_images()) {
      const TimeNs stamp_ns = image->stamp_ns;
      out[stamp_ns] = std::move(image);
    }
    return out;
  }

  const test::ScratchFolder scratch_;
  const std::filesystem::path path_ = scratch_ / "s.toml";
  scene::Scene scene_;
  std::unique_ptr<LivePhysics> physics_;
  std::unique_ptr<World> world_;
  std::unique_ptr<Session> session_;
};

TEST_F(AttachedWorld, GetsTheImagesThatAWorldOfItsOwnLoopGets) {
  NERITIC_ASSERT_STATUS(world_->want_image(world_->stream("rov_eye/color").value(), 0.0, true));
  const Images found = of_loop();
  NERITIC_ASSERT_OK(const auto own, World::open(path_));
  NERITIC_ASSERT_STATUS(own->want_image(own->stream("rov_eye/color").value(), 0.0, true));
  NERITIC_ASSERT_STATUS(own->tick(120));
  const Images wanted = taken(*own);
  EXPECT_EQ(found.size(), 10u);
  std::size_t both = 0;
  std::vector<std::byte> first, last;
  for (const auto& [stamp_ns, image] : found) {
    EXPECT_EQ(image->width, 48u);
    EXPECT_EQ(image->channels, 3u);
    const std::vector<std::byte> bytes(image->bytes().begin(), image->bytes().end());
    (first.empty() ? first : last) = bytes;
    const auto same = wanted.find(stamp_ns);
    if (same == wanted.end()) continue;
    ++both;
    EXPECT_EQ(bytes,
              std::vector<std::byte>(same->second->bytes().begin(), same->second->bytes().end()))
        << stamp_ns;
    EXPECT_EQ(image->position, same->second->position) << stamp_ns;
  }
  EXPECT_EQ(both, 10u);
  EXPECT_NE(first, last);  // it rises
}

// 20 images a second, 240 steps: one at each twelfth step, whenever it was asked for.
TEST_F(AttachedWorld, AWorldOfItsOwnGivesTheImageOfTheStepThatEndsATick) {
  NERITIC_ASSERT_OK(const auto own, World::open(path_));
  const auto steps = [&] {
    std::vector<int> out;
    for (const auto& [stamp_ns, image] : taken(*own))
      out.push_back(static_cast<int>(std::lround(240e-9 * static_cast<double>(stamp_ns))));
    return out;
  };
  const std::uint32_t color = own->stream("rov_eye/color").value();
  NERITIC_ASSERT_STATUS(own->want_image(color, 0.0, true));
  NERITIC_ASSERT_STATUS(own->tick(12));
  EXPECT_EQ(steps(), std::vector<int>{12});
  const std::vector<std::byte> saved = own->save();
  NERITIC_ASSERT_STATUS(own->tick(29));
  EXPECT_EQ(steps(), (std::vector<int>{24, 36}));
  const std::vector<std::byte> later = own->save();  // of step 41
  // Another rate, or the same stream again, goes by time 0 too.
  NERITIC_ASSERT_STATUS(own->drop_image(color));
  NERITIC_ASSERT_STATUS(own->want_image(color, 10.0, true));
  NERITIC_ASSERT_STATUS(own->tick(31));
  EXPECT_EQ(steps(), (std::vector<int>{48, 72}));
  NERITIC_ASSERT_STATUS(own->want_image(color, 0.0, true));
  NERITIC_ASSERT_STATUS(own->restore(saved));
  NERITIC_ASSERT_STATUS(own->tick(13));
  EXPECT_EQ(steps(), std::vector<int>{24});
  NERITIC_ASSERT_STATUS(own->restore(later));
  NERITIC_ASSERT_STATUS(own->tick(8));
  EXPECT_EQ(steps(), std::vector<int>{48});
}

TEST_F(AttachedWorld, GetsNoneThatItDoesNotWant) {
  const std::uint32_t color = world_->stream("rov_eye/color").value();
  NERITIC_ASSERT_STATUS(world_->want_image(color, 4.0, true));
  EXPECT_EQ(of_loop().size(), 2u);  // at 0.25 and 0.5 s
  NERITIC_ASSERT_STATUS(world_->drop_image(color));
  EXPECT_EQ(of_loop().size(), 0u);
}

}  // namespace
}  // namespace neritic::testbed
