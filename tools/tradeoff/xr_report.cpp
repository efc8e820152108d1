// The output of `neritic tradeoff xr` (xr_tradeoff.hpp).
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/xr_tradeoff.hpp"

namespace neritic::tools {
namespace {

// A logarithmic axis has no zero: smaller errors are drawn as this.
constexpr double kLeastLevels = 0.05;

// dB below the largest level; infinite where nothing is off.
double psnr_db(double error) {
  return 20.0 * std::log10(255.0 / error);
}

std::string psnr_words(double error) {
  return error > 0.0 ? fmt::format("{:.1f}", psnr_db(error)) : "exact";
}

std::string xr_csv(const XrTradeoff& t) {
  std::string out = "what,views,scale,focus_deg,mpixels,ms,error,fovea_error\n";
  for (const XrPoint& p : t.points)
    out += fmt::format("picture,{},{:g},{:g},{:.3f},{:.3f},{:.4f},{:.4f}\n", p.views, p.scale,
                       p.focus_deg, p.mpixels, p.ms, p.error, p.fovea_error);
  out += "what,rate_hz,late_m,ms_a_second\n";
  for (const HudRatePoint& p : t.hud)
    out += fmt::format("hud,{:g},{:.4f},{:.4f}\n", p.rate_hz, p.late_m, p.ms_a_second);
  return out;
}

std::string xr_md(const XrTradeoff& t) {
  std::string out = fmt::format(
      "# A headset's pictures: error over cost\n\n{}; {} x {} pixels an eye at full resolution. "
      "Errors are against both eyes at full resolution, stretched to it; the fovea's are weighted "
      "by the eye's acuity around the middle.\n\n| views | scale | sharp within, degrees | "
      "megapixels | device, ms | PSNR, dB | PSNR of the fovea, dB "
      "|\n|---|---|---|---|---|---|---|\n",
      t.device, t.side_px, t.side_px);
  for (const XrPoint& p : t.points)
    out += fmt::format("| {} | {:g} | {} | {:.2f} | {:.2f} | {} | {} |\n", p.views, p.scale,
                       p.focus_deg > 0.0 ? fmt::format("{:g}", p.focus_deg) : "", p.mpixels, p.ms,
                       psnr_words(p.error), psnr_words(p.fovea_error));
  out +=
      "\n## Instruments by their rate, at an ascent of 18 m a minute\n\n| Hz | depth is late by, m "
      "| one core, ms a second |\n|---|---|---|\n";
  for (const HudRatePoint& p : t.hud)
    out += fmt::format("| {:g} | {:.3f} | {:.2f} |\n", p.rate_hz, p.late_m, p.ms_a_second);
  return out;
}

nlohmann::json xr_json(const XrTradeoff& t) {
  nlohmann::json json{{"device", t.device}, {"side_px", t.side_px}};
  for (const XrPoint& p : t.points)
    json["pictures"].push_back({{"views", p.views},
                                {"scale", p.scale},
                                {"focus_deg", p.focus_deg},
                                {"mpixels", p.mpixels},
                                {"ms", p.ms},
                                {"error_levels", p.error},
                                {"fovea_error_levels", p.fovea_error}});
  for (const HudRatePoint& p : t.hud)
    json["hud"].push_back(
        {{"rate_hz", p.rate_hz}, {"late_m", p.late_m}, {"ms_a_second", p.ms_a_second}});
  return json;
}

// A curve for two views over resolution, one for each resolution of the wide views of four.
Panel error_panel(const XrTradeoff& t, const std::string& title, double XrPoint::*error) {
  Panel panel{title, {"device, ms a frame"}, {"error, levels of 255 rms"}};
  const auto add = [&](const std::string& name, auto belongs, auto note) {
    Series series{name, {}, {}};
    for (const XrPoint& p : t.points) {
      if (!belongs(p)) continue;
      series.x.push_back(p.ms);
      series.y.push_back(std::max(p.*error, kLeastLevels));
      series.notes.push_back(note(p));
    }
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  };
  const auto scale_note = [](const XrPoint& p) { return fmt::format("{:g}", p.scale); };
  add(
      "two views, by scale", [](const XrPoint& p) { return p.views == "two"; }, scale_note);
  add(
      "one view for both eyes", [](const XrPoint& p) { return p.views == "one"; }, scale_note);
  std::vector<double> scales;
  for (const XrPoint& p : t.points)
    if (p.views == "four" && std::ranges::find(scales, p.scale) == scales.end())
      scales.push_back(p.scale);
  for (const double scale : scales)
    add(
        fmt::format("four views, wide ones at {:g}", scale),
        [scale](const XrPoint& p) { return p.views == "four" && p.scale == scale; },
        [](const XrPoint& p) { return fmt::format("{:g}\u00b0", p.focus_deg); });
  return panel;
}

Page xr_page(const XrTradeoff& t) {
  Page page{"A headset's pictures and instruments: error over cost",
            {fmt::format("{}, {} x {} pixels an eye", t.device, t.side_px, t.side_px)}};
  page.panels.push_back(error_panel(t, "Weighted by the fovea", &XrPoint::fovea_error));
  page.panels.push_back(error_panel(t, "All of the picture", &XrPoint::error));
  Panel hud{"Instruments by their rate", {"one core, ms a second"}, {"depth is late by, m"}};
  Series series{"wrist layout, ascent of 18 m a minute", {}, {}};
  for (const HudRatePoint& p : t.hud) {
    series.x.push_back(std::max(p.ms_a_second, 1e-3));
    series.y.push_back(p.late_m);
    series.notes.push_back(fmt::format("{:g} Hz", p.rate_hz));
    if (p.rate_hz == 5.0) hud.marks.push_back({series.x.back(), p.late_m, "default"});
  }
  hud.series.push_back(std::move(series));
  page.panels.push_back(std::move(hud));
  return page;
}

}  // namespace

Result<bool> write_xr_tradeoff(const std::filesystem::path& folder, const XrTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "xr.csv", xr_csv(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "xr.md", xr_md(tradeoff)));
  NERITIC_TRY_STATUS(write_json(folder / "xr.json", xr_json(tradeoff)));
  return write_picture(folder / "xr.png", page_data(xr_page(tradeoff)));
}

}  // namespace neritic::tools
