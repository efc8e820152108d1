// Parameters, gases, levels (deco_case_parts.hpp).
#include "diver/deco_case_parts.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"

namespace neritic::diver {

Expected expected_number(const CaseField& field) {
  return field.present() ? Expected(field.number(0.0)) : Expected();
}

std::optional<TissueState> read_tissues(const CaseField& field) {
  const auto rows = field.rows(kCompartments, 2);
  if (rows.size() != kCompartments) return {};
  TissueState tissues;
  for (std::size_t i = 0; i < kCompartments; ++i) {
    tissues.n2_bar[i] = rows[i][0];
    tissues.he_bar[i] = rows[i][1];
    if (rows[i][0] < 0.0 || rows[i][1] < 0.0 || rows[i][0] > 1e3 || rows[i][1] > 1e3) {
      field.at(i).refuse("two pressures of 0 to 1000 bar");
      return {};
    }
  }
  return tissues;
}

void read_model(const CaseField& model, DecoConventions& conventions) {
  const std::string name = model.text();
  const bool c = name == "ZH-L16C-GF";
  if (!c && name != "ZH-L16B-GF") model.refuse("\"ZH-L16B-GF\" or \"ZH-L16C-GF\"");
  conventions.table = c ? BuehlmannTable::kC : BuehlmannTable::kB;
  conventions.first_compartment = c ? FirstCompartment::k4Min : FirstCompartment::k5Min;
}

void read_parameters(const CaseField& parameters, DivePlanRequest& request) {
  DecoConventions& c = request.conventions;
  const auto take = [&](const char* key, double& value) { value = parameters[key].number(value); };
  take("gf_low", request.gf_low);
  take("gf_high", request.gf_high);
  if (parameters["altitude_m"].present())
    c.environment.surface_bar =
        surface_bar_at(parameters["altitude_m"].number(0.0, -500.0, 11000.0));
  take("surface_pressure_bar", c.environment.surface_bar);
  if (parameters["water_density_kg_m3"].present())
    c.environment.bar_per_m =
        bar_per_m_of(parameters["water_density_kg_m3"].number(1000.0, 500.0, 2000.0),
                     parameters["gravity_m_s2"].number(kStandardGravity_m_s2, 1.0, 30.0));
  take("bar_per_metre", c.environment.bar_per_m);
  take("water_vapour_pressure_bar", c.water_vapour_bar);
  take("start_n2_fraction", c.start_n2);
  take("descent_rate_m_min", c.descent_m_min);
  take("ascent_rate_m_min", c.ascent_m_min);
  const bool last_follows = c.last_stop_m == c.stop_step_m;
  take("stop_step_m", c.stop_step_m);
  if (last_follows) c.last_stop_m = c.stop_step_m;
  take("last_stop_m", c.last_stop_m);
  take("stop_quantum_min", c.stop_quantum_min);
}

std::vector<PlanGas> read_gases(const CaseField& gases) {
  std::vector<PlanGas> out;
  for (std::size_t i = 0; i < gases.size(); ++i) {
    const CaseField field = gases.at(i);
    field.allow_with_texts({"o2", "he", "n2", "switch_depth_m", "role"});
    PlanGas gas;
    const double o2 = field.required("o2").number(21.0, 1.0, 100.0);
    const double he = field["he"].number(0.0, 0.0, 99.0);
    if (o2 + he > 100.0)
      field.fail(found_accepted(fmt::format("{} % of oxygen and {} % of helium", o2, he),
                                "at most 100 % in all"));
    const double n2 = field["n2"].number(100.0 - o2 - he);
    if (std::abs(n2 + o2 + he - 100.0) > 0.01) field["n2"].refuse("what is left of 100");
    gas.mix = mix_of_percent(o2, he);
    gas.switch_depth_m = field["switch_depth_m"].number(0.0, 0.0, 2000.0);
    const std::string role = field["role"].text(i == 0 ? "bottom" : "deco");
    if (role == "travel")
      gas.role = GasRole::kTravel;
    else if (role == "deco")
      gas.role = GasRole::kDeco;
    else if (role != "bottom")
      field["role"].refuse("travel, bottom or deco");
    out.push_back(gas);
  }
  return out;
}

PlanLevel read_level(const CaseField& field, const char* leave) {
  return {field.required("depth_m").number(1.0, 0.01, 2000.0),
          field.required(leave).number(0.0, 0.0, 1e6)};
}

std::vector<PlanLevel> read_levels(const CaseField& profile) {
  profile.allow_with_texts({"kind", "depth_m", "bottom_runtime_min", "levels"});
  const std::string kind = profile.required("kind").text();
  if (kind == "square") return {read_level(profile, "bottom_runtime_min")};
  if (kind != "multilevel") profile["kind"].refuse("square or multilevel");
  std::vector<PlanLevel> out;
  const CaseField levels = profile.required("levels");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels.at(i).allow_with_texts({"depth_m", "leave_runtime_min"});
    out.push_back(read_level(levels.at(i), "leave_runtime_min"));
  }
  if (out.empty()) levels.refuse("a list of at least one level");
  return out;
}

std::optional<std::vector<ExpectedStop>> read_stops(const CaseField& list) {
  if (!list.present()) return {};
  std::vector<ExpectedStop> stops;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CaseField field = list.at(i);
    field.allow_with_texts({"depth_m", "minutes", "o2", "he", "gf_next"});
    ExpectedStop stop;
    stop.depth_m = field.required("depth_m").number(0.0, 0.0, 2000.0);
    stop.minutes = field.required("minutes").number(0.0, 0.0, 1e6);
    stop.gf_next = expected_number(field["gf_next"]);
    if (field["o2"].present())
      stop.mix = mix_of_percent(field["o2"].number(21.0), field["he"].number(0.0));
    stops.push_back(stop);
  }
  return stops;
}

std::optional<std::vector<ExpectedStop>> read_stop_rows(const CaseField& list) {
  if (!list.present()) return {};
  std::vector<ExpectedStop> stops;
  for (const std::vector<double>& row : list.rows(0, 2)) stops.push_back({row[0], row[1], {}, {}});
  return stops;
}

}  // namespace neritic::diver
