// See depth_normals.hpp.
//
// Noise is measured by fourth differences of inverse depth, which is linear in the pixel on a plane
// seen by a pinhole: they vanish on planes of any slope and nearly so on curved surfaces, and keep
// sqrt(70) of the noise of a pixel (the root of the sum of 1, 4, 6, 4, 1 squared). Outlines are
// outliers of the median.
#include "sonar/depth_normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace neritic::sonar {
namespace {

constexpr std::int64_t kTile = 32;           // pixels: noise is measured anew in each tile
constexpr std::size_t kFewest = 64;          // fourth differences that a median takes
constexpr double kMedianOfNormal = 0.6745;   // of the absolute value, in standard deviations
constexpr double kClean_rad = radians(1.0);  // less error is left as it is
constexpr double kWanted_rad = radians(2.0);
constexpr int kWidest = 7;                                           // pixels to each side
constexpr double kUnseen = std::numeric_limits<double>::infinity();  // lies on no plane
constexpr std::size_t kLanes = 16;  // columns of a fit, to a whole number of vectors
// Pixels around the image that a fit may read: from -kWidest to kLanes - kWidest - 1.
constexpr std::int64_t kBorder = 8;

// For a difference over 2 pixels, and for a plane fitted to 2 w + 1 by 2 w + 1: standard deviation
// of a slope for noise 1 a pixel. Both slopes tilt a normal: hence sqrt(2).
double error_of_fit(int w) {
  return std::sqrt(2.0) * std::sqrt(3.0 / (w * (w + 1.0))) / (2.0 * w + 1.0);
}
constexpr double kErrorOfNeighbours = 1.0;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The step to which depths were rounded, as those of an image of whole numbers are; 0: none. Their
// rounding is noise that neighbours of the same number do not show.
double quantum(const std::vector<double>& depth_m) {
  constexpr std::size_t kFewestSteps = 16;
  constexpr double kMost_m = 0.2, kWhole = 0.01;
  constexpr std::size_t kMostPixels = 50'000;  // tell as much as all
  std::vector<double> seen;
  for (std::size_t i = 0; i < depth_m.size(); i += 1 + depth_m.size() / kMostPixels)
    if (depth_m[i] > 0.0 && std::isfinite(depth_m[i])) seen.push_back(depth_m[i]);
  const std::size_t pixels = seen.size();
  std::ranges::sort(seen);
  // Equal but for rounding of floats.
  // std::ranges::unique does not compile with Debian 12's clang, which tools/fuzz takes.
  seen.erase(std::unique(seen.begin(), seen.end(),
                         [](double a, double b) { return b - a <= 1e-6 * std::abs(b); }),
             seen.end());
  if (seen.size() < kFewestSteps || 2 * seen.size() > pixels) return 0.0;
  double least = kMost_m;
  for (std::size_t i = 1; i < seen.size(); ++i) least = std::min(least, seen[i] - seen[i - 1]);
  std::size_t whole = 0;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    const double steps = (seen[i] - seen[i - 1]) / least;
    whole += std::abs(steps - std::round(steps)) < kWhole * steps;
  }
  return 10 * whole >= 9 * (seen.size() - 1) ? least : 0.0;
}

// The step to the neighbour's side along one image axis: towards the side whose depth is nearer to
// this pixel's, or both. before and after may be absent.
std::optional<Vec3> step(const std::optional<Vec3>& before, const Vec3& here,
                         const std::optional<Vec3>& after) {
  if (!before && !after) return std::nullopt;
  if (!before) return *after - here;
  if (!after) return here - *before;
  const double back = std::abs(before->z - here.z), forth = std::abs(after->z - here.z);
  // Three times: a smooth surface bends by far less from pixel to pixel, an outline by far more.
  constexpr double kOutline = 3.0;
  if (forth > kOutline * back) return here - *before;
  if (back > kOutline * forth) return *after - here;
  return *after - *before;
}

