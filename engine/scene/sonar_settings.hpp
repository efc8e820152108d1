// An acoustic sensor's settings in a scene or on a command line. Everything optional is a term of
// the sonar's physics that is neither modelled nor paid for unless it is named. Plain values, SI,
// angles in radians, levels in decibels; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/water_column.hpp"

namespace neritic::scene {

// Bins in each of range, azimuth and elevation: of scenes, sensors, flags and quality levels.
inline constexpr std::uint32_t kMaxSonarBins = 16384;

enum class SonarKind { kImaging, kProfiling, kEchoSounder, kSideScan, kMechanical };
// "imaging", "profiling", "echosounder", "sidescan", "mechanical".
const char* name_of(SonarKind kind);

// The water's acoustics at the sonar. depth_m absent: the sonar's own depth.
struct SonarWater {
  double temperature_c = 10.0, salinity_psu = 35.0, ph = 8.0;
  std::optional<double> depth_m;
  std::optional<double> sound_speed_m_s;  // absent: Mackenzie's from the above
  // The scene's layers, in place of temperature and salinity; absent where the sonar names its own.
  std::optional<WaterColumn> column = {};
  bool own = false;  // names temperature, salinity or sound speed
  SeaWater at(double depth_below_m) const {
    return column ? column->at(depth_below_m) : SeaWater{temperature_c, salinity_psu};
  }
  // The same water, whoever named it.
  bool operator==(const SonarWater& other) const {
    return temperature_c == other.temperature_c && salinity_psu == other.salinity_psu &&
           ph == other.ph && depth_m == other.depth_m && sound_speed_m_s == other.sound_speed_m_s &&
           column == other.column;
  }
};

// A table of two columns, read from a file or a list: x strictly increasing.
struct SonarRow {
  double x = 0.0, y = 0.0;
  bool operator==(const SonarRow&) const = default;
};
using SonarTable = std::vector<SonarRow>;

// Decibels: echo level = source level - 2 transmission loss + target strength, then the receiver.
// Absent: the published model's plain cosine.
struct SonarLevel {
  double source_level_db = 200.0;  // re 1 uPa at 1 m
  enum class Absorption { kFrancoisGarrison, kAinslieMcColm, kFixed, kNone };
  Absorption absorption = Absorption::kFrancoisGarrison;
  double absorption_db_per_m = 0.0;  // kFixed
  bool spreading = true;             // spherical, 20 log r each way
  double tvg_log = 0.0;         // time-varied gain: tvg_log * log10(r / 1 m): 20, 30, 40; 0: none
  bool tvg_absorption = false;  // and 2 alpha r
  SonarTable tvg_table;         // metres, decibels: instead of tvg_log
  double gain_db = 0.0;         // of the receiver
  bool operator==(const SonarLevel&) const = default;
};

// One-way beam pattern over the sine of the angle, of an aperture of length L (sonar/beam_pattern).
enum class BeamShape {
  kSinc,     // uniform line or rectangle side L: sin(pi u) / (pi u)
  kHamming,  // line with Hamming weights, continuous: side lobes below -42 dB
  kPiston,   // circular, L its diameter: 2 J1(pi u) / (pi u)
  kTable,    // measured
};

// One axis' one-way beam pattern.
struct SonarPattern {
  BeamShape shape = BeamShape::kSinc;
  double half_power_rad = radians(1.0);  // full width at half power of one way
  // Off-axis angle (radians, -pi to pi; without negative ones both sides are alike), decibels.
  SonarTable table;
  bool operator==(const SonarPattern&) const = default;
};

struct SonarBeam {
  std::optional<SonarPattern> azimuth, elevation;
  // Gather columns a beam, so that the pattern's main lobe is sampled; at least 1.
  std::uint32_t samples = 1;
  // How beams are formed: each with the pattern about its own axis (lenses, turned heads), or by
  // phase on one flat array, whose beams widen to the sides by 1 / cos of their bearing.
  enum class Steering { kNone, kFlat };
  Steering steering = Steering::kNone;
  // Whether the sound is sent through the azimuth pattern too. Absent: by all kinds but imaging and
  // profiling, which send into the whole fan.
  std::optional<bool> two_way;
  bool operator==(const SonarBeam&) const = default;
};

// Range point spread of a pulse: c / 2B.
struct SonarRangeSpread {
  double bandwidth_hz = 30e3;
  enum class Window { kNone, kHann };
  Window window = Window::kHann;
  bool operator==(const SonarRangeSpread&) const = default;
};

struct SonarSpeckle {
  double scatterer_m = 0.0;  // the world's finest cells of scatterers; 0: the range step
  double shape = 0.0;        // K distribution's nu; 0: Rayleigh
  double texture_m = 0.5;    // size of the patches that share one draw of the gamma texture
  bool operator==(const SonarSpeckle&) const = default;
};

// dB re 1 uPa, of the whole of the receiver's band (range_spread's bandwidth).
struct SonarNoise {
  std::optional<double> level_db;  // all of it; else the powers of the following, added:
  // Ambient: Wenz's 1962 curves in Coates's form of 1990 at the sonar's frequency, over its band.
  double wind_m_s = 5.0, shipping = 0.5;
  double directivity_db = 0.0;    // of the receiver, which ambient noise is less by
  std::optional<double> self_db;  // of the vehicle and the receiver
  bool operator==(const SonarNoise&) const = default;
};

struct SonarGhosts {
  bool surface = false;             // one bounce off y = 0
  std::optional<double> bottom_m;   // depth of a flat bottom that mirrors
  double surface_reflection = 1.0;  // amplitude, absolute
  double bottom_reflection = 0.4;
  bool operator==(const SonarGhosts&) const = default;
};

// Sound speed over depth. Absent: constant.
struct SonarProfile {
  SonarTable table;     // depth in metres, m/s
  bool bent = false;    // rays bend; else straight rays, only time differs
  bool layers = false;  // the table is that of the scene's layers
  bool operator==(const SonarProfile&) const = default;
};

struct SonarMotion {
  bool within_ping = false;  // the sonar moves while the echo comes back
  bool doppler = false;      // a chirp's range shift by the closing speed
  double pulse_s = 100e-6;   // of the chirp
  bool operator==(const SonarMotion&) const = default;
};

struct SonarLabels {
  bool energy = false;  // by the class and instance that gave most energy, with its fraction
  bool coco = false;    // boxes and masks as COCO JSON
  bool operator==(const SonarLabels&) const = default;
};

// The receiver's output. bits 0: floats; else 8 or 16-bit counts, 0 at floor_db.
struct SonarOutput {
  std::uint32_t bits = 0;
  double floor_db = 40.0, span_db = 80.0;
  bool named = false;  // by any key: then pictures too show floor_db to floor_db + span_db
  bool operator==(const SonarOutput&) const = default;
};

// How profiling, echo sounder and side-scan detect returns in what they gather over a track.
struct SonarDetection {
  // A return begins where this part of the strongest (side-scan: of the 95th percentile) is
  // reached. Absent: the kind's own.
  std::optional<double> threshold;
  // Above the noise's mean in the bin: what is quieter is not heard. Absent: 1e-7 false alarms a
  // bin.
  std::optional<double> floor_db;
  double quality = 0.0;     // profiling: least part that the echo is of all that its beam heard
  std::uint32_t pings = 5;  // side-scan: the altitude is the median over these, an odd number
  bool operator==(const SonarDetection&) const = default;
};

struct SonarTerms {
  double frequency_hz = 750e3;
  SonarWater water;
  std::optional<SonarLevel> level;
  SonarBeam beam;
  std::optional<SonarRangeSpread> range_spread;
  std::optional<SonarSpeckle> speckle;
  std::optional<SonarNoise> noise;
  std::optional<SonarGhosts> ghosts;
  std::optional<SonarProfile> profile;
  std::optional<SonarMotion> motion;
  SonarLabels labels;
  SonarOutput output;
  SonarDetection detection;
  bool operator==(const SonarTerms&) const = default;
};

}  // namespace neritic::scene
