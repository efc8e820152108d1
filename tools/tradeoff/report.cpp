// What `neritic tradeoff sonar` writes (sonar_tradeoff.hpp).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "tools/common/plot.hpp"
#include "tools/tradeoff/sonar_tradeoff.hpp"

namespace neritic::tools {
namespace {

const char* const kGatherNames[] = {"nearest", "plane", "published"};

std::vector<const Point*> select(const SonarTradeoff& t, const std::string& scene,
                                 const std::string& sweep, const std::string& gather) {
  std::vector<const Point*> out;
  for (const Point& p : t.points)
    if (p.scene == scene && p.sweep == sweep && (gather.empty() || p.gather == gather))
      out.push_back(&p);
  return out;
}

std::string csv_of(const SonarTradeoff& t) {
  std::string out =
      "scene,sweep,images,gather,normals,gbuffer_scale,width,height,bins_range,bins_azimuth,bins_"
      "elevation,"
      "error_energy,error_l1,error_range_mm,gather_ms,raster_ms\n";
  for (const Point& p : t.points)
    out += fmt::format("{},{},{},{},{},{:g},{},{},{},{},{},{:.6f},{:.6f},{:.4f},{:.4f},{:.4f}\n",
                       p.scene, p.sweep, p.images, p.gather, p.normals, p.scale, p.width, p.height,
                       p.bins.range, p.bins.azimuth, p.bins.elevation, p.error.energy, p.error.l1,
                       p.error.shift_mm, p.gather_ms, p.raster_ms);
  return out;
}

// For people, what tradeoff.csv says.
std::string table_of(const SonarTradeoff& t, const std::string& scene) {
  std::string out = fmt::format(
      "## {}\n\n| sweep | gather | normals | pixels a cell | bins | energy | sum of differences | "
      "range, mm | gather, ms | raster, ms |\n|---|---|---|---|---|---|---|---|---|---|\n",
      scene);
  for (const Point& p : t.points)
    if (p.scene == scene)
      out += fmt::format(
          "| {} | {} | {} | {:g} | {} x {} x {} | {:.2f} % | {:.2f} % | {:.2f} | "
          "{:.2f} | {} |\n",
          p.sweep, p.gather, p.normals, p.scale, p.bins.range, p.bins.azimuth, p.bins.elevation,
          100.0 * p.error.energy, 100.0 * p.error.l1, p.error.shift_mm, p.gather_ms,
          p.raster_ms > 0.0 ? fmt::format("{:.2f}", p.raster_ms) : "");
  return out;
}

// The knee of a gather's curve over resolution: error by l1, cost in milliseconds. A finer G-buffer
// cannot cost less than a coarser one: where it seems so, something else slowed the coarser down.
const Point* knee(const SonarTradeoff& t, const std::string& scene, const std::string& gather) {
  const auto points = select(t, scene, "resolution", gather);
  if (points.empty()) return nullptr;
  std::vector<double> cost, error;
  for (const Point* p : points) {
    cost.push_back(p->cost_ms());
    error.push_back(p->error.l1);
  }
  for (std::size_t i = cost.size() - 1; i-- > 0;) cost[i] = std::min(cost[i], cost[i + 1]);
  return points[knee_of(cost, error)];
}

// Short enough to stand under a bar.
std::string bar_name(const Point& p) {
  if (p.sweep == "bins")
    return p.bins.range == p.bins.elevation
               ? fmt::format("{} bins", p.bins.range)
               : fmt::format("{}, {} up", p.bins.range, p.bins.elevation);
  if (p.normals == "octahedral 16") return "oct 16";
  return p.normals == "rgb 8 gamma 2.2" ? "rgb 8 g" : p.normals;
}

nlohmann::json json_of(const Point& p) {
  return {{"gather", p.gather},
          {"gbuffer_scale", p.scale},
          {"gbuffer", {p.width, p.height}},
          {"normals", p.normals},
          {"bins", {p.bins.range, p.bins.azimuth, p.bins.elevation}},
          {"error_energy", p.error.energy},
          {"error_l1", p.error.l1},
          {"error_range_mm", p.error.shift_mm},
          {"gather_ms", p.gather_ms},
          {"raster_ms", p.raster_ms}};
}

nlohmann::json summary_of(const SonarTradeoff& t, const std::vector<std::string>& scenes) {
  nlohmann::json json{
      {"device", t.device},
      {"truth",
       fmt::format("mean over {} rays a (theta, phi) cell of the finest bins", t.rays_a_cell)},
      {"errors",
       {{"error_energy", "total energy over the truth's, less 1"},
        {"error_l1", "sum of absolute differences over the truth's total"},
        {"error_range_mm", "mean way that energy must move along range, by column"}}},
      {"cost", "least GPU time of the sonar's passes; raster_ms: of the G-buffer by the renderer"}};
  for (const std::string& scene : scenes) {
    nlohmann::json knees = nlohmann::json::object();
    for (const char* gather : kGatherNames)
      if (const Point* p = knee(t, scene, gather)) knees[gather] = json_of(*p);
    json["scenes"][scene] = {{"knee", knees}};
  }
  // The default: the plane gather's knee in the first scene.
  if (const Point* p = knee(t, scenes.front(), "plane")) json["knee"] = json_of(*p);
  return json;
}

using Value = double (*)(const Point&);

std::vector<Series> series_of(const SonarTradeoff& t, const std::string& scene, Value x, Value y,
                              bool noted) {
  std::vector<Series> out;
  const auto add = [&](const std::string& name, const std::vector<const Point*>& points) {
    if (points.empty()) return;
    Series s{name, kSeriesColors[out.size()], {}, {}, {}};
    for (const Point* p : points) {
      s.x.push_back(x(*p));
      s.y.push_back(y(*p));
      if (noted && name == "plane") s.notes.push_back(fmt::format("{:g}", p->scale));
    }
    out.push_back(std::move(s));
  };
  for (const char* gather : kGatherNames) add(gather, select(t, scene, "resolution", gather));
  add("plane, renderer's images", select(t, scene, "renderer", ""));
  return out;
}

void draw_curve(draw2d::Canvas& canvas, const Box& box, const SonarTradeoff& t,
                const std::string& scene, const std::string& title, Axis x, Axis y, Value fx,
                Value fy, bool mark) {
  const auto series = series_of(t, scene, fx, fy, mark);
  std::vector<double> xs, ys;
  for (const Series& s : series) {
    xs.insert(xs.end(), s.x.begin(), s.x.end());
    ys.insert(ys.end(), s.y.begin(), s.y.end());
  }
  x = axis_for(x.label, xs, x.log);
  y = axis_for(y.label, ys, y.log);
  draw_lines(canvas, box, title, x, y, series, !mark);
  const Point* p = mark ? knee(t, scene, "plane") : nullptr;
  if (p != nullptr)
    draw_mark(canvas, box, x, y, fx(*p), fy(*p), fmt::format("knee: {:g} pixels a cell", p->scale));
}

ImageU8 plot_of(const SonarTradeoff& t, const std::vector<std::string>& scenes) {
  constexpr double kWidth = 640, kHeight = 460, kTop = 64;
  draw2d::Canvas canvas(
      1920, static_cast<std::uint32_t>(kTop + kHeight * static_cast<double>(scenes.size())),
      kPaper);
  canvas.text(24, 34, 18, "Imaging sonar: error against cost", kInk, draw2d::Align::kLeft,
              draw2d::Face::kBold);
  canvas.text(24, 54, 10,
              fmt::format("{}; truth: {} rays a cell; labels: G-buffer pixels a cell", t.device,
                          t.rays_a_cell),
              kInk.with_alpha(0.7f));
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const double top = kTop + kHeight * static_cast<double>(i);
    const auto box = [&](int column) {
      return Box{kWidth * column, top, kWidth * (column + 1), top + kHeight};
    };
    const std::string& scene = scenes[i];
    draw_curve(
        canvas, box(0), t, scene, scene + ": image error over cost",
        {"ms, raster (where known) and gather", 0, 0, true},
        {"sum of differences / energy", 0, 0, false}, [](const Point& p) { return p.cost_ms(); },
        [](const Point& p) { return p.error.l1; }, true);
    draw_curve(
        canvas, box(1), t, scene, scene + ": energy over resolution",
        {"G-buffer pixels a cell", 0, 0, true}, {"total energy / truth, less 1", 0, 0, false},
        [](const Point& p) { return p.scale; }, [](const Point& p) { return p.error.energy; },
        false);
    std::vector<Bar> bars;
    for (const Point* p : select(t, scene, "normals", "plane"))
      bars.push_back({bar_name(*p), kSeriesColors[1], p->error.l1});
    for (const Point* p : select(t, scene, "bins", "plane"))
      bars.push_back({bar_name(*p), kSeriesColors[2], p->error.l1});
    draw_bars(canvas, box(2), scene + ": normals and bins (plane gather, 0.5 pixels a cell)",
              "sum of differences / energy", bars);
  }
  return canvas.take();
}

std::string plain_markdown(const SonarTradeoff& t, const std::vector<std::string>& scenes) {
  std::string out = fmt::format(
      "# Imaging sonar, the plain cosine: error against cost\n\n{}; truth: {} rays a cell of the "
      "finest bins. Energy: over the truth's, less 1. Range: how far energy must move.\n\n",
      t.device, t.rays_a_cell);
  for (const std::string& scene : scenes) {
    out += table_of(t, scene);
    if (const Point* p = knee(t, scene, "plane"))
      out += fmt::format("\nThe plane gather's knee: {:g} pixels a cell.\n\n", p->scale);
  }
  return out +
         fmt::format("The default: plane, {:g} pixels a cell.\n", scene::Sonar{}.gbuffer_scale);
}

}  // namespace

Status write_plain(const std::filesystem::path& folder, const SonarTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  std::vector<std::string> scenes;
  for (const Point& p : tradeoff.points)
    if (std::find(scenes.begin(), scenes.end(), p.scene) == scenes.end()) scenes.push_back(p.scene);
  NERITIC_TRY_STATUS(write_text(folder / "tradeoff.csv", csv_of(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "plain.md", plain_markdown(tradeoff, scenes)));
  NERITIC_TRY_STATUS(scene::write_png8(folder / "tradeoff.png", plot_of(tradeoff, scenes)));
  return write_json(folder / "tradeoff.json", summary_of(tradeoff, scenes));
}

}  // namespace neritic::tools
