// The instruments over a view: what they show is the state's, and each lies where its layout says.
#include "testbed/view/dive_hud.hpp"

#include <gtest/gtest.h>

#include "diver/frames.hpp"
#include "engine/xr/offscreen.hpp"
#include "testbed/instruments/instrument_data.hpp"
#include "testbed/simulation/human_readings.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

constexpr std::uint32_t kWidth = 640, kHeight = 480;

std::unique_ptr<LivePhysics> diver_physics(const std::string& keys = "",
                                           const std::string& human = "") {
  const scene::Scene scene =
      load_text(kStillWater +
                diver_text("position_m = [0, -12, 0]\n" + std::string(kProne) + keys, human))
          .value();
  auto physics = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
  physics->start();
  physics->follow(0, 1.5);
  return physics;
}

TEST(InstrumentData, IsWhatTheStateSays) {
  const auto physics = diver_physics();
  const PhysicsHuman& human = physics->world().humans()[0];
  const HumanPhysics& state = physics->shown().humans()[0];
  const hud::DiveData data = instrument_data(physics->world(), 0, physics->shown_snapshot());
  const ComputerReading computer = computer_reading(human, state);
  EXPECT_EQ(data.time_s, physics->shown_snapshot().time_s);
  EXPECT_EQ(data.depth_m, computer.depth_m);
  EXPECT_NEAR(data.depth_m, 12.0, 1.0);
  EXPECT_EQ(data.po2_bar, computer.po2_bar);
  EXPECT_EQ(data.cns_percent, computer.cns_percent);
  EXPECT_EQ(data.no_stop_min, computer.no_stop_min);
  const diver::GasReading gas = diver::read_gas(human.body, state.human);
  EXPECT_EQ(data.tank_pa, gas.tank_pa);
  EXPECT_EQ(data.gas_min, gas.remaining_s / 60.0);
  EXPECT_EQ(data.jacket_m3, gas.jacket_m3);
  EXPECT_EQ(data.lift_n, human.body.water_kg_m3 * 9.80665 * gas.jacket_m3);
  EXPECT_EQ(data.heart_bpm, state.human.life.vitals.heart_bpm);
  EXPECT_TRUE(data.gas_known);
  // Air at saturation of the surface: n2 of 0.75 bar in 2.2 bar, and little more.
  for (const double tissue : data.tissues) EXPECT_NEAR(tissue, 0.5 * 0.75 / 2.2, 0.05);
}

TEST(InstrumentData, TheConditionIsThatOfEffectsThatTheSceneNames) {
  const auto plain = diver_physics();
  const hud::DiveData without = instrument_data(plain->world(), 0, plain->shown_snapshot());
  EXPECT_TRUE(std::isnan(without.slowing) && std::isnan(without.saturation));
  const auto physics = diver_physics("condition = { effects = [\"narcosis\", \"cold\"] }\n");
  const hud::DiveData data = instrument_data(physics->world(), 0, physics->shown_snapshot());
  const diver::ConditionState& state = physics->shown().conditions()[0];
  EXPECT_EQ(data.core_c, state.cold.core_c);
  EXPECT_EQ(data.slowing, state.slowing);
  EXPECT_EQ(data.strength, state.strength);
  EXPECT_NEAR(data.narcotic_depth_m, 12.0, 1.5);  // of air
  EXPECT_TRUE(std::isnan(data.saturation) && std::isnan(data.co2_mmhg));
  EXPECT_TRUE(std::isnan(data.oxygen_dose));
  EXPECT_FALSE(data.unconscious);
}

TEST(InstrumentData, AnotherTankIsToldOnlyWhereItsGasCanBeBreathed) {
  const test::ScratchFolder folder;
  const std::string file = (folder / "human.toml").string();
  for (const auto& [tanks, wanted] : {std::pair("[ {} ]", false),
                                      {"[ {}, { oxygen = 0.32 } ]", true},
                                      {"[ {}, { oxygen = 1.0 } ]", false},  // 2.2 bar at 12 m
                                      {"[ {}, { oxygen = 0.05, helium = 0.8 } ]", false},
                                      {"[ {}, { pressure_bar = 3 } ]", false}}) {
    ASSERT_TRUE(write_text(file, fmt::format("tanks = {}\n", tanks)).ok());
    const auto physics = diver_physics("", file);
    const hud::DiveData data = instrument_data(physics->world(), 0, physics->shown_snapshot());
    EXPECT_EQ(data.other_gas, wanted) << tanks;
  }
}

