// The cost of decompression: a plan, a computer's view, and the tissues of many divers at once.
#include <vector>

#include "diver/deco_live.hpp"
#include "diver/dive_plan.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

constexpr int kPlans = 100;
constexpr std::size_t kDivers = 10000;
constexpr double kAdvance_s = 1.0;  // of the divers' dive a round

diver::DivePlanRequest trimix_request() {
  diver::DivePlanRequest request;
  request.gf_high = 0.8;
  request.gases = {{{0.18, 0.45}, 0.0, diver::GasRole::kBottom},
                   {{0.5, 0.0}, 21.0, diver::GasRole::kDeco},
                   {{1.0, 0.0}, 6.0, diver::GasRole::kDeco}};
  request.levels = {{60.0, 25.0}};
  return request;
}

// One plan's time, the mean of many.
Contender plans() {
  return {"deco/plan_trimix_three_gases", []() -> Result<Sample> {
            const diver::DivePlanRequest request = trimix_request();
            Hash64 hash;
            const TimeNs start = now_ns();
            for (int i = 0; i < kPlans; ++i) {
              NERITIC_TRY(const diver::DivePlan plan, diver::plan_dive(request));
              hash.add(plan.surfacing.tissues);
            }
            return Sample{to_ms(now_ns() - start) / kPlans, {}, hash.hex()};
          }};
}

// All divers hang at depths of their own; a round moves each by a second.
Contender tissues_of_many() {
  return {"deco/tissues_10000_divers", []() -> Result<Sample> {
            const diver::DivePlanRequest request = trimix_request();
            const diver::Buehlmann model = request.conventions.model();
            const diver::DecoEnvironment& where = request.conventions.environment;
            const diver::StepFactors factors = diver::step_factors(model, kAdvance_s / 60.0);
            std::vector<diver::TissueState> divers(
                kDivers, diver::saturated(model, where.surface_bar, 0.79));
            const TimeNs start = now_ns();
            for (std::size_t i = 0; i < kDivers; ++i) {
              const double p = where.pressure_bar(60.0 * static_cast<double>(i) / kDivers);
              divers[i] = diver::load(model, factors, divers[i], p, p + 0.01, request.gases[0].mix);
            }
            const double ms = to_ms(now_ns() - start);
            Hash64 hash;
            hash.add_span(std::span<const diver::TissueState>(divers));
            return Sample{ms, {}, hash.hex()};
          }};
}

// The same with all that a dive computer keeps: oxygen, ascent rate, the first stop.
Contender computers_of_many() {
  return {
      "deco/computers_10000_divers", []() -> Result<Sample> {
        const diver::DivePlanRequest request = trimix_request();
        NERITIC_TRY(const diver::DiveComputer computer,
                    diver::DiveComputer::create(
                        {request.conventions, request.gf_low, request.gf_high, request.gases, {}}));
        std::vector<diver::DiveComputerState> divers(kDivers, computer.start());
        const TimeNs start = now_ns();
        for (std::size_t i = 0; i < kDivers; ++i)
          divers[i] =
              computer.step(divers[i], {60.0 * static_cast<double>(i) / kDivers, 0}, kAdvance_s);
        const double ms = to_ms(now_ns() - start);
        Hash64 hash;
        for (const diver::DiveComputerState& diver : divers) hash.add(diver);
        return Sample{ms, {}, hash.hex()};
      }};
}

// The numbers that one computer shows at the end of the bottom: time without stops, next stop,
// whole ascent.
Contender one_view() {
  return {"deco/view", []() -> Result<Sample> {
            const diver::DivePlanRequest request = trimix_request();
            NERITIC_TRY(
                const diver::DiveComputer computer,
                diver::DiveComputer::create(
                    {request.conventions, request.gf_low, request.gf_high, request.gases, {}}));
            diver::DiveComputerState state = computer.step(computer.start(), {60.0, 0}, 180.0);
            state = computer.step(state, {60.0, 0}, 1320.0);
            Hash64 hash;
            const TimeNs start = now_ns();
            for (int i = 0; i < kPlans; ++i) hash.add(computer.view(state).to_surface_min);
            return Sample{to_ms(now_ns() - start) / kPlans, {}, hash.hex()};
          }};
}

}  // namespace

Status bench_deco(Suite& suite) {
  if (!suite.wants("deco")) return {};
  NERITIC_TRY_STATUS(suite.measure({plans(), one_view(), tissues_of_many(), computers_of_many()}));
  suite.aim_ms("a plan on trimix with three gases", "deco/plan_trimix_three_gases", 1.0);
  suite.aim_ms("tissues of 10 000 divers, a second", "deco/tissues_10000_divers", 1000.0);
  suite.aim_ms("computers of 10 000 divers, a second", "deco/computers_10000_divers", 1000.0);
  return {};
}

}  // namespace neritic::bench
