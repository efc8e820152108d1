// The wearer's sight: each view by the pinhole equations of its own, asymmetric frustum, from
// where the head is when the picture is shown; in every format of the runtime's images.
#include <algorithm>

#include "engine/core/npy.hpp"
#include "tests/testbed/headset/headset_run.hpp"

namespace neritic::testbed {
namespace {

constexpr double kRadius_m = 0.4;
const Vec3 kLab_m{30.0, -5.6, 10.0};

struct Place {
  double x_px = 0.0, y_px = 0.0, nearest_m = 0.0;
  double width_px = 0.0, height_px = 0.0;  // of the picture
};

class HeadsetPicture : public HeadsetRun {
 protected:
  // A ball in the dark, at that place of the lab.
  static scene::Scene scene(const Vec3& lab_from_ball) {
    const Vec3 ball = kLab_m + lab_from_ball;
    const test::ScratchFolder scratch;
    EXPECT_TRUE(
        write_text(scratch / "ball.toml",
                   fmt::format("[sun]\nelevation_deg = 60\n[[objects]]\nname = \"ball\"\n"
                               "shape = \"sphere\"\nradius_m = {}\n"
                               "position_m = [{}, {}, {}]\n"
                               "[lab]\nposition_m = [{}, {}, {}]\n"
                               "[[cameras]]\nname = \"eyes\"\nwidth = 33\nheight = 22\n",
                               kRadius_m, ball.x, ball.y, ball.z, kLab_m.x, kLab_m.y, kLab_m.z))
            .ok());
    return scene::load_scene(scratch / "ball.toml").value();
  }
  // The middle of the ball's pixels, by the depth that went to the runtime. Pixels that
  // the lenses hide are at the near plane.
  Place seen(int frame, int view) const {
    const auto depth =
        read_npy(fmt::format("{}/frame_{:04}_view_{}_depth.npy", folder(), frame, view)).value();
    const std::vector<double> metres = depth.to_doubles();
    Place sum;
    double count = 0.0;
    sum.nearest_m = 1e9;
    for (std::size_t i = 0; i < metres.size(); ++i) {
      if (!(metres[i] < 100.0) || metres[i] < 0.06) continue;
      sum.x_px += static_cast<double>(i % depth.shape[1]) + 0.5;
      sum.y_px += static_cast<double>(i / depth.shape[1]) + 0.5;
      sum.nearest_m = std::min(sum.nearest_m, metres[i]);
      count += 1.0;
    }
    return {sum.x_px / count, sum.y_px / count, sum.nearest_m, static_cast<double>(depth.shape[1]),
            static_cast<double>(depth.shape[0])};
  }
  // The middle of the brightest pixels of the middle half, which the lenses show whole: of the lit
  // part of the ball.
  Place brightest(int frame, int view) const {
    const ImageU8 seen = picture(frame, view);
    const auto light = [&](std::uint32_t x, std::uint32_t y) {
      return seen.at(x, y, 0) + seen.at(x, y, 1) + seen.at(x, y, 2);
    };
    int least = 765, most = 0;
    const auto of_middle = [&](const auto& visit) {
      for (std::uint32_t y = seen.height / 4; y < seen.height * 3 / 4; ++y)
        for (std::uint32_t x = seen.width / 4; x < seen.width * 3 / 4; ++x) visit(x, y);
    };
    of_middle([&](std::uint32_t x, std::uint32_t y) {
      least = std::min(least, light(x, y));
      most = std::max(most, light(x, y));
    });
    Place sum;
    double count = 0.0;
    of_middle([&](std::uint32_t x, std::uint32_t y) {
      if (light(x, y) < (least + most) / 2) return;
      sum.x_px += x + 0.5;
      sum.y_px += y + 0.5;
      count += 1.0;
    });
    return {sum.x_px / count, sum.y_px / count};
  }
  // The middle of a sphere's outline, which is an ellipse: perspective moves it outwards.
  static Place expected(const Vec3& view_from_ball, double left_deg, double right_deg,
                        double up_deg, double down_deg, double width, double height) {
    const double z = -view_from_ball.z, out = z / (z * z - kRadius_m * kRadius_m);
    const auto t = [](double deg) { return std::tan(radians(deg)); };
    return {(view_from_ball.x * out - t(left_deg)) / (t(right_deg) - t(left_deg)) * width,
            (t(up_deg) - view_from_ball.y * out) / (t(up_deg) - t(down_deg)) * height, 0.0};
  }
};

// The wearer glides to the right at 0.2 m/s; a pose of a frame earlier or later would be a pixel
// off.
TEST_F(HeadsetPicture, EachEyeSeesABallWhereItIsWhenThePictureIsShown) {
  fakes::FakeHeadset fake(
      fmt::format("size 240 220\nfov -52 42 45 -49\neye_distance 0.064\nperiod 0.1\nlead 2\n"
                  "head 0 0 1.6 0\nhead 10 2 1.6 0\nout {}\nout_frames 3\n",
                  folder()));
  const Vec3 ball{2.0, 1.5, -3.0};
  NERITIC_ASSERT_STATUS(dive(scene(ball), 5));
  const double shown_s = (3 + 1 + 2) * 0.1;
  const Vec3 head{0.2 * shown_s, 1.6, 0.0};
  const Vec3 left = ball - head + Vec3(0.032, 0, 0), right = ball - head - Vec3(0.032, 0, 0);
  const Place a = seen(3, 0), b = seen(3, 1);
  const Place in_left = expected(left, -52, 42, 45, -49, 240, 220);
  const Place in_right = expected(right, -42, 52, 45, -49, 240, 220);
  EXPECT_NEAR(a.x_px, in_left.x_px, 0.1);
  EXPECT_NEAR(a.y_px, in_left.y_px, 0.1);
  EXPECT_NEAR(b.x_px, in_right.x_px, 0.1);
  EXPECT_NEAR(b.y_px, in_right.y_px, 0.1);
  EXPECT_NEAR(a.x_px - b.x_px, in_left.x_px - in_right.x_px, 0.1);
  EXPECT_NEAR(a.nearest_m, 3.0 - kRadius_m, 0.01);
}

// No machine draws a frame in a millisecond, so that the governor draws coarser views. Their depth
// goes to the runtime all the same: late frames need it most. It fits the picture, which the
// runtime scales.
TEST_F(HeadsetPicture, ACoarserPictureHasItsDepthToo) {
  fakes::FakeHeadset fake(
      fmt::format("size 240 220\nfov -52 42 45 -49\neye_distance 0.064\nperiod 0.001\n"
                  "head 0 0 1.6 0\nout {}\nout_frames 14\n",
                  folder()));
  govern();
  const Vec3 ball{0.4, 1.5, -3.0};
  NERITIC_ASSERT_STATUS(dive(scene(ball), 16));
  for (int view = 0; view < 2; ++view) {
    const Vec3 place = ball - Vec3(view == 0 ? -0.032 : 0.032, 1.6, 0.0);
    const double left = view == 0 ? -52 : -42, right = view == 0 ? 42 : 52;
    const Place depth = seen(14, view);
    ASSERT_LT(depth.width_px, 240.0 * 0.9);
    ASSERT_LT(depth.height_px, 220.0 * 0.9);
    const Place want = expected(place, left, right, 45, -49, depth.width_px, depth.height_px);
    EXPECT_NEAR(depth.x_px, want.x_px, 0.25);
    EXPECT_NEAR(depth.y_px, want.y_px, 0.25);
    EXPECT_NEAR(depth.nearest_m, 3.0 - kRadius_m, 0.05);
    EXPECT_NE(fake.log().find(fmt::format(" of {} x {}", depth.width_px, depth.height_px)),
              std::string::npos)
        << "the picture is of another size";
    const Place lit = brightest(14, view);
    EXPECT_NEAR(lit.x_px, depth.x_px / depth.width_px * 240.0, 3.0);
    EXPECT_NEAR(lit.y_px, depth.y_px / depth.height_px * 220.0, 10.0);
  }
}

TEST_F(HeadsetPicture, FourViewsAreTwoWideOnesAndTwoSharpOnes) {
  fakes::FakeHeadset fake(
      fmt::format("views 4\nsize 120 110\nfocus_size 160 160\nfov -52 42 45 -49\nfocus_deg 15\n"
                  "eye_distance 0.064\nhead 0 0 1.6 0\nout {}\nout_frames 3\n",
                  folder()));
  const Vec3 ball{0.1, 1.5, -3.0};
  NERITIC_ASSERT_STATUS(dive(scene(ball), 5));
  for (int view = 0; view < 4; ++view) {
    const double side = view % 2 == 0 ? -0.032 : 0.032;
    const Vec3 place = ball - Vec3(side, 1.6, 0.0);
    const Place want = view == 0   ? expected(place, -52, 42, 45, -49, 120, 110)
                       : view == 1 ? expected(place, -42, 52, 45, -49, 120, 110)
                                   : expected(place, -15, 15, 15, -15, 160, 160);
    const Place got = seen(3, view);
    EXPECT_NEAR(got.x_px, want.x_px, 0.1) << view;
    EXPECT_NEAR(got.y_px, want.y_px, 0.1) << view;
  }
}

// Both show the lit ball, in different places.
TEST_F(HeadsetPicture, BothEyesGetAPicture) {
  fakes::FakeHeadset fake(
      fmt::format("size 60 50\nhead 0 0 1.6 0\nout {}\nout_frames 2\n", folder()));
  NERITIC_ASSERT_STATUS(dive(scene({0.1, 1.6, -2.0}), 3));
  const ImageU8 left = picture(2, 0), right = picture(2, 1);
  for (const ImageU8* eye : {&left, &right}) {
    const auto of_ball = *std::max_element(eye->data.begin(), eye->data.end());
    EXPECT_GT(of_ball, eye->at(0, 0, 2) + 30);  // the corner is behind it
  }
  EXPECT_NE(left.data, right.data);
}

TEST_F(HeadsetPicture, ThePictureIsTheSameInEveryFormat) {
  std::vector<ImageU8> pictures;
  for (const char* format : {"R8G8B8A8_SRGB", "B8G8R8A8_SRGB", "R16G16B16A16_SFLOAT"}) {
    fakes::FakeHeadset fake(
        fmt::format("size 60 50\nhead 0 0 1.6 0\nout {}\nout_frames 2\n"
                    "formats {}\n",
                    folder(), format));
    NERITIC_ASSERT_STATUS(dive(scene({0.1, 1.6, -2.0}), 3));
    pictures.push_back(picture(2, 0));
  }
  int brightest = 0;
  for (std::size_t i = 0; i < pictures[0].data.size(); ++i) {
    brightest = std::max<int>(brightest, pictures[0].data[i]);
    EXPECT_NEAR(pictures[0].data[i], pictures[1].data[i], 1) << i;
    EXPECT_NEAR(pictures[0].data[i], pictures[2].data[i], 2) << i;
  }
  EXPECT_GT(brightest, 60);
}

}  // namespace
}  // namespace neritic::testbed
