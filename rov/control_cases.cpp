#include "rov/control_cases.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "rov/bluerov2.hpp"

namespace neritic::rov {
namespace {

constexpr const char* kFigures[] = {"rise_10_90",  "t90",          "overshoot_pct", "settle_s",
                                    "final_error", "max_tilt_deg", "max_thruster_N"};

std::vector<PidAxis> read_axes(const CaseField& field, std::size_t count) {
  const std::vector<double> kp = field.required("KP").numbers();
  if (count == 0) count = kp.size();
  if (count == 0 || count > 6 || kp.size() != count) {
    field["KP"].refuse(count == 6 ? "a list of six numbers"
                                  : "a list of as many numbers as axes, one to six");
    return {};
  }
  std::vector<PidAxis> axes(count);
  const auto read = [&](const char* key, double PidAxis::*member, bool needed, double least) {
    const CaseField at = needed ? field.required(key) : field[key];
    const std::vector<double> values = at.numbers(count);
    for (std::size_t i = 0; i < values.size(); ++i) {
      axes[i].*member = values[i];
      if (!(values[i] >= least)) at.refuse(fmt::format("numbers from {}", least));
    }
  };
  read("KP", &PidAxis::kp, true, -1e300);
  read("KI", &PidAxis::ki, true, -1e300);
  read("KD", &PidAxis::kd, true, -1e300);
  read("umax", &PidAxis::u_max, false, 0.0);
  read("imax", &PidAxis::i_max, false, 0.0);
  read("izone", &PidAxis::zone, false, 0.0);
  return axes;
}

PidCase read_pid(const CaseField& field) {
  field.allow_with_texts({"KP", "KI", "KD", "umax", "imax", "izone", "dt", "I0", "rule", "steps"});
  PidCase out;
  out.id = "pid_sequence";
  out.axes = read_axes(field, 0);
  const std::size_t n = out.axes.size();
  out.dt_s = field.required("dt").number(0.0, 1e-9, 1e3);
  out.integral = field["I0"].numbers(n);
  out.integral.resize(n);
  const CaseField steps = field.required("steps");
  for (std::size_t i = 0; i < steps.size() && n > 0; ++i) {
    const CaseField at = steps.at(i);
    at.allow_with_texts({"e", "nu", "u", "I"});
    PidStep step{at["e"].required_numbers(n), at["nu"].required_numbers(n), at["u"].numbers(n),
                 at["I"].numbers(n)};
    if (step.output.empty() && step.integral.empty())
      at.fail(found_accepted("nothing to compare", "u or I"));
    out.steps.push_back(std::move(step));
  }
  if (out.steps.empty()) steps.fail(found_accepted("none", "at least one step"));
  return out;
}

std::optional<double> maybe(const CaseField& field) {
  if (!field.present()) return std::nullopt;
  return field.number(0.0);
}

void read_allocation_cases(const CaseField& list, AllocationTable& out, CaseFile& file) {
  const std::size_t n = out.columns.size();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CaseField at = list.at(i);
    AllocationCase one;
    one.id = fmt::format("allocation/{}", i);
    file.enter_case(one.id);
    at.allow_with_texts({"tau", "f_pinv", "scale", "f_scaled", "tau_achieved"});
    const std::vector<double> tau = at["tau"].required_numbers(6);
    std::copy(tau.begin(), tau.end(), one.wrench.v.begin());
    one.wanted_n = at["f_pinv"].numbers(n);
    one.scale = maybe(at["scale"]);
    one.force_n = at["f_scaled"].numbers(n);
    one.achieved = at["tau_achieved"].numbers(6);
    if (one.wanted_n.empty() && !one.scale && one.force_n.empty() && one.achieved.empty())
      at.fail(found_accepted("nothing to compare", "f_pinv, scale, f_scaled or tau_achieved"));
    out.cases.push_back(std::move(one));
  }
}

AllocationTable read_allocation(const CaseField& field, CaseFile& file) {
  field.allow_with_texts({"B_6x8", "pinv_8x6", "rank", "singular_values", "cond", "cond_length_0p2",
                          "fmax", "fmin", "rule", "cases"});
  AllocationTable out;
  constexpr std::size_t n = 8;
  static_assert(n <= kMaxThrusters);
  const auto rows = field.required("B_6x8").rows(6, n);
  out.columns.resize(n);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < n; ++k) out.columns[k][i] = rows[i][k];
  out.inverse = field["pinv_8x6"].rows(n, 6);
  out.rank = maybe(field["rank"]);
  out.singular_values = field["singular_values"].present() ? field["singular_values"].numbers(6)
                                                           : std::vector<double>();
  out.condition = maybe(field["cond"]);
  out.condition_length_0_2 = maybe(field["cond_length_0p2"]);
  out.max_n.assign(n, field.required("fmax").number(0.0, 0.0, 1e9));
  out.min_n.assign(n, field.required("fmin").number(0.0, -1e9, 0.0));
  read_allocation_cases(field["cases"], out, file);
  return out;
}

