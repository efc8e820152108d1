// What a case expects, and the dives before it (deco_case_parts.hpp).
#include <algorithm>
#include <array>

#include "diver/deco_case_parts.hpp"

namespace neritic::diver {
namespace {

bool has_key(const CaseField& object, std::string_view key) {
  const std::vector<std::string> keys = object.keys();
  return std::ranges::find(keys, key) != keys.end();
}

std::optional<ExpectedPoint> read_point(const CaseField& field) {
  if (!field.present()) return {};
  ExpectedPoint point;
  point.run_min = expected_number(field["runtime_min"]);
  if (!point.run_min) point.run_min = expected_number(field["arrival_runtime_min"]);
  point.depth_m = expected_number(field["depth_m"]);
  point.pressure_bar = expected_number(field["abs_pressure_bar"]);
  point.tissues = read_tissues(field["tissues_n2_he_bar"]);
  // At surfacing there is one number, of all compartments.
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
  ExpectedNdl ndl;
  ndl.given = has_key(field, "continuous");
  ndl.continuous_min = expected_number(field["continuous"]);
  ndl.whole_min = expected_number(field["whole_minutes"]);
  return ndl;
}

// The set of conventions that is nearest to a program's.
std::string set_of(const std::string& program, const std::string& conventions) {
  if (program == "subsurface") return "run-minutes";
  if (program == "baker_gfdeco") return "msw";
  for (const NamedConventions& set : convention_sets())
    if (conventions.find(set.name) != conventions.npos) return std::string(set.name);
  return {};
}

// The column of ZH-L16 that a text names: a word that is B or C, or ends so as 16C does.
std::optional<BuehlmannTable> table_of(const std::string& text) {
  const auto is_word = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  };
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool last = at + 1 == text.size() || !is_word(text[at + 1]);
    const bool first = at == 0 || !is_word(text[at - 1]) || (at >= 2 && text[at - 1] == '6');
    if (!first || !last || (text[at] != 'B' && text[at] != 'C')) continue;
    return text[at] == 'B' ? BuehlmannTable::kB : BuehlmannTable::kC;
  }
  return {};
}

SecondOpinion read_opinion(const CaseField& field, const std::string& program) {
  SecondOpinion opinion;
  opinion.program = program;
  const auto words = [&](const char* key) {
    return field[key].is_text() ? field[key].text() : std::string();
  };
  opinion.set = set_of(program, words("conventions"));
  opinion.table = table_of(words("table"));
  opinion.stop_min = expected_number(field["total_stop_time_min"]);
  opinion.leave_last_min = expected_number(field["runtime_leaving_last_stop_min"]);
  opinion.run_min = expected_number(field["total_runtime_min"]);
  opinion.zone_m = expected_number(field["start_of_deco_zone_m"]);
  opinion.cns_percent = expected_number(field["cns_percent"]);
  opinion.otu = expected_number(field["otu"]);
  opinion.tissues = read_tissues(field["end_of_bottom_tissues_n2_he_bar"]);
  // A program that gives no sum gives stops whose minutes include the ways between them.
  const auto rows = read_stops(field["stops"]);
  if (!opinion.stop_min && rows && !rows->empty()) {
    opinion.stops_and_ways_min = 0.0;
    for (const ExpectedStop& stop : *rows) *opinion.stops_and_ways_min += stop.minutes;
  }
  opinion.band_min =
      std::max(3.0, 0.15 * opinion.stop_min.value_or(opinion.stops_and_ways_min.value_or(0.0)));
  return opinion;
}

// One dive before. told: where what is expected of it is said, each name after this prefix.
EarlierCase read_earlier_dive(const CaseField& dive, const CaseField& told,
                              const std::string& prefix, const DivePlanRequest& base) {
  EarlierCase one;
  DivePlanRequest& request = one.earlier.dive;
  request = base;
  request.start.reset();
  read_parameters(dive["parameters"], request);
  request.levels = read_levels(dive["profile"].present() ? dive["profile"] : dive);
  if (dive["gases"].present()) request.gases = read_gases(dive["gases"]);
  one.stops = read_stops(told[prefix + "stops"]);
  one.run_min = expected_number(told[prefix + "runtime_min"]);
  if (one.stops && !one.stops->empty())
    request.last_stop_always = one.stops->front().depth_m >= request.conventions.last_stop_m;
  return one;
}

// The i-th of a list, or the one thing that is no list.
CaseField one_of(const CaseField& field, std::size_t i) {
  return field.is_array() ? field.at(i) : field;
}

// Minutes at the surface after the i-th dive: said in its entry, or around it.
double read_interval(const CaseField& entry, const CaseField& around, std::size_t i) {
  const CaseField own = entry["surface_interval_min"];
  const CaseField interval =
      own.present() ? own : one_of(around.required("surface_interval_min"), i);
  if (!interval.present()) interval.refuse("minutes at the surface are");
  return interval.number(0.0, 0.0, 1e9);
}

// What was dived before an earlier dive.
void add_before(const CaseField& repetitive, const DivePlanRequest& base,
                std::vector<EarlierCase>& out) {
  const std::vector<EarlierCase> before = read_earlier(repetitive, base);
  out.insert(out.end(), before.begin(), before.end());
}

constexpr std::array<const char*, 6> kOrdinals{"first_",  "second_", "third_",
                                               "fourth_", "fifth_",  "sixth_"};