// At 12 m no tank of these has too much oxygen. One with less than now is leaner, one with more is
// not.
TEST(InstrumentData, ALeanerGasHasLessOxygenThanTheOneThatIsBreathed) {
  const test::ScratchFolder folder;
  const std::string file = (folder / "human.toml").string();
  for (const auto& [tanks, wanted] :
       {std::pair("[ { oxygen = 0.32 } ]", false),
        {"[ { oxygen = 0.32 }, { oxygen = 0.21 } ]", true},
        {"[ { oxygen = 0.32 }, { oxygen = 0.50 } ]", false},
        {"[ { oxygen = 0.32 }, { oxygen = 0.05, helium = 0.8 } ]", false},
        {"[ { oxygen = 0.32 }, { oxygen = 0.21, pressure_bar = 3 } ]", false}}) {
    ASSERT_TRUE(write_text(file, fmt::format("tanks = {}\n", tanks)).ok());
    const auto physics = diver_physics("", file);
    const hud::DiveData data = instrument_data(physics->world(), 0, physics->shown_snapshot());
    EXPECT_EQ(data.leaner_gas, wanted) << tanks;
  }
}

// From the axes: the head's way while the diver lies, the belly's while the diver stands.
TEST(InstrumentData, HeadingIsAheadInAnyAttitude) {
  for (const double heading : {0.1, 1.0, 2.5, 4.0, 6.0})
    for (double pitch = -1.5; pitch <= 2.1; pitch += 0.2) {
      const Quat yaw = glm::angleAxis(heading, Vec3(0, 0, 1));
      const Quat up = glm::angleAxis(pitch, Vec3(0, 1, 0));  // the head rises
      const double found = diver_heading_rad(yaw * up);
      EXPECT_NEAR(std::remainder(found - heading, 2.0 * kPi), 0.0, 1e-6) << heading << " " << pitch;
      EXPECT_GE(found, 0.0);
    }
}

TEST(InstrumentData, TheWristIsAtTheDrawnHand) {
  const auto physics = diver_physics();
  const Pose wrist = world_from_wrist(physics->world().humans()[0], physics->shown().humans()[0]);
  const Vec3 hips = diver::world_from_ned(physics->shown().humans()[0].human.root.position_ned_m);
  // A prone diver who swims north; the left arm is to the west.
  EXPECT_LT(wrist.position_m.x, hips.x - 0.1);
  EXPECT_LT(glm::distance(wrist.position_m, hips), 1.2);
}

class DiveHudTest : public test::GpuTest {
 protected:
  void SetUp() override {
    test::GpuTest::SetUp();
    if (IsSkipped()) return;
    physics_ = diver_physics();
    frames_ = gpu::Frames::create(device(), 1).value();
    executor_ = std::make_unique<graph::Executor>(*frames_);
    group_ = xr::one_view(kWidth, kHeight, radians(60.0));
    display_ = xr::OffscreenDisplay::create(device(), {{group_}}).value();
  }
  void TearDown() override {
    executor_.reset();
    test::GpuTest::TearDown();
  }
  // One frame that is seen at seen_s; gives the names of its passes.
  std::vector<std::string> frame(DiveHud& hud, double seen_s = 0.0) {
    graph::FrameGraph graph;
    std::vector<xr::Layer> layers;
    HudView view{group_, false, {}, {}};
    view.seen_s = seen_s;
    EXPECT_TRUE(hud.declare(graph, view, layers).ok());
    EXPECT_TRUE(display_->declare(graph, {}, layers).ok());
    gpu::Commands* commands = frames_->begin().value();
    EXPECT_TRUE(executor_->run(graph, *commands).ok());
    EXPECT_TRUE(frames_->wait(frames_->submit().value()).ok());
    std::vector<std::string> names;
    for (const graph::PassDecl& pass : graph.declaration().passes) names.push_back(pass.name);
    return names;
  }
  std::vector<std::byte> shown() {
    return gpu::read_image(device(), display_->picture(0), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)
        .value();
  }