class Estimator {
 public:
  explicit Estimator(const SonarInput& in)
      : in_(in),
        stride_(in.width + 2 * kBorder),
        inverse_(static_cast<std::size_t>(stride_ * (in.height + 2 * kBorder)), kUnseen),
        tiles_x_((in.width + kTile - 1) / kTile) {
    for (std::uint32_t v = 0; v < in.height; ++v)
      for (std::uint32_t u = 0; u < in.width; ++u)
        if (const auto p = point_of(in, u, v)) inverse_[place(u, v)] = -1.0 / p->z;
    measure_noise();
  }

  DepthNormals run() const {
    DepthNormals out;
    out.normals.assign(3 * in_.depth.size(), 0.0);
    std::vector<double> noises, plain, errors, widths;
    for (std::int64_t v = 0; v < in_.height; ++v)
      for (std::int64_t u = 0; u < in_.width; ++u) {
        const double q = inverse(u, v);
        if (q == 0.0) continue;
        // Slope error a pixel's width: noise in metres over the width of a pixel there.
        const double noise_m = noise(u, v);
        const double noise_px = noise_m * q * std::sqrt(in_.intrinsics.fx * in_.intrinsics.fy);
        const int w = half_width(noise_px);
        std::optional<Vec3> n;
        for (int wide = w; wide > 0 && wide <= kWidest && !n; ++wide)
          n = normal_of_plane(u, v, wide, noise_m * q * q);
        if (!n) n = from_neighbours(u, v);
        if (!n) continue;
        std::copy_n(&(*n)[0], 3, &out.normals[3 * index(u, v)]);
        noises.push_back(noise_m);
        plain.push_back(kErrorOfNeighbours * noise_px);
        errors.push_back((w == 0 ? kErrorOfNeighbours : error_of_fit(w)) * noise_px);
        widths.push_back(w == 0 ? 0.0 : 2.0 * w + 1.0);
      }
    if (noises.empty()) return out;
    out.estimate = {median(noises), std::atan(median(plain)), std::atan(median(errors)),
                    static_cast<int>(median(widths))};
    return out;
  }

  SmoothedDepth smooth(double accepted_m, std::vector<double>& depth) const {
    std::vector<double> noises, left, widths;
    for (std::int64_t v = 0; v < in_.height; ++v)
      for (std::int64_t u = 0; u < in_.width; ++u) {
        const double q = inverse(u, v);
        if (q == 0.0) continue;
        const double noise_m = noise(u, v);
        int w = 0;  // a plane of n pixels keeps 1 / sqrt(n) of their noise in its middle
        while (w < kWidest && noise_m > accepted_m * (2.0 * w + 1.0)) ++w;
        noises.push_back(noise_m);
        left.push_back(noise_m / (2.0 * w + 1.0));
        widths.push_back(w == 0 ? 0.0 : 2.0 * w + 1.0);
        if (w == 0) continue;
        const auto plane = plane_round(u, v, w, noise_m * q * q);
        // Planar depth and range along a ray are in proportion.
        if (plane && plane->x > 0.0) depth[index(u, v)] *= q / plane->x;
      }
    if (noises.empty()) return {};
    return {median(noises), median(left), static_cast<int>(median(widths))};
  }

 private:
  std::size_t index(std::int64_t u, std::int64_t v) const {
    return static_cast<std::size_t>(v * in_.width + u);
  }
  std::size_t place(std::int64_t u, std::int64_t v) const {
    return static_cast<std::size_t>((v + kBorder) * stride_ + u + kBorder);
  }
  // 0 beyond the edges, up to the border, and where nothing is seen.
  double inverse(std::int64_t u, std::int64_t v) const {
    const double q = inverse_[place(u, v)];
    return q == kUnseen ? 0.0 : q;
  }
  std::optional<Vec3> point(std::int64_t u, std::int64_t v) const {
    if (inverse(u, v) == 0.0) return std::nullopt;
    return point_of(in_, static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(v));
  }

