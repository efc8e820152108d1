// What is drawn before a headset's first frame makes the pipelines of every quality that a view may
// choose, in few small pictures; only a machine that compiled is told so.
#include "testbed/view/dive_prepare.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "engine/gpu/pipeline_work.hpp"
#include "testbed/view/dive_view.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/simulation/dives.hpp"
#include "tests/testbed/view/kept_display.hpp"

namespace neritic::testbed {
namespace {

xr::ViewGroup pair_of(std::uint32_t width, std::uint32_t height) {
  xr::ViewGroup group = xr::one_view(width, height, radians(90.0));
  group.views.push_back(group.views.front());
  return group;
}

double pixels_of(const UnseenPicture& picture) {
  double sum = 0.0;
  for (const auto& [width, height] : picture.sizes) sum += 2.0 * width * height;
  return sum;
}

// Whether two numbers of pixels and their parts are powers of two alike.
bool alike_in_powers_of_two(std::uint32_t a, std::uint32_t b) {
  for (const std::uint32_t part : {1u, 2u, 4u, 8u, 16u})
    if (std::has_single_bit((a + part - 1) / part) != std::has_single_bit((b + part - 1) / part))
      return false;
  return true;
}

// The software driver compiles anew for a texture whose width or height is a power of two.
TEST(UnseenPictures, HaveEachLightWithThePowersOfTwoOfEachRungAndAreSmall) {
  for (const xr::ViewGroup& group :
       {pair_of(2016, 2240), pair_of(2048, 2048), pair_of(64, 60), pair_of(3, 2)}) {
    const auto pictures = unseen_pictures(std::span(&group, 1), quality_rungs());
    for (const Quality& rung : quality_rungs()) {
      const auto stands_for = [&](const UnseenPicture& picture) {
        const auto& [width, height] = picture.sizes.front();
        return picture.light == rung.light &&
               alike_in_powers_of_two(width, scaled(group.width, rung.view_scale)) &&
               alike_in_powers_of_two(height, scaled(group.height, rung.view_scale));
      };
      EXPECT_TRUE(std::ranges::any_of(pictures, stands_for))
          << group.width << " " << rung.view_scale << " " << rung.light;
    }
    for (const UnseenPicture& picture : pictures) EXPECT_LT(pixels_of(picture), 6e4);
  }
  const std::vector<xr::ViewGroup> four{pair_of(1500, 1400), pair_of(1250, 1100)};
  const auto pictures = unseen_pictures(four, quality_rungs());
  EXPECT_LE(pictures.size(), kLightLevels + 5);
  EXPECT_EQ(pictures.front().sizes.size(), 2u);
  EXPECT_EQ(unseen_pictures(four, quality_rungs().first(1)).size(), 1u);
}

TEST(PrepareNote, IsOfShadersThatWereCompiled) {
  // Measured on two cores: cold, and warm ones that three other programs kept busy.
  EXPECT_NE(prepare_note({.took_s = 13.0, .made_s = 1.6, .again_s = 0.4}), "");
  EXPECT_EQ(prepare_note({.took_s = 13.0, .made_s = 6.0, .again_s = 3.0}), "");
  // A driver that compiles where pipelines are made, and keeps what it compiled.
  EXPECT_NE(prepare_note({.took_s = 13.0, .made_s = 12.0, .again_s = 0.1, .cache_grew = true}), "");
  EXPECT_EQ(prepare_note({.took_s = 13.0, .made_s = 12.0, .again_s = 0.1}), "");
  EXPECT_EQ(prepare_note({.took_s = 6.0, .made_s = 0.5, .again_s = 0.1}), "") << "no long wait";
}

class DivePrepare : public test::GpuTest {};

// In a scene with all that the levels of light change: shadows, shafts, lamps' glow, skylight, the
// sea's waves, forward scatter, snow.
TEST_F(DivePrepare, NoRungMakesAPipelineLater) {
  const std::string models = (test::source_dir() / "assets/models/").string();
  scene::Scene scene =
      load_text(
          "[sun]\nelevation_deg = 50\n[sun.shafts]\n[sun.shadows]\n[sun.caustics]\n"
          "[ambient.skylight]\nbox_m = [-5, -9, -5, 5, -3, 5]\n[water]\ntype = \"IB\"\nsurface = "
          "true\n[water.waves]\n"
          "wind_m_s = 5\n[water.forward_scatter]\n[water.snow]\n"
          "[[objects]]\nshape = \"box\"\nsize_m = [20, 1, 20]\nposition_m = [0, -9, 0]\n"
          "[[objects]]\nmodel = \"" +
          models +
          "diver.glb\"\nposition_m = [0, -7, -3]\n"
          "[[lamps]]\nposition_m = [1, -6, 0]\npitch_deg = -60\nintensity_cd = 3000\n"
          "[[cameras]]\nposition_m = [0, -6, 1]\nwidth = 200\nheight = 180\n")
          .value();
  const scene::Camera camera = scene.cameras[0];
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
  KeptDisplay display(false);
  display.ahead({pair_of(1832, 1920)});
  NERITIC_ASSERT_OK(const auto view,
                    DiveView::create(*session, display, nullptr, nullptr, {.governed = true}));
  NERITIC_ASSERT_OK(const std::uint64_t pictures, session->frames().completed());
  // A start of over 10 s draws them once more for its note.
  EXPECT_TRUE(pictures == kLightLevels || pictures == 2 * kLightLevels) << pictures;
  const std::uint64_t made = gpu::pipeline_work(device()).made;
  const Pose eyes = camera.mount.pose;
  const xr::ViewGroup group = pair_of(92, 96);  // a picture's size changes no pipeline
  for (std::size_t rung = 0; rung < kRungs; ++rung) {
    const Quality quality = quality_rungs()[rung];
    ViewsRequest views{.name = camera.name,
                       .exposure = camera.exposure,
                       .antialias = camera.antialias,
                       .detail = detail_at(camera.detail, quality.light),
                       .thrift = thrift_at(quality.light)};
    views.views.width = scaled(group.width, quality.view_scale);
    views.views.height = scaled(group.height, quality.view_scale);
    for (std::size_t k = 0; k < group.views.size(); ++k)
      views.views.views.push_back({.world_from_view = eyes,
                                   .tangents = group.views[k].tangents,
                                   .near_m = camera.near_m,
                                   .next_world_from_view = eyes});
    FrameRequest request{.capture = kColorOnGpu};
    request.views.push_back(std::move(views));
    NERITIC_ASSERT_OK(const FrameResult frame, session->render(request));
    EXPECT_EQ(gpu::pipeline_work(device()).made, made) << "rung " << rung;
  }
  EXPECT_GT(made, 30u) << "otherwise the scene has little of what is compiled";
}

}  // namespace
}  // namespace neritic::testbed
