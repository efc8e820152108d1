// A scene: what a TOML file names, resolved (includes merged, models loaded, units SI, angles in
// radians). It holds only what the file named: an effect that is absent here is neither modelled
// nor paid for. World frame; positions double. A plain value; any thread may read it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/camera_terms.hpp"
#include "engine/scene/flock.hpp"
#include "engine/scene/lamp_profile.hpp"
#include "engine/scene/model.hpp"
#include "engine/scene/modem_settings.hpp"
#include "engine/scene/physics_settings.hpp"
#include "engine/scene/picture_detail.hpp"
#include "engine/scene/scene_light.hpp"
#include "engine/scene/scene_water.hpp"
#include "engine/scene/sonar_settings.hpp"
#include "engine/scene/source_settings.hpp"
#include "engine/scene/track.hpp"

namespace neritic::scene {

// Semantic classes. 0 is nothing. The names and ids below are known everywhere; a scene's [classes]
// adds others.
struct ClassName {
  const char* name;
  std::uint16_t id;
};
inline constexpr ClassName kClasses[] = {
    {"seabed", 1}, {"rock", 2},  {"wreck", 3}, {"diver", 4}, {"rov", 5},        {"fish", 6},
    {"shark", 7},  {"plant", 8}, {"coral", 9}, {"pipe", 10}, {"structure", 11}, {"target", 12}};

// A hull on the waves: heave, roll and pitch of the plane that fits them over its footprint.
struct Afloat {
  SeaState sea;
  SeaWaves waves;              // of that
  Vec2 length_breadth_m{0.0};  // along its axis z, and along x
};

// Where something is: in the world, or on an object (then the pose is object_from_this).
struct Mount {
  int object = -1;                                 // index into Scene::objects; -1: the world
  Pose pose;                                       // of what moves: at time 0
  std::optional<Track> track = {};                 // absent: it stands still there
  std::shared_ptr<const Afloat> afloat = nullptr;  // null: no waves move it; in the world alone
  int joint = -1;  // node of the object's model, as it is posed; -1: the object's origin
  Pose pose_at(double time_s) const { return track ? scene::pose_at(*track, time_s) : pose; }
};

struct Object {
  std::string name;
  int model = -1;  // index into Scene::models; -1: not drawn, it carries others
  Mount mount;
  Vec3 scale{1.0};
  std::uint16_t class_id = 0;
  std::uint16_t instance = 0;  // label, unique; first of instance_count() consecutive labels
  float reflectivity = 1.0f;   // acoustic, 0 to 1, multiplies the incidence term
  std::string material;        // by name, for its acoustic impedance; empty: none
  std::optional<double> backscatter_db;  // Lambert's strength of the surface, 10 log mu
  int clip = -1;                         // of the model; -1: rest pose
  double clip_offset_s = 0.0, clip_rate = 1.0;
  Collision collision = Collision::kNone;  // without [physics]: none
  std::optional<Dynamics> dynamics;  // it moves by physics, from its mount's pose at time 0 on
  std::optional<Human> human;        // likewise, by its limbs
  std::vector<InputChoice> inputs;   // the source of its pose; empty: its mount alone
  std::optional<Thing> thing;        // that grippers and hands can carry
  // Extra copies: object_from_copy. Empty: drawn once at the mount. Each copy has its own label.
  std::vector<Mat4> copies;
  std::optional<Flock> flock = {};  // moves the copies
  std::size_t instance_count() const { return copies.empty() ? 1 : copies.size(); }
};

// Light at the surface. Sun irradiance and colour come from the water model's spectrum.
struct Sun {
  double elevation_rad = 1.0,
         azimuth_rad = 0.0;  // in air; azimuth from -Z (north) towards +X (east)
  double intensity = 1.0;    // 1: clear day
  double overcast = 0.0;     // share of the sky that clouds cover
  std::optional<SunShadows> shadows = {};
  std::optional<Caustics> caustics = {};
  std::optional<Shafts> shafts = {};
};

// Jerlov's optical water types (Jerlov 1976): five oceanic, five coastal.
inline constexpr std::string_view kWaterTypes[] = {"I",  "IA", "IB", "II", "III",
                                                   "1C", "3C", "5C", "7C", "9C"};

struct Water {
  std::string type = "II";  // of kWaterTypes
  bool scattering = false;  // backscatter along the line of sight
  bool surface = false;     // the surface seen from below (Snell's window)
  std::optional<ForwardScatter> forward_scatter = {};
  std::optional<Snow> snow = {};
  std::optional<SeaState> waves = {};  // of the surface; absent: flat
  bool waves_move = false;             // bodies that physics moves feel them
  std::optional<Murk> murk = {};
  std::optional<WaterColumn> column = {};  // temperature, salinity and their layers
  std::vector<BubbleSource> bubbles = {};
  std::vector<SiltSource> silt = {};
};

struct Lamp {
  std::string name;
  Mount mount;  // shines along the mount's -Z
  Vec3f color{1.0f};
  double intensity_cd = 1000.0;
  double inner_cone_rad = 0.3, outer_cone_rad = 0.6;
  std::optional<LampProfile> profile = {};  // instead of the cone; its edge is outer_cone_rad
  bool shadows = false;
  std::uint32_t shadow_size = 512;                     // texels a side of what it sees
  double strobe_period_s = 0.0, strobe_flash_s = 0.0;  // 0: it burns steadily
};

// A light that a model brings, shown by an object or one of its copies (see model_lights.hpp).
struct ModelLight {
  std::size_t object = 0;
  int copy = -1;  // of Object::copies; -1: the object itself
  int node = 0;   // of the object's model; it names the light
};

struct Exposure {
  // "auto": from the light that the water leaves at the camera's depth; else stops over that.
  double compensation_ev = 0.0;
  std::optional<double> fixed_ev;  // absolute: 2^-ev scales radiance
};

struct Camera {
  std::string name;
  Mount mount;
  std::uint32_t width = 1280, height = 720;
  double vertical_fov_rad = radians(60.0);
  double near_m = 0.05;
  double rate_hz = 30.0;
  double stereo_baseline_m = 0.0;  // > 0: a stereo pair by one multiview pass
  bool antialias = false;          // smooth edges of the display picture
  PictureDetail detail;            // how finely that is made
  Exposure exposure;
  CameraTerms terms;
};

struct Sonar {
  std::string name;
  SonarKind kind = SonarKind::kImaging;
  Mount mount;
  double range_min_m = 1.0, range_max_m = 5.0;
  double azimuth_rad = radians(90.0), elevation_rad = radians(28.0);  // full apertures
  std::uint32_t bins_range = 500, bins_azimuth = 500, bins_elevation = 500;
  double rate_hz = 10.0;
  // G-buffer pixels per beam cell, linear (1: a pixel a cell); 0: the documented default.
  double gbuffer_scale = 0.0;
  std::string gather;  // "plane", "nearest", "published"; empty: the documented default
  double near_m = 0.02;
  double semi_angle_rad = radians(12.5);  // echo sounder: of its cone
  double depression_rad = radians(35.0);  // side-scan: of each side's axis below the horizontal
  double step_rad = radians(1.0);         // mechanical: from ping to ping
  // Side-scan: a camera that looks straight down, from whose pictures the image-based record is
  // made beside the acoustic one; empty: none.
  std::string picture_camera;
  // "draft", "standard", "reference" or an error to stay under: what is not set follows from it.
  std::string quality;
  double max_error = 0.0;  // 0: not named
  // The file names nothing of how beams are sampled: load_scene chooses the quality, which then
  // keeps the range bins and makes nothing coarser.
  bool quality_chosen = false;
  double least_target_m = 0.0;  // with a chosen standard: of small_targets.hpp; 0: none
  SonarTerms terms;
};
// Whether all but name, rate and mount are the same.
bool same_settings(const Sonar& a, const Sonar& b);

struct Scene {
  std::string title;
  std::string path;
  std::uint64_t seed = 1;
  std::vector<std::shared_ptr<const Model>> models;
  std::vector<Object> objects;
  std::map<std::uint16_t, std::string> class_names;
  std::optional<Sun> sun;
  std::optional<Ambient> ambient;
  std::optional<Water> water;
  std::optional<Physics> physics;
  std::optional<Current> current;
  std::vector<DeviceSource> sources;  // devices that feed its divers
  std::vector<Lamp> lamps;
  std::vector<ModelLight> model_lights;  // those that shine beside lamps and sun
  std::vector<Camera> cameras;
  std::vector<Sonar> sonars;
  // Where the frame of a lab's tracking (headset, motion suit) lies; absent: as the wearer starts.
  std::optional<Pose> world_from_lab;
  std::vector<std::string> notes;  // what was ignored, once each
  std::vector<Modem> modems;       // each on an object that physics or devices move
  std::optional<Acoustics> acoustics;