  // In metres: a difference of inverse depth times the depth squared.
  void measure_noise() {
    std::vector<std::vector<double>> tiles(tiles_x_ * ((in_.height + kTile - 1) / kTile));
    std::vector<double> all;
    for (std::int64_t v = 0; v < in_.height; ++v)
      for (std::int64_t u = 0; u < in_.width; ++u) {
        const double q = inverse(u, v);
        for (const auto& [du, dv] : {std::pair{1, 0}, {0, 1}}) {
          const double a = inverse(u - 2 * du, v - 2 * dv), b = inverse(u - du, v - dv),
                       c = inverse(u + du, v + dv), d = inverse(u + 2 * du, v + 2 * dv);
          if (q == 0.0 || a == 0.0 || b == 0.0 || c == 0.0 || d == 0.0) continue;
          const double difference = std::abs(a - 4.0 * b + 6.0 * q - 4.0 * c + d) / (q * q);
          tiles[tile(u, v)].push_back(difference);
          all.push_back(difference);
        }
      }
    const double scale = 1.0 / (kMedianOfNormal * std::sqrt(70.0));
    const double rounding_m = quantum(in_.depth) / std::sqrt(12.0);
    const double everywhere = all.size() < kFewest ? 0.0 : scale * median(all);
    for (std::vector<double>& values : tiles)
      noise_m_.push_back(
          std::max(values.size() < kFewest ? everywhere : scale * median(values), rounding_m));
  }
  std::size_t tile(std::int64_t u, std::int64_t v) const {
    return static_cast<std::size_t>(v / kTile * tiles_x_ + u / kTile);
  }
  double noise(std::int64_t u, std::int64_t v) const { return noise_m_[tile(u, v)]; }

  // Pixels to each side that a plane is fitted to; 0: the neighbours are enough.
  static int half_width(double noise_px) {
    if (kErrorOfNeighbours * noise_px < kClean_rad) return 0;
    int w = 1;
    while (w < kWidest && error_of_fit(w) * noise_px > kWanted_rad) ++w;
    return w;
  }

  std::optional<Vec3> from_neighbours(std::int64_t u, std::int64_t v) const {
    const Vec3 here = *point(u, v);
    const auto right = step(point(u - 1, v), here, point(u + 1, v));
    const auto down = step(point(u, v - 1), here, point(u, v + 1));
    if (!right || !down) return std::nullopt;
    return facing(glm::cross(*down, *right), here);
  }

  static std::optional<Vec3> facing(const Vec3& n, const Vec3& here) {
    const double size = glm::length(n);
    if (!(size > 0.0) || !std::isfinite(size)) return std::nullopt;
    return n * ((glm::dot(n, here) > 0.0 ? -1.0 : 1.0) / size);
  }

  using Lanes = std::array<double, kLanes>;
  struct Fit {
    Vec3 plane{0.0};  // q = plane.x + plane.y du + plane.z dv
    int pixels = 0;   // that lie on it
  };
  // By least squares to the pixels around that lie on a first guess, up to the slack a pixel off;
  // what lies off the first fits is of another surface.
  std::optional<Fit> fit_from(const Vec3& guess, double slack, std::int64_t u, std::int64_t v,
                              int w, double noise) const {
    Fit fit{guess};
    const auto columns = static_cast<std::size_t>(2 * w + 1), lanes = (columns + 3) / 4 * 4;
    Lanes across{}, aside{}, beyond{};  // du, its size, and what keeps lanes out that are no column
    for (std::size_t i = 0; i < lanes; ++i) {
      across[i] = static_cast<double>(i) - w;
      aside[i] = std::abs(across[i]);
      beyond[i] = i < columns ? 0.0 : kUnseen;
    }
    Mat3 normal(0.0);
    Vec3 right(0.0);
    for (int round = 0; round < 3; ++round) {
      const double more = round == 0 ? slack : 0.0;
      // Sums over the rows of a column: of 1, dv and dv squared, and of 1 and dv times q.
      Lanes n{}, n_v{}, n_vv{}, q{}, q_v{};
      for (int row = -w; row <= w; ++row) {
        const double* there = &inverse_[place(u - w, v + row)];
        const double dv = row, up = std::abs(dv), level = fit.plane.x + fit.plane.z * dv;
        for (std::size_t i = 0; i < lanes; ++i) {
          const double off = std::abs(there[i] - (level + fit.plane.y * across[i])) + beyond[i];
          const double most = 4.0 * noise + more * (aside[i] > up ? aside[i] : up);
          const bool lies = off <= most;
          const double on = lies ? 1.0 : 0.0, value = lies ? there[i] : 0.0;
          n[i] += on, n_v[i] += on * dv, n_vv[i] += on * dv * dv;
          q[i] += value, q_v[i] += value * dv;
        }
      }
      const Mat3 normal_before = std::exchange(normal, Mat3(0.0));
      const Vec3 right_before = std::exchange(right, Vec3(0.0));
      for (std::size_t i = 0; i < columns; ++i) {
        const double du = across[i];
        normal += Mat3(n[i], du * n[i], n_v[i], du * n[i], du * du * n[i], du * n_v[i], n_v[i],
                       du * n_v[i], n_vv[i]);
        right += Vec3(q[i], du * q[i], q_v[i]);
      }
      // The same pixels tell the same plane.
      if (normal == normal_before && right == right_before) break;
      fit.pixels = static_cast<int>(normal[0][0]);
      if (fit.pixels < 3 || !(std::abs(glm::determinant(normal)) > 1e-9)) return std::nullopt;
      fit.plane = glm::inverse(normal) * right;
    }
    return fit;
  }

