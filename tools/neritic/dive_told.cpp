#include "tools/neritic/dive_told.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "diver/gas_label.hpp"
#include "engine/core/json.hpp"
#include "engine/core/log.hpp"
#include "rov/frames.hpp"
#include "testbed/samples/authority_words.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

std::string touch_words(std::uint64_t steps) {
  return steps == 0 ? "touched nothing" : fmt::format("touched something in {} steps", steps);
}

// When a navigation was lost and began anew; empty: never.
std::string lost_words(const std::vector<double>& anew_s) {
  if (anew_s.empty()) return {};
  return fmt::format("NAVIGATION LOST, begun anew at {:.1f} s{}, ", anew_s.front(),
                     anew_s.size() == 1 ? std::string()
                                        : fmt::format(" and {} times more, the last at {:.1f} s",
                                                      anew_s.size() - 1, anew_s.back()));
}

std::string vehicle_line(const PhysicsVehicle& vehicle, const VehicleState& state,
                         const DiveFigures& figures) {
  std::string line = vehicle.name + ": ";
  if (vehicle.mission && vehicle.mission->waypoint_count() > 0) {
    line +=
        fmt::format("{} of {} waypoints", state.mission.arrived, vehicle.mission->waypoint_count());
    if (!figures.arrivals_s.empty())
      line +=
          fmt::format(" (the last after {:.1f} s{})", figures.arrivals_s.back(),
                      vehicle.navigation ? fmt::format(", truly off by up to {:.2f} m",
                                                       *std::ranges::max_element(figures.misses_m))
                                         : std::string());
    line += ", ";
  }
  line += fmt::format(
      "{:.2f} m of way, up to {:.2f} m/s, {:.1f} to {:.1f} m deep, tilted up to {:.1f} degrees, ",
      figures.path_m, figures.largest_speed_m_s, figures.shallowest_m, figures.deepest_m,
      degrees(figures.largest_tilt_rad));
  if (figures.largest_navigation_error_m)
    line += fmt::format("navigation off by up to {:.2f} m ({:.2f} m at the end), ",
                        *figures.largest_navigation_error_m, *figures.navigation_error_m);
  line += lost_words(figures.navigation_anew_s);
  if (figures.battery_empty_from_s)
    line += fmt::format("BATTERY EMPTY from {:.1f} s on, ", *figures.battery_empty_from_s);
  else if (figures.battery_charge)
    line += fmt::format("battery at {:.0f} %, ", 100.0 * *figures.battery_charge);
  line += touch_words(state.contact.touched_steps);
  if (state.body.refused_inputs > 0)
    line += fmt::format(", {} inputs refused", state.body.refused_inputs);
  return line + "\n";
}

std::string gas_words(const PhysicsHuman& human, const HumanFigures& figures) {
  if (!(figures.out_of_gas_s > 0.0)) return {};
  return fmt::format("NO GAS for {:.0f} s, from {:.0f} s on, out of {} ({:.0f} s at a stretch); ",
                     figures.out_of_gas_s, figures.out_of_gas_from_s,
                     tank_words(human, figures.out_of_gas_tank), figures.out_of_gas_longest_s);
}

// One line for each danger that there was.
std::string warning_lines(const PhysicsHuman& human, const HumanFigures& figures) {
  std::string lines;
  if (figures.ascent_alarm != diver::AscentAlarm::kNone)
    lines += fmt::format("{}: ASCENT TOO FAST, {:.0f} m/min at {:.0f} s: {} alarm for {:.0f} s\n",
                         human.name, figures.fastest_ascent_m_min, figures.fastest_ascent_at_s,
                         name_of(figures.ascent_alarm), figures.ascent_alarm_s);
  if (figures.above_ceiling_m > 0.0)
    lines += fmt::format("{}: CEILING VIOLATED from {:.0f} s on, by up to {:.1f} m\n", human.name,
                         figures.above_ceiling_from_s, figures.above_ceiling_m);
  if (figures.oxygen >= diver::RiskLevel::kHigh)
    lines += fmt::format("{}: OXYGEN RISK {} from {:.0f} s on: {:.2f} to {:.2f} bar breathed\n",
                         human.name, name_of(figures.oxygen), figures.oxygen_from_s,
                         figures.least_po2_bar, figures.most_po2_bar);
  return lines;
}