  std::unique_ptr<LivePhysics> physics_;
  std::unique_ptr<gpu::Frames> frames_;
  std::unique_ptr<graph::Executor> executor_;
  xr::ViewGroup group_;
  std::unique_ptr<xr::OffscreenDisplay> display_;
};

// Over black, premultiplied colour is itself: the corner's pixels are the picture's own.
TEST_F(DiveHudTest, LiesInTheWindowTexelOnPixel) {
  DiveHud hud(device(), *frames_, *physics_, {.layouts = {hud::LayoutKind::kCorner}});
  frame(hud);
  const auto pixels = shown();
  const std::uint32_t height = 269;  // 0.75 of 358, which is more than 0.43 of 480
  hud::Hud alone(hud::LayoutKind::kCorner, hud::Units::kMetric, height);
  alone.update(instrument_data(physics_->world(), 0, physics_->shown_snapshot()), 0.0);
  const ImageU8& picture = alone.picture();
  const auto left = static_cast<std::uint32_t>(std::round(0.98 * (kWidth - picture.width)));
  const auto top = static_cast<std::uint32_t>(std::round(0.96 * (kHeight - picture.height)));
  int off = 0, lit = 0;
  for (std::uint32_t y = 0; y < kHeight; ++y)
    for (std::uint32_t x = 0; x < kWidth; ++x)
      for (std::uint32_t c = 0; c < 3; ++c) {
        const bool inside =
            x >= left && x < left + picture.width && y >= top && y < top + picture.height;
        const int wanted = inside ? picture.at(x - left, y - top, c) : 0;
        const int found = static_cast<int>(pixels[(std::size_t{y} * kWidth + x) * 4 + c]);
        off += std::abs(found - wanted) > 2;
        lit += wanted > 200;
      }
  EXPECT_EQ(off, 0);
  EXPECT_GT(lit, 3000);
}

TEST_F(DiveHudTest, APictureIsUploadedOnlyWhereItChanged) {
  DiveHud hud(device(), *frames_, *physics_, {.layouts = {hud::LayoutKind::kMask}});
  const auto uploads = [&](double seen_s) {
    return std::ranges::count(frame(hud, seen_s), "hud mask");
  };
  EXPECT_EQ(uploads(0.0), 1);
  EXPECT_EQ(uploads(1.0), 0);  // the simulation stands still
  const auto before = shown();
  physics_->follow(0, 4.5);
  EXPECT_EQ(uploads(2.0), 1);  // the dive's time at least
  EXPECT_NE(shown(), before);
}

// A dive at 20 times its pace: new numbers each fifth of a second of the viewer, not more often.
TEST_F(DiveHudTest, NumbersChangeAtTheViewersPaceWhereTheSceneRunsFast) {
  DiveHud hud(device(), *frames_, *physics_, {.layouts = {hud::LayoutKind::kMask}});
  std::ptrdiff_t uploads = 0;
  for (int i = 0; i < 50; ++i) {
    physics_->follow(0, 1.5 + 0.4 * i);
    uploads += std::ranges::count(frame(hud, 0.02 * i), "hud mask");
  }
  EXPECT_EQ(uploads, 5);
}

TEST_F(DiveHudTest, TheKeyShowsEachAloneThenNoneThenTheChosenOnes) {
  DiveHud hud(device(), *frames_, *physics_,
              {.layouts = {hud::LayoutKind::kCorner, hud::LayoutKind::kWrist}});
  const auto panels = [&] {
    graph::FrameGraph graph;
    std::vector<xr::Layer> layers;
    EXPECT_TRUE(hud.declare(graph, {group_, false, {}, {}}, layers).ok());
    std::string names;
    for (const xr::Layer& layer : layers) names += std::get<xr::PanelLayer>(layer).name + " ";
    return names;
  };
  EXPECT_EQ(panels(), "wrist corner ");
  for (const char* wanted : {"wrist ", "mask ", "corner ", "console ", "", "wrist corner "}) {
    hud.cycle();
    EXPECT_EQ(panels(), wanted);
  }
}

