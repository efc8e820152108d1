// A scene half-way: what its file says, type- and range-checked, while names are not yet resolved
// nor models loaded. Inside engine/scene only. One thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/scene/scene_includes.hpp"
#include "engine/scene/scene_keys.hpp"
#include "engine/scene/shapes.hpp"

namespace neritic::scene {

// A track before the rotation that comes on top of its heading is known.
struct TrackDraft {
  std::vector<Track::Place> places;
  std::vector<Quat> recorded;  // attitudes of a file, one a place; empty: heading says
  TrackHeading heading;
  bool repeat = false;
};

// A pose with the names it depends on. place_*: "file:line: key", for errors.
struct PlacementDraft {
  Pose pose;  // of what moves: at time 0
  std::optional<TrackDraft> track;
  std::string on, look_at;  // names of objects; empty: none
  std::string joint;        // name of a node of on's model; empty: its origin
  std::optional<Vec3> look_at_m;
  std::string place_on, place_joint, place_look_at;
};

struct Look {
  Vec3 color{0.5};  // linear
  double roughness = 0.9, metallic = 0.0;
  bool double_sided = false;
  std::filesystem::path color_texture, normal_texture, detail_texture;
  std::string place_color_texture, place_normal_texture,
      place_detail_texture;                // "file:line: key", for errors
  double texture_m = 1.0, detail_m = 0.3;  // a repeat
};

// The model that an object draws. Two requests with the same identity() are the same model.
struct ModelRequest {
  enum class Kind { kFile, kShape, kTerrain, kTether };
  Kind kind = Kind::kFile;
  std::filesystem::path file;  // of kFile and kTerrain
  std::string node;            // of kFile; empty: the whole scene of the file
  std::string shape;           // of kShape
  double radius_m = 0.5, height_m = 1.0;
  Vec3 size_m{1.0};
  int segments = 48;  // of a tether: its joints
  bool inside_out = false;
  HeightfieldOptions heights;
  Look look;  // of kShape and kTerrain
  std::string place;