constexpr std::string_view kPlantForm =
    "\"Fossen + thruster lag T s, force limits +MAX/-MIN N\", three numbers above 0";
constexpr std::string_view kMap = "tau=M_RB*u (paper), F=scale(pinv tau)";

// Takes a number off the front of a text, and the words behind it; nothing where they are not
// there.
std::optional<double> take_number(std::string_view& text, std::string_view words_behind) {
  const std::size_t end = text.find(words_behind);
  if (end == text.npos) return std::nullopt;
  const auto number = parse_number(text.substr(0, end));
  text.remove_prefix(end + words_behind.size());
  if (!number || !(*number >= 1e-6 && *number <= 1e6)) return std::nullopt;
  return number;
}

// The plant is a text of one fixed form; the map, if given, a fixed text.
void read_plant(const CaseField& loop, LoopCase& out) {
  const std::string plant = loop.required("plant").text();
  std::string_view rest = plant;
  constexpr std::string_view kBegin = "Fossen + thruster lag ";
  if (rest.starts_with(kBegin)) {
    rest.remove_prefix(kBegin.size());
    const auto lag = take_number(rest, " s, force limits +");
    const auto most = lag ? take_number(rest, "/-") : std::nullopt;
    const auto least = most ? take_number(rest, " N") : std::nullopt;
    if (least && rest.empty()) {
      out.lag_s = *lag;
      out.max_n = *most;
      out.min_n = -*least;
    } else {
      loop["plant"].refuse(kPlantForm);
    }
  } else {
    loop["plant"].refuse(kPlantForm);
  }
  if (loop["map"].present() && loop["map"].text() != kMap)
    loop["map"].refuse(fmt::format("\"{}\"", kMap));
}

// "surge_2m", "depth_+1m", "yaw_90deg"
bool read_manoeuvre(const std::string& name, LoopCase& out) {
  constexpr const char* kAxes[] = {"surge_", "sway_", "depth_", "roll_", "pitch_", "yaw_"};
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string prefix = kAxes[i];
    const std::string unit = i < 3 ? "m" : "deg";
    if (!name.starts_with(prefix) || !name.ends_with(unit)) continue;
    const char* from = name.data() + prefix.size();
    const char* to = name.data() + name.size() - unit.size();
    if (from < to && *from == '+') ++from;
    const auto read = std::from_chars(from, to, out.amount);
    if (read.ec != std::errc() || read.ptr != to || !(std::abs(out.amount) > 1e-9)) return false;
    out.axis = i;
    if (i >= 3) out.amount = radians(out.amount);
    return std::abs(out.amount) <= (i < 3 ? 1e4 : 3.1);
  }
  return false;
}