// One colour of the size of a sensor's picture, as an image that a pass may read.
gpu::Image flat_picture(gpu::Device& device, std::uint32_t width, std::uint32_t height,
                        std::array<std::uint8_t, 4> color) {
  gpu::Image image = gpu::Image::create(device, {.name = "flat",
                                                 .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                 .width = width,
                                                 .height = height,
                                                 .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                                          VK_IMAGE_USAGE_SAMPLED_BIT,
                                                 .array_view = true})
                         .value();
  std::vector<std::uint8_t> texels;
  for (std::uint32_t i = 0; i < width * height; ++i)
    texels.insert(texels.end(), color.begin(), color.end());
  EXPECT_TRUE(gpu::upload_image(device, image, std::as_bytes(std::span(texels))).ok());
  return image;
}

// The pictures of sonar and camera fill the middles of their places, in their own shapes, and stay
// there until the next ones; a console without such sensors has no place and copies nothing.
TEST_F(DiveHudTest, TheConsoleShowsTheSonarsAndTheCamerasPictures) {
  const gpu::Image sonar = flat_picture(device(), 100, 80, {200, 40, 10, 255}),
                   camera = flat_picture(device(), 160, 90, {10, 40, 200, 255});
  for (const bool has : {true, false}) {
    DiveHud hud(device(), *frames_, *physics_,
                {.layouts = {hud::LayoutKind::kConsole},
                 .sonar = has ? "rov sonar" : "",
                 .camera = has ? "rov camera" : ""});
    std::vector<std::string> names;
    for (const double seen_s : {0.0, 0.05, 0.1}) {
      graph::FrameGraph graph;
      std::vector<xr::Layer> layers;
      HudView view{group_, false, {}, {}};
      view.seen_s = seen_s;
      EXPECT_EQ(hud.wants_pictures(seen_s), seen_s == 0.0);
      if (hud.wants_pictures(seen_s)) {
        constexpr graph::ImportState kThere{.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        view.sonar = {graph.import_image(sonar, kThere), 100, 80};
        view.camera = {graph.import_image(camera, kThere), 160, 90};
      }
      NERITIC_ASSERT_STATUS(hud.declare(graph, view, layers));
      ASSERT_TRUE(display_->declare(graph, {}, layers).ok());
      gpu::Commands* commands = frames_->begin().value();
      ASSERT_TRUE(executor_->run(graph, *commands).ok());
      ASSERT_TRUE(frames_->wait(frames_->submit().value()).ok());
      for (const graph::PassDecl& pass : graph.declaration().passes) names.push_back(pass.name);
    }
    EXPECT_EQ(std::ranges::count(names, "hud sonar"), has);
    EXPECT_EQ(std::ranges::count(names, "hud camera"), has);
    const auto pixels = shown();
    std::size_t reds = 0, blues = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
      const auto is = [&](int red, int green, int blue) {
        return std::abs(static_cast<int>(pixels[i]) - red) <= 2 &&
               std::abs(static_cast<int>(pixels[i + 1]) - green) <= 2 &&
               std::abs(static_cast<int>(pixels[i + 2]) - blue) <= 2;
      };
      reds += is(200, 40, 10);
      blues += is(10, 40, 200);
    }
    // The console at half its size: the sonar's place is 142 by 130, the camera's 142 by 70.
    EXPECT_NEAR(static_cast<double>(reds), has ? 142.0 * 142.0 * 0.8 : 0.0, 300.0);
    EXPECT_NEAR(static_cast<double>(blues), has ? 70.0 * 70.0 / 0.5625 : 0.0, 300.0);
  }
}

