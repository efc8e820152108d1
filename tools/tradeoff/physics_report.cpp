// What `neritic tradeoff physics` writes (physics_tradeoff.hpp).
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "tools/common/plot.hpp"
#include "tools/tradeoff/physics_tradeoff.hpp"

namespace neritic::tools {
namespace {

using rov::Integrator;

constexpr Integrator kDrawn[] = {Integrator::kSemiImplicit, Integrator::kRk4, Integrator::kGuarded};
constexpr const char* kVehicles[] = {"no lag", "lag"};
constexpr double kLevels_m[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};

std::string physics_csv(const PhysicsTradeoff& t) {
  std::string out = "vehicle,integrator,step_ms,error_m,error_rad,us_a_second,order\n";
  for (const PhysicsPoint& p : t.points)
    out +=
        fmt::format("{},{},{:.6g},{:.4g},{:.4g},{:.4g},{:.2f}\n", p.vehicle, name_of(p.integrator),
                    1e3 * p.step_s, p.error_m, p.error_rad, p.us_a_second, p.order);
  return out;
}

std::string number_text(double value) {
  return std::isfinite(value) ? fmt::format("{:.1e}", value) : "diverges";
}

std::string physics_md(const PhysicsTradeoff& t) {
  std::string out = fmt::format(
      "# Physics: error against cost\n\nA BlueROV2 Heavy flies {:g} s round a square in a current, "
      "by the same recorded commands; the largest distance from an adaptive extrapolation of order "
      "16 (itself within {:.0e} m), and microseconds of one core a second of flight.\n",
      t.flight_s, t.reference_error_m);
  for (const char* vehicle : kVehicles) {
    out += fmt::format("\n## With {}\n\n| step, ms |", vehicle);
    for (const Integrator i : kDrawn) out += fmt::format(" {}, m | us |", name_of(i));
    out += "\n|---|---|---|---|---|---|---|\n";
    for (const PhysicsPoint& row : t.points) {
      if (row.vehicle != vehicle || row.integrator != kDrawn[0]) continue;
      out += fmt::format("| {:.3g} |", 1e3 * row.step_s);
      for (const PhysicsPoint& p : t.points)
        if (p.vehicle == vehicle && p.step_s == row.step_s)
          out += fmt::format(" {} | {:.0f} |", number_text(p.error_m), p.us_a_second);
      out += "\n";
    }
  }
  out +=
      "\n## Cheapest that holds an error, with and without lag\n\n| m | integrator | step, ms | us "
      "|\n|---|---|---|---|\n";
  for (const double level : kLevels_m)
    if (const PhysicsPoint* p = cheapest(t, level))
      out += fmt::format("| {:.0e} | {} | {:.3g} | {:.0f} |\n", level, name_of(p->integrator),
                         1e3 * p->step_s, p->us_a_second);
  return out;
}

nlohmann::json point_json(const PhysicsPoint& p) {
  return {{"integrator", name_of(p.integrator)},
          {"step_ms", 1e3 * p.step_s},
          {"error_m", p.error_m},
          {"error_rad", p.error_rad},
          {"us_a_second", p.us_a_second}};
}

nlohmann::json physics_json(const PhysicsTradeoff& t) {
  nlohmann::json json{{"flight_s", t.flight_s}, {"reference_error_m", t.reference_error_m}};
  for (const char* vehicle : kVehicles)
    if (const PhysicsPoint* p = knee(t, vehicle)) json["knees"][vehicle] = point_json(*p);
  for (const double level : kLevels_m)
    if (const PhysicsPoint* p = cheapest(t, level)) {
      json["levels"].push_back(point_json(*p));
      json["levels"].back()["max_error_m"] = level;
    }
  return json;
}

// Curves over x: what(point). noted: steps beside the default's.
void draw_physics(sonar::Canvas& canvas, const Box& box, const PhysicsTradeoff& t,
                  const std::string& vehicle, const std::string& title, const std::string& label,
                  double (*what)(const PhysicsPoint&), bool noted) {
  std::vector<Series> series;
  std::vector<double> xs, ys;
  for (const Integrator i : kDrawn) {
    Series s{std::string(name_of(i)), kSeriesColors[series.size()], {}, {}, {}};
    for (const PhysicsPoint& p : t.points) {
      if (p.vehicle != vehicle || p.integrator != i || !(p.error_m > 0.0) || p.error_m > 10.0)
        continue;
      s.x.push_back(what(p));
      s.y.push_back(p.error_m);
      if (noted && i == Integrator::kGuarded)
        s.notes.push_back(fmt::format("{:.3g} ms", 1e3 * p.step_s));
    }
    xs.insert(xs.end(), s.x.begin(), s.x.end());
    ys.insert(ys.end(), s.y.begin(), s.y.end());
    series.push_back(std::move(s));
  }
  const Axis x = axis_for(label, xs, true);
  Axis y = axis_for("largest error, m", ys, true);
  y.max *= 5.0;  // room for its label
  draw_lines(canvas, box, title, x, y, series, !noted);
  if (const PhysicsPoint* p = knee(t, vehicle))
    draw_mark(canvas, box, x, y, what(*p), p->error_m, "knee");
}

ImageU8 physics_plot(const PhysicsTradeoff& t) {
  constexpr double kWide = 900, kHigh = 520, kHead = 64;
  sonar::Canvas canvas(static_cast<std::uint32_t>(2 * kWide),
                       static_cast<std::uint32_t>(kHead + 2 * kHigh), kPaper);
  canvas.text(24, 34, 18, "Vehicle physics: error against cost", kInk, sonar::Align::kLeft, 2.2);
  canvas.text(24, 54, 10,
              fmt::format("{:g} s round a square in a current, recorded commands; truth: adaptive "
                          "extrapolation of order 16, within {:.0e} m",
                          t.flight_s, t.reference_error_m),
              kInk.with_alpha(0.7f));
  for (std::size_t row = 0; row < 2; ++row) {
    const double top = kHead + kHigh * static_cast<double>(row);
    const std::string with = row == 0 ? "without thruster lag" : "with third-order thruster lag";
    draw_physics(
        canvas, {0, top, kWide, top + kHigh}, t, kVehicles[row], with + ": over cost",
        "us of one core a second of flight", [](const PhysicsPoint& p) { return p.us_a_second; },
        true);
    draw_physics(
        canvas, {kWide, top, 2 * kWide, top + kHigh}, t, kVehicles[row], with + ": over the step",
        "step, ms", [](const PhysicsPoint& p) { return 1e3 * p.step_s; }, false);
  }
  return canvas.take();
}

}  // namespace

Status write_physics_tradeoff(const std::filesystem::path& folder,
                              const PhysicsTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "physics.csv", physics_csv(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "physics.md", physics_md(tradeoff)));
  NERITIC_TRY_STATUS(scene::write_png8(folder / "physics.png", physics_plot(tradeoff)));
  return write_json(folder / "physics.json", physics_json(tradeoff));
}

}  // namespace neritic::tools
