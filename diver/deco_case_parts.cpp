// Parameters, gases, levels (deco_case_parts.hpp).
#include "diver/deco_case_parts.hpp"

#include <algorithm>
#include <cmath>

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
      field.at(i).refuse("two pressures of 0 to 1000 bar are");
      return {};
    }
  }
  return tissues;
}

void read_model(const CaseField& model, const CaseField& table, DecoConventions& conventions) {
  const std::string name = model.text();
  const bool b = name.find("16B") != name.npos, c = name.find("16C") != name.npos;
  if (b == c) model.refuse("a text with 16B or 16C is");
  conventions.table = c ? BuehlmannTable::kC : BuehlmannTable::kB;
  // "compartment 1b" or "compartment 1 ", and not "compartment 12".
  const std::string words = table.text() + " ";
  const std::string about = "compartment 1";
  const std::size_t at = words.find(about);
  const char next = at == words.npos ? '?' : words[at + about.size()];
  const bool slow = next == 'b', quick = next == ' ' || next == ',' || next == ':' || next == '=';
  conventions.first_compartment =
      slow || (b && !quick) ? FirstCompartment::k5Min : FirstCompartment::k4Min;
}

void read_parameters(const CaseField& parameters, DivePlanRequest& request) {
  constexpr std::string_view kNames[] = {
      "gf_low",       "gf_high",           "altitude_m",        "surface_pressure_bar",
      "gravity_m_s2", "bar_per_metre",     "stop_step_m",       "water_density_kg_m3",
      "last_stop_m",  "stop_quantum_min",  "saturation",        "water_vapour_pressure_bar",
      "desaturation", "start_n2_fraction", "ascent_rate_m_min", "descent_rate_m_min"};
  parameters.refuse_misspelt(kNames);
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
  take("saturation", c.saturation);
  take("desaturation", c.desaturation);
}

std::vector<PlanGas> read_gases(const CaseField& gases) {
  std::vector<PlanGas> out;
  for (std::size_t i = 0; i < gases.size(); ++i) {
    const CaseField field = gases.at(i);
    PlanGas gas;
    const double o2 = field.required("o2").number(21.0, 1.0, 100.0);
    const double he = field["he"].number(0.0, 0.0, 99.0);
    if (o2 + he > 100.0)
      field.fail(
          fmt::format("{} % of oxygen and {} of helium found, 100 in all "
                      "are accepted",
                      o2, he));
    const double n2 = field["n2"].number(100.0 - o2 - he);
    if (std::abs(n2 + o2 + he - 100.0) > 0.01) field["n2"].refuse("what is left of 100 is");
    gas.mix = mix_of_percent(o2, he);
    gas.switch_depth_m = field["switch_depth_m"].number(0.0, 0.0, 2000.0);
    const std::string role = field["role"].text(i == 0 ? "bottom" : "deco");
    if (role == "travel")
      gas.role = GasRole::kTravel;
    else if (role == "deco")
      gas.role = GasRole::kDeco;
    else if (role != "bottom")
      field["role"].refuse("travel, bottom or deco is");
    out.push_back(gas);
  }
  return out;
}

GasMix read_surface_gas(const CaseField& field) {
  const std::string text = field.text("air");
  // The first word that is a gas and no bare number.
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" (),;", at), text.size());
    const std::string_view word = std::string_view(text).substr(at, end - at);
    const bool is_count = word.find_first_not_of("0123456789.") == word.npos;
    const auto mix = parse_mix(word);
    if (mix.ok() && !is_count) return *mix;
    at = end + 1;
  }
  field.refuse("a text with air, O2, EAN32 or O2/He is");
  return kAir;
}

std::vector<PlanLevel> read_levels(const CaseField& profile) {
  const CaseField levels = profile["levels"];
  const std::string kind = profile["kind"].text(levels.present() ? "multilevel" : "square");
  if (kind == "square") {
    const double depth = profile.required("depth_m").number(1.0, 0.01, 2000.0);
    return {{depth, profile.required("bottom_runtime_min").number(0.0, 0.0, 1e6)}};
  }
  std::vector<PlanLevel> out;
  if (kind != "multilevel") profile["kind"].refuse("square or multilevel is");
  for (std::size_t i = 0; i < levels.size(); ++i)
    out.push_back({levels.at(i).required("depth_m").number(1.0, 0.01, 2000.0),
                   levels.at(i).required("leave_runtime_min").number(0.0, 0.0, 1e6)});
  if (out.empty()) profile["levels"].refuse("a list of at least one level is");
  return out;
}

std::optional<std::vector<ExpectedStop>> read_stops(const CaseField& list) {
  if (!list.present()) return {};
  std::vector<ExpectedStop> stops;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CaseField field = list.at(i);
    ExpectedStop stop;
    if (field.is_array()) {
      const std::vector<double> row = field.numbers(2);
      if (row.empty()) return {};
      stop.depth_m = row[0];
      stop.minutes = row[1];
    } else {
      stop.depth_m = field.required("depth_m").number(0.0, 0.0, 2000.0);
      stop.minutes = field.required("minutes").number(0.0, 0.0, 1e6);
      stop.gf_next = expected_number(field["gf_next"]);
      if (field["o2"].present())
        stop.mix = mix_of_percent(field["o2"].number(21.0), field["he"].number(0.0));
    }
    stops.push_back(stop);
  }
  return stops;
}

}  // namespace neritic::diver
