#include "tools/tradeoff/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/core/math.hpp"

namespace neritic::tools {
namespace {

// One number a pixel, in rows.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;
  double& at(int x, int y) { return values[static_cast<std::size_t>(y) * width + x]; }
  double at(int x, int y) const { return values[static_cast<std::size_t>(y) * width + x]; }
};
Plane plane_like(const Plane& p) {
  return {p.width, p.height, std::vector<double>(p.values.size())};
}

// Linear sRGB to CIE XYZ, D65, and back (IEC 61966-2-1).
const Mat3& xyz_from_rgb() {
  static const Mat3 matrix =
      glm::transpose(Mat3(0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750,
                          0.0193339, 0.1191920, 0.9503041));
  return matrix;
}
const Mat3& rgb_from_xyz() {
  static const Mat3 matrix = glm::inverse(xyz_from_rgb());
  return matrix;
}
const Vec3& white() {
  static const Vec3 xyz = xyz_from_rgb() * Vec3(1.0);
  return xyz;
}

Vec3 linear_pixel(const ImageU8& image, std::uint32_t x, std::uint32_t y) {
  Vec3 out;
  for (std::uint32_t c = 0; c < 3; ++c) {
    const double v = image.at(x, y, c) / 255.0;
    out[static_cast<int>(c)] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  return out;
}

// The opponent space in which the eye's contrast sensitivity is known: Y, red-green, blue-yellow.
Vec3 opponent_of(const Vec3& rgb) {
  const Vec3 n = xyz_from_rgb() * rgb / white();
  return {116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z)};
}
Vec3 rgb_of(const Vec3& opponent) {
  const double y = (opponent.x + 16.0) / 116.0;
  const Vec3 n(y + opponent.y / 500.0, y, y - opponent.z / 200.0);
  return rgb_from_xyz() * (n * white());
}

// CIE 1976 L*a*b*; saturation falls with lightness (Hunt).
Vec3 hunt_lab_of(const Vec3& rgb) {
  const Vec3 n = xyz_from_rgb() * rgb / white();
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
  };
  const double lightness = 116.0 * f(n.y) - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (f(n.x) - f(n.y)),
          0.01 * lightness * 200.0 * (f(n.y) - f(n.z))};
}

double hyab(const Vec3& a, const Vec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// Weights at -radius to radius; places outside the picture are those of its edge.
using Kernel = std::vector<double>;
Plane filtered(const Plane& in, const Kernel& along_x, const Kernel& along_y) {
  const auto pass = [](const Plane& from, const Kernel& kernel, bool rows) {
    const int radius = static_cast<int>(kernel.size() / 2);
    const int last = (rows ? from.width : from.height) - 1;
    Plane out = plane_like(from);
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x) {
        double sum = 0.0;
        for (int k = -radius; k <= radius; ++k) {
          const int at = std::clamp((rows ? x : y) + k, 0, last);
          sum += kernel[static_cast<std::size_t>(k + radius)] *
                 (rows ? from.at(at, y) : from.at(x, at));
        }
        out.at(x, y) = sum;
      }
    return out;
  };
  return pass(pass(in, along_x, true), along_y, false);
}

Kernel gaussian(int radius, double falloff) {
  Kernel out;
  for (int k = -radius; k <= radius; ++k) out.push_back(std::exp(-falloff * k * k));
  return out;
}
double sum_of(const Kernel& kernel) {
  double sum = 0.0;
  for (const double w : kernel) sum += w;
  return sum;
}

