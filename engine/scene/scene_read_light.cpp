// Reads [sun] with its terms, and [ambient] with its own.
#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/scene/scene_reader.hpp"
#include "engine/scene/sun_position.hpp"

namespace neritic::scene {
namespace {

SunShadows read_shadows(TableReader& reader) {
  SunShadows shadows;
  shadows.size = static_cast<std::uint32_t>(reader.whole("size", shadows.size, 64, 4096));
  shadows.cascades = static_cast<std::uint32_t>(reader.whole("cascades", shadows.cascades, 1, 4));
  shadows.reach_m = reader.number("reach_m", shadows.reach_m, {1, 1000, false, false, "metres"});
  shadows.full_resolution = reader.flag("full_resolution", false);
  return shadows;
}

Caustics read_caustics(TableReader& reader) {
  Caustics caustics;
  caustics.tile_m = reader.number("tile_m", caustics.tile_m, {0.5, 100, false, false, "metres"});
  caustics.texels = static_cast<std::uint32_t>(reader.whole("texels", caustics.texels, 16, 1024));
  if (reader.has("waves") && (reader.has("wind_m_s") || reader.has("direction_deg")))
    reader.refuse("waves", "no wind_m_s or direction_deg beside it");
  for (const auto& row : reader.rows("waves", {3}, {-360, 1000})) {
    if (!(row[1] >= 0.02) || std::abs(row[0]) > 10.0) {
      reader.refuse("waves",
                    "rows [amplitude_m, wavelength_m, direction_deg], at most 10 m high, "
                    "at least 0.02 m long");
      return caustics;
    }
    caustics.waves.push_back({row[0], row[1], radians(row[2])});
  }
  if (caustics.waves.size() > kMostCausticWaves || (reader.has("waves") && caustics.waves.empty()))
    reader.refuse("waves", fmt::format("1 to {} rows [amplitude_m, wavelength_m, direction_deg]",
                                       kMostCausticWaves));
  caustics.wind_m_s = reader.number("wind_m_s", caustics.wind_m_s, {0, 15, false, false, "m/s"});
  caustics.direction_rad = radians(reader.number("direction_deg", 0.0, kAnyTurn));
  return caustics;
}

Shafts read_shafts(TableReader& reader) {
  Shafts shafts;
  shafts.samples = static_cast<std::uint32_t>(reader.whole("samples", shafts.samples, 1, 256));
  shafts.reach_m = reader.number("reach_m", shafts.reach_m, {0.5, 1000, false, false, "metres"});
  return shafts;
}

Vec3 cells_along(const Skylight& skylight) {
  return glm::ceil((skylight.high_m - skylight.low_m) / skylight.cell_m);
}

Skylight read_skylight(TableReader& reader) {
  Skylight skylight;
  const std::vector<double> box = reader.numbers("box_m", {6}, {-1e5, 1e5});
  if (box.empty()) {
    reader.refuse("box_m", "[x, y, z, x, y, z], two opposite corners");
    return skylight;
  }
  const Vec3 a(box[0], box[1], box[2]), b(box[3], box[4], box[5]);
  skylight.low_m = glm::min(a, b);
  skylight.high_m = glm::max(a, b);
  skylight.cell_m = reader.number("cell_m", skylight.cell_m, {0.05, 100, false, false, "metres"});
  skylight.samples = static_cast<std::uint32_t>(reader.whole("samples", skylight.samples, 1, 64));
  const Vec3 cells = cells_along(skylight);
  if (!(cells.x * cells.y * cells.z >= 1.0) || !(cells.x * cells.y * cells.z <= kMostSkylightCells))
    reader.refuse("box_m", fmt::format("a box of 1 to {:g} cells of cell_m; this one has {:g}",
                                       kMostSkylightCells, cells.x * cells.y * cells.z));
  return skylight;
}

// By elevation and azimuth, or by latitude, day and hour.
void read_place_of_sun(TableReader& reader, Sun& sun) {
  const bool by_time = reader.has("latitude_deg") || reader.has("day") || reader.has("hour");
  if (by_time && (reader.has("elevation_deg") || reader.has("azimuth_deg")))
    reader.refuse_table("elevation_deg or azimuth_deg beside latitude_deg, day or hour",
                        "one way to say where the sun stands");
  if (by_time) {
    const SunPosition at = sun_position(
        radians(reader.number("latitude_deg", 0.0, {-90, 90, false, false, "degrees"})),
        static_cast<double>(reader.whole("day", 172, 1, 366)),
        reader.number("hour", 12.0, {0, 24, false, false, "hours"}));
    sun.elevation_rad = at.elevation_rad;
    sun.azimuth_rad = at.azimuth_rad;
    return;
  }
  sun.elevation_rad =
      radians(reader.number("elevation_deg", 55.0, {-90, 90, false, false, "degrees"}));
  sun.azimuth_rad = radians(reader.number("azimuth_deg", 0.0, kAnyTurn));
}

}  // namespace

std::array<std::uint32_t, 3> cells_of(const Skylight& skylight) {
  const Vec3 cells = cells_along(skylight);
  std::array<std::uint32_t, 3> out{};
  for (int i = 0; i < 3; ++i)
    out[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(std::max(cells[i], 1.0));
  return out;
}

Result<Sun> read_sun(const SceneSource& source, const TomlValue& table) {
  TableReader reader(source, table, "sun", kSunKeys);
  Sun sun;
  read_place_of_sun(reader, sun);
  sun.intensity = reader.number("intensity", 1.0, {0, 1000});
  sun.overcast = reader.number("overcast", 0.0, {0, 1});
  if (const TomlValue* shadows = reader.table("shadows")) {
    TableReader inner(source, *shadows, "sun.shadows", kSunShadowKeys);
    sun.shadows = read_shadows(inner);
    NERITIC_TRY_STATUS(inner.status());
  }
  if (const TomlValue* caustics = reader.table("caustics")) {
    TableReader inner(source, *caustics, "sun.caustics", kCausticsKeys);
    sun.caustics = read_caustics(inner);
    NERITIC_TRY_STATUS(inner.status());
  }
  if (const TomlValue* shafts = reader.table("shafts")) {
    TableReader inner(source, *shafts, "sun.shafts", kShaftKeys);
    sun.shafts = read_shafts(inner);
    NERITIC_TRY_STATUS(inner.status());
    if (!sun.shadows && !sun.caustics)
      reader.refuse("shafts", "beside sun.shadows or sun.caustics");
  }
  NERITIC_TRY_STATUS(reader.status());
  return sun;
}

Result<Ambient> read_ambient(const SceneSource& source, const TomlValue& table) {
  TableReader reader(source, table, "ambient", kAmbientKeys);
  Ambient ambient;
  ambient.bottom_color = Vec3f(reader.vector3("bottom_color", Vec3(ambient.bottom_color), {0, 1}));
  if (reader.has("bottom_depth_m"))
    ambient.bottom_depth_m =
        reader.number("bottom_depth_m", 0.0, {0, 12000, false, false, "metres"});
  ambient.occlusion_m = reader.number("occlusion_m", 0.0, {0, 20, false, false, "metres"});
  ambient.occlusion_samples =
      static_cast<std::uint32_t>(reader.whole("occlusion_samples", 8, 4, 64));
  if (reader.has("occlusion_samples") && ambient.occlusion_m == 0.0)
    reader.refuse("occlusion_samples", "beside an occlusion_m above 0");
  ambient.skylight = read_term<Skylight>(reader, "skylight", kSkylightKeys, read_skylight);
  NERITIC_TRY_STATUS(reader.status());
  return ambient;
}

}  // namespace neritic::scene
