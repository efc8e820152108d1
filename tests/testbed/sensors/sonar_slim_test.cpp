// Slim things return energy as their area, wherever they stand and however they lean: poles of 2
// and 20 mm against their closed form, at the default and at the named quality levels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarSlim = test::GpuTest;

constexpr double kDistance_m = 2.0, kThin_m = 0.001, kThick_m = 0.010;  // radii

// Where a pole is seen, and how far it leans to port.
struct PolePlace {
  double bearing_rad, lean_rad;
};

std::vector<PolePlace> upright_poles(int count) {
  std::vector<PolePlace> out;
  for (int i = 0; i < count; ++i)
    out.push_back({radians(-4.0 + 8.0 * std::fmod(0.37 + i * 0.6180339887, 1.0)), 0.0});
  return out;
}

std::vector<PolePlace> leaning_poles() {
  std::vector<PolePlace> out;
  for (const double lean_deg : {-0.7, 1.3, 3.0, -6.0, 9.0, -14.0, 20.0, -31.0, 45.0})
    out.push_back({radians(0.1 * lean_deg - 1.0), radians(lean_deg)});
  return out;
}

// The imaging sonar's default bins and sampling over parts of its azimuth, elevation and range,
// with pattern and pulse.
scene::Sonar slim_sonar(const std::string& quality, std::uint32_t beams) {
  scene::Sonar sonar;
  sonar.name = "sonar";
  sonar.azimuth_rad = beams * radians(0.18);
  sonar.elevation_rad = radians(14.0);
  // A named level samples by the number of bins, too.
  sonar.range_min_m = quality.empty() ? 1.6 : 1.0;
  sonar.range_max_m = quality.empty() ? 2.4 : 5.0;
  sonar.bins_range = quality.empty() ? 100 : 500;
  sonar.bins_elevation = 250;
  sonar.bins_azimuth = beams;
  sonar.quality = quality;
  sonar.terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(0.6)};
  sonar.terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 60e3};
  return sonar;
}

// The plain cosine's sum over all bins: azimuth in beams, elevation in apertures. For a piece of
// the pole at h from its nearest point, d away, at range r: solid angle 2 a dh (d / r) / r^2; mean
// cosine of incidence over its width (pi / 4) (d / r).
double pole_energy(const scene::Sonar& s, double radius_m, double lean_rad) {
  constexpr int kSteps = 20000;
  constexpr double kHalf_m = 2.0, kStep_m = 2.0 * kHalf_m / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double h = -kHalf_m + (i + 0.5) * kStep_m, r = std::hypot(h, kDistance_m);
    const double elevation = std::asin(h * std::cos(lean_rad) / r);
    if (std::abs(elevation) > s.elevation_rad / 2.0) continue;
    const double sine = kDistance_m / r;
    sum += 2.0 * radius_m * kStep_m * sine / (r * r) * (kPi / 4.0) * sine / std::cos(elevation);
  }
  return sum / (s.azimuth_rad / s.bins_azimuth) / s.elevation_rad;
}

struct SlimErrors {
  double mean = 0.0, deviation = 0.0, worst = 0.0;  // of energy over the closed form, less 1
};

