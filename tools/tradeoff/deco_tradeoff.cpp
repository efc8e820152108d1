#include "tools/tradeoff/deco_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "diver/deco_live.hpp"
#include "diver/dive_plan.hpp"
#include "engine/core/check.hpp"
#include "engine/core/random.hpp"
#include "tools/tradeoff/measure.hpp"

namespace neritic::tools {
namespace {

using diver::TissueState;
using enum TissueMethod;

constexpr TissueMethod kMethods[] = {kEuler, kHeld, kMean, kSchreiner, kFactors};
constexpr double kSteps_s[] = {1, 2, 3, 5, 10, 15, 20, 30, 60};
constexpr double kGfLow = 0.3;

// A dive of linear depth changes whose corners lie between samples.
struct KnownDive {
  std::string name;
  diver::DecoConventions conventions;
  std::vector<diver::PlanGas> gases;
  std::vector<diver::PlanSegment> segments;
  double minutes = 0.0;
};

KnownDive planned_dive(const std::string& name, const diver::DivePlanRequest& request) {
  const auto plan = diver::plan_dive(request);
  NERITIC_CHECK(plan.ok(), "{}", plan.error().message);
  return {name, request.conventions, request.gases, plan->segments, plan->run_min()};
}

KnownDive square_dive() {
  diver::DivePlanRequest request;
  request.levels = {{35.0, 40.0}};
  // Rates that no step divides.
  request.conventions.descent_m_min = 19.3;
  request.conventions.ascent_m_min = 9.7;
  return planned_dive("air, 35 m, 40 min", request);
}

KnownDive trimix_dive() {
  diver::DivePlanRequest request;
  request.levels = {{60.0, 25.0}};
  request.gases = {{{0.18, 0.45}, 0.0, diver::GasRole::kBottom},
                   {{0.5, 0.0}, 21.0, diver::GasRole::kDeco},
                   {{1.0, 0.0}, 6.0, diver::GasRole::kDeco}};
  request.conventions.descent_m_min = 19.3;
  request.conventions.ascent_m_min = 9.7;
  return planned_dive("18/45, 60 m, 25 min", request);
}

// Up and down along a wall, a corner every 20 s or so.
KnownDive wandering_dive() {
  KnownDive dive{"air, up and down", {}, {diver::PlanGas{}}, {}, 0.0};
  double depth_m = 0.0;
  for (std::uint32_t i = 0; dive.minutes < 60.0; ++i) {
    const double minutes = 0.1 + 0.5 * random_uniform({1, 0, 0}, i);
    const double rate_m_min =
        30.0 * random_uniform({1, 1, 0}, i) - (dive.minutes < 30.0 ? 12.0 : 16.0);
    const double to_m = std::clamp(depth_m + minutes * rate_m_min, 0.0, 40.0);
    dive.segments.push_back({depth_m, to_m, minutes, 0, diver::PlanPhase::kBottom});
    depth_m = to_m;
    dive.minutes += minutes;
  }
  return dive;
}

struct Sample {
  double bar = 0.0;
  std::size_t gas = 0;
  TissueState exact;
};

// Pressures, gases and exact tissues every step_s. A gas switch takes effect at the next sample:
// the diver reports it to the computer, which does not have to guess it.
std::vector<Sample> samples_of(const KnownDive& dive, double step_s) {
  const diver::Buehlmann model = dive.conventions.model();
  const diver::DecoEnvironment& where = dive.conventions.environment;
  TissueState tissues = diver::saturated(model, where.surface_bar, dive.conventions.start_n2);
  std::size_t gas = dive.segments[0].gas;
  std::vector<Sample> out{{where.surface_bar, gas, tissues}};
  double begin_min = 0.0;
  for (const diver::PlanSegment& s : dive.segments) {
    double done_min = 0.0;
    const auto bar_at = [&](double minutes) {
      return where.pressure_bar(s.from_m + (s.to_m - s.from_m) * minutes / s.minutes);
    };
    const auto advance = [&](double to_min) {
      tissues = diver::load(model, tissues, bar_at(done_min), bar_at(to_min), to_min - done_min,
                            dive.gases[gas].mix);
      done_min = to_min;
    };
    for (;;) {
      const double due_min = static_cast<double>(out.size()) * step_s / 60.0 - begin_min;
      if (due_min > s.minutes) break;
      advance(due_min);
      gas = s.gas;
      out.push_back({bar_at(due_min), gas, tissues});
    }
    advance(s.minutes);
    begin_min += s.minutes;
  }
  return out;
}

TissueState euler_step(const diver::Buehlmann& model, const TissueState& t, double bar,
                       double minutes, const diver::GasMix& mix) {
  TissueState out;
  const double lungs = bar - model.water_vapour_bar;
  for (std::size_t i = 0; i < diver::kCompartments; ++i) {
    out.n2_bar[i] =
        t.n2_bar[i] + model.n2.rate_min[i] * minutes * (mix.nitrogen() * lungs - t.n2_bar[i]);
    out.he_bar[i] =
        t.he_bar[i] + model.he.rate_min[i] * minutes * (mix.helium * lungs - t.he_bar[i]);
  }
  return out;
}

TissueState sampled_step(const diver::Buehlmann& model, const diver::StepFactors& factors,
                         TissueMethod method, const TissueState& t, double from, double to,
                         const diver::GasMix& mix) {
  const double mean = 0.5 * (from + to);
  switch (method) {
    case kEuler:
      return euler_step(model, t, from, factors.minutes, mix);
    case kHeld:
      return diver::load(model, factors, t, from, from, mix);
    case kMean:
      return diver::load(model, factors, t, mean, mean, mix);
    case kSchreiner:
      return diver::load(model, t, from, to, factors.minutes, mix);
    case kFactors:
      break;
  }
  return diver::load(model, factors, t, from, to, mix);
}

// Calls seen(sample, tissues) at each sample after the first.
template <class Seen>
void dive_by_samples(const KnownDive& dive, const std::vector<Sample>& samples, TissueMethod method,
                     double step_s, const Seen& seen) {
  const diver::Buehlmann model = dive.conventions.model();
  const diver::StepFactors factors = diver::step_factors(model, step_s / 60.0);
  TissueState tissues = samples[0].exact;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    tissues = sampled_step(model, factors, method, tissues, samples[i - 1].bar, samples[i].bar,
                           dive.gases[samples[i - 1].gas].mix);
    seen(samples[i], tissues);
  }
}

// Processor time of one dive: the least of several runs, each long enough to measure.
double dive_cpu_us(const KnownDive& dive, const std::vector<Sample>& samples, TissueMethod method,
                   double step_s, bool quick) {
  double least = 1e300, kept = 0.0;
  for (int repeat = 0; repeat < (quick ? 1 : 7); ++repeat) {
    int dives = 0;
    const std::clock_t begin = std::clock();
    do {
      dive_by_samples(dive, samples, method, step_s,
                      [&](const Sample&, const TissueState& t) { kept += t.n2_bar[0]; });
      ++dives;
    } while (!quick && std::clock() - begin < CLOCKS_PER_SEC / 100);
    const double us = 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / dives;
    if (kept != 0.0) least = std::min(least, us);  // the tissues are needed for this
  }
  return std::max(least, 1e-3);
}

DecoPoint measure_deco(const KnownDive& dive, const std::vector<Sample>& samples,
                       TissueMethod method, double step_s, bool quick) {
  DecoPoint point{dive.name, method, step_s, 0.0, 0.0, 0.0};
  const diver::Buehlmann model = dive.conventions.model();
  dive_by_samples(dive, samples, method, step_s, [&](const Sample& s, const TissueState& t) {
    for (std::size_t i = 0; i < diver::kCompartments; ++i) {
      const double off =
          std::abs(t.n2_bar[i] + t.he_bar[i] - s.exact.n2_bar[i] - s.exact.he_bar[i]);
      if (!(off <= point.error_bar)) point.error_bar = off;
    }
    const double off_bar = diver::ceiling(model, t, kGfLow).pressure_bar -
                           diver::ceiling(model, s.exact, kGfLow).pressure_bar;
    point.ceiling_error_m =
        std::max(point.ceiling_error_m, std::abs(off_bar) / dive.conventions.environment.bar_per_m);
  });
  point.us_an_hour = dive_cpu_us(dive, samples, method, step_s, quick) * 60.0 / dive.minutes;
  return point;
}

}  // namespace

