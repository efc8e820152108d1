// Pixels that are the mean of finer ones: `detail.resolution` above 1.
#include <gtest/gtest.h>

#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

// A leaning rod, half a pixel thick, and a ball, in the sun's light.
constexpr const char* kRod =
    "[sun]\nelevation_deg = 50\n"
    "[[objects]]\nname = \"rod\"\nshape = \"box\"\nsize_m = [0.01, 9, 0.01]\nroll_deg = 7\n"
    "position_m = [0, 0, -2]\n"
    "[[objects]]\nname = \"ball\"\nshape = \"sphere\"\nradius_m = 0.4\nposition_m = [0.9, 0, -3]\n"
    "[[cameras]]\nname = \"eye\"\nnear_m = 0.1\nexposure = 0\nlinear = true\n";

class AveragedPixels : public test::GpuTest {
 protected:
  Result<ViewImages> picture(std::uint32_t side, const std::string& camera,
                             const Capture& capture = Capture{}.without_geometry()) {
    NERITIC_TRY(scene::Scene scene,
                scene::load_scene(
                    "rod.toml",
                    {.text = kRod + fmt::format("width = {0}\nheight = {0}\n", side) + camera}));
    FrameRequest request;
    request.cameras = {0};
    request.capture = capture;
    NERITIC_TRY(const auto session, Session::create(device(), std::move(scene)));
    session->keep_plan_dump(true);
    NERITIC_TRY(FrameResult result, session->render(request));
    plan_ = session->plan_text();
    return std::move(result.cameras[0].eyes[0]);
  }
  std::string plan_;
};

TEST_F(AveragedPixels, AreTheMeanOfTheFinerPicture) {
  for (const std::uint32_t side : {2u, 3u, 4u}) {
    NERITIC_ASSERT_OK(const ViewImages fine, picture(96 * side, ""));
    EXPECT_EQ(plan_.find("average"), std::string::npos);
    NERITIC_ASSERT_OK(const ViewImages mean,
                      picture(96, fmt::format("detail = {{ resolution = {} }}\n", side)));
    EXPECT_NE(plan_.find("average"), std::string::npos);
    ASSERT_EQ(mean.linear.width, 96u);
    ASSERT_EQ(mean.color.width, 96u);
    double worst = 0.0;
    for (std::uint32_t y = 0; y < 96; ++y)
      for (std::uint32_t x = 0; x < 96; ++x)
        for (std::uint32_t c = 0; c < 3; ++c) {
          double sum = 0.0;
          for (std::uint32_t v = 0; v < side; ++v)
            for (std::uint32_t u = 0; u < side; ++u)
              sum += fine.linear.data[3 * ((y * side + v) * 96 * side + x * side + u) + c];
          const double expected = sum / (side * side);
          worst = std::max(worst, std::abs(mean.linear.data[3 * (y * 96 + x) + c] - expected) /
                                      std::max(expected, 0.01));
        }
    EXPECT_LT(worst, 0.002) << side;  // of half floats
  }
}

// The light that a thin rod adds to each row of the picture, over its mean: it varies as the rod
// breaks into dots.
double spread_along(const ViewImages& image) {
  std::vector<double> rows;
  for (std::uint32_t y = 8; y < 88; ++y) {
    double sum = 0.0, first = image.linear.data[3 * (y * 96 + 2) + 1];
    for (std::uint32_t x = 32; x < 60; ++x)
      sum += std::abs(image.linear.data[3 * (y * 96 + x) + 1] - first);
    rows.push_back(sum);
  }
  double mean = 0.0, squares = 0.0;
  for (const double row : rows) mean += row / rows.size();
  for (const double row : rows) squares += (row - mean) * (row - mean) / rows.size();
  return std::sqrt(squares) / mean;
}

TEST_F(AveragedPixels, AThinRodBreaksIntoFewerDots) {
  NERITIC_ASSERT_OK(const ViewImages once, picture(96, ""));
  NERITIC_ASSERT_OK(const ViewImages four, picture(96, "detail = { resolution = 4 }\n"));
  EXPECT_GT(spread_along(once), 0.5);
  EXPECT_LT(spread_along(four), 0.35 * spread_along(once));
}

// The camera's own terms work on the mean; arrays have a value for each of its pixels.
TEST_F(AveragedPixels, ComeBeforeTheCameraAndBesideArrays) {
  const std::string terms =
      "vignette = 1\nfocus = { distance_m = 2, f_number = 4 }\nshutter = { exposure_s = 0.01 }\n"
      "sensor = {}\n";
  NERITIC_ASSERT_OK(const ViewImages plain, picture(96, terms, Capture{}));
  NERITIC_ASSERT_OK(const ViewImages mean,
                    picture(96, terms + "detail = { resolution = 2 }\n", Capture{}));
  EXPECT_NE(plan_.find("average"), std::string::npos);
  EXPECT_EQ(mean.depth.data, plain.depth.data);
  ASSERT_EQ(mean.color.data.size(), plain.color.data.size());
  EXPECT_NE(mean.color.data, plain.color.data);
  double off = 0.0;
  for (std::size_t i = 0; i < plain.color.data.size(); ++i)
    off += std::abs(int{plain.color.data[i]} - int{mean.color.data[i]});
  EXPECT_LT(off / static_cast<double>(plain.color.data.size()), 3.0);  // of 255: at edges alone
}

}  // namespace
}  // namespace neritic::testbed