  // How q changes from pixel to pixel along one axis: towards the side where it changes less, or
  // both.
  static double slope(double before, double here, double after) {
    const double back = here - before, forth = after - here;
    if (before == 0.0) return after == 0.0 ? 0.0 : forth;
    if (after == 0.0) return back;
    return std::abs(forth) > 3.0 * std::abs(back)   ? back
           : std::abs(back) > 3.0 * std::abs(forth) ? forth
                                                    : 0.5 * (back + forth);
  }

  // A plane n . P = d is seen at the inverse depth q = (n.x x + n.y y - n.z) / d in the ray (x, y,
  // -1): q = x + y du + z dv of what this returns. From a guess that faces the sight, which takes
  // in surfaces turned by up to 72 degrees to it (they rise by 3 pixels' widths a pixel), and where
  // that has not nearly all pixels also from the slope to the neighbours, for steeper ones: the
  // better of them.
  std::optional<Vec3> plane_round(std::int64_t u, std::int64_t v, int w, double noise) const {
    constexpr double kNearlyAll = 0.9;
    const double q = inverse(u, v);
    const double rise = 3.0 * q / std::sqrt(in_.intrinsics.fx * in_.intrinsics.fy);
    const auto facing_fit = fit_from({q, 0.0, 0.0}, rise, u, v, w, noise);
    const int all = (2 * w + 1) * (2 * w + 1);
    if (facing_fit && facing_fit->pixels >= kNearlyAll * all) return facing_fit->plane;
    const Vec3 steep(q, slope(inverse(u - 1, v), q, inverse(u + 1, v)),
                     slope(inverse(u, v - 1), q, inverse(u, v + 1)));
    const auto steep_fit = fit_from(steep, 3.0 * noise, u, v, w, noise);
    if (!steep_fit || (facing_fit && facing_fit->pixels >= steep_fit->pixels))
      return facing_fit ? std::optional(facing_fit->plane) : std::nullopt;
    return steep_fit->plane;
  }

  std::optional<Vec3> normal_of_plane(std::int64_t u, std::int64_t v, int w, double noise) const {
    const auto plane = plane_round(u, v, w, noise);
    if (!plane) return std::nullopt;
    const Vec3& fit = *plane;
    const Intrinsics& k = in_.intrinsics;
    const double x = (u + 0.5 - k.cx) / k.fx, y = (k.cy - v - 0.5) / k.fy;
    const double across = fit.y * k.fx, up = -fit.z * k.fy;
    return facing(Vec3(across, up, -(fit.x - across * x - up * y)), *point(u, v));
  }

  const SonarInput& in_;
  std::int64_t stride_;
  std::vector<double> inverse_;  // 1 / planar depth or kUnseen, in rows of stride_, with a border
  std::int64_t tiles_x_;
  std::vector<double> noise_m_;  // by tile
};

}  // namespace

DepthNormals normals_from_depth(const SonarInput& in) {
  return Estimator(in).run();
}

SmoothedDepth smooth_depth(SonarInput& in, double accepted_m) {
  std::vector<double> depth = in.depth;
  const SmoothedDepth told = Estimator(in).smooth(accepted_m, depth);
  in.depth = std::move(depth);
  return told;
}

}  // namespace neritic::sonar
