// FLIP against values that follow from its definition, and against its sums done one by one.
#include "tools/tradeoff/flip.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
namespace {

ImageU8 plain_picture(std::uint32_t side, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  ImageU8 out(side, side, 3);
  for (std::size_t i = 0; i < out.data.size(); i += 3)
    out.data[i] = r, out.data[i + 1] = g, out.data[i + 2] = b;
  return out;
}

// L*a*b* of sRGB's green and blue are known (87.735 -86.183 83.179; 32.297 79.188 -107.860).
TEST(Flip, OfPlainPicturesIsThatOfTheirColours) {
  const ImageU8 black = plain_picture(12, 0, 0, 0), white = plain_picture(12, 255, 255, 255),
                green = plain_picture(12, 0, 255, 0), blue = plain_picture(12, 0, 0, 255);
  EXPECT_EQ(flip_error(green, green), 0.0);
  EXPECT_NEAR(flip_error(green, blue), 1.0, 1e-6);
  const auto error = [](double hyab) {
    const double across =
        std::hypot(0.87735 * -86.183 - 0.32297 * 79.188, 0.87735 * 83.179 - 0.32297 * -107.860);
    const double most = std::pow(87.735 - 32.297 + across, 0.7), e = std::pow(hyab, 0.7);
    return e < 0.4 * most ? 0.95 * e / (0.4 * most) : 0.95 + 0.05 * (e - 0.4 * most) / (0.6 * most);
  };
  EXPECT_NEAR(flip_error(white, black), error(100.0), 1e-4);
  // A middle grey, L* 53.585, beside black.
  EXPECT_NEAR(flip_error(plain_picture(12, 128, 128, 128), black), error(53.585), 1e-3);
  EXPECT_EQ(flip_error(ImageU8(), ImageU8()), 0.0);
}

// The paper's sums, each over its square of pixels.
class OneByOne {
 public:
  OneByOne(const ImageU8& image, double ppd) : image_(image), ppd_(ppd) {}

  Vec3 lab(int x, int y) const {
    const double a[3][2] = {{1.0, 0.0}, {1.0, 0.0}, {34.1, 13.5}};
    const double b[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
    const int radius =
        static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi * kPi)) * ppd_));
    Vec3 sum(0.0), whole(0.0);
    for (int v = -radius; v <= radius; ++v)
      for (int u = -radius; u <= radius; ++u)
        for (int c = 0; c < 3; ++c) {
          const double z = (u * u + v * v) / (ppd_ * ppd_);
          double w = 0.0;
          for (int i = 0; i < 2; ++i)
            w += a[c][i] * std::sqrt(kPi / b[c][i]) * std::exp(-kPi * kPi * z / b[c][i]);
          sum[c] += w * opponent(x + u, y + v)[c];
          whole[c] += w;
        }
    const Vec3 o = sum / whole;
    const double fy = (o.x + 16.0) / 116.0;
    const Vec3 rgb = glm::clamp(
        glm::inverse(matrix()) * (Vec3(fy + o.y / 500.0, fy, fy - o.z / 200.0) * white()), 0.0,
        1.0);
    const Vec3 n = matrix() * rgb / white();
    Vec3 f;
    for (int c = 0; c < 3; ++c)
      f[c] = n[c] > 0.008856452 ? std::cbrt(n[c]) : 7.787037 * n[c] + 16.0 / 116.0;
    const double lightness = 116.0 * f.y - 16.0;
    return {lightness, 5.0 * lightness * (f.x - f.y), 2.0 * lightness * (f.y - f.z)};
  }
  double feature(int x, int y, bool point) const {
    const double sd = 0.5 * 0.082 * ppd_;
    const int radius = static_cast<int>(std::ceil(3.0 * sd));
    double along[2] = {}, up = 0.0, down = 0.0;
    for (int pass = 0; pass < 2; ++pass)
      for (int v = -radius; v <= radius; ++v)
        for (int u = -radius; u <= radius; ++u)
          for (int axis = 0; axis < 2; ++axis) {
            const double d = axis == 0 ? u : v, g = std::exp(-(u * u + v * v) / (2.0 * sd * sd));
            const double w = g * (point ? d * d / (sd * sd) - 1.0 : -d);
            if (pass == 0 && axis == 0) (w > 0.0 ? up : down) += std::abs(w);
            if (pass == 1)
              along[axis] += w / (w > 0.0 ? up : down) * (opponent(x + u, y + v).x + 16.0) / 116.0;
          }
    return std::hypot(along[0], along[1]);
  }

 private:
  static Mat3 matrix() {
    return glm::transpose(Mat3(0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750,
                               0.0193339, 0.1191920, 0.9503041));
  }
  static Vec3 white() { return matrix() * Vec3(1.0); }
  Vec3 opponent(int x, int y) const {
    const auto last = static_cast<int>(image_.width) - 1;
    Vec3 rgb;
    for (std::uint32_t c = 0; c < 3; ++c) {
      const double v = image_.at(static_cast<std::uint32_t>(std::clamp(x, 0, last)),
                                 static_cast<std::uint32_t>(std::clamp(y, 0, last)), c) /
                       255.0;
      rgb[static_cast<int>(c)] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    const Vec3 n = matrix() * rgb / white();
    return {116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z)};
  }

  const ImageU8& image_;
  double ppd_;
};

TEST(Flip, OfNoiseIsThatOfItsSumsOneByOne) {
  constexpr double kPixelsADegree = 30.0;
  ImageU8 a = plain_picture(14, 90, 120, 140), b = a;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    a.data[i] = static_cast<std::uint8_t>(255.0 * random_uniform({1, 2, 3}, i));
    if (i % 7 < 4) b.data[i] = static_cast<std::uint8_t>(255.0 * random_uniform({4, 5, 6}, i));
  }
  const ImageF32 map = flip_map(a, b, kPixelsADegree);
  const OneByOne one(a, kPixelsADegree), other(b, kPixelsADegree);
  const double most = std::pow(203.3, 0.7);  // of green and blue
  for (const auto& [x, y] : {std::pair{0, 0}, {13, 5}, {7, 7}, {2, 12}, {6, 1}}) {
    const Vec3 p = one.lab(x, y), q = other.lab(x, y);
    const double e = std::pow(std::abs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z), 0.7);
    const double color =
        e < 0.4 * most ? 0.95 * e / (0.4 * most) : 0.95 + 0.05 * (e / most - 0.4) / 0.6;
    const double feature = std::max(std::abs(one.feature(x, y, false) - other.feature(x, y, false)),
                                    std::abs(one.feature(x, y, true) - other.feature(x, y, true)));
    EXPECT_NEAR(map.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)),
                std::pow(color, 1.0 - std::sqrt(feature / std::sqrt(2.0))), 1e-3)
        << x << " " << y;
  }
}

// A checkerboard of single pixels and the grey of its mean light look alike from far away, and
// unlike from near.
TEST(Flip, ForgivesWhatAnEyeDoesNotResolve) {
  const ImageU8 grey = plain_picture(64, 188, 188, 188);
  ImageU8 board = grey;
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t x = 0; x < 64; ++x)
      for (std::uint32_t c = 0; c < 3; ++c) board.at(x, y, c) = (x + y) % 2 ? 255 : 0;
  EXPECT_LT(flip_error(board, grey, 120.0), 0.05);
  EXPECT_GT(flip_error(board, grey, 10.0), 0.5);
}

}  // namespace
}  // namespace neritic::tools
