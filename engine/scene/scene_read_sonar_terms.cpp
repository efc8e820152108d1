// Reads the terms of a sonar, each a table under [[sonars]]: what is not named is not modelled. A
// key that would have no effect is refused. Limits are those of the formulas (sonar/acoustics.hpp)
// or, where these have none, of what any device has.
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"
#include "engine/scene/scene_table.hpp"

namespace neritic::scene {
namespace {

constexpr Interval kFrequency{1, 1e7, false, false, "hertz"};
constexpr Interval kLevel{-300, 300, false, false, "decibels"};
// The strongest sources, arrays of air guns, reach some 260 dB re 1 uPa at 1 m.
constexpr Interval kSourceLevel{0, 260, false, false, "decibels"};
constexpr Interval kGain{-120, 120, false, false, "decibels"};
// From a tenth of deep water's least in 1 Hz to a ship at arm's length.
constexpr Interval kNoiseLevel{-60, 200, false, false, "decibels"};
constexpr Interval kSpeed{100, 10000, false, false, "m/s"};
constexpr Interval kTermFraction{0, 1};

constexpr TableFormat kGainTable{
    "range_m, db", {0, 1e6, false, false, "metres"}, {-120, 200, false, false, "decibels"}};
constexpr TableFormat kPatternTable{
    "angle_deg, db", {-180, 180, false, false, "degrees"}, {-300, 0, false, false, "decibels"}};
constexpr TableFormat kSpeedTable{"depth_m, m/s", {-100, 12000, false, false, "metres"}, kSpeed};

void refuse_beside(TableReader& reader, Key key, std::string_view what) {
  if (reader.has(key)) reader.refuse(key, fmt::format("no such key {}", what));
}

SonarWater read_sonar_water(TableReader& reader) {
  SonarWater water;
  water.temperature_c = reader.number("temperature_c", water.temperature_c,
                                      {-4, 60, false, false, "degrees Celsius"});
  water.salinity_psu =
      reader.number("salinity_psu", water.salinity_psu, {0, 60, false, false, "psu"});
  water.ph = reader.number("ph", water.ph, {6, 10});
  if (reader.has("depth_m"))
    water.depth_m = reader.number("depth_m", 0.0, {0, 12000, false, false, "metres"});
  if (reader.has("sound_speed_m_s"))
    water.sound_speed_m_s = reader.number("sound_speed_m_s", 1500.0, kSpeed);
  water.own = reader.has("temperature_c") || reader.has("salinity_psu") || water.sound_speed_m_s;
  return water;
}

bool is_text(const TomlValue* value, std::string_view text) {
  return value && value->kind == TomlValue::Kind::kString && value->text == text;
}

void read_absorption(TableReader& reader, SonarLevel& level) {
  using Absorption = SonarLevel::Absorption;
  constexpr Interval kPerMetre{0, 1000, false, false, "dB/m"};
  const TomlValue* value = reader.find("absorption");
  if (!value || is_text(value, "francois-garrison")) return;
  if (is_text(value, "ainslie-mccolm")) {
    level.absorption = Absorption::kAinslieMcColm;
  } else if (is_text(value, "none")) {
    level.absorption = Absorption::kNone;
  } else if (value->is_number() && kPerMetre.holds(value->number)) {
    level.absorption = Absorption::kFixed;
    level.absorption_db_per_m = value->number;
  } else {
    reader.refuse("absorption",
                  "francois-garrison, ainslie-mccolm, none, or a number in " + kPerMetre.text());
  }
}

void read_tvg(TableReader& reader, SonarLevel& level) {
  constexpr Interval kLog{0, 60};
  const TomlValue* value = reader.find("tvg");
  level.tvg_absorption = reader.flag("tvg_absorption", false);
  if (!value || is_text(value, "none")) return;
  if (value->is_number() && kLog.holds(value->number)) {
    level.tvg_log = value->number;
  } else if (is_table(*value)) {
    level.tvg_table = read_table(reader, "tvg", kGainTable);
    refuse_beside(reader, "tvg_absorption", "beside a table of gains");
  } else {
    reader.refuse("tvg", fmt::format("none, a number in {} (times log10 of metres), or {}",
                                     kLog.text(), table_text(kGainTable)));
  }
}

SonarLevel read_level(TableReader& reader) {
  SonarLevel level;
  level.source_level_db = reader.number("source_level_db", level.source_level_db, kSourceLevel);
  read_absorption(reader, level);
  level.spreading = reader.flag("spreading", level.spreading);
  read_tvg(reader, level);
  level.gain_db = reader.number("gain_db", level.gain_db, kGain);
  return level;
}

// width: the key of the half-power width of the pattern under key.
std::optional<SonarPattern> read_pattern(TableReader& reader, Key key, Key width) {
  const TomlValue* value = reader.find(key);
  if (!value) {
    refuse_beside(reader, width, fmt::format("without {}, the beam's shape", key));
    return std::nullopt;
  }
  SonarPattern pattern;
  if (is_table(*value)) {
    pattern.shape = BeamShape::kTable;
    pattern.table = read_table(reader, key, kPatternTable);
    for (SonarRow& row : pattern.table) row.x = radians(row.x);
    refuse_beside(reader, width, "beside a table");
    return pattern;
  }
  if (is_text(value, "hamming"))
    pattern.shape = BeamShape::kHamming;
  else if (is_text(value, "piston"))
    pattern.shape = BeamShape::kPiston;
  else if (!is_text(value, "sinc"))
    reader.refuse(key, "sinc, hamming, piston, or " + table_text(kPatternTable));
  pattern.half_power_rad = radians(reader.number(width, 1.0, {0.001, 180, false, true, "degrees"}));
  return pattern;
}

SonarBeam read_beam(TableReader& reader) {
  SonarBeam beam;
  beam.azimuth = read_pattern(reader, "azimuth", "azimuth_deg");
  beam.elevation = read_pattern(reader, "elevation", "elevation_deg");
  beam.samples = static_cast<std::uint32_t>(reader.whole("samples", 1, 1, 64));
  const std::string steering =
      reader.choice("steering", "none", std::to_array<Key>({"none", "flat"}));
  if (steering == "flat") beam.steering = SonarBeam::Steering::kFlat;
  if (reader.has("two_way")) beam.two_way = reader.flag("two_way", false);
  if (!beam.azimuth)
    for (const Key key : {"steering", "two_way"})
      refuse_beside(reader, key, "without azimuth, the beam's shape");
  return beam;
}

SonarRangeSpread read_range_spread(TableReader& reader, double bandwidth_hz) {
  SonarRangeSpread spread;
  spread.bandwidth_hz = reader.number("bandwidth_hz", bandwidth_hz, kFrequency);
  const std::string window = reader.choice("window", "hann", std::to_array<Key>({"none", "hann"}));
  if (window == "none") spread.window = SonarRangeSpread::Window::kNone;
  return spread;
}

// 0 stands for what the term's comment says.
double zero_or(TableReader& reader, Key key, const Interval& interval) {
  const double value = reader.number(key, 0.0, {0, interval.max, false, false, interval.unit});
  if (value != 0.0 && !interval.holds(value)) reader.refuse(key, "0, or in " + interval.text());
  return value;
}

SonarSpeckle read_speckle(TableReader& reader) {
  SonarSpeckle speckle;
  speckle.scatterer_m = zero_or(reader, "scatterer_m", {1e-4, 100, false, false, "metres"});
  speckle.shape = zero_or(reader, "shape", {0.05, 1000});
  speckle.texture_m =
      reader.number("texture_m", speckle.texture_m, {1e-3, 1000, false, false, "metres"});
  if (speckle.shape == 0.0) refuse_beside(reader, "texture_m", "without shape");
  return speckle;
}

SonarNoise read_noise(TableReader& reader) {
  SonarNoise noise;
  if (reader.has("level_db")) {
    noise.level_db = reader.number("level_db", 0.0, kNoiseLevel);
    for (const Key key : {"wind_m_s", "shipping", "directivity_db", "self_db"})
      refuse_beside(reader, key, "beside level_db, which is all the noise");
    return noise;
  }
  noise.wind_m_s = reader.number("wind_m_s", noise.wind_m_s, {0, 60, false, false, "m/s"});
  noise.shipping = reader.number("shipping", noise.shipping, kTermFraction);
  noise.directivity_db = reader.number("directivity_db", 0.0, {0, 60, false, false, "dB"});
  if (reader.has("self_db")) noise.self_db = reader.number("self_db", 0.0, kNoiseLevel);
  return noise;
}

SonarGhosts read_ghosts(TableReader& reader) {
  SonarGhosts ghosts;
  ghosts.surface = reader.flag("surface", false);
  if (reader.has("bottom_m"))
    ghosts.bottom_m = reader.number("bottom_m", 0.0, {0, 12000, true, false, "metres"});
  ghosts.surface_reflection =
      reader.number("surface_reflection", ghosts.surface_reflection, kTermFraction);
  ghosts.bottom_reflection =
      reader.number("bottom_reflection", ghosts.bottom_reflection, kTermFraction);
  if (!ghosts.surface) refuse_beside(reader, "surface_reflection", "without surface = true");
  if (!ghosts.bottom_m) refuse_beside(reader, "bottom_reflection", "without bottom_m");
  if (!ghosts.surface && !ghosts.bottom_m)
    reader.refuse_table("no mirror", "surface = true, bottom_m, or both");
  return ghosts;
}

SonarProfile read_profile(TableReader& reader) {
  SonarProfile profile;
  profile.layers = is_text(reader.find("profile"), "layers");
  if (!profile.layers) profile.table = read_table(reader, "profile", kSpeedTable);
  if (!reader.has("profile")) reader.refuse("profile", table_text(kSpeedTable));
  profile.bent =
      reader.choice("rays", "straight", std::to_array<Key>({"straight", "bent"})) == "bent";
  return profile;
}

SonarMotion read_motion(TableReader& reader) {
  SonarMotion motion;
  motion.within_ping = reader.flag("within_ping", false);
  motion.doppler = reader.flag("doppler", false);
  motion.pulse_s = reader.number("pulse_s", motion.pulse_s, {0, 10, true, false, "seconds"});
  if (!motion.doppler) refuse_beside(reader, "pulse_s", "without doppler = true");
  if (!motion.within_ping && !motion.doppler)
    reader.refuse_table("no motion", "within_ping = true, doppler = true, or both");
  return motion;
}

SonarLabels read_labels(TableReader& reader) {
  const SonarLabels labels{reader.flag("energy", false), reader.flag("coco", false)};
  if (!labels.energy) refuse_beside(reader, "coco", "without energy = true, whose masks it holds");
  return labels;
}

SonarOutput read_output(TableReader& reader) {
  SonarOutput output;
  output.bits = static_cast<std::uint32_t>(reader.whole("bits", 0, 0, 16));
  if (output.bits != 0 && output.bits != 8 && output.bits != 16)
    reader.refuse("bits", "0 (floats), 8 or 16");
  output.floor_db = reader.number("floor_db", output.floor_db, kLevel);
  output.span_db = reader.number("span_db", output.span_db, {0, 600, true, false, "decibels"});
  output.named = output.bits != 0 || reader.has("floor_db") || reader.has("span_db");
  return output;
}

SonarDetection read_detection(TableReader& reader) {
  SonarDetection detection;
  if (reader.has("threshold"))
    detection.threshold = reader.number("threshold", 0.0, {0, 1, true, false});
  if (reader.has("floor_db"))
    detection.floor_db = reader.number("floor_db", 0.0, {-60, 120, false, false, "decibels"});
  detection.quality = reader.number("quality", detection.quality, kTermFraction);
  detection.pings = static_cast<std::uint32_t>(reader.whole("pings", detection.pings, 1, 999));
  if (detection.pings % 2 == 0) reader.refuse("pings", "an odd number");
  return detection;
}

// Requirements of one term on another.
void check_together(TableReader& reader, const SonarTerms& terms) {
  if (terms.range_spread && terms.range_spread->bandwidth_hz > 2.0 * terms.frequency_hz)
    reader.refuse("frequency_hz", fmt::format("at least half of the bandwidth, {:g} Hz: in hertz",
                                              terms.range_spread->bandwidth_hz));
  if (terms.noise && !terms.level)
    reader.refuse("noise", "noise beside level: its decibels are the level's");
  if (terms.noise && !terms.noise->level_db && !terms.range_spread)
    reader.refuse("noise", "level_db, or bandwidth_hz of the sonar: ambient noise fills a band");
  if (terms.detection.floor_db && !terms.noise)
    reader.refuse("detection", "floor_db beside noise: its decibels are above it");
  if (terms.output.named && !terms.level)
    reader.refuse("output", "output beside level: its floor is in decibels");
  if (terms.motion && terms.motion->doppler && !terms.range_spread)
    reader.refuse("motion", "doppler beside range_spread or bandwidth_hz: it shifts the pulse");
}

}  // namespace

void read_sonar_terms(TableReader& reader, SonarTerms& terms) {
  terms.frequency_hz = reader.number("frequency_hz", terms.frequency_hz, kFrequency);
  terms.water = read_term<SonarWater>(reader, "water", kSonarWaterKeys, read_sonar_water)
                    .value_or(SonarWater{});
  terms.level = read_term<SonarLevel>(reader, "level", kSonarLevelKeys, read_level);
  terms.beam =
      read_term<SonarBeam>(reader, "beam", kSonarBeamKeys, read_beam).value_or(SonarBeam{});
  // A device's bandwidth is by itself the range spread of its pulse.
  const double bandwidth_hz =
      reader.number("bandwidth_hz", SonarRangeSpread{}.bandwidth_hz, kFrequency);
  terms.range_spread = read_term<SonarRangeSpread>(
      reader, "range_spread", kSonarRangeSpreadKeys,
      [&](TableReader& table) { return read_range_spread(table, bandwidth_hz); });
  if (!terms.range_spread && reader.has("bandwidth_hz"))
    terms.range_spread = SonarRangeSpread{.bandwidth_hz = bandwidth_hz};
  terms.speckle = read_term<SonarSpeckle>(reader, "speckle", kSonarSpeckleKeys, read_speckle);
  terms.noise = read_term<SonarNoise>(reader, "noise", kSonarNoiseKeys, read_noise);
  terms.ghosts = read_term<SonarGhosts>(reader, "ghosts", kSonarGhostKeys, read_ghosts);
  terms.profile =
      read_term<SonarProfile>(reader, "sound_speed", kSonarSoundSpeedKeys, read_profile);
  terms.motion = read_term<SonarMotion>(reader, "motion", kSonarMotionKeys, read_motion);
  terms.labels = read_term<SonarLabels>(reader, "labels", kSonarLabelKeys, read_labels)
                     .value_or(SonarLabels{});
  terms.output = read_term<SonarOutput>(reader, "output", kSonarOutputKeys, read_output)
                     .value_or(SonarOutput{});
  terms.detection =
      read_term<SonarDetection>(reader, "detection", kSonarDetectionKeys, read_detection)
          .value_or(SonarDetection{});
  check_together(reader, terms);
}

}  // namespace neritic::scene
