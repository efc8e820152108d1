#include "tools/tradeoff/swim_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "diver/flutter_kick.hpp"
#include "tools/tradeoff/measure.hpp"

namespace neritic::tools {
namespace {

constexpr int kTruthStrips = 64;
// All swims are looked at so often: a whole number of every step but 1/240 s, which is met within.
constexpr double kLook_s = 0.1;
constexpr const char* kSwims[] = {"straight", "turning", "ascent"};

diver::Body body_of(diver::Model model, int strips) {
  diver::BodyParameters p;
  p.model = model;
  p.strips_a_segment = strips;
  return diver::make_body(p).value();
}

// Joints of the swim at a time: a kick that steers a little.
diver::JointRotations joints_at(const diver::Body& body, const std::string& swim, double t) {
  diver::FlutterKick kick;
  kick.lift_rad = radians(4.0) * std::sin(2.0 * kPi * t / 7.0);
  diver::JointAngles joints = diver::streamlined(body);
  diver::set_flutter(joints, body, kick, 2.0 * kPi * 0.9 * t);
  if (swim == "turning")
    for (const diver::Segment spine : {diver::kAbdomen, diver::kThorax})
      joints[diver::joint_of(spine)].z = radians(6.0) * std::sin(2.0 * kPi * t / 9.0);
  return diver::rotations_of(joints);
}

Vec3 place_from(const std::string& swim) {
  return {0.0, 0.0, swim == "ascent" ? 25.0 : 15.0};
}

diver::HumanState start_of(const diver::Body& body, const std::string& swim) {
  const double up_rad = swim == "ascent" ? radians(45.0) : 0.0;
  return diver::start_at(body, place_from(swim),
                         {std::cos(0.5 * up_rad), 0.0, std::sin(0.5 * up_rad), 0.0},
                         joints_at(body, swim, 0.0));
}

// Places at every look.
std::vector<Vec3> swim_all(const diver::Body& body, const std::string& swim, double seconds,
                           double step_s) {
  diver::HumanState state = start_of(body, swim);
  diver::HumanInputs inputs;
  std::vector<Vec3> places;
  const int looks = static_cast<int>(std::lround(seconds / kLook_s));
  std::int64_t taken = 0;
  for (int look = 1; look <= looks; ++look) {
    const auto until = std::llround(look * kLook_s / step_s);
    for (; taken < until; ++taken) {
      inputs.joints = joints_at(body, swim, static_cast<double>(taken + 1) * step_s);
      // Longer substeps than anyone uses, so that the step itself is measured.
      state = diver::step(body, state, inputs, step_s, step_s);
    }
    places.push_back(state.root.position_ned_m);
  }
  return places;
}

double largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double off = glm::distance(a[i], b[i]);
    most = off <= most ? most : off;
  }
  return most < 1e3 ? most : std::numeric_limits<double>::infinity();
}

// Processor time of the steps alone, the least of several.
double least_swim_cpu_us(const diver::Body& body, const std::string& swim, double step_s,
                         int repeats) {
  constexpr double kTimed_s = 2.0;
  const int count = static_cast<int>(std::lround(kTimed_s / step_s));
  std::vector<diver::HumanInputs> inputs(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    inputs[static_cast<std::size_t>(i)].joints = joints_at(body, swim, (i + 1) * step_s);
  double least = 1e300, farthest = 0.0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    diver::HumanState state = start_of(body, swim);
    const std::clock_t begin = std::clock();
    for (const diver::HumanInputs& in : inputs)
      state = diver::step(body, state, in, step_s, step_s);
    const double us = 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    farthest = std::max(farthest, state.root.position_ned_m.x);
    if (farthest > -1.0) least = std::min(least, us / kTimed_s);  // the swims are needed for this
  }
  return least;
}

double strips_a_second(const diver::Body& body, double step_s) {
  double strips = kStepInStrips;
  for (std::size_t i = 0; i < body.part_count; ++i) strips += body.parts[i].strips;
  return strips / step_s;
}

struct Variant {
  diver::Model model;
  int strips;
};
std::vector<Variant> variants(const SwimTradeoffOptions& options) {
  std::vector<Variant> out;
  for (const int strips : options.strips) out.push_back({diver::Model::kFull, strips});
  out.push_back({diver::Model::kPlanar, diver::BodyParameters{}.strips_a_segment});
  return out;
}