TEST_F(DiveHudTest, AHeadsetLocksEachToItsFrame) {
  DiveHud hud(
      device(), *frames_, *physics_,
      {.layouts = {hud::LayoutKind::kWrist, hud::LayoutKind::kMask, hud::LayoutKind::kConsole}});
  graph::FrameGraph graph;
  std::vector<xr::Layer> layers;
  const Pose stage{{3, -4, 5}, from_yaw_pitch_roll(1.0, 0.0, 0.0)};
  const Pose hand = world_from_wrist(physics_->world().humans()[0], physics_->shown().humans()[0]);
  NERITIC_ASSERT_STATUS(hud.declare(graph, {group_, true, stage, {}, hand}, layers));
  ASSERT_EQ(layers.size(), 3u);
  const auto& wrist = std::get<xr::PanelLayer>(layers[0]);
  const auto& mask = std::get<xr::PanelLayer>(layers[1]);
  const auto& console = std::get<xr::PanelLayer>(layers[2]);
  EXPECT_EQ(wrist.lock, xr::PanelLayer::Lock::kWorld);
  EXPECT_LT(glm::distance(wrist.pose.position_m, hand.position_m), 0.08);
  EXPECT_EQ(mask.lock, xr::PanelLayer::Lock::kHead);
  EXPECT_EQ(mask.size_m, hud::layout_of(hud::LayoutKind::kMask).size_m);
  EXPECT_EQ(console.lock, xr::PanelLayer::Lock::kWorld);
  const Vec3 wanted = (stage * Pose{{0.0, 1.5, -1.6}}).position_m;
  EXPECT_LT(glm::distance(console.pose.position_m, wanted), 1e-9);
  // Without a tracked hand the wrist's is held before the eyes.
  layers.clear();
  NERITIC_ASSERT_STATUS(hud.declare(graph, {group_, true, stage, {}}, layers));
  const auto& held = std::get<xr::PanelLayer>(layers[0]);
  EXPECT_EQ(held.lock, xr::PanelLayer::Lock::kHead);
  EXPECT_LT(held.pose.position_m.z, 0.0);
}

// The angles from an eye to a panel in the head's frame, flat or bent, in degrees.
struct Angles {
  double left = 1e9, right = -1e9, bottom = 1e9, top = -1e9;
};
Angles angles_from(const Vec3& eye_m, const xr::PanelLayer& panel, bool bent) {
  constexpr int kParts = 40;
  Angles out;
  for (int i = 0; i <= kParts; ++i)
    for (int j = 0; j <= kParts; ++j) {
      const Vec2 at = panel.size_m * (Vec2(i, j) / double{kParts} - 0.5);
      const double r = bent ? panel.radius_m : 0.0;
      const Vec3 on = r > 0.0 ? Vec3(r * std::sin(at.x / r), at.y, r - r * std::cos(at.x / r))
                              : Vec3(at.x, at.y, 0.0);
      const Vec3 to = panel.pose * on - eye_m;
      const double right = degrees(std::atan2(to.x, -to.z)), up = degrees(std::atan2(to.y, -to.z));
      out.left = std::min(out.left, right), out.right = std::max(out.right, right);
      out.bottom = std::min(out.bottom, up), out.top = std::max(out.top, up);
    }
  return out;
}

// Nearer than the mask's, the wrist's covered its left end in the left eye.
TEST_F(DiveHudTest, WithoutAHandTheWristsIsClearOfTheMasksForEachEye) {
  const auto held_with = [&](std::vector<hud::LayoutKind> layouts) {
    DiveHud hud(device(), *frames_, *physics_, {.layouts = std::move(layouts)});
    graph::FrameGraph graph;
    std::vector<xr::Layer> layers;
    const Status status = hud.declare(graph, {group_, true, {}, {}}, layers);
    EXPECT_TRUE(status.ok());
    std::vector<xr::PanelLayer> out;
    for (const xr::Layer& layer : layers) out.push_back(std::get<xr::PanelLayer>(layer));
    return out;
  };
  const auto both = held_with({hud::LayoutKind::kWrist, hud::LayoutKind::kMask});
  ASSERT_EQ(both.size(), 2u);
  for (const double eye_m : {-0.037, -0.032, 0.0, 0.032, 0.037})
    for (const bool bent : {false, true}) {
      const Angles wrist = angles_from({eye_m, 0, 0}, both[0], bent);
      const Angles mask = angles_from({eye_m, 0, 0}, both[1], bent);
      EXPECT_TRUE(wrist.right < mask.left - 1.0 || wrist.bottom > mask.top + 1.0)
          << eye_m << " " << wrist.right << " " << mask.left << " " << wrist.bottom << " "
          << mask.top;
      EXPECT_GT(wrist.left, -45.0);
    }
  // As near as alone, where it stays in its place.
  const auto alone = held_with({hud::LayoutKind::kWrist});
  const hud::Layout& layout = hud::layout_of(hud::LayoutKind::kWrist);
  EXPECT_EQ(alone.at(0).pose.position_m, layout.head_from_panel.position_m);
  EXPECT_NEAR(glm::length(both[0].pose.position_m), glm::length(alone[0].pose.position_m), 1e-9);
}

}  // namespace
}  // namespace neritic::testbed
