#include "tools/tradeoff/tether_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "rov/cable.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"

namespace neritic::tools {
namespace {

constexpr double kLine_m = 50.0, kChain_m = 10.0;
const Vec3 kTop(0.0, 0.0, 5.0), kEnd(40.0, 0.0, 8.0);
constexpr double kSettleStep_s = 1.0;

// A cable from kTop to a fixed place or a free end, stepped as a tether is.
struct Rig {
  rov::Cable cable;
  double length_m = kLine_m;
  Vec3 end = kEnd, end_velocity{0.0}, current{0.0};
  bool fixed = true;
  std::vector<rov::CableNode> nodes{};
  rov::CableWork work{};
  std::vector<Vec3> currents{};

  explicit Rig(std::uint32_t segments) {
    cable.segments = segments;
    cable.stiffness_n = 1e7;
    nodes.resize(segments - 1);
  }
  rov::CablePull step(double dt_s) {
    currents.assign(cable.segments + 1, current);
    const rov::CableEnds ends{kTop,         kTop,         end + dt_s * end_velocity,
                              end_velocity, end_velocity, Mat3(fixed ? 1e9 : 0.0)};
    const rov::CablePull pull =
        rov::step_cable(cable, length_m, ends, currents, {}, dt_s, nodes, work);
    if (fixed) return pull;
    end_velocity = pull.end_velocity_m_s;
    end += dt_s * end_velocity;
    return pull;
  }
  // At rest; the force on what holds its end.
  Vec3 settle() {
    rov::hang_cable(cable, length_m, kTop, end, nodes);
    rov::CablePull pull;
    for (int i = 0; i < 800; ++i) pull = step(kSettleStep_s);
    return pull.impulse_n_s / kSettleStep_s;
  }
  double cost_us_a_second(double rate_hz, int seconds) {
    double least = 1e300;
    for (int i = 0; i < seconds; ++i) {
      const TimeNs begun = now_ns();
      for (int k = 0; k < static_cast<int>(rate_hz); ++k) step(1.0 / rate_hz);
      least = std::min(least, 1e-3 * static_cast<double>(now_ns() - begun));
    }
    return least;
  }
};

// A line's true places at equal lengths from the top, and its pull at the end.
struct TrueLine {
  std::vector<Vec3> places;  // of each 1 / places.size() of the length
  Vec3 pull_n{0.0};
};

// From the end up by Runge and Kutta's method: the load a metre turns the tension.
std::vector<Vec3> integrated(const Rig& rig, const Vec3& pull_n, int steps) {
  const rov::Cable& c = rig.cable;
  const auto load = [&](const Vec3& tension) {
    const Vec3 along = glm::normalize(tension);
    const Vec3 t = glm::dot(rig.current, along) * along, n = rig.current - t;
    return Vec3(0.0, 0.0, c.net_weight_n_m) +
           0.5 * c.water_kg_m3 * c.diameter_m *
               (c.normal_drag * glm::length(n) * n + kPi * c.tangential_drag * glm::length(t) * t);
  };
  std::vector<Vec3> places(static_cast<std::size_t>(steps) + 1);
  Vec3 tension = -pull_n, at = kEnd;
  places.back() = at;
  const double ds = rig.length_m / steps;
  for (int i = steps - 1; i >= 0; --i) {
    const Vec3 k1 = load(tension), k2 = load(tension + 0.5 * ds * k1),
               k3 = load(tension + 0.5 * ds * k2), k4 = load(tension + ds * k3);
    const Vec3 next = tension + ds / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    at -= ds / 6.0 *
          (glm::normalize(tension) + 4.0 * glm::normalize(0.5 * (tension + next)) +
           glm::normalize(next));
    tension = next;
    places[static_cast<std::size_t>(i)] = at;
  }
  return places;
}

// Newton's method on the pull with which the line ends at its top.
TrueLine shot(const Rig& rig, Vec3 pull_n) {
  constexpr int kSteps = 12'800;
  const auto miss = [&](const Vec3& pull) { return integrated(rig, pull, kSteps).front() - kTop; };
  for (int round = 0; round < 12; ++round) {
    const Vec3 off = miss(pull_n);
    if (glm::length(off) < 1e-9) break;
    Mat3 slope(0.0);
    for (int k = 0; k < 3; ++k) {
      Vec3 moved = pull_n;
      moved[k] += 1e-4;
      slope[k] = (miss(moved) - off) / 1e-4;
    }
    pull_n -= glm::inverse(slope) * off;
  }
  return {integrated(rig, pull_n, kSteps), pull_n};
}

// In closed form: y = a cosh(x / a) through both ends.
TrueLine catenary(double weight_n_m) {
  const double wide = kEnd.x - kTop.x, rise = kTop.z - kEnd.z;  // y is up
  double low = 1e-3, high = 1e6;
  for (int i = 0; i < 200; ++i) {
    const double a = std::sqrt(low * high);
    (2.0 * a * std::sinh(0.5 * wide / a) > std::sqrt(kLine_m * kLine_m - rise * rise) ? low
                                                                                      : high) = a;
  }
  const double a = low, x0 = 0.5 * wide - a * std::atanh(rise / kLine_m);
  TrueLine out;
  constexpr int kPlaces = 12'800;
  const double s0 = a * std::sinh(-x0 / a), y0 = a * std::cosh(x0 / a);
  for (int i = 0; i <= kPlaces; ++i) {
    const double s = s0 + kLine_m * i / kPlaces;
    out.places.push_back(kTop + Vec3(x0 + a * std::asinh(s / a), 0.0, -(std::hypot(a, s) - y0)));
  }
  out.pull_n = weight_n_m * Vec3(-a, 0.0, s0 + kLine_m);
  return out;
}

TetherPoint against(const std::string& name, Rig& rig, const Vec3& pull_n, const TrueLine& truth,
                    int seconds) {
  TetherPoint point{name, rig.cable.segments, 240.0};
  for (std::size_t i = 0; i < rig.nodes.size(); ++i)
    point.error_m = std::max(
        point.error_m,
        glm::distance(rig.nodes[i].position_ned_m,
                      truth.places[(i + 1) * (truth.places.size() - 1) / rig.cable.segments]));
  point.error_percent = 100.0 * glm::distance(pull_n, truth.pull_n) / glm::length(truth.pull_n);
  point.us_a_second = rig.cost_us_a_second(point.rate_hz, seconds);
  return point;
}

TetherPoint swings(std::uint32_t segments, double rate_hz, int seconds) {
  // The slowest swing of a chain: j01 / 2 sqrt(g / L); its shape J0(j01 sqrt(1 - s / L)).
  constexpr double kJ01 = 2.404825557695773;
  Rig rig(segments);
  rig.cable.water_kg_m3 = 0.0;
  rig.cable.net_weight_n_m = 1.0;
  rig.cable.damping_n_s = 0.0;
  rig.length_m = kChain_m;
  rig.fixed = false;
  const auto place = [&](double s) {
    return kTop + Vec3(0.05 * std::cyl_bessel_j(0.0, kJ01 * std::sqrt(1.0 - s / kChain_m)), 0.0, s);
  };
  for (std::size_t i = 0; i < rig.nodes.size(); ++i)
    rig.nodes[i].position_ned_m = place(kChain_m * static_cast<double>(i + 1) / segments);
  rig.end = place(kChain_m);
  double last_x = rig.end.x;
  std::vector<double> crossings;
  for (int i = 1; crossings.size() < 3 && i < static_cast<int>(30.0 * rate_hz); ++i) {
    rig.step(1.0 / rate_hz);
    if ((last_x > 0.0) != (rig.end.x > 0.0))
      crossings.push_back((i - rig.end.x / (rig.end.x - last_x)) / rate_hz);
    last_x = rig.end.x;
  }
  const double expected_s = 2.0 * kPi / (0.5 * kJ01 * std::sqrt(rig.cable.gravity_m_s2 / kChain_m));
  TetherPoint point{"swings", segments, rate_hz};
  point.error_percent = crossings.size() < 3
                            ? 100.0
                            : 100.0 * std::abs((crossings[2] - crossings[0]) / expected_s - 1.0);
  point.us_a_second = rig.cost_us_a_second(rate_hz, seconds);
  return point;
}

constexpr const char* kTetherRigs[][2] = {{"hangs", "hanging: against the catenary"},
                                          {"current", "in a current: against its equilibrium"},
                                          {"swings", "swinging: period, against a chain's"}};

}  // namespace

std::vector<TetherPoint> run_tether_tradeoff(bool quick) {
  const std::vector<std::uint32_t> counts =
      quick ? std::vector<std::uint32_t>{4, 16} : std::vector<std::uint32_t>{4, 8, 16, 32, 64, 128};
  const int seconds = quick ? 1 : 5;
  std::vector<TetherPoint> points;
  const auto hanging = [](std::uint32_t segments) {
    Rig rig(segments);
    rig.cable.net_weight_n_m = 1.0;
    return rig;
  };
  const auto streaming = [](std::uint32_t segments) {
    Rig rig(segments);
    rig.cable.net_weight_n_m = 0.2;
    rig.current = Vec3(0.1, 0.5, 0.0);
    return rig;
  };
  const TrueLine hung = catenary(1.0);
  for (const std::uint32_t n : counts) {
    Rig rig = hanging(n);
    const Vec3 pull = rig.settle();
    points.push_back(against("hangs", rig, pull, hung, seconds));
  }
  Rig first = streaming(quick ? 16 : 64);
  const Vec3 guess = first.settle();
  const TrueLine streamed = shot(first, guess);
  for (const std::uint32_t n : counts) {
    Rig rig = streaming(n);
    const Vec3 pull = rig.settle();
    points.push_back(against("current", rig, pull, streamed, seconds));
  }
  for (const std::uint32_t n : counts) points.push_back(swings(n, 240.0, seconds));
  for (const double rate_hz : {60.0, 1000.0}) points.push_back(swings(16, rate_hz, seconds));
  return points;
}

Result<bool> write_tether_tradeoff(const std::filesystem::path& folder,
                                   const std::vector<TetherPoint>& points) {
  std::string csv = "rig,segments,rate_hz,error_m,error_percent,us_a_second\n";
  std::string md =
      "# A tether of segments: error against cost\n\nA line of 50 m, 40 m across, at rest: the "
      "farthest node from its true place and the error of the pull at its end, against the "
      "catenary, and in a current of 0.5 m/s across against the equilibrium integrated along the "
      "line. A hanging chain of 10 m: the error of its slowest period.\n\n"
      "| rig | segments | steps a second | farthest node, m | pull or period, % | us of one core a "
      "second |\n|---|---|---|---|---|---|\n";
  Page page{
      "A tether of segments: error against cost",
      {"Error of the pull at the end, or of the period; by the number of segments. One core."}};
  for (const auto& [rig, words] : kTetherRigs) {
    Panel panel{words, {"\u00b5s of one core a second"}, {"error, %"}};
    Series series{"240 steps a second", {}, {}}, others{"other rates, 16 segments", {}, {}};
    others.joined = false;
    for (const TetherPoint& p : points) {
      if (p.rig != rig) continue;
      csv += fmt::format("{},{},{:g},{:.4g},{:.4g},{:.4g}\n", p.rig, p.segments, p.rate_hz,
                         p.error_m, p.error_percent, p.us_a_second);
      md += fmt::format("| {} | {} | {:g} | {} | {:.2g} | {:.0f} |\n", p.rig, p.segments, p.rate_hz,
                        p.rig == "swings" ? std::string("-") : fmt::format("{:.2g}", p.error_m),
                        p.error_percent, p.us_a_second);
      Series& into = p.rate_hz == 240.0 ? series : others;
      into.x.push_back(p.us_a_second);
      into.y.push_back(std::max(p.error_percent, 1e-6));
      into.notes.push_back(p.rate_hz == 240.0 ? fmt::format("{}", p.segments)
                                              : fmt::format("{:g} Hz", p.rate_hz));
    }
    panel.series.push_back(std::move(series));
    if (!others.x.empty()) panel.series.push_back(std::move(others));
    page.panels.push_back(std::move(panel));
  }
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "tether.csv", csv));
  NERITIC_TRY_STATUS(write_text(folder / "tether.md", md));
  return write_picture(folder / "tether.png", page_data(page));
}

}  // namespace neritic::tools
