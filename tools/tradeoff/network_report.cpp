// The output of `neritic tradeoff network` (network_tradeoff.hpp).
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/network_tradeoff.hpp"

namespace neritic::tools {
namespace {

constexpr const char* kVaried[] = {"delay", "jitter", "loss"};

double varied_of(const NetworkPoint& p) {
  if (p.varied == "delay") return p.delay_ms;
  return p.varied == "jitter" ? p.jitter_ms : p.loss_percent;
}

std::string network_csv(const NetworkTradeoff& t) {
  std::string out =
      "varied,delay_ms,jitter_ms,loss_percent,joints_deg,leg_deg,astray_m,way_m,follow_m,"
      "follow_rms_m,silent_percent\n";
  for (const NetworkPoint& p : t.points)
    out += fmt::format("{},{:g},{:g},{:g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g}\n",
                       p.varied, p.delay_ms, p.jitter_ms, p.loss_percent, p.joints_deg, p.leg_deg,
                       p.astray_m, p.way_m, p.follow_m, p.follow_rms_m, p.silent_percent);
  return out;
}

std::string network_md(const NetworkTradeoff& t) {
  std::string out = fmt::format(
      "# Network: tracking error against delay, jitter and loss\n\nA person swims for {:g} s by "
      "what he sees of his diver, through a simulated suit at 240 Hz with the other devices. "
      "Joints: the diver's less the person's at that instant. Astray: rms distance from the same "
      "dive without a network. Robot: rms change of its distance to the diver that it follows.\n",
      t.dive_s);
  for (const char* varied : kVaried) {
    out += fmt::format(
        "\n| {}, {} | joints, degrees rms | largest leg joint, degrees rms | astray, m | way, m | "
        "robot, m away | its change, m rms | autopilot, % |\n|---|---|---|---|---|---|---|---|\n",
        varied, std::string(varied) == "loss" ? "%" : "ms");
    for (const NetworkPoint& p : t.points)
      if (p.varied == varied)
        out +=
            fmt::format("| {:g} | {:.2f} | {:.2f} | {:.3f} | {:.1f} | {:.2f} | {:.3f} | {:.1f} |\n",
                        varied_of(p), p.joints_deg, p.leg_deg, p.astray_m, p.way_m, p.follow_m,
                        p.follow_rms_m, p.silent_percent);
  }
  return out;
}

nlohmann::json network_json(const NetworkTradeoff& t) {
  nlohmann::json json{{"dive_s", t.dive_s}, {"points", nlohmann::json::array()}};
  for (const NetworkPoint& p : t.points)
    json["points"].push_back({{"varied", p.varied},
                              {"delay_ms", p.delay_ms},
                              {"jitter_ms", p.jitter_ms},
                              {"loss_percent", p.loss_percent},
                              {"joints_deg", p.joints_deg},
                              {"leg_deg", p.leg_deg},
                              {"astray_m", p.astray_m},
                              {"way_m", p.way_m},
                              {"follow_m", p.follow_m},
                              {"follow_rms_m", p.follow_rms_m},
                              {"silent_percent", p.silent_percent}});
  return json;
}

Series network_series(const NetworkTradeoff& t, const std::string& varied, const std::string& name,
                      double NetworkPoint::*value) {
  Series series{name, {}, {}};
  for (const NetworkPoint& p : t.points)
    if (p.varied == varied) {
      series.x.push_back(varied_of(p));
      series.y.push_back(p.*value);
    }
  return series;
}

Page network_page(const NetworkTradeoff& t) {
  Page page{"Through a network: tracking error",
            {fmt::format("{:g} s of swimming by a simulated suit at 240 Hz; the person sees the "
                         "diver, a robot follows.",
                         t.dive_s)}};
  for (const std::string varied : kVaried) {
    const std::string label = varied == "loss" ? "packets lost, %" : varied + ", ms";
    Panel joints{"Limbs over " + varied, {label, false}, {"degrees rms", false}};
    joints.series = {network_series(t, varied, "all joints", &NetworkPoint::joints_deg),
                     network_series(t, varied, "largest leg joint", &NetworkPoint::leg_deg)};
    Panel places{"Places over " + varied, {label, false}, {"metres rms", false}};
    places.series = {network_series(t, varied, "diver astray", &NetworkPoint::astray_m),
                     network_series(t, varied, "robot's distance", &NetworkPoint::follow_rms_m)};
    page.panels.push_back(std::move(joints));
    page.panels.push_back(std::move(places));
  }
  return page;
}

}  // namespace

Result<bool> write_network_tradeoff(const std::filesystem::path& folder,
                                    const NetworkTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "network.csv", network_csv(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "network.md", network_md(tradeoff)));
  NERITIC_TRY_STATUS(write_json(folder / "network.json", network_json(tradeoff)));
  return write_picture(folder / "network.png", page_data(network_page(tradeoff)));
}

}  // namespace neritic::tools
