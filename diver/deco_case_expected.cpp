// What a case expects, and the dives before it (deco_case_parts.hpp).
#include <algorithm>
#include <array>

#include "diver/deco_case_parts.hpp"
#include "engine/core/text.hpp"

namespace neritic::diver {
namespace {

bool has_key(const CaseField& object, std::string_view key) {
  const std::vector<std::string> keys = object.keys();
  return std::ranges::find(keys, key) != keys.end();
}

std::optional<ExpectedPoint> read_point(const CaseField& field) {
  if (!field.present()) return {};
  constexpr std::string_view kNames[] = {
      "runtime_min",         "arrival_runtime_min", "depth_m",
      "abs_pressure_bar",    "tissues_n2_he_bar",   "ceiling_bar_gf_low",
      "ceiling_bar_gf_high", "ceiling_bar_gf_100",  "leading_compartment_gf_low",
      "leading_ceiling_bar", "ceiling_m_gf_low",    "ceiling_m_gf_high"};
  field.refuse_misspelt(kNames);
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

// Where something of a dive may be said: in it, or beside it with each name after a prefix.
struct ToldPlace {
  CaseField field;
  std::string prefix;
};
using ToldPlaces = std::vector<ToldPlace>;

// The one place where what is expected is said; absent where it is nowhere.
CaseField told(const ToldPlaces& places, const std::string& name) {
  CaseField found = places.front().field[places.front().prefix + name];
  for (std::size_t i = 1; i < places.size(); ++i) {
    const CaseField member = places[i].field[places[i].prefix + name];
    if (member.present() && found.present())
      member.fail(fmt::format("said at {} too, once is accepted", found.path()));
    if (member.present()) found = member;
  }
  return found;
}

constexpr const char* kSurfacingTissues = "tissues_at_surfacing";
constexpr const char* kIntervalTissues = "tissues_after_interval";
constexpr const char* kIntervalMin = "surface_interval_min";
constexpr const char* kIntervalGas = "surface_interval_gas";
constexpr std::array<const char*, 4> kExpectedOfDive{"stops", "runtime_min", kSurfacingTissues,
                                                     kIntervalTissues};
constexpr std::array<const char*, 6> kOrdinals{"first_",  "second_", "third_",
                                               "fourth_", "fifth_",  "sixth_"};

// What is said beside dives: of all of them, or of one after its ordinal.
std::vector<std::string> names_beside(std::size_t dives) {
  std::vector<std::string> names{kIntervalMin, kIntervalGas, kSurfacingTissues, kIntervalTissues};
  for (std::size_t i = 0; i < std::min(dives, kOrdinals.size()); ++i)
    for (const char* expected : kExpectedOfDive)
      names.push_back(std::string(kOrdinals[i]) + "dive_" + expected);
  return names;
}

// What is not read here would not be compared; texts are a file's own.
void refuse_unknown(const CaseField& object, const std::vector<std::string>& names) {
  for (const std::string& key : object.keys()) {
    const CaseField member = object[key];
    if (!member.present() || member.is_text() || std::ranges::find(names, key) != names.end())
      continue;
    const std::vector<std::string_view> views(names.begin(), names.end());
    member.fail(fmt::format("not known of earlier dives; the nearest is {}", nearest(key, views)));
  }
}

void refuse_unknown_of_dive(const CaseField& dive) {
  std::vector<std::string> names{"depth_m",   "bottom_runtime_min", "levels",     "profile",
                                 "gases",     "parameters",         "repetitive", kIntervalMin,
                                 kIntervalGas};
  names.insert(names.end(), kExpectedOfDive.begin(), kExpectedOfDive.end());
  refuse_unknown(dive, names);
}

// The i-th of a list, or the one thing that is no list.
CaseField one_of(const CaseField& field, std::size_t i) {
  return field.is_array() ? field.at(i) : field;
}

// One dive before, the i-th of those that stand in `around`, where what is not said of this one
// alone is.
EarlierCase read_earlier_dive(const CaseField& dive, const ToldPlaces& places,
                              const CaseField& around, std::size_t i, const DivePlanRequest& base) {
  refuse_unknown_of_dive(dive);
  EarlierCase one;
  DivePlanRequest& request = one.earlier.dive;
  request = base;
  request.start.reset();
  read_parameters(dive["parameters"], request);
  request.levels = read_levels(dive["profile"].present() ? dive["profile"] : dive);
  if (dive["gases"].present()) request.gases = read_gases(dive["gases"]);
  one.stops = read_stops(told(places, "stops"));
  one.run_min = expected_number(told(places, "runtime_min"));
  one.surfacing = read_tissues(told(places, kSurfacingTissues));
  one.after_interval = read_tissues(told(places, kIntervalTissues));
  if (one.stops && !one.stops->empty())
    request.last_stop_always = one.stops->front().depth_m >= request.conventions.last_stop_m;
  // What is nearest counts: in the list's entry, in the dive, around all of them.
  const auto nearest_of = [&](const char* name) {
    for (const ToldPlace& place : places)
      if (place.prefix.empty() && place.field[name].present()) return place.field[name];
    return one_of(around[name], i);
  };
  const CaseField interval = nearest_of(kIntervalMin);
  if (!interval.present()) around.required(kIntervalMin).at(i).refuse("minutes at the surface are");
  one.earlier.surface_min = interval.number(0.0, 0.0, 1e9);
  one.earlier.surface_gas = read_surface_gas(nearest_of(kIntervalGas));
  return one;
}

// What was dived before an earlier dive.
void add_before(const CaseField& repetitive, const DivePlanRequest& base,
                std::vector<EarlierCase>& out) {
  const std::vector<EarlierCase> before = read_earlier(repetitive, base);
  out.insert(out.end(), before.begin(), before.end());
}

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

// Lists around dives are of as many as stand there; tissues are of the last dive, or one table a
// dive. which: these dives' places in out.
void read_around(const CaseField& around, const std::vector<std::size_t>& which,
                 std::vector<EarlierCase>& out) {
  for (const auto& [key, what] : {std::pair{kIntervalMin, "minutes at the surface"},
                                  std::pair{kIntervalGas, "gases at the surface"}})
    if (around[key].is_array() && around[key].size() != which.size())
      around[key].fail(fmt::format("{} {} for {} dives found, as many are accepted",
                                   around[key].size(), what, which.size()));
  const auto read = [&](const char* key, std::optional<TissueState> EarlierCase::*expected) {
    const CaseField all = around[key];
    if (!all.present()) return;
    bool many = false;
    for (std::size_t i = 0; all.is_array() && i < all.size(); ++i)
      many = many || (all.at(i).is_array() && all.at(i).at(0).is_array());
    if (many && all.size() != which.size())
      all.fail(fmt::format("{} tables for {} dives found, as many are accepted", all.size(),
                           which.size()));
    for (std::size_t i = many ? 0 : which.size() - 1; i < which.size(); ++i) {
      const CaseField table = many ? all.at(i) : all;
      std::optional<TissueState>& tissues = out[which[i]].*expected;
      if (table.present() && tissues) table.fail("said of this dive already, once is accepted");
      if (table.present()) tissues = read_tissues(table);
    }
  };
  read(kSurfacingTissues, &EarlierCase::surfacing);
  read(kIntervalTissues, &EarlierCase::after_interval);
}

// Dives by their ordinal names, with what is said beside them.
std::vector<EarlierCase> read_ordinals(const CaseField& field, const DivePlanRequest& base) {
  std::vector<EarlierCase> out;
  std::vector<std::size_t> which;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kOrdinals.size(); ++i) {
    const std::string name = std::string(kOrdinals[i]) + "dive";
    const CaseField dive = field[name];
    if (!dive.present()) break;
    add_before(dive["repetitive"], base, out);
    which.push_back(out.size());
    names.push_back(name);
    out.push_back(read_earlier_dive(dive, {{dive, ""}, {field, name + "_"}}, field, i, base));
  }
  if (out.empty()) {
    field.fail("no dive found; first_dive, or a list of dives, is accepted");
    return out;
  }
  read_around(field, which, out);
  refuse_misspelt_dives(field);
  const std::vector<std::string> beside = names_beside(which.size());
  names.insert(names.end(), beside.begin(), beside.end());
  refuse_unknown(field, names);
  return out;
}

// around: what a list of a name stands in, else absent.
std::vector<EarlierCase> read_list(const CaseField& list, const CaseField& around,
                                   const DivePlanRequest& base) {
  std::vector<EarlierCase> out;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CaseField entry = list.at(i);
    if (entry["first_dive"].present()) {
      const std::vector<EarlierCase> more = read_ordinals(entry, base);
      out.insert(out.end(), more.begin(), more.end());
      which.push_back(out.size() - 1);
      continue;
    }
    const CaseField inner = entry["dive"], dive = inner.present() ? inner : entry;
    ToldPlaces places{{entry, ""}};
    if (inner.present()) {
      places.push_back({inner, ""});
      std::vector<std::string> names{"dive", kIntervalMin, kIntervalGas};
      names.insert(names.end(), kExpectedOfDive.begin(), kExpectedOfDive.end());
      refuse_unknown(entry, names);
    }
    if (i < kOrdinals.size()) places.push_back({around, std::string(kOrdinals[i]) + "dive_"});
    add_before(dive["repetitive"], base, out);
    which.push_back(out.size());
    out.push_back(read_earlier_dive(dive, places, around, i, base));
  }
  if (!out.empty()) read_around(around, which, out);
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
  constexpr std::string_view kOxygen[] = {"cns_percent", "otu", "max_po2_bar"};
  oxygen.refuse_misspelt(kOxygen);
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
  std::vector<std::string> names = names_beside(kOrdinals.size());
  for (const std::string& name : repetitive.keys()) {
    const CaseField list = repetitive[name];
    const bool beside = std::ranges::find(names, name) != names.end();
    if (beside || !list.is_array() || !list.at(0).is_object()) continue;
    names = names_beside(list.size());
    names.push_back(name);
    refuse_unknown(repetitive, names);
    return read_list(list, repetitive, base);
  }
  return read_ordinals(repetitive, base);
}

}  // namespace neritic::diver
