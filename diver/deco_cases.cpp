#include "diver/deco_cases.hpp"

#include <algorithm>
#include <set>

#include "diver/deco_case_parts.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::diver {
namespace {

constexpr std::size_t kMostCases = 100000;

constexpr std::string_view kColumns[] = {"from_m",     "to_m",       "minutes",
                                         "o2_percent", "he_percent", "phase"};

std::vector<ReplayedSegment> read_segments(const CaseField& field) {
  if (!field.present()) return {};
  field.allow_with_texts({"columns", "rows"});
  const CaseField columns = field.required("columns"), rows = field.required("rows");
  bool same = columns.size() == std::size(kColumns);
  for (std::size_t i = 0; same && i < columns.size(); ++i)
    same = columns.at(i).text() == kColumns[i];
  if (!same) columns.refuse(join(kColumns));
  std::vector<ReplayedSegment> out;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const CaseField row = rows.at(r);
    if (row.size() != std::size(kColumns))
      row.refuse(fmt::format("a row of {}", std::size(kColumns)));
    const double o2 = row.at(3).number(21.0, 1.0, 100.0);
    const double he = row.at(4).number(0.0, 0.0, 100.0 - o2);
    out.push_back({row.at(0).number(0.0, -1.0, 2000.0), row.at(1).number(0.0, -1.0, 2000.0),
                   row.at(2).number(0.0, 0.0, 1e6), mix_of_percent(o2, he)});
  }
  return out;
}

// Records what is wrong with a request.
void check_read(const CaseField& field, const DivePlanRequest& request) {
  const Status status = check_request(request);
  if (!status.ok()) field.fail(status.error().message);
}

DecoCase read_case(const CaseField& profile, std::string id) {
  profile.allow_with_texts({"id", "model", "parameters", "gases", "profile", "initial_tissues",
                            "repetitive", "segments", "reference", "oxygen_exposure",
                            "second_opinions"});
  DecoCase one;
  one.id = std::move(id);
  DivePlanRequest& request = one.request;
  read_model(profile.required("model"), request.conventions);
  const CaseField parameters = profile.required("parameters");
  parameters.allow_with_texts({"gf_low", "gf_high", "altitude_m", "surface_pressure_bar",
                               "bar_per_metre", "water_density_kg_m3", "gravity_m_s2",
                               "water_vapour_pressure_bar", "start_n2_fraction",
                               "descent_rate_m_min", "ascent_rate_m_min", "stop_step_m",
                               "stop_quantum_min", "last_stop_m"});
  parameters.required("gf_low");
  parameters.required("gf_high");
  read_parameters(parameters, request);
  request.gases = read_gases(profile.required("gases"));
  one.earlier = read_earlier(profile["repetitive"], request);
  request.levels = read_levels(profile.required("profile"));
  request.start = read_tissues(profile["initial_tissues"]);
  one.segments = read_segments(profile["segments"]);
  one.expected = read_expected(profile);
  if (one.expected.stops && !one.expected.stops->empty())
    request.last_stop_always =
        one.expected.stops->front().depth_m >= request.conventions.last_stop_m;
  else if (one.expected.first_stop && one.expected.first_stop->depth_m)
    request.last_stop_always =
        *one.expected.first_stop->depth_m >= request.conventions.last_stop_m - 1e-6;
  check_read(profile, request);
  if (one.earlier) check_read(profile["repetitive"], one.earlier->earlier.dive);
  return one;
}

NdlTable read_table(const CaseField& table, std::string id) {
  table.allow_with_texts({"model", "gf_low", "gf_high", "o2", "surface_pressure_bar",
                          "bar_per_metre", "descent_rate_m_min", "ascent_rate_m_min", "rows"});
  NdlTable out;
  out.id = std::move(id);
  DivePlanRequest& request = out.request;
  read_model(table.required("model"), request.conventions);
  request.gf_low = table["gf_high"].number(request.gf_high, 0.01, 1.5);
  read_parameters(table, request);
  request.gases = {PlanGas{mix_of_percent(table.required("o2").number(21.0, 1.0, 100.0), 0.0), 0.0,
                           GasRole::kBottom}};
  const CaseField rows = table.required("rows");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const CaseField row = rows.at(i);
    row.allow_with_texts({"depth_m", "decotengu_runtime_whole_min", "decotengu_runtime_min",
                          "closed_form_time_at_depth_min", "controlling_compartment"});
    NdlRow one;
    one.depth_m = row.required("depth_m").number(1.0, 0.01, 2000.0);
    one.run_min = expected_number(row["decotengu_runtime_min"]);
    one.whole_min = expected_number(row["decotengu_runtime_whole_min"]);
    one.closed_min = expected_number(row["closed_form_time_at_depth_min"]);
    one.compartment = expected_number(row["controlling_compartment"]);
    const std::vector<std::string> keys = row.keys();
    const auto is_null = [&](const char* key) {
      return std::ranges::find(keys, key) != keys.end() && !row[key].present();
    };
    one.no_run_limit = is_null("decotengu_runtime_min");
    one.no_closed_limit = is_null("closed_form_time_at_depth_min");
    out.rows.push_back(one);
  }
  request.levels = {{out.rows.empty() ? 10.0 : out.rows[0].depth_m, 1e6}};
  check_read(table, request);
  return out;
}

}  // namespace

Result<DecoCases> read_deco_cases(std::string_view text, std::string name) {
  NERITIC_TRY(CaseFile file, CaseFile::parse(text, std::move(name)));
  const CaseField root = file.root();
  root.allow_with_texts(
      {"units", "tolerances", "conventions_of_reference", "profiles", "ndl_tables"});
  root["tolerances"].allow_with_texts({"tissues_bar", "ndl_continuous_min"});
  DecoCases out;
  out.tissues_bar = root["tolerances"]["tissues_bar"].number(out.tissues_bar, 0.0, 1.0);
  out.ndl_min = root["tolerances"]["ndl_continuous_min"].number(out.ndl_min, 0.0, 10.0);
  const CaseField profiles = root["profiles"], tables = root["ndl_tables"];
  if (profiles.size() + tables.size() == 0 && !file.failed())
    profiles.fail(found_accepted("no case", "a list of dives here, or of tables in ndl_tables"));
  if (profiles.size() + tables.size() > kMostCases)
    profiles.fail(found_accepted(fmt::format("{} cases", profiles.size() + tables.size()),
                                 fmt::format("at most {}", kMostCases)));
  std::set<std::string> ids;
  for (std::size_t i = 0; i < profiles.size() && !file.failed(); ++i) {
    const CaseField profile = profiles.at(i);
    std::string id = profile.required("id").text();
    if (!ids.insert(id).second)
      profile["id"].fail(
          found_accepted(fmt::format("'{}' a second time", id), "a name of its own"));
    file.enter_case(id);
    out.dives.push_back(read_case(profile, std::move(id)));
  }
  for (std::size_t i = 0; i < tables.size() && !file.failed(); ++i) {
    const CaseField table = tables.at(i);
    file.enter_case("");
    const double high = table.required("gf_high").number(0.85, 0.01, 1.5);
    std::string id = fmt::format("ndl_{}_gf{:.0f}_o2_{:g}", table["model"].text(), 100.0 * high,
                                 table["o2"].number(21.0));
    out.tables.push_back(read_table(table, std::move(id)));
  }
  if (file.failed()) return file.error();
  return out;
}

}  // namespace neritic::diver