  std::string base_identity() const;  // without the node
  std::string identity() const { return base_identity() + "#" + node; }
};

struct ScatterDraft {
  std::uint32_t count = 1;
  std::uint64_t seed = 0;
  double x_min_m = 0, z_min_m = 0, x_max_m = 0, z_max_m = 0;
  std::string on;
  double scale_min = 1.0, scale_max = 1.0;
  bool align_to_surface = false;
  double sink_m = 0.0;
  struct KeepOut {
    double x_m, z_m, radius_m;
  };
  std::vector<KeepOut> keep_out;
  std::string place;  // of the table
};

struct ObjectDraft {
  Object object;
  PlacementDraft placement;
  std::optional<std::size_t> request;  // index into SceneDraft::requests; absent: not drawn
  std::string clip, place_clip;
  std::optional<ScatterDraft> scatter;
  std::string place, place_node;
};

template <class Sensor>
struct MountedDraft {
  Sensor sensor;
  PlacementDraft placement;
  std::string place;
};

struct SceneDraft {
  Scene scene;  // title, seed, classes, sun, water
  std::vector<ModelRequest> requests;
  std::vector<ObjectDraft> objects;
  std::vector<MountedDraft<Camera>> cameras;
  std::vector<MountedDraft<Sonar>> sonars;
  std::vector<MountedDraft<Lamp>> lamps;
};

// scene_read.cpp: the whole file. scene_read_object.cpp and so on: its parts.
Result<SceneDraft> read_draft(const SceneSource& source);

class TableReader;
// The keys that camera, sonar, lamp and object share. default_on: the object that the table is in.
PlacementDraft read_placement(TableReader& reader, const std::string& default_on);
std::string read_name(TableReader& reader, const std::string& otherwise);
// scene_read_track.cpp: the key track, where it is there.
std::optional<TrackDraft> read_track(TableReader& parent);
Track make_track(const TrackDraft& draft, const Quat& rotation);
// scene_read_camera.cpp: lens, sensor, white balance; width, height and field of view are read.
void read_camera_terms(TableReader& reader, Camera& camera);
// scene_read_sonar.cpp, scene_read_sonar_terms.cpp: a sonar's own keys, and its tables.
void read_sonar(TableReader& reader, Sonar& sonar);
void read_sonar_terms(TableReader& reader, SonarTerms& terms);
// Each appends to the draft. parent_object carries the sensors and prefixes their names; empty:
// none.
Status read_objects(SceneDraft& draft, const SceneSource& source,
                    const std::vector<TomlValue>& tables, const std::string& path);
Status read_sensors(SceneDraft& draft, TableReader& parent, const std::string& parent_object);
// scene_read_physics.cpp: [physics] and [current], absent where nullptr; then, once all objects are
// read, what is solid, moves by itself and where to. first_object: the draft of tables[0].
Status read_physics(SceneDraft& draft, const SceneSource& source, const TomlValue* physics,
                    const TomlValue* current);
Status read_vehicle_physics(SceneDraft& draft, const SceneSource& source,
                            const std::vector<TomlValue>& tables, const std::string& path,
                            std::size_t first_object);
// scene_read_mission.cpp: the table mission of the vehicle of that name.
Mission read_mission(TableReader& reader, const SceneDraft& draft, const std::string& vehicle);
// The key speed_over: "ground" or "water".
SpeedOver read_speed_over(TableReader& reader, SpeedOver otherwise);
// scene_read_inputs.cpp: the table inputs, with a key for any of the groups; empty where it is
// absent. recorded: the groups for which the scene names a file. then: the default of that key.
std::vector<InputChoice> read_inputs(TableReader& reader, KeyList groups, KeyList recorded,
                                     const std::string& then = "autopilot");
// scene_read_condition.cpp: the tables condition and regulator of a diver, where they are there.
std::optional<Condition> read_condition(TableReader& reader);
std::optional<Regulator> read_regulator(TableReader& reader);
// scene_read_tether.cpp: the table tether of the vehicle of that name, where it is there, and the
// object as which it is drawn, whose placement is the tether's top.
struct TetherDraft {
  std::optional<ObjectDraft> object;
  ModelRequest request;
};
std::optional<Tether> read_tether(TableReader& reader, const std::string& vehicle,
                                  TetherDraft& drawn);
// scene_read_carry.cpp: the tables thing, gripper, hands, wash, where they are there.
std::optional<Wash> read_wash(TableReader& reader);
std::optional<Thing> read_thing(TableReader& reader);
std::optional<Grip> read_grip(TableReader& reader, Key key);
// scene_read_modem.cpp: the table modem, where it is there; [acoustics].
std::optional<Modem> read_modem(TableReader& reader);
Result<Acoustics> read_acoustics(const SceneSource& source, const TomlValue& table);
// scene_read_sources.cpp: [sources], absent where nullptr, once all objects and their inputs are
// read.
Status read_sources(SceneDraft& draft, const SceneSource& source, const TomlValue* sources);

// scene_models.cpp: one model a distinct request, in the order of first use, and each request's.
struct LoadedModels {
  std::vector<std::shared_ptr<const Model>> models;
  std::vector<int> model_of_request;
};
Result<LoadedModels> load_models(const std::vector<ModelRequest>& requests);

// scene_node.cpp: the model that draws only that node and what hangs below it.
Result<Model> model_of_node(const Model& model, const std::string& node);

// scene_place.cpp: names to indices, look_at to rotations. Needs models and clips.
Status place_all(SceneDraft& draft, const std::vector<std::shared_ptr<const Model>>& models);
// A node of the object's model, by name; place: of the name, for errors.
Result<int> find_joint(const Object& object,
                       const std::vector<std::shared_ptr<const Model>>& models,
                       const std::string& name, const std::string& place);
// World pose at time 0 of what hangs on that mount's object, and there on its joint.
Pose world_from_carrier(const SceneDraft& draft,
                        const std::vector<std::shared_ptr<const Model>>& models,
                        const Mount& mount);

// scene_scatter.cpp: fills the copies of objects that are scattered. Needs placed objects.
Status scatter_all(SceneDraft& draft, const std::vector<std::shared_ptr<const Model>>& models);

}  // namespace neritic::scene
