// The report of a dive as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "rov/frames.hpp"
#include "testbed/samples/authority_words.hpp"
#include "tools/neritic/dive_told.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

nlohmann::json modem_json(const Modems& modems, std::size_t i, const sonar::ModemCounts& counts,
                          const ModemTasks& tasks) {
  const PhysicsModem& modem = modems.all()[i];
  nlohmann::json line{{"name", modem.name}};
  sonar::ModemCounts::fields([&](const char* key, const auto& count) { line[key] = count; },
                             counts);
  if (modem.ranging)
    line["usbl"] = {{"target", modems.all()[modem.target].name},
                    {"fixes", tasks.fixes},
                    {"misses", tasks.misses}};
  line["unanswered"] = tasks.unanswered;
  return line;
}

nlohmann::json human_json(const PhysicsHuman& human, const HumanPhysics& state,
                          const HumanFigures& figures) {
  const diver::GasReading gas = diver::read_gas(human.body, state.human);
  const diver::AscentGas ascent = gas_for_ascent(human, state);
  const diver::DiveComputerView& deco = ascent.view;
  const Vec3 p = rov::world_from_ned(state.human.root.position_ned_m);
  return {{"name", human.name},
          {"waypoints", human.waypoints_ned_m.size()},
          {"arrived", state.arrived},
          {"way_m", figures.path_m},
          {"largest_speed_m_s", figures.largest_speed_m_s},
          {"shallowest_m", figures.shallowest_m},
          {"deepest_m", figures.deepest_m},
          {"tank", tank_words(human, state.human.held.tank)},
          {"tank_bar", 1e-5 * gas.tank_pa},
          {"gas_switches", changes_json(human, figures)},
          {"ventilation_l_min", gas.ventilation_l_min},
          {"ascent_gas_l", ascent.needed_l},
          {"ascent_gas_there_l", ascent.there_l},
          {"ascent_gas_enough", ascent.enough()},
          {"limb_work_j", state.human.life.limb_work_j},
          {"heart_bpm", state.human.life.vitals.heart_bpm},
          {"risk_proxies",
           {{"note", diver::kRiskNote},
            {"co2_mmhg", state.human.life.vitals.risk.co2_mmhg},
            {"co2", name_of(state.human.life.vitals.risk.co2)},
            {"narcotic_depth_m", state.human.life.vitals.risk.narcotic_depth_m},
            {"narcosis", name_of(state.human.life.vitals.risk.narcosis)},
            {"gas_density", name_of(state.human.life.vitals.risk.gas_density)},
            {"breathing", name_of(state.human.life.vitals.risk.breathing)},
            {"oxygen_bar", state.human.life.vitals.risk.oxygen_bar},
            {"oxygen", name_of(state.human.life.vitals.risk.oxygen)}}},
          {"ceiling_m", deco.ceiling_m},
          {"ceiling_violated", deco.ceiling_violated},
          {"no_stop_min", deco.no_stop_min},
          {"dangers", dangers_json(human, figures)},
          {"touched_steps", state.contact.touched_steps},
          {"deepest_contact_m", state.contact.deepest_m},
          {"refused_inputs", state.human.refused_inputs},
          {"end", {{"position_m", {p.x, p.y, p.z}}}}};
}

nlohmann::json number_or_null(const std::optional<double>& number) {
  return number ? nlohmann::json(*number) : nlohmann::json();
}

nlohmann::json vehicle_json(const PhysicsVehicle& vehicle, const VehicleState& state,
                            const DiveFigures& figures) {
  const Pose end = rov::world_pose(state.body.position_ned_m, state.body.attitude);
  const Vec3& p = end.position_m;
  const Quat& q = end.rotation;
  return {{"name", vehicle.name},
          {"waypoints", vehicle.mission ? vehicle.mission->waypoint_count() : 0},
          {"arrived", state.mission.arrived},
          {"arrivals_s", figures.arrivals_s},
          {"true_misses_m", figures.misses_m},
          {"way_m", figures.path_m},
          {"largest_speed_m_s", figures.largest_speed_m_s},
          {"largest_tilt_deg", degrees(figures.largest_tilt_rad)},
          {"touched_steps", state.contact.touched_steps},
          {"deepest_contact_m", state.contact.deepest_m},
          {"shallowest_m", figures.shallowest_m},
          {"deepest_m", figures.deepest_m},
          {"refused_inputs", state.body.refused_inputs},
          {"battery_charge", number_or_null(figures.battery_charge)},
          {"battery_empty_from_s", number_or_null(figures.battery_empty_from_s)},
          {"navigation", vehicle.navigation ? "measured" : "truth"},
          {"navigation_error_m", number_or_null(figures.navigation_error_m)},
          {"largest_navigation_error_m", number_or_null(figures.largest_navigation_error_m)},
          {"navigation_begun_anew_s", figures.navigation_anew_s},
          {"end", {{"position_m", {p.x, p.y, p.z}}, {"rotation_xyzw", {q.x, q.y, q.z, q.w}}}}};
}

