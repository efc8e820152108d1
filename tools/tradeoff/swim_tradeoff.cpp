#include "tools/tradeoff/swim_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "diver/flutter_kick.hpp"
#include "tools/tradeoff/measure.hpp"

namespace neritic::tools {
namespace {

using diver::Model;

constexpr double kStepsMs[] = {1, 2, 1e3 / 240, 8, 12.5, 20, 25, 50};
constexpr int kStrips[] = {1, 2, 3, 4, 6, 8, 16};
constexpr int kTruthStrips = 64;
constexpr double kTruthStep_s = 0.25e-3;
// All swims are looked at so often: a whole number of every step but 1/240 s, which is met within.
constexpr double kLook_s = 0.1;
constexpr const char* kSwims[] = {"straight", "turning"};

diver::Body body_of(Model model, int strips) {
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

// Places at every look.
std::vector<Vec3> swim_all(const diver::Body& body, const std::string& swim, double seconds,
                           double step_s) {
  diver::HumanState state =
      diver::start_at(body, {0.0, 0.0, 15.0}, {1.0, 0.0, 0.0, 0.0}, joints_at(body, swim, 0.0));
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
    diver::HumanState state =
        diver::start_at(body, {0.0, 0.0, 15.0}, {1.0, 0.0, 0.0, 0.0}, inputs[0].joints);
    const std::clock_t begin = std::clock();
    for (const diver::HumanInputs& in : inputs)
      state = diver::step(body, state, in, step_s, step_s);
    const double us = 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    farthest = std::max(farthest, state.root.position_ned_m.x);
    if (farthest > -1.0) least = std::min(least, us / kTimed_s);  // the swims are needed for this
  }
  return least;
}

struct Variant {
  Model model;
  int strips;
};
std::vector<Variant> variants() {
  std::vector<Variant> out;
  for (const int strips : kStrips) out.push_back({Model::kFull, strips});
  out.push_back({Model::kPlanar, diver::BodyParameters{}.strips_a_segment});
  return out;
}

}  // namespace

std::uint64_t steps(const SwimTradeoffOptions&) {
  return std::size(kSwims) * (2 + std::size(kStepsMs) * variants().size());
}

SwimTradeoff run_swim_tradeoff(const SwimTradeoffOptions& options) {
  SwimTradeoff out;
  out.swim_s = options.quick ? 2.0 : 20.0;
  for (const std::string swim : kSwims) {
    const diver::Body finest = body_of(Model::kFull, kTruthStrips);
    const auto truth = swim_all(finest, swim, out.swim_s, kTruthStep_s);
    options.step();
    const auto looser = swim_all(finest, swim, out.swim_s, 2.0 * kTruthStep_s);
    options.step();
    out.reference_error_m = std::max(out.reference_error_m, largest_distance(truth, looser));
    const double way_m = glm::distance(truth.back(), Vec3(0.0, 0.0, 15.0));
    if (swim == kSwims[0]) out.way_m = way_m;
    for (const Variant& variant : variants()) {
      const diver::Body body = body_of(variant.model, variant.strips);
      for (const double step_ms : kStepsMs) {
        const double step_s = 1e-3 * step_ms;
        const auto places = swim_all(body, swim, out.swim_s, step_s);
        SwimPoint point{swim, variant.model, variant.strips, step_s};
        point.error_m = largest_distance(places, truth);
        point.way_error =
            std::abs(glm::distance(places.back(), Vec3(0.0, 0.0, 15.0)) - way_m) / way_m;
        point.us_a_second = least_swim_cpu_us(body, swim, step_s, options.quick ? 1 : 7);
        out.points.push_back(point);
        options.step();
      }
    }
  }
  return out;
}

bool is_default(const SwimPoint& p) {
  return p.model == Model::kFull && p.strips == diver::BodyParameters{}.strips_a_segment &&
         std::abs(p.step_s - 1.0 / 240.0) < 1e-6;
}

const SwimPoint* knee(const SwimTradeoff& tradeoff, const std::string& swim) {
  std::vector<const SwimPoint*> front;
  std::vector<double> cost, error;
  for (const SwimPoint& p : tradeoff.points) {
    const auto counts = [&](const SwimPoint& q) {
      return q.swim == swim && q.model == Model::kFull && std::isfinite(q.error_m);
    };
    const bool beaten = std::ranges::any_of(tradeoff.points, [&](const SwimPoint& other) {
      return counts(other) && other.us_a_second < p.us_a_second && other.error_m <= p.error_m;
    });
    if (!counts(p) || beaten) continue;
    front.push_back(&p);
    cost.push_back(std::log(p.us_a_second));
    error.push_back(std::log(p.error_m + 1e-12));
  }
  return front.empty() ? nullptr : front[knee_of(cost, error)];
}

}  // namespace neritic::tools
