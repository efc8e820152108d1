#include "sonar/terms_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/math.hpp"
#include "sonar/beam_pattern.hpp"

namespace neritic::sonar {
namespace {

using nlohmann::json;
using scene::SonarLevel;

// Degrees as they were written: radians and back are off by a last bit.
double degrees_of(double rad) {
  return std::round(degrees(rad) * 1e10) / 1e10;
}

json rows_json(const SonarTable& table) {
  json rows = json::array();
  for (const auto& [x, y] : table) rows.push_back({x, y});
  return rows;
}

json water_json(const scene::SonarWater& water) {
  json out{{"temperature_c", water.temperature_c},
           {"salinity_psu", water.salinity_psu},
           {"ph", water.ph}};
  if (water.column) {
    out = {{"ph", water.ph}};
    out["layers"] = json::array({{{"temperature_c", water.column->temperature_c},
                                  {"salinity_psu", water.column->salinity_psu}}});
    for (const WaterLayer& layer : water.column->layers())
      out["layers"].push_back({{"depth_m", layer.depth_m},
                               {"thickness_m", layer.thickness_m},
                               {"temperature_c", layer.temperature_c},
                               {"salinity_psu", layer.salinity_psu}});
  }
  if (water.depth_m) out["depth_m"] = *water.depth_m;
  if (water.sound_speed_m_s) out["sound_speed_m_s"] = *water.sound_speed_m_s;
  return out;
}

json absorption_json(const SonarLevel& level) {
  switch (level.absorption) {
    case SonarLevel::Absorption::kFrancoisGarrison:
      return "francois-garrison";
    case SonarLevel::Absorption::kAinslieMcColm:
      return "ainslie-mccolm";
    case SonarLevel::Absorption::kFixed:
      return level.absorption_db_per_m;
    case SonarLevel::Absorption::kNone:
      return "none";
  }
  return {};
}

json level_json(const SonarLevel& level) {
  json out{{"source_level_db", level.source_level_db},
           {"absorption", absorption_json(level)},
           {"spreading", level.spreading},
           {"gain_db", level.gain_db}};
  if (!level.tvg_table.empty()) {
    out["tvg"] = rows_json(level.tvg_table);
    return out;
  }
  out["tvg"] = level.tvg_log;
  out["tvg_absorption"] = level.tvg_absorption;
  return out;
}

void add_pattern(json& beam, const char* axis, const std::optional<scene::SonarPattern>& pattern) {
  if (!pattern) return;
  if (pattern->shape == BeamShape::kTable) {
    SonarTable degrees_db = pattern->table;
    for (SonarRow& row : degrees_db) row.x = degrees_of(row.x);
    beam[axis] = rows_json(degrees_db);
    return;
  }
  beam[axis] = name_of(pattern->shape);
  beam[std::string(axis) + "_deg"] = degrees_of(pattern->half_power_rad);
}

json beam_json(const scene::SonarBeam& beam) {
  json out = json::object();
  add_pattern(out, "azimuth", beam.azimuth);
  add_pattern(out, "elevation", beam.elevation);
  if (beam.samples > 1) out["samples"] = beam.samples;
  if (beam.steering == scene::SonarBeam::Steering::kFlat) out["steering"] = "flat";
  if (beam.two_way) out["two_way"] = *beam.two_way;
  return out;
}

json speckle_json(const scene::SonarSpeckle& speckle) {
  json out{{"scatterer_m", speckle.scatterer_m}, {"shape", speckle.shape}};
  if (speckle.shape > 0.0) out["texture_m"] = speckle.texture_m;
  return out;
}

json noise_json(const scene::SonarNoise& noise) {
  if (noise.level_db) return {{"level_db", *noise.level_db}};
  json out{{"wind_m_s", noise.wind_m_s}, {"shipping", noise.shipping}};
  if (noise.directivity_db > 0.0) out["directivity_db"] = noise.directivity_db;
  if (noise.self_db) out["self_db"] = *noise.self_db;
  return out;
}

json ghosts_json(const scene::SonarGhosts& ghosts) {
  json out{{"surface", ghosts.surface}};
  if (ghosts.surface) out["surface_reflection"] = ghosts.surface_reflection;
  if (ghosts.bottom_m) {
    out["bottom_m"] = *ghosts.bottom_m;
    out["bottom_reflection"] = ghosts.bottom_reflection;
  }
  return out;
}

json motion_json(const scene::SonarMotion& motion) {
  json out{{"within_ping", motion.within_ping}, {"doppler", motion.doppler}};
  if (motion.doppler) out["pulse_s"] = motion.pulse_s;
  return out;
}

json detection_json(const scene::SonarDetection& detection) {
  json out = json::object();
  if (detection.threshold) out["threshold"] = *detection.threshold;
  if (detection.floor_db) out["floor_db"] = *detection.floor_db;
  if (detection.quality > 0.0) out["quality"] = detection.quality;
  if (detection.pings != scene::SonarDetection{}.pings) out["pings"] = detection.pings;
  return out;
}

}  // namespace

json terms_json(const scene::SonarTerms& t) {
  json out = json::object();
  if (t.level) out["level"] = level_json(*t.level);
  if (json beam = beam_json(t.beam); !beam.empty()) out["beam"] = std::move(beam);
  using Window = scene::SonarRangeSpread::Window;
  if (t.range_spread)
    out["range_spread"] = {{"bandwidth_hz", t.range_spread->bandwidth_hz},
                           {"window", t.range_spread->window == Window::kHann ? "hann" : "none"}};
  if (t.speckle) out["speckle"] = speckle_json(*t.speckle);
  if (t.noise) out["noise"] = noise_json(*t.noise);
  if (t.ghosts) out["ghosts"] = ghosts_json(*t.ghosts);
  if (t.profile)
    out["sound_speed"] = {{"rays", t.profile->bent ? "bent" : "straight"},
                          {"profile", rows_json(t.profile->table)}};
  if (t.motion) out["motion"] = motion_json(*t.motion);
  if (t.labels.energy || t.labels.coco)
    out["labels"] = {{"energy", t.labels.energy}, {"coco", t.labels.coco}};
  if (t.output.named)
    out["output"] = {
        {"bits", t.output.bits}, {"floor_db", t.output.floor_db}, {"span_db", t.output.span_db}};
  if (json detection = detection_json(t.detection); !detection.empty())
    out["detection"] = std::move(detection);
  if (out.empty()) return out;
  out["frequency_hz"] = t.frequency_hz;
  out["water"] = water_json(t.water);
  return out;
}

json sensor_json(const scene::Sonar& s) {
  json out = terms_json(s.terms);
  out["kind"] = scene::name_of(s.kind);
  out["range_m"] = {s.range_min_m, s.range_max_m};
  out["bins"] = {s.bins_range, s.bins_azimuth, s.bins_elevation};
  out["rate_hz"] = s.rate_hz;
  out["near_m"] = s.near_m;
  if (s.kind == scene::SonarKind::kEchoSounder) {
    out["semi_angle_deg"] = degrees_of(s.semi_angle_rad);
  } else {
    out["azimuth_deg"] = degrees_of(s.azimuth_rad);
    out["elevation_deg"] = degrees_of(s.elevation_rad);
  }
  if (s.kind == scene::SonarKind::kSideScan) out["depression_deg"] = degrees_of(s.depression_rad);
  if (!s.picture_camera.empty()) out["picture_camera"] = s.picture_camera;
  if (s.kind == scene::SonarKind::kMechanical) out["step_deg"] = degrees_of(s.step_rad);
  if (s.gbuffer_scale > 0.0) out["gbuffer_scale"] = s.gbuffer_scale;
  if (!s.gather.empty()) out["gather"] = s.gather;
  if (!s.quality.empty()) out["quality"] = s.quality;
  if (s.max_error > 0.0) out["max_error"] = s.max_error;
  return out;
}

json quality_json(const QualityLevel& level, double max_error, bool chosen) {
  json out{{"level", level.name}, {"measured_error", level.error}};
  if (max_error > 0.0) out["max_error"] = max_error;
  if (chosen) out["chosen"] = "the scene names none";
  return out;
}

}  // namespace neritic::sonar
