#include "diver/deco_ndl.hpp"

#include <cmath>

namespace neritic::diver {
namespace {

class Sojourn {
 public:
  Sojourn(const AscentSettings& settings, const TissueState& tissues, double depth_m,
          const GasMix& gas)
      : settings_(settings), tissues_(tissues), depth_m_(depth_m), gas_(gas) {}

  bool needs_stops_after(double minutes) const {
    const DecoEnvironment& where = settings_.conventions.environment;
    const double p = where.pressure_bar(depth_m_);
    const TissueState stayed = load(settings_.model, tissues_, p, p, minutes, gas_);
    const TissueState up = after_direct_ascent(settings_, stayed, depth_m_, gas_);
    return ceiling(settings_.model, up, settings_.gf_high).pressure_bar > where.surface_bar;
  }

 private:
  const AscentSettings& settings_;
  const TissueState& tissues_;
  double depth_m_;
  const GasMix& gas_;
};

}  // namespace

double minutes_without_stops(const AscentSettings& settings, const TissueState& tissues,
                             double depth_m, const GasMix& gas) {
  const Sojourn sojourn(settings, tissues, depth_m, gas);
  if (sojourn.needs_stops_after(0.0)) return -1.0;
  // Doubling first: tissues that still give off gas from before may need stops for a while in
  // between, and the first limit is the one that counts.
  double safe = 0.0, not_safe = 1.0;
  while (!sojourn.needs_stops_after(not_safe)) {
    safe = not_safe;
    not_safe *= 2.0;
    if (safe >= kNoLimit_min) return kNoLimit_min;
  }
  while (not_safe - safe > 1e-9 * not_safe) {
    const double middle = 0.5 * (safe + not_safe);
    (sojourn.needs_stops_after(middle) ? not_safe : safe) = middle;
  }
  return safe;
}

Result<std::optional<double>> run_time_without_stops(const DivePlanRequest& request) {
  DivePlanRequest down = request;
  if (!down.levels.empty()) {
    down.levels.resize(1);
    down.levels[0].leave_min = down.levels[0].depth_m / request.conventions.descent_m_min;
  }
  NERITIC_TRY(const PlanPoint reached, end_of_levels(down));
  const AscentSettings settings =
      ascent_settings(request.conventions, request.gf_low, request.gf_high, request.gases);
  std::size_t bottom = 0;
  for (std::size_t i = 0; i < request.gases.size(); ++i)
    if (request.gases[i].role == GasRole::kBottom) bottom = i;
  const double more =
      minutes_without_stops(settings, reached.tissues, reached.depth_m, request.gases[bottom].mix);
  if (more < 0.0) return std::optional<double>();
  return std::optional<double>(reached.run_min + more);
}

ClosedNdl closed_form_ndl(const Buehlmann& model, const DecoEnvironment& where, double start_n2,
                          double depth_m, const GasMix& gas, double gf) {
  const double start = start_n2 * (where.surface_bar - model.water_vapour_bar);
  const double lungs = gas.nitrogen() * (where.pressure_bar(depth_m) - model.water_vapour_bar);
  ClosedNdl least;
  for (std::size_t i = 0; i < kCompartments; ++i) {
    const double most =
        where.surface_bar * (gf / model.n2.b[i] + 1.0 - gf) + model.n2.a_bar[i] * gf;
    if (lungs <= most) continue;
    const double minutes = -std::log((lungs - most) / (lungs - start)) / model.n2.rate_min[i];
    if (minutes < least.minutes) least = {minutes, i};
  }
  return least;
}

}  // namespace neritic::diver