// The changes of tanks, with time and depth; empty: none.
std::string change_lines(const PhysicsHuman& human, const HumanFigures& figures) {
  constexpr std::size_t kTold = 8;
  if (figures.tank_changes.empty()) return {};
  std::string line;
  for (std::size_t i = 0; i < std::min(kTold, figures.tank_changes.size()); ++i) {
    const TankChange& change = figures.tank_changes[i];
    line += fmt::format("{} to {} at {:.0f} s, {:.1f} m deep ({:.2f} bar of oxygen)",
                        i == 0 ? ": changes" : ",", tank_words(human, change.to), change.time_s,
                        change.depth_m, change.po2_bar);
  }
  if (figures.tank_changes.size() > kTold)
    line += fmt::format(" and {} times more", figures.tank_changes.size() - kTold);
  return human.name + line + "\n";
}

std::string human_line(const PhysicsHuman& human, const HumanPhysics& state,
                       const HumanFigures& figures) {
  const diver::GasReading gas = diver::read_gas(human.body, state.human);
  const diver::AscentGas ascent = gas_for_ascent(human, state);
  const diver::DiveComputerView& deco = ascent.view;
  std::string line = human.name + ": " + gas_words(human, figures);
  if (!human.waypoints_ned_m.empty())
    line += fmt::format("{} of {} waypoints, ", state.arrived, human.waypoints_ned_m.size());
  line += fmt::format(
      "{:.2f} m of way, up to {:.2f} m/s, {:.1f} to {:.1f} m deep, {:.0f} bar left, {:.0f} l/min, ",
      figures.path_m, figures.largest_speed_m_s, figures.shallowest_m, figures.deepest_m,
      1e-5 * gas.tank_pa, gas.ventilation_l_min);
  line += deco.ceiling_m > 0.0 ? fmt::format("ceiling {:.1f} m, ", deco.ceiling_m)
          : std::isfinite(deco.no_stop_min)
              ? fmt::format("{:.0f} min without stops, ", deco.no_stop_min)
              : std::string("no limit to the time without stops, ");
  if (deco.ceiling_violated) line += "which is violated, ";
  if (!ascent.enough())
    line += fmt::format("NOT ENOUGH GAS: the way up takes {:.0f} l of {}'s {:.0f}, ",
                        ascent.needed_l, tank_words(human, state.human.held.tank), ascent.there_l);
  line += touch_words(state.contact.touched_steps);
  if (state.human.refused_inputs > 0)
    line += fmt::format(", {} inputs refused", state.human.refused_inputs);
  return line + "\n" + change_lines(human, figures) + warning_lines(human, figures);
}

std::string modem_line(const std::string& name, const sonar::ModemCounts& counts) {
  std::string line =
      fmt::format("{}: modem: {} messages sent, {} received", name, counts.sent, counts.received);
  for (const auto& [count, words] : {std::pair(counts.refused, "not sent"),
                                     {counts.too_weak, "lost: too weak"},
                                     {counts.noisy, "lost in noise"},
                                     {counts.collided, "lost to others"},
                                     {counts.was_sending, "lost while it sent"}})
    if (count > 0) line += fmt::format(", {} {}", count, words);
  return line + "\n";
}

// How often a modem that ranges found its target; how many requests a modem did not answer.
std::string ranging_line(const Modems& modems, std::size_t i, const ModemTasks& tasks) {
  const PhysicsModem& modem = modems.all()[i];
  std::string out;
  if (modem.ranging)
    out = fmt::format("{}: usbl: {} fixes of {}, {} requests without an answer in time\n",
                      modem.name, tasks.fixes, modems.all()[modem.target].name, tasks.misses);
  if (tasks.unanswered > 0)
    out += fmt::format("{}: modem: {} requests not answered, as it owed {} answers\n", modem.name,
                       tasks.unanswered, ModemTasks::kOwed);
  return out;
}

// A line a live source of which samples were lost, dropped or refused.
std::string source_lines(const SampleInbox& inbox) {
  std::string lines;
  const auto names = inbox.source_names();
  for (SourceId id = 0; id < names.size(); ++id) {
    const SourceCounts counts = inbox.counts(id);
    if (!in_trouble(counts)) continue;
    lines +=
        fmt::format("source {}: {} samples taken", names[id], counts.accepted - counts.dropped);
    for (const auto& [count, words] : {std::pair(counts.lost, "lost"),
                                       {counts.dropped, "dropped"},
                                       {counts.late, "late"},
                                       {counts.repeated, "repeated"},
                                       {counts.out_of_order, "out of order"},
                                       {counts.not_finite, "not finite"},
                                       {counts.not_plausible, "not plausible"},
                                       {counts.not_of_stream, "not of their stream"}})
      if (count > 0) lines += fmt::format(", {} {}", count, words);
    lines += "\n";
  }
  if (const auto unknown = inbox.unknown_sources(); unknown > 0)
    lines += fmt::format("{} samples of unknown sources refused\n", unknown);
  return lines;
}

