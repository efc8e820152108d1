// The output of `neritic tradeoff physics` (physics_tradeoff.hpp).
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/physics_settings.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/physics_tradeoff.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

using rov::Integrator;

constexpr Integrator kDrawn[] = {Integrator::kSemiImplicit, Integrator::kRk4, Integrator::kGuarded};
constexpr double kLevels_m[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};

// Names of flights in tables and plots, in the order of kFlightNames.
constexpr std::size_t kFirstAmongThings = 4;  // of the flights
struct FlightWords {
  const char *title, *about;
};
constexpr FlightWords kWords[] = {
    {"open water, no lag",
     "A BlueROV2 Heavy flies {:g} s round a square in a current, by the same recorded commands."},
    {"open water, lag", "The same with the third-order lag of its thrusters."},
    {"controller in a current",
     "A BlueROV2 Heavy with lag flies {:g} s round a circle by a controller in the loop, in a "
     "current "
     "that changes with place and time."},
    {"controller with pulses", "The same with pulses in whole microseconds."},
    {"contact, no lag",
     "A BlueROV2 Heavy is set down on sand, driven along it, lifted, driven against a wall corner "
     "first, along it and away, {:g} s, by the same recorded commands."},
    {"contact, lag", "The same with lag."},
    {"controller in contact", "The same with lag by a controller in the loop."},
    {"sand in a current",
     "By a controller in the loop in a current that changes with place and time, {:g} s: set down "
     "on flat sand, driven along it, lifted, set down again."},
    {"uneven sand in a current", "The same on waves of sand of 5 cm, in triangles of 0.5 m."},
    {"the wreck in a current",
     "In the same current against the side of the wreck of assets/scenes/mission.toml, along it "
     "and onto its deck, {:g} s: a mesh of 190 000 triangles, a vehicle of five boxes."},
    {"a ball that bounces", "Restitution 0.6, no drag: the closed form is the truth."},
    {"a block that slides",
     "At 1 m/s onto sand with friction 0.3, no drag: by Coulomb's law it stops after 1.67 m."},
    {"a ball that slides, then rolls",
     "At 1 m/s onto sand with friction 0.3, no drag: it rolls from 0.64 s on, at 5/7 of that."}};

std::string physics_csv(const PhysicsTradeoff& t) {
  std::string out = "flight,integrator,step_ms,within_m,error_m,error_rad,us_a_second,order\n";
  for (const auto* points : {&t.points, &t.halved})
    for (const PhysicsPoint& p : *points)
      out += fmt::format("\"{}\",{},{:.6g},{:g},{:.4g},{:.4g},{:.4g},{:.2f}\n", p.flight,
                         name_of(p.integrator), 1e3 * p.step_s, p.within_m, p.error_m, p.error_rad,
                         p.us_a_second, p.order);
  return out;
}

std::string number_text(double value) {
  return std::isfinite(value) ? fmt::format("{:.1e}", value) : "diverges";
}

std::string halved_md(const PhysicsTradeoff& t) {
  std::string out =
                  "\n## Steps that touch, halved until a half changes them by no more (guarded)\n\n"
                  "| step, ms | within, m |",
              rule = "\n|---|---|";
  for (std::size_t f = 0; f < std::size(kFlightNames); ++f)
    if (std::ranges::count(t.halved, kFlightNames[f], &PhysicsPoint::flight) > 0) {
      out += fmt::format(" {}, m | us |", kWords[f].title);
      rule += "---|---|";
    }
  out += rule + "\n";
  for (const PhysicsPoint& row : t.halved) {
    if (row.flight != t.halved.front().flight) continue;
    out += fmt::format("| {:.3g} | {:g} |", 1e3 * row.step_s, row.within_m);
    for (const PhysicsPoint& p : t.halved)
      if (p.within_m == row.within_m && p.step_s == row.step_s)
        out += fmt::format(" {} | {:.0f} |", number_text(p.error_m), p.us_a_second);
    out += "\n";
  }
  return out;
}

