#include "testbed/view/gauge_panel.hpp"

#include <algorithm>
#include <cmath>

#include "rov/frames.hpp"
#include "testbed/view/panel_frame.hpp"

namespace neritic::testbed {
namespace {

constexpr float kRow_px = 20.0f, kFrame_px = 84.0f;

// From the middle to the right ahead, to the left astern.
void thrust_bar(ImDrawList& list, ImVec2 from, ImVec2 size, double share, bool failed) {
  const ImVec2 to(from.x + size.x, from.y + size.y);
  const float middle = from.x + 0.5f * size.x;
  list.AddRectFilled(from, to, kPaper);
  const float end = middle + 0.5f * size.x * static_cast<float>(std::clamp(share, -1.0, 1.0));
  list.AddRectFilled(ImVec2(std::min(middle, end), from.y), ImVec2(std::max(middle, end), to.y),
                     failed ? kAlarm : kMark);
  list.AddLine(ImVec2(middle, from.y), ImVec2(middle, to.y), kInk);
}

}  // namespace

VehicleGauges gauges_of(const PhysicsVehicle& vehicle, const VehicleState& state,
                        const TetherState* line) {
  const rov::State& body = state.body;
  VehicleGauges out{.name = vehicle.name,
                    .depth_m = body.position_ned_m.z,
                    .heading_deg = degrees(rov::heading_of(body.attitude)),
                    .speed_m_s = glm::length(body.velocity.linear())};
  if (out.heading_deg < 0.0) out.heading_deg += 360.0;
  const auto forces = rov::thruster_forces(vehicle.vehicle, body, body.held);
  for (std::size_t i = 0; i < vehicle.file.parameters.thrusters.size(); ++i) {
    const rov::Thruster& thruster = vehicle.file.parameters.thrusters[i];
    const double limit_n = forces[i] < 0.0 ? -thruster.min_n : thruster.max_n;
    out.thrust.push_back(limit_n > 0.0 ? forces[i] / limit_n : 0.0);
    out.failed.push_back((body.held.failed_thrusters >> i & 1) != 0);
  }
  if (const auto& tether = vehicle.vehicle.tether) {
    const Vec3 at = body.position_ned_m + body.attitude * tether->attachment_m;
    const Vec3 velocity =
        body.attitude *
        (body.velocity.linear() + glm::cross(body.velocity.angular(), tether->attachment_m));
    const Vec3& anchor = body.held.tether_anchor_ned_m;
    out.tether_n =
        glm::length(rov::tether_force_n(*tether, anchor, at, velocity, body.held.current_ned_m_s));
    out.tether_used = glm::distance(at, anchor) / tether->length_m;
  }
  if (line) {
    out.tether_n = line->end_n;
    out.tether_used = glm::distance(line->top_ned_m, line->end_ned_m) / line->length_m;
    out.tether_touching = line->touching;
  }
  return out;
}

PanelWish gauges_wish(const VehicleGauges& gauges) {
  const auto rows = static_cast<float>(gauges.thrust.size()) + (gauges.tether_used > 0.0 ? 1 : 0);
  return {.wanted = kFrame_px + rows * kRow_px, .least = kFrame_px + 2.0f * kRow_px};
}

void draw_gauges(const VehicleGauges& gauges, const PanelRect& rect, float scale) {
  begin_panel(gauges.name + "###gauges", rect, scale);
  text_line(fmt::format("{:.2f} m   {:03.0f}\u00b0   {:.2f} m/s", gauges.depth_m,
                        std::fmod(std::round(gauges.heading_deg), 360.0), gauges.speed_m_s));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeight(), label = 70.0f * scale;
  for (std::size_t i = 0; i < gauges.thrust.size(); ++i) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    text_line(gauges.failed[i] ? fmt::format("{} failed", i + 1)
                               : fmt::format("{}  {:+.0f} %", i + 1, 100.0 * gauges.thrust[i]));
    const float width = ImGui::GetContentRegionAvail().x - label;
    thrust_bar(list, ImVec2(from.x + label, from.y), ImVec2(width, line), gauges.thrust[i],
               gauges.failed[i]);
  }
  if (gauges.tether_used > 0.0)
    text_line(fmt::format("tether {:.0f} N, {:.0f} % of its length out{}", gauges.tether_n,
                          100.0 * gauges.tether_used,
                          gauges.tether_touching > 0 ? ", it touches" : ""));
  ImGui::End();
}

}  // namespace neritic::testbed
