#include "testbed/view/gauge_panel.hpp"

#include <algorithm>
#include <cmath>

#include "hud/numbers.hpp"
#include "rov/frames.hpp"
#include "testbed/view/panel_frame.hpp"

namespace neritic::testbed {
namespace {

constexpr double kLowCharge = 0.2;
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

// From the left; in the colour of alarms below a fifth.
void charge_bar(ImDrawList& list, ImVec2 from, ImVec2 size, double charge) {
  list.AddRectFilled(from, ImVec2(from.x + size.x, from.y + size.y), kPaper);
  list.AddRectFilled(from, ImVec2(from.x + size.x * static_cast<float>(charge), from.y + size.y),
                     charge < kLowCharge ? kAlarm : kMark);
}

std::string battery_words(const VehicleGauges::Battery& battery) {
  if (battery.charge <= 0.0) return fmt::format("battery empty, {:.1f} V", battery.voltage_v);
  const double left_min = battery.left_s / 60.0;
  return fmt::format(
      "battery {:.0f} %, {:.1f} V, {}", 100.0 * battery.charge, battery.voltage_v,
      left_min < 600.0 ? fmt::format("{:.0f} min", std::floor(left_min)) : std::string("hours"));
}

}  // namespace

VehicleGauges gauges_of(const PhysicsWorld& world, const PhysicsState& state, std::size_t index) {
  const PhysicsVehicle& vehicle = world.vehicles()[index];
  const rov::State& body = state.vehicles()[index].body;
  VehicleGauges out{.name = vehicle.name,
                    .depth_m = body.position_ned_m.z,
                    .heading_rad = rov::heading_of(body.attitude),
                    .speed_m_s = glm::length(body.velocity.linear())};
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
  if (vehicle.tether) {
    const TetherState* line = &state.tethers()[*vehicle.tether];
    out.tether_n = line->end_n;
    out.tether_used = glm::distance(line->top_ned_m, line->end_ned_m) / line->length_m;
    out.tether_touching = line->touching;
  }
  if (const rov::BatteryState* now = world.battery(state, index))
    out.battery = {now->voltage_v, now->charge,
                   rov::battery_left_s(*vehicle.file.parameters.battery, *now)};
  return out;
}

std::string tether_words(const VehicleGauges& gauges, hud::Units units) {
  return fmt::format("tether {}, {:.0f} % of its length out{}", force_text(gauges.tether_n, units),
                     100.0 * gauges.tether_used, gauges.tether_touching > 0 ? ", it touches" : "");
}

PanelWish gauges_wish(const VehicleGauges& gauges) {
  const auto rows = static_cast<float>(gauges.thrust.size()) + (gauges.tether_used > 0.0 ? 1 : 0) +
                    (gauges.battery ? 2 : 0);
  return {.wanted = kFrame_px + rows * kRow_px, .least = kFrame_px + 2.0f * kRow_px};
}

void draw_gauges(const VehicleGauges& gauges, const PanelRect& rect, hud::Units units,
                 float scale) {
  begin_panel(gauges.name + "###gauges", rect, scale);
  text_line(fmt::format("{}   {}\u00b0   {}", length_text(gauges.depth_m, 2, units),
                        hud::heading_text(gauges.heading_rad).view(),
                        speed_text(gauges.speed_m_s, units)));
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
  if (gauges.tether_used > 0.0) text_line(tether_words(gauges, units));
  if (gauges.battery) {
    text_line(battery_words(*gauges.battery));
    charge_bar(list, ImGui::GetCursorScreenPos(),
               ImVec2(ImGui::GetContentRegionAvail().x, 0.5f * line), gauges.battery->charge);
    ImGui::Dummy(ImVec2(0.0f, 0.5f * line));
  }
  ImGui::End();
}

}  // namespace neritic::testbed