// What is asked or flown by, as a column's heading: rates, or the error that was asked for.
std::string missions_md(const PhysicsTradeoff& t, bool touch) {
  std::string out = touch ? "\n## Missions that touch something, by the error that is asked\n\n| "
                            "mission | truth is sure to, m |"
                          : "\n## Missions in open water, by the rate (guarded)\n\n| mission | "
                            "truth is sure to, m |",
              rule = "\n|---|---|";
  std::vector<double> worst;
  const auto heading = [&](const std::string& words) {
    out += fmt::format(" {}, m | us |", words);
    rule += "---|---|";
    worst.push_back(0.0);
  };
  if (touch)
    for (const double asked_m : kAskedInContact_m) heading(fmt::format("{:g}", asked_m));
  else
    for (const rov::MeasuredRate& rate : rov::measured_rates())
      heading(fmt::format("{:g} Hz", rate.hz));
  out += rule + "\n";
  for (const MissionError& mission : t.missions) {
    if (mission.touches != touch) continue;
    out += fmt::format("| {} | {:.0e} |", mission.flight, mission.truth_error_m);
    for (std::size_t i = 0; i < mission.error_m.size(); ++i) {
      out += fmt::format(" {} | {:.0f} |", number_text(mission.error_m[i]), mission.us_a_second[i]);
      worst[i] = std::max(worst[i], mission.error_m[i]);
    }
    out += "\n";
  }
  out += "| worst | |";
  for (const double error_m : worst) out += fmt::format(" {} | |", number_text(error_m));
  return out + "\n";
}

std::string physics_md(const PhysicsTradeoff& t) {
  std::string out =
      "# Physics: error against cost\n\nThe largest distance from the truth, and microseconds of "
      "one core a second of flight. The truth is an adaptive extrapolation of order 16 in open "
      "water, halved steps among things.\n";
  for (std::size_t f = 0; f < std::size(kFlightNames); ++f) {
    const std::string flight = kFlightNames[f];
    out += fmt::format("\n## {}\n\n{} The truth is sure to {:.0e} m.\n\n| step, ms |",
                       kWords[f].title, fmt::format(fmt::runtime(kWords[f].about), t.flight_s),
                       t.truth_error_m.at(flight));
    for (const Integrator i : kDrawn) out += fmt::format(" {}, m | us |", name_of(i));
    out += "\n|---|---|---|---|---|---|---|\n";
    for (const PhysicsPoint& row : t.points) {
      if (row.flight != flight || row.integrator != kDrawn[0]) continue;
      out += fmt::format("| {:.3g} |", 1e3 * row.step_s);
      for (const PhysicsPoint& p : t.points)
        if (p.flight == flight && p.step_s == row.step_s)
          out += fmt::format(" {} | {:.0f} |", number_text(p.error_m), p.us_a_second);
      out += "\n";
    }
  }
  out += halved_md(t) + missions_md(t, false) + missions_md(t, true);
  out +=
      "\n## Cheapest that holds an error in open water, with and without lag\n\n| m | integrator | "
      "step, ms | us |\n|---|---|---|---|\n";
  for (const double level : kLevels_m)
    if (const PhysicsPoint* p = cheapest(t, level))
      out += fmt::format("| {:.0e} | {} | {:.3g} | {:.0f} |\n", level, name_of(p->integrator),
                         1e3 * p->step_s, p->us_a_second);
  return out;
}

nlohmann::json point_json(const PhysicsPoint& p) {
  return {{"integrator", name_of(p.integrator)},
          {"step_ms", 1e3 * p.step_s},
          {"within_m", p.within_m},
          {"error_m", p.error_m},
          {"error_rad", p.error_rad},
          {"us_a_second", p.us_a_second}};
}

nlohmann::json physics_json(const PhysicsTradeoff& t) {
  nlohmann::json json{{"flight_s", t.flight_s}, {"truth_error_m", t.truth_error_m}};
  for (const MissionError& m : t.missions)
    json["missions"].push_back({{"name", m.flight},
                                {"touches", m.touches},
                                {"truth_error_m", m.truth_error_m},
                                {"error_m", m.error_m},
                                {"us_a_second", m.us_a_second}});
  for (const char* flight : kFlightNames)
    if (const PhysicsPoint* p = knee(t, flight)) json["knees"][flight] = point_json(*p);
  for (const double level : kLevels_m)
    if (const PhysicsPoint* p = cheapest(t, level)) {
      json["levels"].push_back(point_json(*p));
      json["levels"].back()["max_error_m"] = level;
    }
  return json;
}

