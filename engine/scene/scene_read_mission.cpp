// Reads a vehicle's mission: where it is to go and what it faces, objects by their names. In the
// second pass over a scene, when all objects are known.
#include <algorithm>

#include "engine/core/text.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr Interval kLength{0, 1e6, true, false, "metres"};
constexpr Interval kMissionSpeed{0, 100, true, false, "m/s"};
constexpr std::size_t kMaxMissionWaypoints = 10000;

class MissionReader {
 public:
  MissionReader(const SceneDraft& draft, const std::string& vehicle)
      : draft_(draft), vehicle_(vehicle) {}

  Mission read(TableReader& reader) {
    Mission mission;
    constexpr Key kWays[] = {"waypoints", "hold", "orbit", "follow", "stand_between"};
    const auto ways = std::ranges::count_if(kWays, [&](Key key) { return reader.has(key); });
    if (ways != 1)
      reader.refuse_table(
          fmt::format("{} of {}", ways == 0 ? "none" : "more than one", join(kWays)),
          "one of them");
    if (reader.has("waypoints")) read_waypoints(reader, mission);
    if (reader.has("hold")) reader.choice("hold", "station", std::to_array<Key>({"station"}));
    if (const TomlValue* table = reader.table("orbit")) read_orbit(reader, *table, mission);
    if (const TomlValue* table = reader.table("follow")) read_follow(reader, *table, mission);
    if (const TomlValue* table = reader.table("stand_between"))
      read_stand_between(reader, *table, mission);
    if (mission.kind != Mission::Kind::kWaypoints)
      for (const Key key : {"acceptance_m", "speed_m_s", "speed_over", "repeat"})
        if (reader.has(key)) reader.refuse(key, "no such key without waypoints");
    mission.facing = read_facing(reader);
    if (mission.kind == Mission::Kind::kStandBetween)
      for (const Key key : {"heading_deg", "look_at", "look_at_m"})
        if (reader.has(key)) reader.refuse(key, "no such key beside stand_between, which faces b");
    return mission;
  }

 private:
  // The object of that name, other than this one.
  Aim read_aim(TableReader& reader, Key key) {
    Aim aim;
    const std::string name = reader.text(key, "");
    std::vector<Key> names;
    for (std::size_t i = 0; i < draft_.objects.size(); ++i) {
      const std::string& known = draft_.objects[i].object.name;
      if (known == vehicle_) continue;
      if (known == name) aim.object = static_cast<int>(i);
      names.push_back(known);
    }
    if (aim.object < 0)
      reader.refuse(
          key, fmt::format("the name of another object or vehicle{}",
                           names.empty() ? std::string()
                                         : fmt::format(" (nearest: {})", nearest(name, names))));
    return aim;
  }

  Facing read_facing(TableReader& reader) {
    Facing facing;
    if (int{reader.has("heading_deg")} + int{reader.has("look_at")} + int{reader.has("look_at_m")} >
        1)
      reader.refuse_table("more than one of heading_deg, look_at, look_at_m", "one of them");
    if (reader.has("heading_deg"))
      facing.heading_rad = radians(reader.number("heading_deg", 0.0, kAnyTurn));
    if (reader.has("look_at")) facing.look_at = read_aim(reader, "look_at");
    if (reader.has("look_at_m"))
      facing.look_at = Aim{-1, reader.vector3("look_at_m", Vec3(0.0), kAnyMetres)};
    facing.tilt = reader.flag("tilt", false);
    if (reader.has("tilt") && !facing.look_at)
      reader.refuse("tilt", "no such key without look_at or look_at_m");
    return facing;
  }

