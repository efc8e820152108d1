// The instruments in a headset, composed by the runtime as layers of their own: goldens of two and
// four views with those of the head, the wrist and the world; text upright in each eye, where each
// eye's frustum puts it. NERITIC_UPDATE_GOLDEN=1 (tools/golden) writes the goldens anew.
#include <cstdlib>

#include "testbed/instruments/instrument_data.hpp"
#include "testbed/view/dive_camera.hpp"
#include "tests/testbed/headset/headset_run.hpp"
#include "tests/testbed/simulation/devices.hpp"

namespace neritic::testbed {
namespace {

namespace fs = std::filesystem;

// The wearer of every test: upright in the room, the left hand before the chest.
constexpr const char* kWearer =
    "head 0 0 1.6 0 0 -10\nhand left 0 -0.1 1.36 -0.34 -70 0 0\nhand right 0 0.3 1.2 -0.3\n"
    "eye_distance 0.064\n";

class HeadsetHud : public HeadsetRun {
 protected:
  void SetUp() override {
    HeadsetRun::SetUp();
    if (IsSkipped()) return;
    scene_ = dive_of(hover_text("") +
                     "[sun]\nelevation_deg = 50\n[[objects]]\nname = \"floor\"\nshape = "
                     "\"box\"\nsize_m = [60, 0.2, 60]\n"
                     "position_m = [0, -14, 0]\n"
                     "[[objects]]\nname = \"ball\"\nshape = \"sphere\"\nradius_m = 0.4\n"
                     "position_m = [2, -12.5, -4]\n")
                 .scene;
    scene_.cameras.push_back(camera_for(scene_));
    NERITIC_ASSERT_OK(physics_, LivePhysics::create(scene_, LivePhysics::Pace::kPicture));
    HeadsetRun::with(*physics_);
  }
  void wear(std::vector<hud::LayoutKind> layouts) {
    HeadsetRun::with(DiveHudOptions{.layouts = std::move(layouts)});
  }
  // The views of a frame side by side, as high as the highest.
  ImageU8 sheet(int frame, int views) const {
    std::vector<ImageU8> pictures;
    std::uint32_t width = 0, height = 0;
    for (int i = 0; i < views; ++i) {
      pictures.push_back(picture(frame, i));
      width += pictures.back().width;
      height = std::max(height, pictures.back().height);
    }
    ImageU8 out(width, height, 3);
    std::uint32_t left = 0;
    for (const ImageU8& one : pictures) {
      for (std::uint32_t y = 0; y < one.height; ++y)
        for (std::uint32_t x = 0; x < one.width; ++x)
          for (std::uint32_t c = 0; c < 3; ++c) out.at(left + x, y, c) = one.at(x, y, c);
      left += one.width;
    }
    return out;
  }
  static void expect_golden(const std::string& name, const ImageU8& actual) {
    const fs::path golden = test::source_dir() / "tests/testbed/headset/golden" / name;
    const char* update = std::getenv("NERITIC_UPDATE_GOLDEN");
    if (update && std::string(update) == "1") {
      NERITIC_ASSERT_STATUS(make_folder(golden.parent_path()));
      NERITIC_ASSERT_STATUS(scene::write_png8(golden, actual));
      return;
    }
    const ImageU8 wanted = scene::read_image8(golden, 3).value();
    ASSERT_EQ(wanted.width, actual.width) << name;
    ASSERT_EQ(wanted.height, actual.height) << name;
    std::size_t differ = 0;
    for (std::size_t i = 0; i < actual.data.size(); ++i)
      differ += std::abs(int(actual.data[i]) - int(wanted.data[i])) > 8;
    const std::size_t most = actual.data.size() / 200;
    EXPECT_LE(differ, most) << name << "; see golden/headset_" << name << " in the build folder";
    if (differ <= most) return;
    const fs::path folder = fs::path(NERITIC_BINARY_DIR) / "golden";
    NERITIC_ASSERT_STATUS(make_folder(folder));
    NERITIC_ASSERT_STATUS(scene::write_png8(folder / ("headset_" + name), actual));
  }

