// The output of `neritic tradeoff sonar` (sonar_tradeoff.hpp).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
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

// A curve a gather, and one of the renderer's own images; resolutions stand beside the default's.
Panel gather_panel(const SonarTradeoff& t, const std::string& scene, const std::string& title,
                   const Axis& x, const Axis& y, Value fx, Value fy, bool noted) {
  Panel panel{title, x, y};
  const auto add = [&](const std::string& name, const std::vector<const Point*>& points) {
    if (points.empty()) return;
    Series s{name, {}, {}};
    for (const Point* p : points) {
      s.x.push_back(fx(*p));
      s.y.push_back(fy(*p));
      if (noted && name == "plane") s.notes.push_back(fmt::format("{:g}", p->scale));
      if (name == "plane" && p->scale == scene::Sonar{}.gbuffer_scale)
        panel.marks.push_back({fx(*p), fy(*p), fmt::format("default: {:g}", p->scale)});
    }
    panel.series.push_back(std::move(s));
  };
  for (const char* gather : kGatherNames) add(gather, select(t, scene, "resolution", gather));
  add("plane, renderer's images", select(t, scene, "renderer", ""));
  const Point* best = knee(t, scene, "plane");
  if (noted && best != nullptr)
    panel.marks.push_back(
        {fx(*best), fy(*best), fmt::format("knee: {:g} pixels a cell", best->scale)});
  return panel;
}

Page plain_page(const SonarTradeoff& t, const std::vector<std::string>& scenes) {
  Page page{
      "Imaging sonar: error against cost",
      {fmt::format("{}. Truth: {} rays a cell. Numbers beside points: G-buffer pixels a cell.",
                   t.device, t.rays_a_cell)},
      3};
  for (const std::string& scene : scenes) {
    page.panels.push_back(gather_panel(
        t, scene, scene + ": image error over cost", {"ms, raster (where known) and gather"},
        {"sum of differences / energy", false}, [](const Point& p) { return p.cost_ms(); },
        [](const Point& p) { return p.error.l1; }, true));
    page.panels.push_back(gather_panel(
        t, scene, scene + ": energy over resolution", {"G-buffer pixels a cell"},
        {"total energy / truth, less 1", false}, [](const Point& p) { return p.scale; },
        [](const Point& p) { return p.error.energy; }, false));
    Panel bars{scene + ": plane, 0.5 pixels a cell", {""}, {"sum of differences / energy"}};
    for (const char* sweep : {"normals", "bins"})
      for (const Point* p : select(t, scene, sweep, "plane"))
        bars.bars.push_back({bar_name(*p), sweep, p->error.l1});
    page.panels.push_back(std::move(bars));
  }
  return page;
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

Result<bool> write_plain(const std::filesystem::path& folder, const SonarTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  std::vector<std::string> scenes;
  for (const Point& p : tradeoff.points)
    if (std::find(scenes.begin(), scenes.end(), p.scene) == scenes.end()) scenes.push_back(p.scene);
  NERITIC_TRY_STATUS(write_text(folder / "tradeoff.csv", csv_of(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "plain.md", plain_markdown(tradeoff, scenes)));
  NERITIC_TRY_STATUS(write_json(folder / "tradeoff.json", summary_of(tradeoff, scenes)));
  return write_picture(folder / "tradeoff.png", page_data(plain_page(tradeoff, scenes)));
}

}  // namespace neritic::tools
