// Reads the table modem of a vehicle, a diver or an object with inputs, and [acoustics]. Limits are
// those of the formulas (sonar/modem.hpp) or, where these have none, of what any device has.
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"
#include "engine/scene/scene_table.hpp"

namespace neritic::scene {
namespace {

constexpr Interval kModemFrequency{100, 1e6, false, false, "hertz"};
constexpr Interval kModemDecibels{-60, 120, false, false, "decibels"};
constexpr double kMostWaits = 15.0;  // requests of a USBL whose answers are still to come
constexpr Interval kModemSpeed{100, 10000, false, false, "m/s"};

Ranging read_usbl(TableReader& reader) {
  Ranging ranging;
  ranging.target = reader.text("target", "");
  if (ranging.target.empty()) reader.refuse("target", "the name of an object with a modem");
  ranging.interval_s =
      reader.number("interval_s", ranging.interval_s, {0.1, 3600, false, false, "seconds"});
  ranging.offset_s =
      reader.number("offset_s", ranging.offset_s, {0, 3600, false, false, "seconds"});
  if (reader.has("wait_s"))
    ranging.wait_s =
        reader.number("wait_s", ranging.interval_s, {0.1, 3600, false, false, "seconds"});
  if (ranging.wait_s.value_or(0.0) > kMostWaits * ranging.interval_s)
    reader.refuse("wait_s", fmt::format("up to {:g} times the interval, {:g} s", kMostWaits,
                                        kMostWaits * ranging.interval_s));
  ranging.range_noise_m =
      reader.number("range_noise_m", ranging.range_noise_m, {0, 100, false, false, "metres"});
  ranging.direction_noise_rad =
      radians(reader.number("direction_noise_deg", degrees(ranging.direction_noise_rad),
                            {0, 90, false, false, "degrees"}));
  if (reader.has("sound_m_s")) ranging.sound_m_s = reader.number("sound_m_s", 1500.0, kModemSpeed);
  return ranging;
}

}  // namespace

std::optional<Modem> read_modem(TableReader& parent) {
  return read_term<Modem>(parent, "modem", kModemKeys, [](TableReader& reader) {
    Modem modem;
    modem.position_m =
        reader.vector3("position_m", modem.position_m, {-100, 100, false, false, "metres"});
    modem.source_level_db =
        reader.number("source_level_db", modem.source_level_db, {0, 260, false, false, "decibels"});
    modem.frequency_hz = reader.number("frequency_hz", modem.frequency_hz, kModemFrequency);
    modem.bandwidth_hz =
        reader.number("bandwidth_hz", modem.bandwidth_hz, {1, 1e6, false, false, "hertz"});
    if (modem.bandwidth_hz > 2.0 * modem.frequency_hz)
      reader.refuse("bandwidth_hz",
                    fmt::format("up to twice the frequency, {:g} Hz", 2.0 * modem.frequency_hz));
    modem.bit_rate_hz =
        reader.number("bit_rate_hz", modem.bit_rate_hz, {1, 1e6, false, false, "bits a second"});
    modem.preamble_s =
        reader.number("preamble_s", modem.preamble_s, {0, 10, false, false, "seconds"});
    modem.coding_gain_db = reader.number("coding_gain_db", modem.coding_gain_db, kModemDecibels);
    modem.detection_db = reader.number("detection_db", modem.detection_db, kModemDecibels);
    modem.self_noise_db =
        reader.number("self_noise_db", modem.self_noise_db, {0, 200, false, false, "decibels"});
    modem.fading = reader.flag("fading", modem.fading);
    modem.turnaround_s =
        reader.number("turnaround_s", modem.turnaround_s, {0.01, 60, false, false, "seconds"});
    modem.usbl = read_term<Ranging>(reader, "usbl", kModemUsblKeys, read_usbl);
    return modem;
  });
}

Result<Acoustics> read_acoustics(const SceneSource& source, const TomlValue& table) {
  TableReader reader(source, table, "acoustics", kAcousticsKeys);
  Acoustics water;
  water.temperature_c = reader.number("temperature_c", water.temperature_c,
                                      {-4, 60, false, false, "degrees Celsius"});
  water.salinity_psu =
      reader.number("salinity_psu", water.salinity_psu, {0, 60, false, false, "psu"});
  water.ph = reader.number("ph", water.ph, {6, 10});
  water.profile = read_table(reader, "profile",
                             {"depth_m, m/s", {-100, 12000, false, false, "metres"}, kModemSpeed});
  const auto paths = std::to_array<Key>({"constant", "straight", "bent"});
  const std::string path = reader.choice("path", "straight", paths);
  water.path = path == "constant" ? Acoustics::Path::kConstant
               : path == "bent"   ? Acoustics::Path::kBent
                                  : Acoustics::Path::kStraight;
  if (water.path == Acoustics::Path::kBent && water.profile.empty())
    reader.refuse("path", "constant or straight without a profile, which alone bends rays");
  water.spreading = reader.number("spreading", water.spreading, {1, 2});
  water.wind_m_s = reader.number("wind_m_s", water.wind_m_s, {0, 40, false, false, "m/s"});
  water.shipping = reader.number("shipping", water.shipping, {0, 1});
  NERITIC_TRY_STATUS(reader.status());
  return water;
}

}  // namespace neritic::scene