// A device's packets and clock, as a source of samples has them.
nlohmann::json device_json(const DeviceHealth& health) {
  const net::LinkCounts& link = health.link;
  const net::ClockEstimate& clock = health.clock;
  nlohmann::json json{{"device", health.device},
                      {"where", health.where},
                      {"datagrams", link.datagrams},
                      {"bytes", link.bytes},
                      {"used", link.used},
                      {"malformed", link.malformed},
                      {"unused", link.unused},
                      {"repeated", link.repeated},
                      {"older", link.older},
                      {"lost", link.lost},
                      {"restarts", link.restarts},
                      {"refused_parts", link.refused},
                      {"queue_overflowed", link.overflowed},
                      {"strangers", link.strangers},
                      {"trouble", health.trouble},
                      {"clock", nullptr}};
  if (clock.known)
    json["clock"] = {{"offset_s", clock.offset_s},
                     {"drift_ppm", clock.drift_ppm},
                     {"jitter_ms", clock.spread_ms},
                     {"longest_ms", clock.longest_ms},
                     {"jumps", clock.jumps}};
  return json;
}

nlohmann::json sources_json(const SampleInbox& inbox, const std::vector<DeviceHealth>& devices) {
  nlohmann::json json = nlohmann::json::array();
  const auto names = inbox.source_names();
  for (SourceId id = 0; id < names.size(); ++id) {
    const SourceCounts counts = inbox.counts(id);
    if (id == kSimulation && counts.accepted == 0 && !in_trouble(counts)) continue;
    json.push_back({{"name", names[id]}});
    for (const auto& [name, count] : named_counts(counts)) json.back()[std::string(name)] = count;
    for (const DeviceHealth& health : devices)
      if (health.name == names[id]) json.back()["link"] = device_json(health);
  }
  return json;
}

// Each group that a source was named for or that samples came for.
template <class Group, class Groups>
nlohmann::json groups_json(const Groups& groups, const std::vector<std::string>& sources) {
  nlohmann::json json = nlohmann::json::object();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const GroupState& state = groups[i];
    if (state.authority == Authority::kAutopilot && state.unheeded == 0 && state.losses == 0)
      continue;
    json[std::string(name_of(static_cast<Group>(i)))] = {
        {"authority", authority_words(state, sources)},
        {"phase", name_of(state.phase)},
        {"used", state.heard},
        {"not_used", state.unheeded},
        {"fell_silent", state.losses},
        {"jumped", state.jumps}};
  }
  return json;
}

// An object that devices move; its end is null while its own track or place has it.
nlohmann::json object_json(const PhysicsObject& object, const ObjectState& state,
                           std::uint64_t refused_events, const std::vector<std::string>& sources) {
  nlohmann::json end;
  if (state.placed != 0) {
    const Vec3& p = state.motion.pose.position_m;
    const Quat& q = state.motion.pose.rotation;
    end = {{"position_m", {p.x, p.y, p.z}}, {"rotation_xyzw", {q.x, q.y, q.z, q.w}}};
  }
  return {{"name", object.name},
          {"inputs", groups_json<ObjectGroup>(state.groups, sources)},
          {"refused_events", refused_events},
          {"end", std::move(end)}};
}

}  // namespace

nlohmann::json changes_json(const PhysicsHuman& human, const HumanFigures& figures) {
  nlohmann::json json = nlohmann::json::array();
  for (const TankChange& change : figures.tank_changes)
    json.push_back({{"at_s", change.time_s},
                    {"depth_m", change.depth_m},
                    {"from", tank_words(human, change.from)},
                    {"to", tank_words(human, change.to)},
                    {"po2_bar", change.po2_bar}});
  return json;
}

