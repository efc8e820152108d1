// Reads what a scene says of physics: [physics], [current], and of objects what is solid and what
// moves by itself; the latter in a second pass, when all names are known.
#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr Interval kCurrentSpeed{-100, 100, false, false, "m/s"};
constexpr Interval kOverZeroMetres{0, 1e6, true, false, "metres"};
constexpr Interval kAnySeconds{-1e9, 1e9, false, false, "seconds"};
// The most thrusters that a vehicle can have.
constexpr std::size_t kMaxFailedThruster = 16;

constexpr Key kPhysicsOnly[] = {
    "collision",      "dynamics",  "mission", "failed_thrusters", "tether_anchor_m", "tether",
    "navigation",     "human",     "swim",    "jacket_buttons",   "inputs",          "modem",
    "condition",      "regulator", "thing",   "gripper",          "hands",           "wash",
    "near_added_mass"};
constexpr Key kDynamicsOnly[] = {"mission", "failed_thrusters", "tether_anchor_m",
                                 "tether",  "navigation",       "gripper",
                                 "wash",    "near_added_mass"};
// The default classes that vehicles cannot pass.
constexpr Key kSolidClasses[] = {"seabed", "rock", "wreck", "structure", "pipe"};

struct CurrentKeysOf {
  Key kind;
  std::array<Key, 5> keys;
};
constexpr CurrentKeysOf kCurrentKinds[] = {
    {"uniform", {"velocity_m_s"}},
    {"power_law", {"velocity_m_s", "depth_m", "exponent"}},
    {"linear", {"velocity_m_s", "deep_velocity_m_s", "depth_m"}},
    {"grid", {"file", "origin_m", "spacing_m", "start_s", "interval_s"}}};
constexpr auto kCurrentNames = std::to_array<Key>({"uniform", "power_law", "linear", "grid"});

// column: of the scene's water, or nullptr.
Result<Physics> read_physics_table(const SceneSource& source, const TomlValue& table,
                                   const WaterColumn* column) {
  TableReader reader(source, table, "physics", kPhysicsKeys);
  Physics physics;
  physics.rate_hz = reader.number("rate_hz", physics.rate_hz, {60, 1000, false, false, "hertz"});
  physics.integrator = reader.choice("integrator", physics.integrator,
                                     std::to_array<Key>({"guarded", "rk4", "semi_euler"}));
  physics.max_error_m = reader.number("max_error_m", 0.0, {0, 1, true, false, "metres"});
  for (const Key key : {"rate_hz", "integrator"})
    if (reader.has("max_error_m") && reader.has(key))
      reader.refuse(key, "no such key beside max_error_m");
  if (column) physics.water_kg_m3 = column->density_kg_m3(0.0);
  physics.water_kg_m3 =
      reader.number("water_kg_m3", physics.water_kg_m3, {900, 1300, false, false, "kg/m^3"});
  physics.altitude_m =
      reader.number("altitude_m", physics.altitude_m, {-500, 9000, false, false, "m"});
  NERITIC_TRY_STATUS(reader.status());
  return physics;
}

void read_grid(TableReader& reader, Current& current) {
  current.file = reader.file("file");
  current.origin_m = reader.vector3("origin_m", current.origin_m, kAnyMetres);
  current.spacing_m = reader.vector3("spacing_m", current.spacing_m, kAnyMetres);
  current.start_s = reader.number("start_s", 0.0, kAnySeconds);
  current.interval_s = reader.number("interval_s", 1.0, {0, 1e9, true, false, "seconds"});
  for (const Key key : {"file", "origin_m", "spacing_m"})
    if (!reader.has(key)) reader.refuse(key, "this key, of a grid");
}

Result<Current> read_current_table(const SceneSource& source, const TomlValue& table) {
  TableReader reader(source, table, "current", kCurrentKeys);
  Current current;
  if (!reader.has("kind")) reader.refuse("kind", "one of " + join(kCurrentNames));
  const std::string kind = reader.choice("kind", "uniform", kCurrentNames);
  for (std::size_t i = 0; i < std::size(kCurrentKinds); ++i) {
    if (kCurrentKinds[i].kind != kind) continue;
    current.kind = static_cast<Current::Kind>(i);
    const auto& taken = kCurrentKinds[i].keys;
    for (const Key key : kCurrentKeys)
      if (key != "kind" && reader.has(key) && std::ranges::find(taken, key) == taken.end())
        reader.refuse(key, fmt::format("no such key of the kind {}", kind));
  }
  if (current.kind == Current::Kind::kGrid) {
    read_grid(reader, current);
  } else {
    current.velocity_m_s = reader.vector3("velocity_m_s", Vec3(0.0), kCurrentSpeed);
    if (!reader.has("velocity_m_s")) reader.refuse("velocity_m_s", "[x, y, z] in m/s");
    current.deep_velocity_m_s = reader.vector3("deep_velocity_m_s", Vec3(0.0), kCurrentSpeed);
    current.depth_m = reader.number("depth_m", current.depth_m, kOverZeroMetres);
    current.exponent = reader.number("exponent", current.exponent, {0, 1, true});
  }
  NERITIC_TRY_STATUS(reader.status());
  return current;
}