// A dive under a name that is nearly an ordinal's, or after one that is not there, would not count.
void refuse_misspelt_dives(const CaseField& field) {
  std::vector<std::string> names;
  for (const char* ordinal : kOrdinals) names.push_back(std::string(ordinal) + "dive");
  const std::size_t dives = static_cast<std::size_t>(
      std::ranges::find_if(names, [&](const std::string& n) { return !field[n].present(); }) -
      names.begin());
  for (const std::string& key : field.keys()) {
    const CaseField member = field[key];
    const bool is_dive =
        member.is_object() &&
        (member["depth_m"].present() || member["levels"].present() || member["profile"].present());
    const auto known = std::ranges::find(names, key);
    if (is_dive && known - names.begin() >= static_cast<std::ptrdiff_t>(dives))
      member.fail(fmt::format("{} dives found before it, {} is accepted", dives,
                              names[std::min(dives, names.size() - 1)]));
  }
}

// Dives by their ordinal names, with what is said beside them.
std::vector<EarlierCase> read_ordinals(const CaseField& field, const DivePlanRequest& base) {
  std::vector<EarlierCase> out;
  for (std::size_t i = 0; i < kOrdinals.size(); ++i) {
    const std::string prefix = std::string(kOrdinals[i]) + "dive_";
    const CaseField dive = field[prefix.substr(0, prefix.size() - 1)];
    if (!dive.present()) break;
    add_before(dive["repetitive"], base, out);
    out.push_back(read_earlier_dive(dive, field, prefix, base));
    out.back().earlier.surface_min = read_interval(dive, field, i);
    out.back().earlier.surface_gas = read_surface_gas(one_of(field["surface_interval_gas"], i));
  }
  if (out.empty()) field.fail("no dive found; first_dive, or a list of dives, is accepted");
  const CaseField intervals = field["surface_interval_min"];
  if (intervals.is_array() && intervals.size() != out.size())
    intervals.fail(fmt::format("{} minutes at the surface for {} dives found, as many are accepted",
                               intervals.size(), out.size()));
  refuse_misspelt_dives(field);
  // Tables: of the last dive, or one a dive.
  const auto table = [&](const char* key, std::size_t i) -> std::optional<TissueState> {
    const CaseField all = field[key];
    if (!all.is_array()) return {};
    const bool many = all.at(0).is_array() && all.at(0).at(0).is_array();
    if (many) return read_tissues(all.at(i));
    return i + 1 == out.size() ? read_tissues(all) : std::nullopt;
  };
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].surfacing = table("tissues_at_surfacing", i);
    out[i].after_interval = table("tissues_after_interval", i);
  }
  return out;
}

std::vector<EarlierCase> read_list(const CaseField& list, const CaseField& around,
                                   const DivePlanRequest& base) {
  std::vector<EarlierCase> out;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CaseField entry = list.at(i);
    if (entry["first_dive"].present()) {
      const std::vector<EarlierCase> more = read_ordinals(entry, base);
      out.insert(out.end(), more.begin(), more.end());
      continue;
    }
    const CaseField inner = entry["dive"], dive = inner.present() ? inner : entry;
    add_before(dive["repetitive"], base, out);
    EarlierCase one = read_earlier_dive(dive, entry, "", base);
    one.earlier.surface_min = read_interval(entry, around, i);
    const CaseField gas = entry["surface_interval_gas"];
    one.earlier.surface_gas =
        read_surface_gas(gas.present() ? gas : one_of(around["surface_interval_gas"], i));
    one.surfacing = read_tissues(entry["tissues_at_surfacing"]);
    one.after_interval = read_tissues(entry["tissues_after_interval"]);
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace

DecoExpected read_expected(const CaseField& profile) {
  DecoExpected expected;
  const CaseField reference = profile["reference"];
  constexpr std::string_view kNames[] = {"end_of_bottom",
                                         "first_stop",
                                         "surfacing",
                                         "stops",
                                         "no_deco",
                                         "total_stop_time_min",
                                         "time_to_surface_min",
                                         "total_runtime_min",
                                         "ndl_bottom_gas_runtime_min"};
  reference.refuse_misspelt(kNames);
  expected.end_of_bottom = read_point(reference["end_of_bottom"]);
  expected.first_stop = read_point(reference["first_stop"]);
  expected.surfacing = read_point(reference["surfacing"]);
  expected.stops = read_stops(reference["stops"]);
  if (reference["no_deco"].present()) expected.no_stops = reference["no_deco"].boolean(false);
  expected.stop_min = expected_number(reference["total_stop_time_min"]);
  expected.ascent_min = expected_number(reference["time_to_surface_min"]);
  expected.run_min = expected_number(reference["total_runtime_min"]);
  expected.ndl = read_ndl(reference["ndl_bottom_gas_runtime_min"]);
  const CaseField oxygen = profile["oxygen_exposure"];
  expected.cns_percent = expected_number(oxygen["cns_percent"]);
  expected.otu = expected_number(oxygen["otu"]);
  expected.max_po2_bar = expected_number(oxygen["max_po2_bar"]);
  const CaseField opinions = profile["second_opinions"];
  for (const std::string& program : opinions.keys())
    if (opinions[program].present())
      expected.opinions.push_back(read_opinion(opinions[program], program));
  return expected;
}

std::vector<EarlierCase> read_earlier(const CaseField& repetitive, const DivePlanRequest& base) {
  if (!repetitive.present()) return {};
  if (repetitive.is_array()) {
    // A list has nothing around it.
    return read_list(repetitive, repetitive.at(repetitive.size()), base);
  }
  const CaseField first = repetitive["first_dive"];
  if (first.present() && !first.is_array()) return read_ordinals(repetitive, base);
  for (const std::string& name : repetitive.keys())
    if (repetitive[name].is_array() && repetitive[name].at(0).is_object())
      return read_list(repetitive[name], repetitive, base);
  return read_ordinals(repetitive, base);
}

}  // namespace neritic::diver
