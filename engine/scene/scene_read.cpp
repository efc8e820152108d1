// Reads the scene's own tables (title, classes, sun, water) and the keys that placed things share.
#include <algorithm>
#include <cctype>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

// Above it stand the numbers by which labels of sonars say ghost, shadow (sonar/label_energy.hpp).
constexpr std::int64_t kMaxClass = 65532;

bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  });
}

Status read_classes(Scene& scene, const SceneSource& source, const TomlValue* table) {
  for (const ClassName& known : kClasses) scene.class_names[known.id] = known.name;
  if (!table) return {};
  for (const TomlEntry& entry : table->entries) {
    const std::string place = source.place(entry.where) + ": classes." + printable(entry.key);
    if (!is_name(entry.key))
      return refusal(place, "a name of another form", "1 to 64 letters, digits, _ and -");
    const TomlValue& id = entry.value;
    if (id.kind != TomlValue::Kind::kInteger || id.integer < 1 || id.integer > kMaxClass)
      return refusal(place, describe(id), fmt::format("a whole number from 1 to {}", kMaxClass));
    for (const auto& [other_id, other_name] : scene.class_names)
      if (other_id == id.integer || other_name == entry.key)
        return refusal(
            place, describe(id),
            fmt::format("a name and number of its own (class {} is {})", other_name, other_id));
    scene.class_names[static_cast<std::uint16_t>(id.integer)] = entry.key;
  }
  return {};
}

Result<Water> read_water(const SceneSource& source, const TomlValue& table) {
  TableReader reader(source, table, "water", kWaterKeys);
  Water water;
  water.type = reader.choice("type", "II", kWaterTypes);
  water.scattering = reader.flag("scattering", false);
  water.surface = reader.flag("surface", false);
  read_water_terms(reader, water);
  NERITIC_TRY_STATUS(reader.status());
  return water;
}

// The attitude by the keys of angles or the quaternion.
Quat read_turn(TableReader& reader) {
  const std::vector<double> q = reader.numbers("rotation_xyzw", {4}, {-1.001, 1.001});
  if (q.size() == 4) {
    const Quat rotation(q[3], q[0], q[1], q[2]);
    if (std::abs(glm::length(rotation) - 1.0) <= 1e-3) return glm::normalize(rotation);
    reader.refuse("rotation_xyzw", "a unit quaternion [x, y, z, w]");
  }
  return from_yaw_pitch_roll(radians(reader.number("yaw_deg", 0.0, kAnyTurn)),
                             radians(reader.number("pitch_deg", 0.0, kAnyTurn)),
                             radians(reader.number("roll_deg", 0.0, kAnyTurn)));
}
bool has_angles(const TableReader& reader) {
  return reader.has("yaw_deg") || reader.has("pitch_deg") || reader.has("roll_deg");
}

// yaw, pitch, roll or rotation_xyzw or a look_at: at most one of the three ways.
void read_rotation(TableReader& reader, PlacementDraft& placement) {
  const int ways = int{has_angles(reader)} + int{reader.has("rotation_xyzw")} +
                   int{reader.has("look_at_m")} + int{reader.has("look_at")};
  if (ways > 1)
    reader.refuse_table("more than one attitude",
                        "one of yaw_deg with pitch_deg and roll_deg, "
                        "rotation_xyzw, look_at_m, look_at");
  placement.pose.rotation = read_turn(reader);
}

Result<Pose> read_lab(const SceneSource& source, const TomlValue& table) {
  TableReader reader(source, table, "lab", kLabKeys);
  Pose world_from_lab;
  world_from_lab.position_m = reader.vector3("position_m", Vec3(0.0), kAnyMetres);
  if (has_angles(reader) && reader.has("rotation_xyzw"))
    reader.refuse_table("more than one attitude",
                        "one of yaw_deg with pitch_deg and roll_deg, rotation_xyzw");
  world_from_lab.rotation = read_turn(reader);
  NERITIC_TRY_STATUS(reader.status());
  return world_from_lab;
}

}  // namespace

std::string read_name(TableReader& reader, const std::string& otherwise) {
  const std::string name = reader.text("name", otherwise);
  if (!is_name(name)) reader.refuse("name", "1 to 64 letters, digits, _ and -");
  return name;
}

PlacementDraft read_placement(TableReader& reader, const std::string& default_on) {
  PlacementDraft placement;
  placement.pose.position_m = reader.vector3("position_m", Vec3(0.0), kAnyMetres);
  placement.track = read_track(reader);
  if (placement.track)
    placement.pose.position_m =
        pose_at({placement.track->places, {Track::Attitude{}}}, 0.0).position_m;
  read_rotation(reader, placement);
  placement.on = reader.text("on", default_on);
  placement.place_on = reader.place("on");
  placement.joint = reader.text("joint", "");
  placement.place_joint = reader.place("joint");
  if (reader.has("joint") && placement.on.empty()) reader.refuse("joint", "beside on");
  if (reader.has("look_at_m"))
    placement.look_at_m = reader.vector3("look_at_m", Vec3(0.0), kAnyMetres);
  placement.look_at = reader.text("look_at", "");
  placement.place_look_at = reader.place("look_at");
  if (placement.look_at_m && *placement.look_at_m == placement.pose.position_m)
    reader.refuse("look_at_m", "a point other than position_m");
  return placement;
}

Result<SceneDraft> read_draft(const SceneSource& source) {
  SceneDraft draft;
  Scene& scene = draft.scene;
  TableReader reader(source, source.root, "", kSceneKeys);
  scene.title = reader.text("title", "");
  scene.path = source.files.front();
  scene.seed = reader.whole("seed", 1, 0, INT64_MAX);
  const TomlValue* classes = reader.table("classes");
  const TomlValue* sun = reader.table("sun");
  const TomlValue* ambient = reader.table("ambient");
  const TomlValue* water = reader.table("water");
  const TomlValue* physics = reader.table("physics");
  const TomlValue* current = reader.table("current");
  const TomlValue* acoustics = reader.table("acoustics");
  const TomlValue* lab = reader.table("lab");
  const TomlValue* sources = reader.table("sources");
  const auto& objects = reader.tables("objects");
  const auto& vehicles = reader.tables("vehicles");
  NERITIC_TRY_STATUS(reader.status());
  NERITIC_TRY_STATUS(read_classes(scene, source, classes));
  if (sun) {
    NERITIC_TRY(scene.sun, read_sun(source, *sun));
  }
  if (ambient) {
    NERITIC_TRY(scene.ambient, read_ambient(source, *ambient));
  }
  if (water) {
    NERITIC_TRY(scene.water, read_water(source, *water));
  }
  if (acoustics) {
    NERITIC_TRY(scene.acoustics, read_acoustics(source, *acoustics));
  }
  if (lab) {
    NERITIC_TRY(scene.world_from_lab, read_lab(source, *lab));
  }
  NERITIC_TRY_STATUS(read_physics(draft, source, physics, current));
  NERITIC_TRY_STATUS(read_sensors(draft, reader, ""));  // first: a scene's own camera leads
  NERITIC_TRY_STATUS(read_objects(draft, source, objects, "objects"));
  NERITIC_TRY_STATUS(read_objects(draft, source, vehicles, "vehicles"));
  NERITIC_TRY_STATUS(read_vehicle_physics(draft, source, objects, "objects", 0));
  NERITIC_TRY_STATUS(read_vehicle_physics(draft, source, vehicles, "vehicles", objects.size()));
  NERITIC_TRY_STATUS(read_sources(draft, source, sources));
  return draft;
}

}  // namespace neritic::scene
