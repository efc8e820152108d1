// Reads the terms under [water], each a table: what is not named is not modelled.
#include <set>

#include "engine/core/refusal.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr Interval kBedDepth{-kFarthest_m, kFarthest_m, false, false, "metres"};
constexpr Interval kReach{0, 1000, true, false, "metres"};
constexpr Interval kWaterWarmth{-2, 40, false, false, "degrees Celsius"};
constexpr Interval kWaterSalt{0, 42, false, false, "psu"};
constexpr Interval kSomeSeconds{0, 1000, false, false, "seconds"};

ForwardScatter read_forward_scatter(TableReader& reader) {
  ForwardScatter out;
  out.angle_rad = radians(
      reader.number("angle_deg", degrees(out.angle_rad), {0.1, 10, false, false, "degrees"}));
  out.levels = static_cast<std::uint32_t>(reader.whole("levels", out.levels, 2, 8));
  return out;
}

Snow read_snow(TableReader& reader) {
  Snow out;
  out.density_m3 = reader.number("density_m3", out.density_m3,
                                 {0, 20000, false, false, "particles per cubic metre"});
  out.diameter_m = 1e-3 * reader.number("diameter_mm", 1e3 * out.diameter_m,
                                        {0, 50, true, false, "millimetres"});
  out.spread = reader.number("spread", out.spread, {0, 2});
  out.range_m = reader.number("range_m", out.range_m, {0, 20, true, false, "metres"});
  // Each is kept: 2e7 take some 3 s and 200 MB.
  constexpr double kMostParticles = 2e7;
  const double particles = out.density_m3 * 4.0 / 3.0 * kPi * std::pow(out.range_m, 3);
  if (particles > kMostParticles)
    reader.refuse("range_m",
                  fmt::format("at most {:.3g} m with {:g} particles per cubic metre",
                              std::cbrt(kMostParticles / particles) * out.range_m, out.density_m3));
  out.drift_m_s = reader.vector3("drift_m_s", out.drift_m_s, {-100, 100, false, false, "m/s"});
  out.shutter_s = reader.number("shutter_s", out.shutter_s, {0, 1, false, false, "seconds"});
  return out;
}

SeaState read_waves(TableReader& reader) {
  SeaState out;
  out.wind_m_s = reader.number("wind_m_s", out.wind_m_s, {0, 60, false, false, "m/s"});
  out.fetch_m =
      1e3 * reader.number("fetch_km", 1e-3 * out.fetch_m, {0.01, 1e4, false, false, "kilometres"});
  out.direction_rad = radians(reader.number("direction_deg", 0.0, kAnyTurn));
  out.components = static_cast<std::uint32_t>(reader.whole("components", out.components, 1, 48));
  out.seed = reader.whole("seed", out.seed, 0, INT64_MAX);
  return out;
}

BubbleSource read_bubbles(TableReader& reader) {
  BubbleSource out;
  out.on = reader.text("on", "");
  out.place = reader.place("on");
  if (out.on.empty()) reader.refuse("on", "the name of an object");
  out.joint_name = reader.text("joint", "");
  out.place_joint = reader.place("joint");
  out.position_m = reader.vector3("position_m", Vec3(0.0), kAnyMetres);
  out.breath_s = reader.number("breath_s", out.breath_s, {0, 120, false, false, "seconds"});
  out.flow_m3_s =
      reader.number("flow_l_min", 6e4 * out.flow_m3_s, {0, 2000, true, false, "litres a minute"}) /
      6e4;
  out.median_radius_m = 0.5e-3 * reader.number("diameter_mm", 2e3 * out.median_radius_m,
                                               {0.5, 100, false, false, "millimetres"});
  out.height_m = reader.number("height_m", out.height_m, {0, 100, true, false, "metres"});
  return out;
}

SiltSource read_silt(TableReader& reader) {
  SiltSource out;
  out.on = reader.text("on", "");
  out.place = reader.place("on");
  if (out.on.empty()) reader.refuse("on", "the name of an object");
  out.joint_name = reader.text("joint", "");
  out.place_joint = reader.place("joint");
  out.position_m = reader.vector3("position_m", Vec3(0.0), kAnyMetres);
  if (!reader.has("bed_depth_m")) reader.refuse_table("no bed_depth_m", "bed_depth_m, in metres");
  out.bed_depth_m = reader.number("bed_depth_m", 0.0, kBedDepth);
  out.reach_m = reader.number("reach_m", out.reach_m, {0, 20, true, false, "metres"});
  out.hang_s = reader.number("hang_s", out.hang_s, {1, 600, false, false, "seconds"});
  return out;
}

Murk read_murk(TableReader& reader) {
  Murk out;
  if (!reader.has("bed_depth_m")) reader.refuse_table("no bed_depth_m", "bed_depth_m, in metres");
  out.bed_depth_m = reader.number("bed_depth_m", 0.0, kBedDepth);
  out.thickness_m = reader.number("thickness_m", out.thickness_m, kReach);
  out.factor = reader.number("factor", out.factor, {1, 1000});
  return out;
}

WaterLayer read_layer(TableReader& reader, const SeaWater& above) {
  WaterLayer out;
  if (!reader.has("depth_m")) reader.refuse_table("no depth_m", "depth_m, in metres");
  out.depth_m = reader.number("depth_m", 0.0, {0, 12000, false, false, "metres"});
  out.thickness_m =
      reader.number("thickness_m", out.thickness_m, {0.01, 1000, false, false, "metres"});
  out.temperature_c = reader.number("temperature_c", above.temperature_c, kWaterWarmth);
  out.salinity_psu = reader.number("salinity_psu", above.salinity_psu, kWaterSalt);
  out.slope = reader.number("slope", out.slope, {0, 0.5});
  const auto lengths = reader.numbers("wavelength_m", {2}, {0.02, 1000, false, false, "metres"});
  if (lengths.size() == 2) {
    out.shortest_m = lengths[0];
    out.longest_m = lengths[1];
    if (!(lengths[0] < lengths[1]))
      reader.refuse("wavelength_m", "[shortest, longest], the first below the second");
  }
  return out;
}