SlimErrors pole_errors(gpu::Device& device, const scene::Sonar& sonar, double radius_m,
                       const std::vector<PolePlace>& places) {
  scene::Scene scene;
  scene.objects.push_back(
      object_of(scene, scene::make_cylinder(radius_m, 6.0, 96), {0.0, 0.0, -kDistance_m}));
  scene.sonars = {sonar};
  // The i-th place at i seconds.
  scene::Track pole{{{0.0, Vec3(0.0, 0.0, -kDistance_m)}}, {}}, head{{{0.0, Vec3(0.0)}}, {}};
  for (const PolePlace& at : places) {
    const auto time_s = static_cast<double>(pole.attitudes.size());
    pole.attitudes.push_back({time_s, glm::angleAxis(at.lean_rad, Vec3(0, 0, 1))});
    head.attitudes.push_back({time_s, glm::angleAxis(at.bearing_rad, Vec3(0, 1, 0))});
  }
  scene.objects[0].mount.track = pole;
  scene.sonars[0].mount.track = head;
  SlimErrors out;
  auto session = Session::create(device, scene);
  if (!session.ok()) {
    ADD_FAILURE() << session.error().message;
    return out;
  }
  FrameRequest request;
  request.sonars = {0};
  request.capture = request.capture.without_geometry();
  double squares = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    request.time_s = request.next_time_s = static_cast<double>(i);
    const auto frame = (*session)->render(request);
    if (!frame.ok()) {
      ADD_FAILURE() << frame.error().message;
      return out;
    }
    const double off =
        total(frame->sonars[0]) / pole_energy(sonar, radius_m, places[i].lean_rad) - 1.0;
    out.mean += off / static_cast<double>(places.size());
    squares += off * off / static_cast<double>(places.size());
    out.worst = std::max(out.worst, std::abs(off));
  }
  out.deviation = std::sqrt(std::max(0.0, squares - out.mean * out.mean));
  fmt::print("{:>9}, {:2.0f} mm, {} poles: mean {:+.3f}, deviation {:.3f}, worst {:.3f}\n",
             sonar.quality.empty() ? "default" : sonar.quality, 2000.0 * radius_m, places.size(),
             out.mean, out.deviation, out.worst);
  return out;
}

TEST_F(SonarSlim, PolesReturnEnergyAsTheirArea) {
  struct Bound {
    const char* quality;
    int thin_poles, thick_poles;
    double mean, worst;
  };
  // Thick poles differ by 0.003 at most, so that three tell their mean to 0.002.
  const bool thorough = test::is_thorough();
  const int thin_poles = thorough ? 12 : 6, thick_poles = thorough ? 12 : 3;
  for (const Bound& bound :
       {Bound{"", 12, thick_poles, 0.02, 0.1}, Bound{"draft", thin_poles, thick_poles, 0.02, 0.1},
        Bound{"standard", thin_poles, thick_poles, 0.01, 0.05},
        Bound{"reference", thorough ? 4 : 2, thorough ? 4 : 1, 0.01, 0.02}}) {
    const scene::Sonar sonar = slim_sonar(bound.quality, 80);
    const SlimErrors thin = pole_errors(device(), sonar, kThin_m, upright_poles(bound.thin_poles)),
                     thick =
                         pole_errors(device(), sonar, kThick_m, upright_poles(bound.thick_poles));
    for (const SlimErrors& found : {thin, thick}) {
      EXPECT_LT(std::abs(found.mean), bound.mean) << bound.quality;
      EXPECT_LT(found.worst, bound.worst) << bound.quality;
    }
    EXPECT_NEAR((1.0 + thick.mean) / (1.0 + thin.mean), 1.0, bound.mean) << bound.quality;
  }
}

TEST_F(SonarSlim, LeaningPolesToo) {
  for (const char* quality : {"", "standard"})
    for (const double radius_m : {kThin_m, kThick_m}) {
      if (*quality != 0 && radius_m == kThick_m && !test::is_thorough()) continue;
      const SlimErrors found =
          pole_errors(device(), slim_sonar(quality, 144), radius_m, leaning_poles());
      EXPECT_LT(std::abs(found.mean), 0.05) << quality;
      EXPECT_LT(found.worst, *quality == 0 ? 0.3 : 0.05) << quality;
    }
}

// Without terms too, where a cell holds one sample a row.
TEST_F(SonarSlim, ThePlainCosineToo) {
  scene::Sonar sonar = slim_sonar("", 80);
  sonar.terms = {};
  for (const double radius_m : {kThin_m, kThick_m}) {
    const SlimErrors found = pole_errors(device(), sonar, radius_m, upright_poles(12));
    EXPECT_LT(std::abs(found.mean), 0.02);
    EXPECT_LT(found.worst, 0.15);
  }
}

}  // namespace
}  // namespace neritic::testbed
