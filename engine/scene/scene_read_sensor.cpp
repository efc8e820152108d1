// Reads [[cameras]], [[sonars]] and [[lamps]], of the scene or of an object that carries them.
#include "engine/core/image.hpp"
#include "engine/scene/color_temperature.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr Interval kStops{-30, 30, false, false, "stops"};

Exposure read_exposure(TableReader& reader) {
  Exposure exposure;
  exposure.compensation_ev = reader.number("exposure_compensation_ev", 0.0, kStops);
  const TomlValue* value = reader.find("exposure");
  if (!value || (value->kind == TomlValue::Kind::kString && value->text == "auto")) return exposure;
  if (value->is_number() && kStops.holds(value->number))
    exposure.fixed_ev = value->number;
  else
    reader.refuse("exposure", "\"auto\" or a number in " + kStops.text());
  return exposure;
}

// The level's knobs, and those that the file turns itself.
PictureDetail read_detail(TableReader& reader) {
  PictureDetail detail = picture_level(reader.choice("quality", "standard", kPictureLevels)).detail;
  if (reader.has("max_error")) {
    const PictureLevel* level =
        picture_level_within(reader.number("max_error", 1.0, {0, 1, true, false}));
    if (reader.has("quality")) {
      reader.refuse("max_error", "no such key beside quality");
    } else if (!level) {
      reader.refuse("max_error",
                    fmt::format("at least {}, the best level's", picture_level("reference").error));
    } else {
      detail = level->detail;
    }
  }
  const TomlValue* table = reader.table("detail");
  if (!table) return detail;
  TableReader knobs(reader.source(), *table, reader.path("detail"), kDetailKeys);
  const auto whole = [&](Key key, std::uint32_t& value, std::int64_t low, std::int64_t high) {
    value = static_cast<std::uint32_t>(knobs.whole(key, value, low, high));
  };
  detail.resolution = knobs.number("resolution", detail.resolution, {0.1, kMostResolution});
  if (detail.resolution > 1.0 && detail.resolution != std::floor(detail.resolution))
    knobs.refuse("resolution", "[0.1, 1], 2, 3 or 4");
  detail.shadow_size = knobs.number("shadow_size", detail.shadow_size, {0.0625, 4});
  whole("cascades", detail.cascades, 1, 4);
  whole("shadow_samples", detail.shadow_samples, 1, 64);
  whole("visibility_step", detail.visibility_step, 1, 4);
  detail.mesh_error = knobs.number("mesh_error", detail.mesh_error, {0, kMostMeshError});
  detail.occlusion_samples =
      knobs.number("occlusion_samples", detail.occlusion_samples, {0.125, 8});
  whole("inscatter_samples", detail.inscatter_samples, 1, 64);
  whole("waves", detail.waves, 1, 48);
  whole("scatter_levels", detail.scatter_levels, 2, 8);
  detail.shaft_samples = knobs.number("shaft_samples", detail.shaft_samples, {0.0625, 8});
  detail.particles = knobs.number("particles", detail.particles, {0, 1});
  if (!knobs.ok()) reader.fail(knobs.status().error());
  return detail;
}

void read_camera(TableReader& reader, Camera& camera) {
  camera.width = static_cast<std::uint32_t>(reader.whole("width", 1280, 1, kMaxPictureSide));
  camera.height = static_cast<std::uint32_t>(reader.whole("height", 720, 1, kMaxPictureSide));
  camera.vertical_fov_rad =
      radians(reader.number("fov_deg", 60.0, {1, 170, true, true, "degrees"}));
  camera.near_m = reader.number("near_m", 0.05, kNear);
  camera.rate_hz = reader.number("rate_hz", 30.0, kRate);
  camera.stereo_baseline_m =
      reader.number("stereo_baseline_m", 0.0, {0, 10, false, false, "metres"});
  camera.antialias = reader.flag("antialias", false);
  camera.exposure = read_exposure(reader);
  camera.detail = read_detail(reader);
  read_camera_terms(reader, camera);
}

