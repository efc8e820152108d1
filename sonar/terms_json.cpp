#include "sonar/terms_json.hpp"

#include <nlohmann/json.hpp>

#include "engine/core/math.hpp"

namespace neritic::sonar {
namespace {

using nlohmann::json;
using scene::SonarLevel;

const char* name_of(SonarLevel::Absorption absorption) {
  switch (absorption) {
    case SonarLevel::Absorption::kFrancoisGarrison:
      return "francois-garrison";
    case SonarLevel::Absorption::kAinslieMcColm:
      return "ainslie-mccolm";
    case SonarLevel::Absorption::kFixed:
      return "fixed";
    case SonarLevel::Absorption::kNone:
      return "none";
  }
  return "";
}

json level_json(const SonarLevel& level) {
  json out{{"source_level_db", level.source_level_db},
           {"absorption", name_of(level.absorption)},
           {"spreading", level.spreading},
           {"gain_db", level.gain_db},
           {"tvg_absorption", level.tvg_absorption}};
  if (level.tvg_table.empty())
    out["tvg_log"] = level.tvg_log;
  else
    out["tvg_table"] = level.tvg_table;
  return out;
}

json pattern_json(const scene::SonarPattern& pattern) {
  using Shape = scene::SonarPattern::Shape;
  if (pattern.shape == Shape::kTable) return {{"shape", "table"}, {"rows", pattern.table.size()}};
  return {{"shape", pattern.shape == Shape::kHamming ? "hamming" : "sinc"},
          {"half_power_deg", degrees(pattern.half_power_rad)}};
}

}  // namespace

json terms_json(const scene::SonarTerms& t) {
  json out = json::object();
  if (t.level) out["level"] = level_json(*t.level);
  if (t.beam.azimuth) out["beam"]["azimuth"] = pattern_json(*t.beam.azimuth);
  if (t.beam.elevation) out["beam"]["elevation"] = pattern_json(*t.beam.elevation);
  if (t.beam.samples > 1) out["beam"]["samples"] = t.beam.samples;
  if (t.range_spread)
    out["range_spread"] = {
        {"bandwidth_hz", t.range_spread->bandwidth_hz},
        {"window",
         t.range_spread->window == scene::SonarRangeSpread::Window::kHann ? "hann" : "none"}};
  if (t.speckle)
    out["speckle"] = {{"scatterer_m", t.speckle->scatterer_m},
                      {"shape", t.speckle->shape},
                      {"texture_m", t.speckle->texture_m}};
  if (t.noise) out["noise"] = {{"level_db", t.noise->level_db}};
  if (t.ghosts) {
    out["ghosts"] = {{"surface", t.ghosts->surface}};
    if (t.ghosts->bottom_m) out["ghosts"]["bottom_m"] = *t.ghosts->bottom_m;
  }
  if (t.profile)
    out["sound_speed"] = {{"rays", t.profile->bent ? "bent" : "straight"},
                          {"profile", t.profile->table}};
  if (t.motion)
    out["motion"] = {{"within_ping", t.motion->within_ping},
                     {"doppler", t.motion->doppler},
                     {"pulse_s", t.motion->pulse_s}};
  if (t.labels.energy) out["labels"] = {{"energy", true}};
  if (!out.empty()) out["frequency_hz"] = t.frequency_hz;
  return out;
}

}  // namespace neritic::sonar