  void read_waypoints(TableReader& reader, Mission& mission) {
    mission.kind = Mission::Kind::kWaypoints;
    const auto& tables = reader.tables("waypoints");
    if (tables.empty() || tables.size() > kMaxMissionWaypoints)
      reader.refuse("waypoints",
                    fmt::format("1 to {} tables with position_m", kMaxMissionWaypoints));
    for (std::size_t i = 0; reader.ok() && i < tables.size(); ++i) {
      TableReader item(reader.source(), tables[i],
                       fmt::format("{}[{}]", reader.path("waypoints"), i), kMissionWaypointKeys);
      MissionWaypoint waypoint;
      waypoint.position_m = item.vector3("position_m", Vec3(0.0), kAnyMetres);
      if (!item.has("position_m")) item.refuse("position_m", "[x, y, z] in metres");
      waypoint.facing = read_facing(item);
      waypoint.hold_s = item.number("hold_s", 0.0, {0, 1e6, false, false, "seconds"});
      if (!item.ok()) reader.fail(item.status().error());
      mission.waypoints.push_back(waypoint);
    }
    mission.acceptance_m = reader.number("acceptance_m", mission.acceptance_m, kLength);
    mission.speed_m_s = reader.number("speed_m_s", 0.0, kMissionSpeed);
    mission.speed_over = read_speed_over(reader, mission.speed_over);
    if (reader.has("speed_over") && !reader.has("speed_m_s"))
      reader.refuse("speed_over", "no such key without speed_m_s");
    mission.repeat = reader.flag("repeat", false);
  }

  void read_orbit(TableReader& parent, const TomlValue& table, Mission& mission) {
    TableReader reader(parent.source(), table, parent.path("orbit"), kOrbitKeys);
    mission.kind = Mission::Kind::kOrbit;
    if (reader.has("object") == reader.has("point_m"))
      reader.refuse_table("none or both of object, point_m", "one of them");
    else if (reader.has("object"))
      mission.target = read_aim(reader, "object");
    else
      mission.target.point_m = reader.vector3("point_m", Vec3(0.0), kAnyMetres);
    mission.radius_m = reader.number("radius_m", 1.0, kLength);
    mission.speed_m_s = reader.number("speed_m_s", 0.3, {-100, 100, false, false, "m/s"});
    mission.speed_over = read_speed_over(reader, mission.speed_over);
    if (!reader.has("radius_m")) reader.refuse("radius_m", "a number in " + kLength.text());
    if (!reader.ok()) parent.fail(reader.status().error());
  }

  void read_follow(TableReader& parent, const TomlValue& table, Mission& mission) {
    TableReader reader(parent.source(), table, parent.path("follow"), kFollowKeys);
    mission.kind = Mission::Kind::kFollow;
    mission.target = read_aim(reader, "object");
    mission.offset_m = reader.vector3("offset_m", Vec3(0.0), kAnyMetres);
    if (!reader.ok()) parent.fail(reader.status().error());
  }

  void read_stand_between(TableReader& parent, const TomlValue& table, Mission& mission) {
    TableReader reader(parent.source(), table, parent.path("stand_between"), kStandBetweenKeys);
    mission.kind = Mission::Kind::kStandBetween;
    mission.between_a = read_aim(reader, "a");
    mission.between_b = read_aim(reader, "b");
    if (reader.has("distance_m"))
      mission.distance_m = reader.number("distance_m", 0.0, {0, 1e6, false, false, "metres"});
    if (!reader.ok()) parent.fail(reader.status().error());
  }

  const SceneDraft& draft_;
  const std::string& vehicle_;  // its own name
};

}  // namespace

SpeedOver read_speed_over(TableReader& reader, SpeedOver otherwise) {
  constexpr auto kOver = std::to_array<Key>({"ground", "water"});
  const Key usual = otherwise == SpeedOver::kGround ? kOver[0] : kOver[1];
  return reader.choice("speed_over", std::string(usual), kOver) == kOver[0] ? SpeedOver::kGround
                                                                            : SpeedOver::kWater;
}

Mission read_mission(TableReader& reader, const SceneDraft& draft, const std::string& vehicle) {
  return MissionReader(draft, vehicle).read(reader);
}

}  // namespace neritic::scene