// The physics of one table of [[objects]] or [[vehicles]].
class VehiclePhysicsReader {
 public:
  VehiclePhysicsReader(TableReader& reader, ObjectDraft& object, const SceneDraft& draft)
      : reader_(reader), object_(object), draft_(draft) {}

  std::optional<Modem> modem;  // that it carries
  TetherDraft tether;          // as which its tether is drawn

  Status read() {
    if (!draft_.scene.physics) {
      for (const Key key : kPhysicsOnly)
        if (reader_.has(key)) reader_.refuse(key, "no such key in a scene without [physics]");
      return reader_.status();
    }
    read_collision();
    read_human();
    read_tracked();
    read_carried();
    modem = read_modem(reader_);
    if (reader_.has("modem") && !reader_.has("dynamics") && !reader_.has("human") && !is_tracked())
      reader_.refuse("modem", "a modem of what has dynamics, human or inputs");
    if (!reader_.has("dynamics")) {
      for (const Key key : kDynamicsOnly)
        if (reader_.has(key)) reader_.refuse(key, "no such key without dynamics");
      return reader_.status();
    }
    Dynamics dynamics;
    dynamics.file = reader_.file("dynamics");
    for (const Key key : {"track", "scatter", "copies", "copies_file", "flock", "on"})
      if (reader_.has(key)) reader_.refuse(key, "no such key beside dynamics");
    if (reader_.has("collision") && object_.object.collision != Collision::kHull)
      reader_.refuse("collision", "\"hull\", beside dynamics");
    if (!object_.request)
      reader_.refuse("dynamics", "no such key for what is not drawn: what is drawn is its shape");
    if (reader_.has("failed_thrusters")) dynamics.failed_thrusters = read_failed();
    if (reader_.has("tether_anchor_m"))
      dynamics.tether_anchor_m = reader_.vector3("tether_anchor_m", Vec3(0.0), kAnyMetres);
    dynamics.gripper = read_grip(reader_, "gripper");
    dynamics.wash = read_wash(reader_);
    dynamics.near_added_mass = reader_.flag("near_added_mass", false);
    dynamics.tether = read_tether(reader_, object_.object.name, tether);
    if (dynamics.tether && dynamics.tether_anchor_m)
      reader_.refuse("tether_anchor_m", "no such key beside tether");
    if (reader_.has("navigation"))
      dynamics.navigation = reader_.choice("navigation", "truth",
                                           std::to_array<Key>({"truth", "measured"})) == "truth"
                                ? Dynamics::Navigation::kTruth
                                : Dynamics::Navigation::kMeasured;
    if (const TomlValue* table = reader_.table("mission")) {
      TableReader mission(reader_.source(), *table, reader_.path("mission"), kMissionKeys);
      dynamics.mission = read_mission(mission, draft_, object_.object.name);
      NERITIC_TRY_STATUS(mission.status());
    }
    dynamics.inputs = read_inputs(reader_, kVehicleInputKeys, {});
    object_.object.dynamics = std::move(dynamics);
    return reader_.status();
  }

 private:
  void read_collision() {
    const Scene& scene = draft_.scene;
    Object& object = object_.object;
    const auto name = scene.class_names.find(object.class_id);
    const bool still =
        !object_.placement.track && object_.clip.empty() && !is_tracked() && !reader_.has("thing");
    const bool solid = name != scene.class_names.end() && still && object_.request &&
                       std::ranges::find(kSolidClasses, name->second) != std::end(kSolidClasses);
    object.collision = solid ? Collision::kMesh : Collision::kNone;
    const TomlValue* value = reader_.find("collision");
    if (!value) return;
    if (value->kind == TomlValue::Kind::kBool)
      object.collision = value->boolean ? Collision::kMesh : Collision::kNone;
    else if (value->kind == TomlValue::Kind::kString && value->text == "hull")
      object.collision = Collision::kHull;
    else
      reader_.refuse("collision", "true, false or \"hull\"");
    if (object.collision != Collision::kNone && !object_.request)
      reader_.refuse("collision", "no such key for what is not drawn");
    if (object.collision != Collision::kNone && !still)
      reader_.refuse("collision",
                     "false, since what has a track, a clip, inputs or thing is not solid");
  }

  // Whether devices move it, though it is neither a vehicle nor a diver.
  bool is_tracked() const {
    return reader_.has("inputs") && !reader_.has("human") && !reader_.has("dynamics");
  }

  void read_carried() {
    object_.object.thing = read_thing(reader_);
    if (!object_.object.thing) return;
    for (const Key key :
         {"track", "scatter", "copies", "copies_file", "flock", "on", "dynamics", "human", "clip"})
      if (reader_.has(key)) reader_.refuse(key, "no such key beside thing");
  }

  void read_tracked() {
    if (!is_tracked()) return;
    if (reader_.has("scatter")) reader_.refuse("inputs", "no such key beside scatter");
    object_.object.inputs = read_inputs(reader_, kObjectInputKeys, {}, "nobody");
    if (object_.object.inputs.empty()) reader_.refuse("inputs", "a table with the key pose");
  }

