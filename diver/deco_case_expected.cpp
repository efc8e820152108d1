// The expected results of a case, and the dive before it (deco_case_parts.hpp).
#include <algorithm>
#include <charconv>
#include <cmath>

#include "diver/deco_case_parts.hpp"

namespace neritic::diver {
namespace {

bool has_key(const CaseField& object, std::string_view key) {
  const std::vector<std::string> keys = object.keys();
  return std::ranges::find(keys, key) != keys.end();
}

// reached: the member that holds the run time.
std::optional<ExpectedPoint> read_point(const CaseField& field, const char* reached) {
  if (!field.present()) return {};
  field.allow_with_texts({reached, "depth_m", "abs_pressure_bar", "tissues_n2_he_bar",
                          "ceiling_bar_gf_low", "ceiling_bar_gf_high", "ceiling_bar_gf_100",
                          "leading_compartment_gf_low", "leading_ceiling_bar", "ceiling_m_gf_low",
                          "ceiling_m_gf_high"});
  ExpectedPoint point;
  point.run_min = expected_number(field[reached]);
  point.depth_m = expected_number(field["depth_m"]);
  point.pressure_bar = expected_number(field["abs_pressure_bar"]);
  point.tissues = read_tissues(field["tissues_n2_he_bar"]);
  // At surfacing it is one number, the highest of all compartments.
  const CaseField high = field["ceiling_bar_gf_high"];
  if (high.is_number())
    point.deepest_high_bar = high.number(0.0);
  else
    point.high_bar = high.numbers(kCompartments);
  point.low_bar = field["ceiling_bar_gf_low"].numbers(kCompartments);
  point.full_bar = field["ceiling_bar_gf_100"].numbers(kCompartments);
  point.leading_low = expected_number(field["leading_compartment_gf_low"]);
  point.leading_bar = expected_number(field["leading_ceiling_bar"]);
  point.low_m = expected_number(field["ceiling_m_gf_low"]);
  point.high_m = expected_number(field["ceiling_m_gf_high"]);
  return point;
}

ExpectedNdl read_ndl(const CaseField& field) {
  field.allow_with_texts({"whole_minutes", "continuous"});
  ExpectedNdl ndl;
  ndl.given = has_key(field, "continuous");
  ndl.continuous_min = expected_number(field["continuous"]);
  ndl.whole_min = expected_number(field["whole_minutes"]);
  return ndl;
}

// The programs of second opinions, and the set of conventions nearest to each.
struct Program {
  std::string_view name, set;
};
constexpr Program kPrograms[] = {{"subsurface", "run-minutes"}, {"baker_gfdeco", "msw"}};

SecondOpinion read_opinion(const CaseField& field, const Program& program) {
  field.allow_with_texts({"stops", "total_stop_time_min", "total_runtime_min",
                          "runtime_leaving_last_stop_min", "start_of_deco_zone_m", "cns_percent",
                          "otu", "end_of_bottom_tissues_n2_he_bar"});
  SecondOpinion opinion;
  opinion.program = program.name;
  opinion.set = program.set;
  opinion.stop_min = expected_number(field["total_stop_time_min"]);
  opinion.leave_last_min = expected_number(field["runtime_leaving_last_stop_min"]);
  opinion.run_min = expected_number(field["total_runtime_min"]);
  opinion.zone_m = expected_number(field["start_of_deco_zone_m"]);
  opinion.cns_percent = expected_number(field["cns_percent"]);
  opinion.otu = expected_number(field["otu"]);
  opinion.tissues = read_tissues(field["end_of_bottom_tissues_n2_he_bar"]);
  // A program that gives no sum gives stops whose minutes include the ways between them.
  const auto rows = read_stop_rows(field["stops"]);
  if (!opinion.stop_min && rows && !rows->empty()) {
    opinion.stops_and_ways_min = 0.0;
    for (const ExpectedStop& stop : *rows) *opinion.stops_and_ways_min += stop.minutes;
  }
  opinion.band_min =
      std::max(3.0, 0.15 * opinion.stop_min.value_or(opinion.stops_and_ways_min.value_or(0.0)));
  return opinion;
}

// The gas of "NAME O2/HE (N2 SHARE), surface pressure, Schreiner with R=0": three ways to say one
// gas, which must agree, and how it loads the tissues, which is always so. Nothing: another text.
std::optional<GasMix> read_surface_gas(std::string_view text) {
  constexpr std::string_view kNitrogen = " (N2 ", kHow = "), surface pressure, Schreiner with R=0";
  constexpr double kSame = 1e-9;
  const std::size_t nitrogen = text.find(kNitrogen), gap = text.substr(0, nitrogen).rfind(' ');
  if (nitrogen == text.npos || gap == text.npos || !text.ends_with(kHow)) return std::nullopt;
  const auto named = parse_mix(text.substr(0, gap));
  const std::string_view percent = text.substr(gap + 1, nitrogen - gap - 1);
  const auto mix = parse_mix(percent);
  if (!named.ok() || !mix.ok() || percent.find('/') == percent.npos) return std::nullopt;
  text.remove_suffix(kHow.size());
  text.remove_prefix(std::min(text.size(), nitrogen + kNitrogen.size()));
  double share = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), share);
  if (read.ec != std::errc{} || read.ptr != text.data() + text.size()) return std::nullopt;
  const bool agree = std::abs(named->oxygen - mix->oxygen) < kSame &&
                     std::abs(named->helium - mix->helium) < kSame &&
                     std::abs(share - (1.0 - mix->oxygen - mix->helium)) < kSame;
  return agree ? std::optional(*mix) : std::nullopt;
}

}  // namespace