  scene::Scene scene_;
  std::unique_ptr<LivePhysics> physics_;
};

const std::vector<hud::LayoutKind> kAll{hud::LayoutKind::kWrist, hud::LayoutKind::kMask,
                                        hud::LayoutKind::kCorner, hud::LayoutKind::kConsole};

TEST_F(HeadsetHud, StereoWithHeadWristAndWorldLockedLayersIsAsItsGolden) {
  fakes::FakeHeadset fake(
      fmt::format("{}size 640 600\nfov -45 38 36 -44\nperiod 0.05\n"
                  "out {}\nout_frames 32\n",
                  kWearer, folder()));
  wear(kAll);
  NERITIC_ASSERT_STATUS(dive(scene_, 34));
  expect_golden("stereo.png", sheet(32, 2));
}

TEST_F(HeadsetHud, FourViewsAreAsTheirGolden) {
  fakes::FakeHeadset fake(
      fmt::format("{}views 4\nsize 320 300\nfocus_size 480 480\nfocus_deg 20\n"
                  "fov -45 38 36 -44\nperiod 0.05\nout {}\nout_frames 28\n",
                  kWearer, folder()));
  // Of the head, the wrist and the world.
  wear({hud::LayoutKind::kWrist, hud::LayoutKind::kCorner, hud::LayoutKind::kConsole});
  NERITIC_ASSERT_STATUS(dive(scene_, 30));
  expect_golden("four_views.png", sheet(28, 4));
}

// How alike a panel's own picture and its place in a view are: 1 the same up to brightness.
double likeness(const ImageU8& view, const FrustumTangents& t, const Vec3& head_from_eye,
                const hud::Layout& layout, const ImageU8& panel, bool mirrored) {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (std::uint32_t y = 2; y < panel.height; y += 3)
    for (std::uint32_t x = 2; x < panel.width; x += 3) {
      const double u = (x + 0.5) / panel.width - 0.5, v = 0.5 - (y + 0.5) / panel.height;
      const Vec3 at = layout.lock_from_panel * Vec3(u * layout.size_m.x, v * layout.size_m.y, 0.0) -
                      head_from_eye;
      const double px = (-at.x / at.z - t.left) / (t.right - t.left) * view.width;
      const double py = (t.top + at.y / at.z) / (t.top - t.bottom) * view.height;
      if (!(px >= 0 && px < view.width && py >= 0 && py < view.height)) continue;
      const double p = panel.at(mirrored ? panel.width - 1 - x : x, y, 1);
      const double q = view.at(static_cast<std::uint32_t>(px), static_cast<std::uint32_t>(py), 1);
      n += 1, a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
    }
  return (ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n));
}

TEST_F(HeadsetHud, TextIsUprightAndUnmirroredWhereEachEyesFrustumPutsIt) {
  fakes::FakeHeadset fake(
      fmt::format("size 1200 1200\nfov -40 25 20 -38\nperiod 0.05\nhead 0 0 1.6 0\n"
                  "eye_distance 0.064\nout {}\nout_frames 3\n",
                  folder()));
  wear({hud::LayoutKind::kCorner});
  NERITIC_ASSERT_STATUS(dive(scene_, 5));
  const hud::Layout& layout = hud::layout_of(hud::LayoutKind::kCorner);
  hud::Hud alone(layout.kind, hud::Units::kMetric, layout.height_px);
  alone.update(instrument_data(physics_->world(), 0, physics_->newest()), 0.0);
  const auto tangent = [](double deg) { return std::tan(radians(deg)); };
  for (int eye = 0; eye < 2; ++eye) {
    const double side = eye == 0 ? -1.0 : 1.0;
    const FrustumTangents t{eye == 0 ? tangent(-40) : tangent(-25),
                            eye == 0 ? tangent(25) : tangent(40), tangent(-38), tangent(20)};
    const auto like = [&](bool mirrored) {
      return likeness(picture(3, eye), t, {0.032 * side, 0, 0}, layout, alone.picture(), mirrored);
    };
    EXPECT_GT(like(false), 0.45) << "eye " << eye;
    EXPECT_LT(like(true), like(false) - 0.3) << "eye " << eye;
  }
}

// Hidden pixels are not drawn, and nothing else changes.
TEST_F(HeadsetHud, WhatTheLensesHideIsNotDrawn) {
  std::vector<ImageU8> pictures;
  for (const char* without : {"", "without XR_KHR_visibility_mask\n"}) {
    fakes::FakeHeadset fake(fmt::format("{}{}size 120 120\nperiod 0.05\nout {}\nout_frames 3\n",
                                        kWearer, without, folder()));
    NERITIC_ASSERT_OK(physics_, LivePhysics::create(scene_, LivePhysics::Pace::kPicture));
    HeadsetRun::with(*physics_);
    NERITIC_ASSERT_STATUS(dive(scene_, 5));
    pictures.push_back(picture(3, 1));
  }
  std::size_t dark = 0, other = 0;
  for (std::uint32_t y = 0; y < 120; ++y)
    for (std::uint32_t x = 0; x < 120; ++x) {
      const auto* masked = &pictures[0].at(x, y);
      const bool black = masked[0] + masked[1] + masked[2] == 0;
      dark += black;
      for (int c = 0; c < 3 && !black; ++c)
        other += std::abs(masked[c] - (&pictures[1].at(x, y))[c]) > 2;
    }
  // The fake's octagon leaves out a corner of a quarter by a quarter, halved, four times.
  EXPECT_NEAR(static_cast<double>(dark), 120.0 * 120.0 / 8.0, 250.0);
  EXPECT_EQ(other, 0u);
  EXPECT_GT(pictures[1].at(0, 0, 2), 20);
}

}  // namespace
}  // namespace neritic::testbed
