// The computer on a drawn diver's wrist shows that diver's dive, in any camera, and costs nothing
// where nobody wears one or no wrist is in sight.
#include "testbed/instruments/wrist_displays.hpp"

#include <gtest/gtest.h>

#include "testbed/instruments/instrument_data.hpp"
#include "testbed/loop/loop.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

// The middle of the display in the joint's frame, and the way off the arm's back
// (tools/assets/diver_trim.py).
const Vec3 kDisplay_m(-0.18647, -0.10770, 0.0);
const Vec3 kOut = glm::normalize(Vec3(-1.0, 1.0, 0.0));

// A camera whose picture is just the display of a wrist, texel on pixel, from 0.3 m.
std::string wrist_camera(const std::string& diver) {
  constexpr double kFrom_m = 0.3, kHigh_m = 0.044;
  const Vec3 at = kDisplay_m + kFrom_m * kOut;
  return fmt::format(
      "[[cameras]]\nname = \"{}_wrist\"\non = \"{}\"\njoint = \"forearm_l\"\n"
      "position_m = [{}, {}, {}]\nyaw_deg = -90\npitch_deg = -45\nroll_deg = -90\n"
      "width = {}\nheight = {}\nfov_deg = {}\n",
      diver, diver, at.x, at.y, at.z, hud::kDisplayWidth_px, hud::kDisplayHeight_px,
      degrees(2.0 * std::atan(0.5 * kHigh_m / kFrom_m)));
}

std::string named_diver(const std::string& name, double east_m, double depth_m) {
  std::string text =
      diver_text(fmt::format("position_m = [{}, {}, 0]\n", east_m, -depth_m) + kProne);
  return text.replace(text.find("\"diver\""), 7, "\"" + name + "\"");
}

// How alike the brightness of two pictures is: 1 for alike but for gain and offset.
double correlation(const ImageU8& a, const ImageU8& b) {
  const auto count = static_cast<double>(a.width) * a.height;
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::uint32_t y = 0; y < a.height; ++y)
    for (std::uint32_t x = 0; x < a.width; ++x) {
      const double va = a.at(x, y, 1), vb = b.at(x, y, 1);
      sa += va, sb += vb, saa += va * va, sbb += vb * vb, sab += va * vb;
    }
  return (count * sab - sa * sb) / std::sqrt((count * saa - sa * sa) * (count * sbb - sb * sb));
}

ImageU8 canvas_of(const hud::DiveData& data) {
  draw2d::Canvas canvas(ImageU8(hud::kDisplayWidth_px, hud::kDisplayHeight_px, 4));
  std::vector<hud::TextMark> marks;
  hud::Painter painter(canvas, 1.0, marks);
  hud::draw_display(painter, hud::shown_on_display(hud::Units::kMetric, data, data.time_s));
  return canvas.image();
}

class WristDisplaysTest : public test::GpuTest {
 protected:
  // Two divers at 6 and 23 m, and a camera that looks away from both.
  void SetUp() override {
    test::GpuTest::SetUp();
    if (!IsSkipped()) open(true);
  }
  void TearDown() override {
    session_.reset();
    test::GpuTest::TearDown();
  }
  void open(bool displays) {
    scene::Scene scene =
        load_text(kStillWater + named_diver("ann", 0.0, 6.0) + named_diver("bob", 4.0, 23.0) +
                  wrist_camera("ann") + wrist_camera("bob") +
                  "[[cameras]]\nname = \"away\"\nposition_m = [0, -6, 50]\nyaw_deg = 180\n"
                  "width = 64\nheight = 48\n")
            .value();
    physics_ = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
    physics_->start();
    displays_.emplace(*physics_, hud::Units::kMetric);
    session_.reset();
    session_ = Session::create(device(), std::move(scene),
                               picture_places(displays ? &*displays_ : nullptr))
                   .value();
    session_->keep_plan_dump(true);
  }
  FrameResult picture(double time_s, std::vector<std::size_t> cameras, bool displays = true) {
    FrameRequest request{.time_s = physics_->follow(0, time_s), .cameras = std::move(cameras)};
    request.capture = Capture{.motion = false}.without_geometry();
    request.simulated = &physics_->motion();
    displays_->follow();
    if (displays) request.pictures = &*displays_;
    return session_->render(request).value();
  }
  bool uploads(const std::string& diver) const {
    return session_->plan_text().find("writes picture of " + diver) != std::string::npos;
  }
  hud::DiveData data(std::size_t diver) const {
    return instrument_data(physics_->world(), diver, physics_->shown_snapshot());
  }