// Whether a point of the full model counts among those of a swim.
bool counts(const SwimPoint& p, const std::string& swim) {
  return p.swim == swim && p.model == diver::Model::kFull && std::isfinite(p.error_m);
}

}  // namespace

std::uint64_t steps(const SwimTradeoffOptions& options) {
  return std::size(kSwims) * (2 + options.steps_ms.size() * variants(options).size());
}

SwimTradeoff run_swim_tradeoff(const SwimTradeoffOptions& options) {
  SwimTradeoff out;
  out.swim_s = options.quick ? 2.0 : options.swim_s;
  for (const std::string swim : kSwims) {
    const Vec3 from = place_from(swim);
    const diver::Body finest = body_of(diver::Model::kFull, kTruthStrips);
    const auto truth = swim_all(finest, swim, out.swim_s, options.truth_step_s);
    options.step();
    const auto looser = swim_all(finest, swim, out.swim_s, 2.0 * options.truth_step_s);
    options.step();
    out.reference_error_m = std::max(out.reference_error_m, largest_distance(truth, looser));
    const double way_m = glm::distance(truth.back(), from);
    if (swim == kSwims[0]) out.way_m = way_m;
    for (const Variant& variant : variants(options)) {
      const diver::Body body = body_of(variant.model, variant.strips);
      for (const double step_ms : options.steps_ms) {
        const double step_s = 1e-3 * step_ms;
        const auto places = swim_all(body, swim, out.swim_s, step_s);
        SwimPoint point{swim, variant.model, variant.strips, step_s};
        point.error_m = largest_distance(places, truth);
        point.way_error = std::abs(glm::distance(places.back(), from) - way_m) / way_m;
        point.strips_a_second = strips_a_second(body, step_s);
        if (options.timed)
          point.us_a_second = least_swim_cpu_us(body, swim, step_s, options.quick ? 1 : 7);
        out.points.push_back(point);
        options.step();
      }
    }
  }
  return out;
}

bool is_default(const SwimPoint& p) {
  return p.model == diver::Model::kFull && p.strips == diver::BodyParameters{}.strips_a_segment &&
         std::abs(p.step_s - 1.0 / 240.0) < 1e-6;
}

std::vector<SwimPoint> worst_of_all(const SwimTradeoff& tradeoff) {
  std::vector<SwimPoint> out;
  for (const SwimPoint& p : tradeoff.points) {
    const auto same = std::ranges::find_if(out, [&](const SwimPoint& q) {
      return q.model == p.model && q.strips == p.strips && q.step_s == p.step_s;
    });
    if (same == out.end()) {
      out.push_back(p);
      out.back().swim = kAllSwims;
      continue;
    }
    same->error_m = std::max(same->error_m, p.error_m);
    same->way_error = std::max(same->way_error, p.way_error);
    same->us_a_second = std::max(same->us_a_second, p.us_a_second);
  }
  return out;
}

const SwimPoint* knee(std::span<const SwimPoint> points, const std::string& swim) {
  std::vector<const SwimPoint*> front;
  std::vector<double> cost, error;
  for (const SwimPoint& p : points) {
    const bool beaten = std::ranges::any_of(points, [&](const SwimPoint& other) {
      return counts(other, swim) && other.strips_a_second < p.strips_a_second &&
             other.error_m <= p.error_m;
    });
    if (!counts(p, swim) || beaten) continue;
    front.push_back(&p);
    cost.push_back(std::log(p.strips_a_second));
    error.push_back(std::log(p.error_m + 1e-12));
  }
  return front.empty() ? nullptr : front[knee_of(cost, error)];
}

const SwimPoint* cheapest_within(std::span<const SwimPoint> points, const std::string& swim,
                                 double error_m) {
  const SwimPoint* best = nullptr;
  for (const SwimPoint& p : points)
    if (counts(p, swim) && p.error_m <= error_m &&
        (best == nullptr || p.strips_a_second < best->strips_a_second))
      best = &p;
  return best;
}

}  // namespace neritic::tools