// Layers from the surface down, none lighter than the one above, which would turn over.
std::optional<WaterColumn> read_column(TableReader& reader) {
  const std::vector<TomlValue>& tables = reader.tables("layers");
  if (tables.empty() && !reader.has("temperature_c") && !reader.has("salinity_psu"))
    return std::nullopt;
  WaterColumn out;
  out.temperature_c = reader.number("temperature_c", out.temperature_c, kWaterWarmth);
  out.salinity_psu = reader.number("salinity_psu", out.salinity_psu, kWaterSalt);
  if (tables.size() > out.layer.size())
    reader.refuse("layers", fmt::format("at most {} tables", out.layer.size()));
  SeaWater above{out.temperature_c, out.salinity_psu};
  double depth_m = -1.0;
  for (std::size_t i = 0; i < tables.size() && reader.ok(); ++i) {
    TableReader one(reader.source(), tables[i], fmt::format("{}[{}]", reader.path("layers"), i),
                    kLayerKeys);
    const WaterLayer layer = read_layer(one, above);
    const SeaWater below{layer.temperature_c, layer.salinity_psu};
    if (!(layer.depth_m > depth_m)) one.refuse("depth_m", "a depth below that of the layer above");
    const double lighter_kg_m3 = sea_density_kg_m3(above) - sea_density_kg_m3(below);
    if (lighter_kg_m3 > 0.0)
      one.refuse_table(fmt::format("water {:.3f} kg/m^3 lighter than that above", lighter_kg_m3),
                       "colder or saltier water");
    if (!one.ok()) reader.fail(one.status().error());
    out.layer[out.count++] = layer;
    above = below;
    depth_m = layer.depth_m;
  }
  return out;
}

// The column's speed of sound as rows, dense about each transition.
SonarTable speed_rows(const WaterColumn& column) {
  std::set<double> depths{0.0};
  for (double depth_m = 25.0; depth_m < 12000.0; depth_m *= 1.25) depths.insert(depth_m);
  for (const WaterLayer& layer : column.layers())
    for (int i = -16; i <= 16; ++i) depths.insert(layer.depth_m + 0.25 * i * layer.sigma_m());
  SonarTable out;
  for (const double depth_m : depths)
    if (depth_m >= 0.0 && (out.empty() || depth_m - out.back().x > 1e-4))
      out.push_back({depth_m, column.sound_speed_m_s(depth_m)});
  return out;
}

}  // namespace

Status resolve_water_column(Scene& scene) {
  const WaterColumn* column = scene.water && scene.water->column ? &*scene.water->column : nullptr;
  for (Sonar& sonar : scene.sonars) {
    if (column && !sonar.terms.water.own) sonar.terms.water.column = *column;
    if (!sonar.terms.profile || !sonar.terms.profile->layers) continue;
    if (!column)
      return refusal(fmt::format("{}: {}: sound_speed.profile", scene.path, sonar.name),
                     "\"layers\" without any", "[[water.layers]] in the scene, or a table");
    sonar.terms.profile->table = speed_rows(*column);
  }
  if (column && !scene.acoustics && !scene.modems.empty()) {
    scene.acoustics.emplace();
    scene.acoustics->temperature_c = column->temperature_c;
    scene.acoustics->salinity_psu = column->salinity_psu;
    scene.acoustics->profile = speed_rows(*column);
  }
  return {};
}

void read_water_terms(TableReader& reader, Water& water) {
  water.forward_scatter = read_term<ForwardScatter>(reader, "forward_scatter", kForwardScatterKeys,
                                                    read_forward_scatter);
  water.snow = read_term<Snow>(reader, "snow", kSnowKeys, read_snow);
  water.waves = read_term<SeaState>(reader, "waves", kWavesKeys, [&](TableReader& waves) {
    water.waves_move = waves.flag("moves", false);
    return read_waves(waves);
  });
  water.murk = read_term<Murk>(reader, "murk", kMurkKeys, read_murk);
  water.column = read_column(reader);
  const auto each = [&](Key key, KeyList keys, auto read, auto& out) {
    std::size_t i = 0;
    for (const TomlValue& table : reader.tables(key)) {
      TableReader one(reader.source(), table, fmt::format("{}[{}]", reader.path(key), i++), keys);
      out.push_back(read(one));
      if (!one.ok()) reader.fail(one.status().error());
    }
  };
  each("bubbles", kBubbleKeys, read_bubbles, water.bubbles);
  each("silt", kSiltKeys, read_silt, water.silt);
  if (water.waves && !water.surface)
    reader.refuse_table("waves without a surface", "surface = true");
}

Status resolve_water_sources(Scene& scene) {
  if (!scene.water) return {};
  const auto resolve = [&](auto& sources) -> Status {
    for (auto& source : sources) {
      for (std::size_t i = 0; i < scene.objects.size(); ++i)
        if (scene.objects[i].name == source.on) source.object = static_cast<int>(i);
      if (source.object < 0)
        return refusal(source.place, fmt::format("\"{}\"", source.on),
                       "the name of an object of the scene");
      if (source.joint_name.empty()) continue;
      NERITIC_TRY(source.joint, find_joint(scene.objects[static_cast<std::size_t>(source.object)],
                                           scene.models, source.joint_name, source.place_joint));
    }
    return {};
  };
  NERITIC_TRY_STATUS(resolve(scene.water->bubbles));
  return resolve(scene.water->silt);
}

}  // namespace neritic::scene