  std::unique_ptr<LivePhysics> physics_;
  std::optional<WristDisplays> displays_;
  std::unique_ptr<Session> session_;
};

TEST_F(WristDisplaysTest, EachShowsItsOwnDiversDive) {
  const FrameResult frame = picture(5.0, {0, 1});
  const ImageU8 canvases[] = {canvas_of(data(0)), canvas_of(data(1))};
  for (std::size_t i = 0; i < 2; ++i) {
    const double own = correlation(frame.cameras[i].eyes[0].color, canvases[i]);
    const double other = correlation(frame.cameras[i].eyes[0].color, canvases[1 - i]);
    EXPECT_GT(own, 0.9) << i;
    EXPECT_GT(own, other + 0.03) << i;
  }
}

TEST_F(WristDisplaysTest, FollowTheDiveAndAreUploadedOnlyWhereTheyChange) {
  const FrameResult before = picture(5.0, {1});
  EXPECT_TRUE(uploads("bob"));
  EXPECT_FALSE(uploads("ann"));
  const ImageU8 then = canvas_of(data(1));
  EXPECT_EQ(picture(5.0, {1}).cameras[0].eyes[0].color.data, before.cameras[0].eyes[0].color.data);
  EXPECT_FALSE(uploads("bob"));
  const FrameResult after = picture(20.0, {1});
  EXPECT_TRUE(uploads("bob"));
  const ImageU8 now = canvas_of(data(1));
  const ImageU8& shown = after.cameras[0].eyes[0].color;
  EXPECT_GT(correlation(shown, now), correlation(shown, then) + 0.01);
}

// In another run, whatever was drawn before.
TEST_F(WristDisplaysTest, TheSameStateGivesTheSameBits) {
  for (const double time_s : {1.0, 3.5, 7.0}) picture(time_s, {0, 1});
  const FrameResult one = picture(9.0, {0, 1});
  open(true);
  const FrameResult two = picture(9.0, {0, 1});
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(one.cameras[i].eyes[0].color.data, two.cameras[i].eyes[0].color.data);
}

TEST_F(WristDisplaysTest, OutOfSightTheyAreNeitherDrawnNorUploaded) {
  picture(5.0, {2});
  EXPECT_EQ(session_->plan_text().find("picture of"), std::string::npos);
  EXPECT_EQ(displays_->picture(0).number, 1u);  // the first of it
}

TEST_F(WristDisplaysTest, ASceneWithoutComputersHasNoImageNorPass) {
  open(false);
  const FrameResult frame = picture(5.0, {0}, false);
  EXPECT_EQ(session_->plan_text().find("picture of"), std::string::npos);
  EXPECT_EQ(session_->plan_text().find("emission"), std::string::npos);
  EXPECT_FALSE(session_->gpu_scene().has_emission());
  // The display is dark.
  const ImageU8& dark = frame.cameras[0].eyes[0].color;
  for (std::uint32_t y = 20; y < dark.height - 20; y += 10)
    for (std::uint32_t x = 20; x < dark.width - 20; x += 10)
      ASSERT_LT(dark.at(x, y, 1), 100) << x << ' ' << y;
}

// A run's loop asks before its physics reaches on for motion.
TEST_F(WristDisplaysTest, ALoopShowsTheFramesOwnTime) {
  struct Last final : FrameSink {
    Status accept(const FrameResult& frame) override {
      color = frame.cameras[0].eyes[0].color;
      return {};
    }
    Status finish() override { return {}; }
    ImageU8 color;
  };
  const auto shown_at = [&](bool motion) {
    open(true);
    Last last;
    Loop loop({.clock = Clock::simulated(7.99, 1.0 / 30.0),
               .physics = physics_.get(),
               .sensors = LoopSensors{.session = session_.get(),
                                      .cameras = {0},
                                      .capture = Capture{.motion = motion}},
               .pictures = &*displays_,
               .frame_sinks = {&last},
               .stop = {.frames = 1}});
    EXPECT_TRUE(loop.run().ok());
    return last.color;
  };
  EXPECT_EQ(shown_at(false).data, shown_at(true).data);
  // The computer's second passes in between.
  open(true);
  physics_->follow(0, 7.99);
  const ImageU8 then = canvas_of(data(0));
  physics_->follow(0, 7.99 + 1.0 / 30.0);
  EXPECT_NE(canvas_of(data(0)).data, then.data);
}

}  // namespace
}  // namespace neritic::testbed