// A line a group of inputs whose live source fell silent, never spoke, or is not heeded, and one of
// events that named no group.
template <class Group, class Groups>
std::string group_lines(const std::string& name, const Groups& groups, std::uint64_t refused_events,
                        const std::vector<std::string>& sources) {
  std::vector<std::string> lines;
  add_trouble<Group>(name, groups, sources, lines);
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (groups[i].phase != GroupPhase::kLost && groups[i].losses > 0)
      lines.push_back(fmt::format("{}: {}: its source fell silent {} times", name,
                                  name_of(static_cast<Group>(i)), groups[i].losses));
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (groups[i].jumps > 0)
      lines.push_back(
          fmt::format("{}: {}: limbs of its source ({}) jumped {} time{}, and were eased", name,
                      name_of(static_cast<Group>(i)), authority_words(groups[i], sources),
                      groups[i].jumps, groups[i].jumps == 1 ? "" : "s"));
  if (refused_events > 0)
    lines.push_back(fmt::format("{}: {} events refused", name, refused_events));
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

std::string tank_words(const PhysicsHuman& human, std::uint64_t tank) {
  if (tank >= human.body.tank_count) return "no tank";
  return fmt::format("tank {} ({})", tank + 1, diver::name_of(human.body.tanks[tank].mix));
}

bool in_trouble(const SourceCounts& counts) {
  return counts.refused() + counts.lost + counts.dropped > 0;
}

void print_summary(const DiveFlags& flags, const PhysicsWorld& world,
                   const PhysicsSimulation& simulation, const DiveRecorder& recorder,
                   const Pace& pace) {
  const auto& newest = simulation.newest();
  const double speed = recorder.stepped_s() / std::max(pace.wall_s, 1e-9);
  const std::string hash = fmt::format("{:016x}", newest.hash);
  const auto sources = simulation.inbox().source_names();
  if (flags.json) {
    fmt::print("{}\n", json_text(summary_json(flags, world, simulation, recorder, pace)));
    return;
  }
  if (flags.quiet) return;
  for (std::size_t i = 0; i < world.vehicles().size(); ++i)
    fmt::print(
        "{}", vehicle_line(world.vehicles()[i], newest.state.vehicles()[i], recorder.figures()[i]));
  for (std::size_t i = 0; i < world.humans().size(); ++i)
    fmt::print("{}", human_line(world.humans()[i], newest.state.humans()[i],
                                recorder.humans().figures()[i]));
  for (std::size_t i = 0; i < world.vehicles().size(); ++i)
    fmt::print(
        "{}", group_lines<VehicleGroup>(world.vehicles()[i].name, newest.state.vehicles()[i].groups,
                                        simulation.inputs().vehicles()[i].refused_events, sources));
  for (std::size_t i = 0; i < world.humans().size(); ++i)
    fmt::print("{}",
               group_lines<DiverGroup>(world.humans()[i].name, newest.state.humans()[i].groups,
                                       simulation.inputs().humans()[i].refused_events, sources));
  for (std::size_t i = 0; i < world.objects().size(); ++i)
    fmt::print("{}",
               group_lines<ObjectGroup>(world.objects()[i].name, newest.state.objects()[i].groups,
                                        simulation.inputs().objects()[i].refused_events, sources));
  for (std::size_t i = 0; i < world.modems().all().size(); ++i)
    fmt::print("{}{}", modem_line(world.modems().all()[i].name, newest.state.modems()[i].counts),
               ranging_line(world.modems(), i, newest.state.modem_tasks()[i]));
  fmt::print("{}", source_lines(simulation.inbox()));
  for (const DeviceHealth& health : pace.devices) log_info("{}", health_words(health, now_ns()));
  const std::string restored =
      recorder.from_s() > 0.0 ? fmt::format(" ({:g} s of them restored)", recorder.from_s()) : "";
  fmt::print("{:g} s in {} steps{}, {:.1f} simulated seconds a second, {} steps dropped, hash {}\n",
             newest.time_s, newest.step, restored, speed, pace.dropped, hash);
}

}  // namespace neritic::tools