  // World_from_mount at a time by tracks, with all that carries it (motion.hpp: by physics too).
  Pose world_from(const Mount& mount, double time_s = 0.0) const;
  // World_from_model of one copy, the object's scale in it: copy < object.instance_count(). After
  // loading, scale is 1 wherever there are copies: theirs hold it.
  Mat4 world_from_copy(const Object& object, std::size_t copy, double time_s = 0.0) const;
};

// Positions: farther out than the Earth's circumference is a mistake.
inline constexpr double kFarthest_m = 4e7;

struct SceneOptions {
  Vec3 offset_m{0.0};         // added to everything fixed to the world: to test far from the origin
  std::string sonar_quality;  // of every sonar, whatever the file says; empty: as it says
  // Stands for what the file says; paths in it are relative to the file, which need not be there.
  std::optional<std::string> text;
  // Files that are merged over it, as if each included it: more sensors, another light.
  std::vector<std::filesystem::path> added;
};

// Reads a scene file (its format: assets/scenes/README.md). Every error names file, line and key,
// what was found, what is accepted (an unknown key with the nearest known one).
Result<Scene> load_scene(const std::filesystem::path& path, const SceneOptions& options = {});

// A scene that shows one model: framed by a camera, no water, lit by the model's own lights where
// it brings some, else by a sun. For `render model.glb`. clip: an index, or -1 for the first.
Scene scene_of_model(Model model, std::uint32_t width, std::uint32_t height, int clip = -1);

}  // namespace neritic::scene