bool is_drawn(const PhysicsPoint& p) {
  return p.error_m > 0.0 && p.error_m <= 10.0;
}

constexpr const char* kError = "largest error, m";
constexpr const char* kCost = "µs of one core a second of flight";

// Error over cost of one flight's integrators; steps stand beside the recommended one's points.
Panel flight_panel(const PhysicsTradeoff& t, std::size_t f) {
  Panel panel{std::string(kWords[f].title) + ": over cost", {kCost}, {kError}};
  for (const Integrator i : kDrawn) {
    Series s{std::string(name_of(i)), {}, {}};
    for (const PhysicsPoint& p : t.points) {
      if (p.flight != kFlightNames[f] || p.integrator != i || !is_drawn(p)) continue;
      s.x.push_back(p.us_a_second);
      s.y.push_back(p.error_m);
      if (i == Integrator::kGuarded) s.notes.push_back(fmt::format("{:.3g} ms", 1e3 * p.step_s));
      if (i == Integrator::kGuarded && std::abs(p.step_s * scene::Physics{}.rate_hz - 1.0) < 1e-6)
        panel.marks.push_back({p.us_a_second, p.error_m, "default"});
    }
    panel.series.push_back(std::move(s));
  }
  if (const PhysicsPoint* p = knee(t, kFlightNames[f]))
    panel.marks.push_back({p->us_a_second, p->error_m, "knee"});
  return panel;
}

// The recommended integrator's error on every flight, over the length of the step.
Panel steps_panel(const PhysicsTradeoff& t) {
  Panel panel{"guarded, every flight: over the step", {"step, ms"}, {kError}};
  for (std::size_t f = 0; f < std::size(kFlightNames); ++f) {
    Series s{kWords[f].title, {}, {}};
    for (const PhysicsPoint& p : t.points) {
      if (p.flight != kFlightNames[f] || p.integrator != Integrator::kGuarded || !is_drawn(p))
        continue;
      s.x.push_back(1e3 * p.step_s);
      s.y.push_back(p.error_m);
    }
    panel.series.push_back(std::move(s));
  }
  return panel;
}

// 80 and 1000 Hz, with the steps that touch halved.
Panel halved_panel(const PhysicsTradeoff& t) {
  Panel panel{"80 and 1000 Hz, guarded, steps that touch halved: over cost", {kCost}, {kError}};
  for (std::size_t f = kFirstAmongThings; f < std::size(kFlightNames); ++f) {
    Series s{kWords[f].title, {}, {}};
    std::vector<const PhysicsPoint*> points;
    for (const PhysicsPoint& p : t.halved)
      if (p.flight == kFlightNames[f] && is_drawn(p)) points.push_back(&p);
    std::ranges::sort(points, {}, &PhysicsPoint::us_a_second);
    for (const PhysicsPoint* p : points) {
      s.x.push_back(p->us_a_second);
      s.y.push_back(p->error_m);
      s.notes.push_back(fmt::format("{:g}", p->within_m));
    }
    panel.series.push_back(std::move(s));
  }
  return panel;
}

Page physics_page(const PhysicsTradeoff& t) {
  Page page{"Vehicle physics: error against cost",
            {fmt::format("{:g} s of recorded commands, round a square in a current or set down on "
                         "sand and driven against a wall. Truth: extrapolation of order 16; among "
                         "things halved steps. Default: guarded, {:g} Hz.",
                         t.flight_s, scene::Physics{}.rate_hz)}};
  for (const std::size_t f : {0, 1, 4, 5}) page.panels.push_back(flight_panel(t, f));
  page.panels.push_back(steps_panel(t));
  page.panels.push_back(halved_panel(t));
  return page;
}

}  // namespace

Result<bool> write_physics_tradeoff(const std::filesystem::path& folder,
                                    const PhysicsTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "physics.csv", physics_csv(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "physics.md", physics_md(tradeoff)));
  NERITIC_TRY_STATUS(write_json(folder / "physics.json", physics_json(tradeoff)));
  return write_picture(folder / "physics.png", page_data(physics_page(tradeoff)));
}

}  // namespace neritic::tools