void read_waypoints(const CaseField& at, LoopCase& out) {
  const CaseField list = at["waypoints"];
  for (std::size_t i = 0; i < list.size(); ++i) {
    list.at(i).allow_with_texts({"p", "yaw"});
    const std::vector<double> p = list.at(i)["p"].required_numbers(3);
    if (p.empty()) return;
    out.waypoints.push_back({{p[0], p[1], p[2]}, list.at(i).required("yaw").number(0.0)});
  }
  if (out.waypoints.empty()) list.fail(found_accepted("none", "at least one waypoint"));
  out.radius_m = at.required("radius").number(0.15, 1e-6, 1e4);
  out.arrivals_s = at["arrival_s"].numbers(out.waypoints.size());
  out.duration_s = 40.0;
}

LoopCase read_loop(const CaseField& loop, const CaseField& at, const std::string& id) {
  at.allow_with_texts({"rise_10_90", "t90", "overshoot_pct", "settle_s", "final_error",
                       "max_tilt_deg", "max_thruster_N", "end_state", "waypoints", "radius",
                       "arrival_s", "priority"});
  LoopCase out;
  out.id = id;
  read_plant(loop, out);
  const auto cut = id.find('/');
  const std::string plant = id.substr(0, cut);
  if (plant == "sea" || plant == "fresh")
    out.buoyancy_water_kg_m3 = plant == "sea" ? kSeaDensity : kFreshDensity;
  else if (plant != "neutral")
    at.fail(found_accepted("another name", "one that begins with neutral/, fresh/ or sea/"));
  if (at["waypoints"].present())
    read_waypoints(at, out);
  else if (cut == id.npos || !read_manoeuvre(id.substr(cut + 1), out))
    at.fail(found_accepted("another name",
                           "surge_, sway_, depth_ and metres (surge_2m), roll_, pitch_, yaw_ and "
                           "degrees (yaw_90deg), or waypoints"));
  const std::string priority = at["priority"].text("none");
  if (priority != "none" && priority != "level") at["priority"].refuse("none or level");
  out.level_first = priority == "level";
  for (const char* figure : kFigures)
    if (const auto value = maybe(at[figure])) out.figures[figure] = *value;
  out.end_state = at["end_state"].numbers(13);
  if (out.figures.empty() && out.end_state.empty() && out.arrivals_s.empty())
    at.fail(found_accepted("nothing to compare", "t90, overshoot_pct, ..., end_state"));
  return out;
}

void read_loops(const CaseField& loop, CaseFile& file, ControlCases& out) {
  ControlGains gains;
  loop.allow_with_texts({"gains", "control_hz", "plant", "map", "results"});
  const CaseField gains_field = loop.required("gains");
  gains_field.allow_with_texts({"KP", "KI", "KD", "umax", "imax", "izone"});
  const std::vector<PidAxis> axes = read_axes(gains_field, 6);
  if (axes.size() == 6) std::copy(axes.begin(), axes.end(), gains.axes.begin());
  gains.period_s = 1.0 / loop["control_hz"].number(50.0, 1.0, 1e4);
  const CaseField results = loop.required("results");
  for (const std::string& id : results.keys()) {
    file.enter_case(id);
    out.loops.push_back(read_loop(loop, results[id], id));
    out.loops.back().gains = gains;
  }
}

}  // namespace

Result<ControlCases> read_control_cases(std::string_view text, const std::string& name) {
  NERITIC_TRY(CaseFile file, CaseFile::parse(text, name));
  const CaseField root = file.root();
  ControlCases out;
  root.allow_with_texts({"pid_sequence", "allocation", "closed_loop"});
  if (const CaseField pid = root["pid_sequence"]; pid.present()) {
    file.enter_case("pid_sequence");
    out.pid = read_pid(pid);
  }
  if (root["allocation"].present()) {
    file.enter_case("allocation");
    out.allocation = read_allocation(root["allocation"], file);
  }
  file.enter_case("closed_loop");
  if (root["closed_loop"].present()) read_loops(root["closed_loop"], file, out);
  file.enter_case("");
  if (!out.pid && !out.allocation && out.loops.empty())
    root.fail(found_accepted("no case", "pid_sequence, allocation and closed_loop"));
  if (file.failed()) return file.error();
  return out;
}

}  // namespace neritic::rov
