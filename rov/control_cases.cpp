#include "rov/control_cases.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "rov/bluerov2.hpp"

namespace neritic::rov {
namespace {

constexpr const char* kFigures[] = {"rise_10_90",  "t90",          "overshoot_pct", "settle_s",
                                    "final_error", "max_tilt_deg", "max_thruster_N"};

std::vector<PidAxis> read_axes(const CaseField& field, std::size_t count) {
  const std::vector<double> kp = field.required("KP").numbers();
  if (count == 0) count = kp.size();
  if (count == 0 || count > 6 || kp.size() != count) {
    field["KP"].refuse(count == 6 ? "a list of six numbers is"
                                  : "a list of as many numbers as axes, one to six, is");
    return {};
  }
  std::vector<PidAxis> axes(count);
  const auto read = [&](const char* key, double PidAxis::*member, bool needed, double least) {
    const CaseField at = needed ? field.required(key) : field[key];
    const std::vector<double> values = at.numbers(count);
    for (std::size_t i = 0; i < values.size(); ++i) {
      axes[i].*member = values[i];
      if (!(values[i] >= least)) at.refuse(fmt::format("numbers from {} are", least));
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

PidCase read_pid(const CaseField& field, std::string id) {
  PidCase out;
  out.id = std::move(id);
  out.axes = read_axes(field, 0);
  const std::size_t n = out.axes.size();
  out.dt_s = field.required("dt").number(0.0, 1e-9, 1e3);
  out.integral = field["I0"].numbers(n);
  out.integral.resize(n);
  const CaseField steps = field.required("steps");
  for (std::size_t i = 0; i < steps.size() && n > 0; ++i) {
    const CaseField at = steps.at(i);
    PidStep step{at["e"].required_numbers(n), at["nu"].required_numbers(n), at["u"].numbers(n),
                 at["I"].numbers(n)};
    if (step.output.empty() && step.integral.empty())
      at.fail("nothing to compare found; u or I is accepted");
    out.steps.push_back(std::move(step));
  }
  if (out.steps.empty()) steps.fail("empty; at least one step is accepted");
  return out;
}

// The member whose name begins so: B_6x8, pinv_8x6.
CaseField beginning(const CaseField& field, std::string_view prefix) {
  for (const std::string& key : field.keys())
    if (key.starts_with(prefix)) return field[key];
  return field[std::string(prefix) + "..."];
}

std::vector<double> one_or_each(const CaseField& field, std::size_t n, double least, double most) {
  if (field.is_array()) return field.numbers(n);
  if (!field.present()) field.fail("not found, but needed");
  return std::vector<double>(n, field.number(0.0, least, most));
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
    one.id = fmt::format("allocation/{}", at["id"].text(fmt::format("{}", i)));
    file.enter_case(one.id);
    const std::vector<double> tau = at["tau"].required_numbers(6);
    std::copy(tau.begin(), tau.end(), one.wrench.v.begin());
    one.wanted_n = at["f_pinv"].numbers(n);
    one.scale = maybe(at["scale"]);
    one.force_n = at["f_scaled"].numbers(n);
    one.achieved = at["tau_achieved"].numbers(6);
    if (one.wanted_n.empty() && !one.scale && one.force_n.empty() && one.achieved.empty())
      at.fail("nothing to compare found; f_pinv, scale, f_scaled or tau_achieved is accepted");
    out.cases.push_back(std::move(one));
  }
}

AllocationTable read_allocation(const CaseField& field, CaseFile& file) {
  AllocationTable out;
  const CaseField matrix = beginning(field, "B_6x");
  if (!matrix.present()) matrix.fail("not found, but needed");
  const std::size_t n = matrix.at(0).is_array() ? matrix.at(0).size() : 0;
  if (n == 0 || n > kMaxThrusters) {
    matrix.refuse(fmt::format("six rows of 1 to {} numbers are", kMaxThrusters));
    return out;
  }
  const auto rows = matrix.rows(6, n);
  out.columns.resize(n);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < n; ++k) out.columns[k][i] = rows[i][k];
  out.inverse = beginning(field, "pinv_").rows(n, 6);
  out.rank = maybe(field["rank"]);
  out.singular_values = field["singular_values"].present() ? field["singular_values"].numbers(6)
                                                           : std::vector<double>();
  out.condition = maybe(field["cond"]);
  out.condition_length_0_2 = maybe(field["cond_length_0p2"]);
  out.max_n = one_or_each(field["fmax"], n, 0.0, 1e9);
  out.min_n = one_or_each(field["fmin"], n, -1e9, 0.0);
  read_allocation_cases(field["cases"], out, file);
  return out;
}

// The number behind the first mention of a word in a text; no number where there is none.
double number_after(const std::string& text, std::string_view word) {
  const auto at = text.find(word);
  double value = NAN;
  if (at != text.npos)
    std::from_chars(text.data() + at + word.size(), text.data() + text.size(), value);
  return value;
}

void read_plant(const CaseField& loop, LoopCase& out) {
  const std::string plant = loop.required("plant").text();
  out.lag_s = number_after(plant, "lag ");
  out.max_n = number_after(plant, "limits +");
  out.min_n = -number_after(plant, "/-");
  const auto fits = [](double x) { return x >= 1e-6 && x <= 1e6; };
  if (!fits(out.lag_s) || !fits(out.max_n) || !fits(-out.min_n))
    loop["plant"].refuse("\"... lag 0.1 s, force limits +51.436/-39.908 N\" is");
  const std::string map = loop["map"].text("tau=M_RB*u");
  if (map.find("M_RB*u") == map.npos) loop["map"].refuse("\"tau=M_RB*u, F=scale(pinv tau)\" is");
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
    const std::vector<double> p = list.at(i)["p"].required_numbers(3);
    if (p.empty()) return;
    out.waypoints.push_back({{p[0], p[1], p[2]}, list.at(i)["yaw"].number(0.0)});
  }
  if (out.waypoints.empty()) list.fail("empty; at least one waypoint is accepted");
  out.radius_m = at["radius"].number(0.15, 1e-6, 1e4);
  out.arrivals_s = at["arrival_s"].numbers(out.waypoints.size());
  out.duration_s = 40.0;
}

LoopCase read_loop(const CaseField& loop, const CaseField& at, const std::string& id) {
  LoopCase out;
  out.id = id;
  read_plant(loop, out);
  const auto cut = id.find('/');
  const std::string plant = id.substr(0, cut);
  if (plant == "sea" || plant == "fresh")
    out.buoyancy_water_kg_m3 = plant == "sea" ? kSeaDensity : kFreshDensity;
  else if (plant != "neutral")
    at.fail("a name that begins with neutral/, fresh/ or sea/ is accepted");
  if (at["waypoints"].present())
    read_waypoints(at, out);
  else if (cut == id.npos || !read_manoeuvre(id.substr(cut + 1), out))
    at.fail(
        "surge_, sway_, depth_ and metres (surge_2m), roll_, pitch_, yaw_ and degrees "
        "(yaw_90deg), or waypoints are accepted");
  out.duration_s = at["duration_s"].number(out.duration_s, 0.1, 1e4);
  const std::string priority = at["priority"].text("none");
  if (priority != "none" && priority != "level") at["priority"].fail("none and level are accepted");
  out.level_first = priority == "level";
  for (const char* figure : kFigures)
    if (const auto value = maybe(at[figure])) out.figures[figure] = *value;
  out.end_state = at["end_state"].numbers(13);
  if (out.figures.empty() && out.end_state.empty() && out.arrivals_s.empty())
    at.fail("nothing to compare found; t90, overshoot_pct, ..., end_state are accepted");
  return out;
}

void read_loops(const CaseField& loop, CaseFile& file, ControlCases& out) {
  ControlGains gains;
  const std::vector<PidAxis> axes = read_axes(loop.required("gains"), 6);
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
  if (const CaseField pid = root["pid_sequence"]; pid.is_array()) {
    for (std::size_t i = 0; i < pid.size(); ++i) {
      const std::string id = pid.at(i)["id"].text(fmt::format("pid_sequence/{}", i));
      file.enter_case(id);
      out.pids.push_back(read_pid(pid.at(i), id));
    }
  } else if (pid.present()) {
    file.enter_case("pid_sequence");
    out.pids.push_back(read_pid(pid, "pid_sequence"));
  }
  if (root["allocation"].present()) {
    file.enter_case("allocation");
    out.allocation = read_allocation(root["allocation"], file);
  }
  file.enter_case("closed_loop");
  if (root["closed_loop"].present()) read_loops(root["closed_loop"], file, out);
  file.enter_case("");
  if (out.pids.empty() && !out.allocation && out.loops.empty())
    root.fail("no case found; pid_sequence, allocation and closed_loop are accepted");
  if (file.failed()) return file.error();
  return out;
}

}  // namespace neritic::rov