nlohmann::json dangers_json(const PhysicsHuman& human, const HumanFigures& figures) {
  nlohmann::json json{{"out_of_gas", nullptr},
                      {"fastest_ascent_m_min", figures.fastest_ascent_m_min},
                      {"ascent_alarm", nullptr},
                      {"ceiling_violation", nullptr},
                      {"oxygen_risk", nullptr}};
  if (figures.out_of_gas_s > 0.0)
    json["out_of_gas"] = {{"tank", tank_words(human, figures.out_of_gas_tank)},
                          {"from_s", figures.out_of_gas_from_s},
                          {"seconds", figures.out_of_gas_s},
                          {"longest_s", figures.out_of_gas_longest_s}};
  if (figures.ascent_alarm != diver::AscentAlarm::kNone)
    json["ascent_alarm"] = {{"worst", name_of(figures.ascent_alarm)},
                            {"seconds", figures.ascent_alarm_s},
                            {"fastest_at_s", figures.fastest_ascent_at_s}};
  if (figures.above_ceiling_m > 0.0)
    json["ceiling_violation"] = {{"from_s", figures.above_ceiling_from_s},
                                 {"worst_m", figures.above_ceiling_m}};
  if (figures.oxygen >= diver::RiskLevel::kHigh)
    json["oxygen_risk"] = {{"worst", name_of(figures.oxygen)},
                           {"from_s", figures.oxygen_from_s},
                           {"least_po2_bar", figures.least_po2_bar},
                           {"most_po2_bar", figures.most_po2_bar}};
  return json;
}

nlohmann::json summary_json(const DiveFlags& flags, const PhysicsWorld& world,
                            const PhysicsSimulation& simulation, const DiveRecorder& recorder,
                            const Pace& pace) {
  const auto& newest = simulation.newest();
  const double speed = recorder.stepped_s() / std::max(pace.wall_s, 1e-9);
  const std::string hash = fmt::format("{:016x}", newest.hash);
  const auto sources = simulation.inbox().source_names();
  nlohmann::json json{{"scene", flags.scene},
                      {"simulated_s", newest.time_s},
                      {"restored_s", recorder.from_s()},
                      {"steps", newest.step},
                      {"step_s", world.step_s()},
                      {"wall_s", pace.wall_s},
                      {"speed", speed},
                      {"dropped", pace.dropped},
                      {"refused_states", simulation.refused_states()},
                      {"hash", hash},
                      {"vehicles", nlohmann::json::array()}};
  for (std::size_t i = 0; i < world.vehicles().size(); ++i) {
    const VehicleState& state = newest.state.vehicles()[i];
    auto vehicle = vehicle_json(world.vehicles()[i], state, recorder.figures()[i]);
    vehicle["inputs"] = groups_json<VehicleGroup>(state.groups, sources);
    vehicle["refused_events"] = simulation.inputs().vehicles()[i].refused_events;
    json["vehicles"].push_back(std::move(vehicle));
  }
  json["humans"] = nlohmann::json::array();
  for (std::size_t i = 0; i < world.humans().size(); ++i) {
    const HumanPhysics& state = newest.state.humans()[i];
    auto human = human_json(world.humans()[i], state, recorder.humans().figures()[i]);
    human["inputs"] = groups_json<DiverGroup>(state.groups, sources);
    human["refused_events"] = simulation.inputs().humans()[i].refused_events;
    json["humans"].push_back(std::move(human));
  }
  json["objects"] = nlohmann::json::array();
  for (std::size_t i = 0; i < world.objects().size(); ++i)
    json["objects"].push_back(object_json(world.objects()[i], newest.state.objects()[i],
                                          simulation.inputs().objects()[i].refused_events,
                                          sources));
  for (std::size_t i = 0; i < world.modems().all().size(); ++i)
    json["modems"].push_back(modem_json(world.modems(), i, newest.state.modems()[i].counts,
                                        newest.state.modem_tasks()[i]));
  json["sources"] = sources_json(simulation.inbox(), pace.devices);
  json["unknown_source_samples"] = simulation.inbox().unknown_sources();
  return json;
}

}  // namespace neritic::tools