  void read_human() {
    if (!reader_.has("human")) {
      for (const Key key : {"swim", "jacket_buttons", "condition", "regulator", "hands"})
        if (reader_.has(key)) reader_.refuse(key, "no such key without human");
      return;
    }
    Human human;
    human.file = reader_.file("human");
    for (const Key key :
         {"track", "scatter", "copies", "copies_file", "flock", "on", "collision", "dynamics"})
      if (reader_.has(key)) reader_.refuse(key, "no such key beside human");
    if (!object_.request)
      reader_.refuse("human", "no such key for what is not drawn: its joints are moved");
    if (const TomlValue* table = reader_.table("swim")) human.swim = read_swim(*table);
    if (reader_.has("jacket_buttons")) human.jacket_buttons = reader_.file("jacket_buttons");
    human.condition = read_condition(reader_);
    human.hands = read_grip(reader_, "hands");
    human.regulator = read_regulator(reader_);
    std::vector<Key> recorded;
    if (human.swim && !human.swim->motion.empty()) recorded.push_back("body");
    if (!human.jacket_buttons.empty()) recorded.push_back("buttons");
    human.inputs = read_inputs(reader_, kDiverInputKeys, recorded);
    object_.object.human = std::move(human);
  }

  SwimPlan read_swim(const TomlValue& table) {
    TableReader swim(reader_.source(), table, reader_.path("swim"), kSwimKeys);
    SwimPlan plan;
    plan.repeat = swim.flag("repeat", false);
    if (swim.has("motion")) {
      plan.motion = swim.file("motion");
      for (const Key key : {"waypoints_m", "speed_m_s", "speed_over", "acceptance_m"})
        if (swim.has(key)) swim.refuse(key, "no such key beside motion");
      if (const Status status = swim.status(); !status.ok()) reader_.fail(status.error());
      return plan;
    }
    for (const auto& p : swim.rows("waypoints_m", {3}, kAnyMetres))
      plan.waypoints_m.push_back({p[0], p[1], p[2]});
    if (plan.waypoints_m.empty()) swim.refuse("waypoints_m", "a list of points [x, y, z]");
    plan.speed_m_s = swim.number("speed_m_s", plan.speed_m_s, {0, 1.2, true, false, "m/s"});
    plan.speed_over = read_speed_over(swim, plan.speed_over);
    plan.acceptance_m =
        swim.number("acceptance_m", plan.acceptance_m, {0, 100, true, false, "metres"});
    if (const Status status = swim.status(); !status.ok()) reader_.fail(status.error());
    return plan;
  }

  std::uint64_t read_failed() {
    std::uint64_t failed = 0;
    const TomlValue* value = reader_.find("failed_thrusters");
    bool good = value->kind == TomlValue::Kind::kArray;
    for (const TomlValue& item : value->items) {
      good = good && item.kind == TomlValue::Kind::kInteger && item.integer >= 1 &&
             item.integer <= static_cast<std::int64_t>(kMaxFailedThruster);
      if (good) failed |= std::uint64_t{1} << (item.integer - 1);
    }
    if (!good)
      reader_.refuse("failed_thrusters",
                     fmt::format("a list of the file's thrusters by number, each 1 to {}",
                                 kMaxFailedThruster));
    return failed;
  }

  TableReader& reader_;
  ObjectDraft& object_;
  const SceneDraft& draft_;
};

}  // namespace

Status read_physics(SceneDraft& draft, const SceneSource& source, const TomlValue* physics,
                    const TomlValue* current) {
  if (physics) {
    NERITIC_TRY(draft.scene.physics,
                read_physics_table(source, *physics,
                                   draft.scene.water && draft.scene.water->column
                                       ? &*draft.scene.water->column
                                       : nullptr));
  }
  if (!current) return {};
  if (!physics)
    return refusal(fmt::format("{}: current", source.place(current->where)), "a table",
                   "no such key in a scene without [physics]");
  NERITIC_TRY(draft.scene.current, read_current_table(source, *current));
  return {};
}

Status read_vehicle_physics(SceneDraft& draft, const SceneSource& source,
                            const std::vector<TomlValue>& tables, const std::string& path,
                            std::size_t first_object) {
  for (std::size_t i = 0; i < tables.size(); ++i) {
    TableReader reader(source, tables[i], fmt::format("{}[{}]", path, i), kObjectKeys);
    VehiclePhysicsReader physics(reader, draft.objects[first_object + i], draft);
    NERITIC_TRY_STATUS(physics.read());
    if (physics.tether.object) {
      draft.objects[first_object + i].object.dynamics->tether->object = draft.objects.size();
      physics.tether.object->request = draft.requests.size();
      draft.requests.push_back(std::move(physics.tether.request));
      draft.objects.push_back(std::move(*physics.tether.object));
    }
    if (!physics.modem) continue;
    physics.modem->object = static_cast<int>(first_object + i);
    draft.scene.modems.push_back(std::move(*physics.modem));
  }
  return {};
}

}  // namespace neritic::scene