// How its light spreads: a cone, a bell curve by its half-intensity angle, or a data sheet's table.
void read_lamp_beam(TableReader& reader, Lamp& lamp) {
  int ways = 0;
  for (const Key key : {"cone_deg", "half_intensity_deg", "profile"})
    ways += reader.has(key) ? 1 : 0;
  if (ways > 1)
    reader.refuse_table("several of cone_deg, half_intensity_deg, profile", "one of them");
  if (reader.has("half_intensity_deg"))
    lamp.profile = gaussian_profile(
        radians(reader.number("half_intensity_deg", 20.0, {0.5, 90, false, false, "degrees"})));
  std::vector<std::pair<double, double>> rows;
  for (const auto& row : reader.rows("profile", {2}, {0, 180})) {
    const bool rises = rows.empty() ? row[0] == 0.0 : radians(row[0]) > rows.back().first;
    if (!rises || row[1] > 1.0) {
      reader.refuse("profile", "rows [angle_deg, share], angles rising from 0, shares in [0, 1]");
      return;
    }
    rows.emplace_back(radians(row[0]), row[1]);
  }
  if (reader.has("profile")) {
    if (rows.size() < 2) {
      reader.refuse("profile", "two rows [angle_deg, share] or more");
      return;
    }
    lamp.profile = table_profile(rows);
    if (!(lamp.profile->solid_angle_sr() > 0.0)) reader.refuse("profile", "some light");
  }
  if (lamp.profile) lamp.outer_cone_rad = lamp.profile->edge_rad;
  const std::vector<double> cone =
      reader.numbers("cone_deg", {2}, {0, 90, false, false, "degrees"});
  if (cone.size() != 2) return;
  lamp.inner_cone_rad = radians(cone[0]);
  lamp.outer_cone_rad = radians(cone[1]);
  if (!(cone[0] < cone[1]))
    reader.refuse("cone_deg", "[inner, outer] half angles, the inner smaller than the outer");
}

void read_lamp(TableReader& reader, Lamp& lamp) {
  lamp.color = Vec3f(reader.vector3("color", Vec3(1.0), {0, 1}));
  if (reader.has("temperature_k")) {
    if (reader.has("color")) reader.refuse("temperature_k", "no color beside it");
    lamp.color = color_of_temperature(
        reader.number("temperature_k", 5600.0, {1500, 15000, false, false, "kelvin"}));
  }
  lamp.shadows = reader.flag("shadows", false);
  lamp.shadow_size = static_cast<std::uint32_t>(reader.whole("shadow_size", 512, 64, 2048));
  if (reader.has("shadow_size") && !lamp.shadows)
    reader.refuse("shadow_size", "beside shadows = true");
  const std::vector<double> strobe =
      reader.numbers("strobe_s", {2}, {0, 3600, true, false, "seconds"});
  if (strobe.size() == 2) {
    lamp.strobe_period_s = strobe[0];
    lamp.strobe_flash_s = strobe[1];
    if (!(strobe[1] < strobe[0])) reader.refuse("strobe_s", "[period, flash], the flash shorter");
  }
  lamp.intensity_cd = reader.number("intensity_cd", 1000.0, {0, 1e7, false, false, "candela"});
  read_lamp_beam(reader, lamp);
  if (!reader.has("flux_lm")) return;
  if (reader.has("intensity_cd")) reader.refuse("flux_lm", "no intensity_cd beside it");
  const double flux_lm = reader.number("flux_lm", 1000.0, {0, 1e7, false, false, "lumen"});
  lamp.intensity_cd =
      flux_lm / (lamp.profile ? lamp.profile->solid_angle_sr()
                              : cone_solid_angle_sr(lamp.inner_cone_rad, lamp.outer_cone_rad));
}

// Reads one array of tables. kind: "cameras"; carried sensors are named after their object.
template <class Sensor, class Read>
Status read_array(std::vector<MountedDraft<Sensor>>& out, TableReader& parent, Key kind,
                  const std::string& object, KeyList keys, Read read) {
  const std::vector<TomlValue>& tables = parent.tables(kind);
  NERITIC_TRY_STATUS(parent.status());
  const std::string singular(kind.substr(0, kind.size() - 1));
  for (std::size_t i = 0; i < tables.size(); ++i) {
    TableReader reader(parent.source(), tables[i], fmt::format("{}[{}]", parent.path(kind), i),
                       keys);
    MountedDraft<Sensor> draft;
    const std::string own = i == 0 ? singular : fmt::format("{}_{}", singular, i);
    draft.sensor.name = read_name(reader, own);
    if (!object.empty()) draft.sensor.name = object + "_" + draft.sensor.name;
    if (!object.empty() && reader.has("on"))
      reader.refuse("on", fmt::format("no such key here: it is mounted on {}", object));
    draft.placement = read_placement(reader, object);
    draft.place = reader.place("name");
    read(reader, draft.sensor);
    NERITIC_TRY_STATUS(reader.status());
    out.push_back(std::move(draft));
  }
  return {};
}

}  // namespace

Status read_sensors(SceneDraft& draft, TableReader& parent, const std::string& parent_object) {
  NERITIC_TRY_STATUS(
      read_array(draft.cameras, parent, "cameras", parent_object, kCameraKeys, read_camera));
  NERITIC_TRY_STATUS(
      read_array(draft.sonars, parent, "sonars", parent_object, kSonarKeys, read_sonar));
  return read_array(draft.lamps, parent, "lamps", parent_object, kLampKeys, read_lamp);
}

}  // namespace neritic::scene