DecoExpected read_expected(const CaseField& profile) {
  DecoExpected expected;
  const CaseField reference = profile["reference"];
  reference.allow_with_texts({"end_of_bottom", "first_stop", "surfacing", "stops", "no_deco",
                              "total_stop_time_min", "time_to_surface_min", "total_runtime_min",
                              "ndl_bottom_gas_runtime_min"});
  expected.end_of_bottom = read_point(reference["end_of_bottom"], "runtime_min");
  expected.first_stop = read_point(reference["first_stop"], "arrival_runtime_min");
  expected.surfacing = read_point(reference["surfacing"], "runtime_min");
  expected.stops = read_stops(reference["stops"]);
  if (reference["no_deco"].present()) expected.no_stops = reference["no_deco"].boolean(false);
  expected.stop_min = expected_number(reference["total_stop_time_min"]);
  expected.ascent_min = expected_number(reference["time_to_surface_min"]);
  expected.run_min = expected_number(reference["total_runtime_min"]);
  expected.ndl = read_ndl(reference["ndl_bottom_gas_runtime_min"]);
  const CaseField oxygen = profile["oxygen_exposure"];
  oxygen.allow_with_texts({"cns_percent", "otu", "max_po2_bar"});
  expected.cns_percent = expected_number(oxygen["cns_percent"]);
  expected.otu = expected_number(oxygen["otu"]);
  expected.max_po2_bar = expected_number(oxygen["max_po2_bar"]);
  const CaseField opinions = profile["second_opinions"];
  opinions.allow_with_texts({kPrograms[0].name, kPrograms[1].name});
  for (const Program& program : kPrograms)
    if (const CaseField field = opinions[program.name]; field.present())
      expected.opinions.push_back(read_opinion(field, program));
  return expected;
}

std::optional<EarlierCase> read_earlier(const CaseField& repetitive, const DivePlanRequest& base) {
  if (!repetitive.present()) return std::nullopt;
  repetitive.allow_with_texts({"first_dive", "first_dive_stops", "first_dive_runtime_min",
                               "tissues_at_surfacing", "surface_interval_min",
                               "surface_interval_gas", "tissues_after_interval"});
  const CaseField dive = repetitive.required("first_dive");
  dive.allow_with_texts({"depth_m", "bottom_runtime_min", "gases"});
  EarlierCase out;
  DivePlanRequest& request = out.earlier.dive;
  request = base;
  request.start.reset();
  request.levels = {read_level(dive, "bottom_runtime_min")};
  if (dive["gases"].present()) request.gases = read_gases(dive["gases"]);
  out.earlier.surface_min = repetitive.required("surface_interval_min").number(0.0, 0.0, 1e9);
  if (const CaseField gas = repetitive["surface_interval_gas"]; gas.present()) {
    const auto mix = read_surface_gas(gas.text());
    if (mix)
      out.earlier.surface_gas = *mix;
    else
      gas.refuse(
          "\"NAME O2/HE (N2 SHARE), surface pressure, Schreiner with R=0\" of one gas, such as "
          "\"air 21/0 (N2 0.79), ...\"");
  }
  out.stops = read_stop_rows(repetitive["first_dive_stops"]);
  out.run_min = expected_number(repetitive["first_dive_runtime_min"]);
  out.surfacing = read_tissues(repetitive["tissues_at_surfacing"]);
  out.after_interval = read_tissues(repetitive["tissues_after_interval"]);
  if (out.stops && !out.stops->empty())
    request.last_stop_always = out.stops->front().depth_m >= request.conventions.last_stop_m;
  return out;
}

}  // namespace neritic::diver
