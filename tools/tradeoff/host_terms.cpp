#include "tools/tradeoff/host_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/core/check.hpp"
#include "sonar/acoustics_pulse.hpp"
#include "sonar/range_correction.hpp"
#include "sonar/sound_speed_profile.hpp"
#include "sonar/write_sonar.hpp"
#include "tools/tradeoff/term_judges.hpp"

namespace neritic::tools {
namespace {

template <class Work>
double least_ms(int repeats, Work work) {
  double least = 1e30;
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    least = std::min(least, took.count());
  }
  return least;
}

double factor_at(const sonar::RangeCorrection& t, double x, double y) {
  const auto i = std::min(static_cast<std::uint32_t>(x * (t.width - 1)), t.width - 2),
             j = std::min(static_cast<std::uint32_t>(y * (t.height - 1)), t.height - 2);
  const double u = x * (t.width - 1) - i, v = y * (t.height - 1) - j;
  const auto at = [&](std::uint32_t k, std::uint32_t l) {
    return double{t.factors[std::size_t{l} * t.width + k]};
  };
  return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
         v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
}

}  // namespace

std::vector<TermPoint> profile_tables(const scene::Sonar& sonar, double depth_m) {
  NERITIC_CHECK(sonar.terms.profile && sonar.terms.range_spread, "a sonar with profile and pulse");
  constexpr double kSpeed_m_s = 1500.0;
  const double resolution_m =
      sonar::range_resolution_m(kSpeed_m_s, sonar.terms.range_spread->bandwidth_hz);
  scene::SonarProfile straight = *sonar.terms.profile, bent = straight;
  straight.bent = false;
  bent.bent = true;
  const auto profile = sonar::SoundSpeedProfile::of_table(straight.table);
  NERITIC_CHECK(profile.ok(), "profile: {}", profile.ok() ? "" : profile.error().message);
  std::vector<TermPoint> out;
  for (const sonar::RangeCorrectionSize size :
       {sonar::RangeCorrectionSize{9, 17}, {17, 33}, {33, 65}, {65, 129}, {129, 257}}) {
    const auto table =
        sonar::range_correction(straight, depth_m, sonar.range_max_m, kSpeed_m_s, size);
    double off = 0.0, most = 0.0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const double x = (i + 0.5) / kSteps, y = 0.1 + 0.8 * (j + 0.5) / kSteps;
        const double r = x * sonar.range_max_m, elevation = std::asin(2.0 * y - 1.0);
        const double exact = kSpeed_m_s * profile->straight_time_s(depth_m, elevation, r);
        const double error = std::abs(r * factor_at(table, x, y) - exact);
        off += error;
        most = std::max(most, error);
      }
    TermPoint p;
    p.term = fmt::format("profile's table, {} ranges x {} sines", size.ranges, size.sines);
    p.ms = least_ms(
        3, [&] { sonar::range_correction(bent, depth_m, sonar.range_max_m, kSpeed_m_s, size); });
    p.error_with = off / (kSteps * kSteps) / resolution_m;
    p.note = fmt::format("of a resolution cell; at most {:.2f} mm; ms of the host, bent rays",
                         1000.0 * most);
    out.push_back(std::move(p));
  }
  return out;
}

std::vector<TermPoint> counts_of(std::span<const float> power) {
  std::vector<TermPoint> out;
  const double strongest = *std::max_element(power.begin(), power.end());
  const std::vector<double> exact(power.begin(), power.end());
  for (const std::uint32_t bits : {8u, 16u}) {
    scene::SonarOutput output;
    output.bits = bits;
    output.span_db = 80.0;
    output.floor_db = 10.0 * std::log10(strongest) - output.span_db;
    std::vector<std::uint16_t> counts;
    TermPoint p;
    p.term = fmt::format("output of {} bits", bits);
    p.ms = least_ms(3, [&] { counts = sonar::quantize(power, output); });
    const double most = bits == 8 ? 255.0 : 65535.0;
    std::vector<float> back;
    for (const std::uint16_t n : counts)
      back.push_back(n == 0 ? 0.0f
                            : static_cast<float>(std::pow(
                                  10.0, (output.floor_db + output.span_db * n / most) / 10.0)));
    p.error_with = difference(back, exact).l1;
    p.error_without = 0.0;
    p.note = "80 dB below the strongest cell; ms of the host";
    out.push_back(std::move(p));
  }
  return out;
}

}  // namespace neritic::tools