const char* name_of(TissueMethod method) {
  constexpr const char* kNames[] = {"euler", "held", "mean", "schreiner", "factors"};
  return kNames[static_cast<std::size_t>(method)];
}

std::uint64_t steps(const DecoTradeoffOptions&) {
  return 3 * std::size(kSteps_s);
}

DecoTradeoff run_deco_tradeoff(const DecoTradeoffOptions& options) {
  DecoTradeoff out;
  for (const KnownDive& dive : {square_dive(), trimix_dive(), wandering_dive()}) {
    out.dives.push_back(dive.name);
    for (const double step_s : kSteps_s) {
      const std::vector<Sample> samples = samples_of(dive, step_s);
      for (const TissueMethod method : kMethods)
        out.points.push_back(measure_deco(dive, samples, method, step_s, options.quick));
      options.step();
    }
  }
  return out;
}

std::vector<DecoPoint> worst_of(const DecoTradeoff& tradeoff) {
  std::vector<DecoPoint> worst;
  for (const DecoPoint& p : tradeoff.points) {
    const auto at = std::ranges::find_if(
        worst, [&](const DecoPoint& w) { return w.method == p.method && w.step_s == p.step_s; });
    if (at == worst.end()) {
      worst.push_back(p);
      worst.back().dive = "the worst";
      continue;
    }
    at->error_bar = std::max(at->error_bar, p.error_bar);
    at->ceiling_error_m = std::max(at->ceiling_error_m, p.ceiling_error_m);
    at->us_an_hour = std::max(at->us_an_hour, p.us_an_hour);
  }
  return worst;
}

DecoPoint knee(const DecoTradeoff& tradeoff) {
  const std::vector<DecoPoint> worst = worst_of(tradeoff);
  std::vector<DecoPoint> front;
  std::vector<double> cost, error;
  for (const DecoPoint& p : worst) {
    const bool beaten = std::ranges::any_of(worst, [&](const DecoPoint& other) {
      return other.us_an_hour <= p.us_an_hour && other.error_bar <= p.error_bar &&
             (other.us_an_hour < p.us_an_hour || other.error_bar < p.error_bar);
    });
    if (beaten || !std::isfinite(p.error_bar)) continue;
    front.push_back(p);
    cost.push_back(p.us_an_hour);
    error.push_back(p.error_bar);
  }
  return front[knee_of(cost, error)];
}

}  // namespace neritic::tools