// Contrast sensitivity of a channel: the Fourier pair of a sum of two Gaussians, a and b of which
// are those of the paper's table (degrees squared).
struct Sensitivity {
  double a[2], b[2];
};
constexpr Sensitivity kSensitivities[] = {
    {{1.0, 0.0}, {0.0047, 1e-5}}, {{1.0, 0.0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}};

Plane seen(const Plane& channel, const Sensitivity& s, double pixels_a_degree) {
  constexpr double kWidest = 0.04;  // of all b
  const int radius =
      static_cast<int>(std::ceil(3.0 * std::sqrt(kWidest / (2.0 * kPi * kPi)) * pixels_a_degree));
  Plane out = plane_like(channel);
  double whole = 0.0;
  for (int i = 0; i < 2; ++i) {
    if (s.a[i] == 0.0) continue;
    const Kernel kernel =
        gaussian(radius, kPi * kPi / (s.b[i] * pixels_a_degree * pixels_a_degree));
    const double weight = s.a[i] * std::sqrt(kPi / s.b[i]);
    const Plane part = filtered(channel, kernel, kernel);
    for (std::size_t k = 0; k < out.values.size(); ++k) out.values[k] += weight * part.values[k];
    whole += weight * sum_of(kernel) * sum_of(kernel);
  }
  for (double& v : out.values) v /= whole;
  return out;
}

// First or second derivative of a Gaussian, whose positive weights are 1 in sum, and its negative
// ones -1, over the square.
Kernel derivative(int radius, double sigma, bool second) {
  Kernel out = gaussian(radius, 1.0 / (2.0 * sigma * sigma));
  for (int k = -radius; k <= radius; ++k)
    out[static_cast<std::size_t>(k + radius)] *=
        second ? k * k / (sigma * sigma) - 1.0 : static_cast<double>(-k);
  const double across = sum_of(gaussian(radius, 1.0 / (2.0 * sigma * sigma)));
  double up = 0.0, down = 0.0;
  for (const double w : out) (w > 0.0 ? up : down) += across * std::abs(w);
  for (double& w : out) w /= w > 0.0 ? up : down;
  return out;
}

// How strong an edge, or a point, is at each pixel of the luminance.
Plane features(const Plane& luminance, double pixels_a_degree, bool points) {
  constexpr double kWidth_deg = 0.082;  // of a feature that an eye finds
  const double sigma = 0.5 * kWidth_deg * pixels_a_degree;
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  const Kernel across = gaussian(radius, 1.0 / (2.0 * sigma * sigma)),
               along = derivative(radius, sigma, points);
  const Plane x = filtered(luminance, along, across), y = filtered(luminance, across, along);
  Plane out = plane_like(luminance);
  for (std::size_t k = 0; k < out.values.size(); ++k)
    out.values[k] = std::hypot(x.values[k], y.values[k]);
  return out;
}

// What is compared of a picture.
struct Look {
  std::vector<Vec3> colors;  // L*a*b* with Hunt's effect, after the eye's blur
  Plane edges, points;
};

Look look_of(const ImageU8& image, double pixels_a_degree) {
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  const std::size_t count = std::size_t{image.width} * image.height;
  std::array<Plane, 3> channels;
  for (Plane& channel : channels) channel = {width, height, std::vector<double>(count)};
  Plane luminance = channels[0];
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const std::size_t k = std::size_t{y} * image.width + x;
      const Vec3 opponent = opponent_of(linear_pixel(image, x, y));
      for (std::size_t c = 0; c < 3; ++c) channels[c].values[k] = opponent[static_cast<int>(c)];
      luminance.values[k] = (opponent.x + 16.0) / 116.0;
    }
  for (std::size_t c = 0; c < 3; ++c)
    channels[c] = seen(channels[c], kSensitivities[c], pixels_a_degree);
  Look out;
  out.colors.reserve(count);
  for (std::size_t k = 0; k < count; ++k)
    out.colors.push_back(hunt_lab_of(glm::clamp(
        rgb_of({channels[0].values[k], channels[1].values[k], channels[2].values[k]}), 0.0, 1.0)));
  out.edges = features(luminance, pixels_a_degree, false);
  out.points = features(luminance, pixels_a_degree, true);
  return out;
}

// The largest distance of colours, of green and blue, becomes 1; small distances take most of the
// range.
double color_error(const Vec3& a, const Vec3& b) {
  constexpr double kPower = 0.7, kKneeAt = 0.4, kKnee = 0.95;
  static const double most =
      std::pow(hyab(hunt_lab_of(Vec3(0.0, 1.0, 0.0)), hunt_lab_of(Vec3(0.0, 0.0, 1.0))), kPower);
  const double error = std::pow(hyab(a, b), kPower), knee = kKneeAt * most;
  return error < knee ? error * kKnee / knee
                      : kKnee + (error - knee) / (most - knee) * (1.0 - kKnee);
}

}  // namespace

ImageF32 flip_map(const ImageU8& shown, const ImageU8& wanted, double pixels_a_degree) {
  ImageF32 out(wanted.width, wanted.height, 1, 0.0f);
  if (out.data.empty()) return out;
  const Look a = look_of(wanted, pixels_a_degree), b = look_of(shown, pixels_a_degree);
  for (std::size_t k = 0; k < out.data.size(); ++k) {
    const double feature = std::max(std::abs(a.edges.values[k] - b.edges.values[k]),
                                    std::abs(a.points.values[k] - b.points.values[k]));
    const double raised = std::sqrt(feature / std::sqrt(2.0));
    out.data[k] = static_cast<float>(
        std::pow(std::clamp(color_error(a.colors[k], b.colors[k]), 0.0, 1.0), 1.0 - raised));
  }
  return out;
}

double flip_error(const ImageU8& shown, const ImageU8& wanted, double pixels_a_degree) {
  const ImageF32 map = flip_map(shown, wanted, pixels_a_degree);
  double sum = 0.0;
  for (const float v : map.data) sum += v;
  return map.data.empty() ? 0.0 : sum / static_cast<double>(map.data.size());
}

}  // namespace neritic::tools
