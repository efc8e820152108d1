#include "diver/diver_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diver/oxygen_exposure.hpp"
#include "engine/core/case_toml.hpp"
#include "engine/core/files.hpp"

namespace neritic::diver {
namespace {

constexpr std::string_view kDiverKeys[] = {
    "name",         "sex",  "height_m", "mass_kg", "model",   "strips_a_segment",
    "suit_mm",      "fins", "tanks",    "jacket",  "lead_kg", "lead_at_shoulders",
    "drag_area_m2", "kick", "computer"};
constexpr std::string_view kFinKeys[] = {"length_m", "width_m", "angle_deg", "mass_kg", "volume_l"};
constexpr std::string_view kTankKeys[] = {"volume_l", "pressure_bar", "oxygen",
                                          "helium",   "empty_kg",     "outer_l",
                                          "radius_m", "length_m",     "switch_depth_m"};
constexpr std::string_view kJacketKeys[] = {"capacity_l", "mass_kg", "volume_l"};
constexpr std::string_view kKickKeys[] = {"amplitude_m", "wavelength_m", "exponent",
                                          "knee_deg",    "pointed_deg",  "most_hz"};
constexpr std::string_view kComputerKeys[] = {"conventions", "gf_low",     "gf_high",
                                              "last_stop_m", "saturation", "desaturation"};

// false: not worn. What is absent is worn as it is by default.
bool taken_off(const CaseField& field) {
  return field.present() && !field.is_object() && !field.is_array() && !field.boolean(false);
}

void read_person(const CaseField& file, BodyParameters& p) {
  const std::string sex = file["sex"].text("male");
  if (sex == "female")
    p.build.sex = Sex::kFemale;
  else if (sex != "male")
    file["sex"].refuse("male or female is");
  p.build.height_m = file["height_m"].number(p.build.height_m);
  p.build.mass_kg = file["mass_kg"].number(p.build.mass_kg);
  const std::string model = file["model"].text("full");
  if (model == "planar")
    p.model = Model::kPlanar;
  else if (model != "full")
    file["model"].refuse("full or planar is");
  p.strips_a_segment =
      static_cast<int>(file["strips_a_segment"].number(p.strips_a_segment, 1.0, 64.0));
}

void read_fins(const CaseField& field, std::optional<Fins>& fins) {
  if (taken_off(field)) {
    fins.reset();
    return;
  }
  field.allow(kFinKeys);
  fins->length_m = field["length_m"].number(fins->length_m);
  fins->width_m = field["width_m"].number(fins->width_m);
  fins->angle_rad = radians(field["angle_deg"].number(degrees(fins->angle_rad)));
  fins->mass_kg = field["mass_kg"].number(fins->mass_kg);
  fins->volume_m3 = 1e-3 * field["volume_l"].number(1e3 * fins->volume_m3);
}

Tank read_tank(const CaseField& field) {
  field.allow(kTankKeys);
  Tank tank;
  tank.water_volume_m3 = 1e-3 * field["volume_l"].number(1e3 * tank.water_volume_m3);
  tank.pressure_pa = 1e5 * field["pressure_bar"].number(1e-5 * tank.pressure_pa);
  tank.mix.oxygen = field["oxygen"].number(tank.mix.oxygen, 0.0, 1.0);
  tank.mix.helium = field["helium"].number(tank.mix.helium, 0.0, 1.0);
  tank.empty_mass_kg = field["empty_kg"].number(tank.empty_mass_kg);
  tank.outer_volume_m3 = 1e-3 * field["outer_l"].number(1e3 * tank.outer_volume_m3);
  tank.radius_m = field["radius_m"].number(tank.radius_m);
  tank.length_m = field["length_m"].number(tank.length_m);
  return tank;
}

void read_jacket(const CaseField& field, std::optional<Jacket>& jacket) {
  if (taken_off(field)) {
    jacket.reset();
    return;
  }
  field.allow(kJacketKeys);
  jacket->capacity_m3 = 1e-3 * field["capacity_l"].number(1e3 * jacket->capacity_m3);
  jacket->mass_kg = field["mass_kg"].number(jacket->mass_kg);
  jacket->volume_m3 = 1e-3 * field["volume_l"].number(1e3 * jacket->volume_m3);
}

void read_gear(const CaseField& file, Gear& gear) {
  gear.suit->thickness_m = 1e-3 * file["suit_mm"].number(1e3 * gear.suit->thickness_m);
  if (gear.suit->thickness_m == 0.0) gear.suit.reset();
  read_fins(file["fins"], gear.fins);
  read_jacket(file["jacket"], gear.jacket);
  if (file["tanks"].present()) {
    gear.tanks.clear();
    for (std::size_t i = 0; i < file["tanks"].size(); ++i)
      gear.tanks.push_back(read_tank(file["tanks"].at(i)));
  }
  const std::pair<const char*, std::optional<double> Gear::*> chosen[] = {
      {"lead_kg", &Gear::lead_kg},
      {"lead_at_shoulders", &Gear::lead_at_shoulders},
      {"drag_area_m2", &Gear::drag_area_m2}};
  for (const auto& [key, member] : chosen)
    if (file[key].present()) gear.*member = file[key].number(0.0);
}

void read_kick(const CaseField& field, SwimmerSettings& swimmer) {
  field.allow(kKickKeys);
  FlutterKick& kick = swimmer.kick;
  kick.amplitude_m = field["amplitude_m"].number(kick.amplitude_m, 0.0, 0.6);
  kick.wavelength_m = field["wavelength_m"].number(kick.wavelength_m, 0.5, 20.0);
  kick.exponent = field["exponent"].number(kick.exponent, 0.5, 4.0);
  kick.knee_rad = radians(field["knee_deg"].number(degrees(kick.knee_rad), 0.0, 60.0));
  kick.pointed_rad = radians(field["pointed_deg"].number(degrees(kick.pointed_rad), 30.0, 110.0));
  swimmer.most_frequency_hz = field["most_hz"].number(swimmer.most_frequency_hz, 0.3, 3.0);
}

// The computer measures the pressure that the water has, whatever its conventions take a metre for.
Status read_computer(const CaseField& root, const BodyParameters& diver,
                     DiveComputerSettings& computer) {
  const Gear& gear = diver.gear;
  const CaseField field = root["computer"];
  field.allow(kComputerKeys);
  if (field["conventions"].present()) {
    NERITIC_TRY(computer.conventions, conventions_of(field["conventions"].text()));
  }
  DecoConventions& c = computer.conventions;
  c.environment = {1e-5 * diver.surface_pa, bar_per_m_of(diver.water_kg_m3)};
  c.last_stop_m = field["last_stop_m"].number(c.last_stop_m, 1.0, 30.0);
  c.saturation = field["saturation"].number(c.saturation, 0.1, 10.0);
  c.desaturation = field["desaturation"].number(c.desaturation, 0.1, 10.0);
  computer.gf_low = field["gf_low"].number(computer.gf_low, 0.0, 1.0);
  computer.gf_high = field["gf_high"].number(computer.gf_high, 0.0, 1.0);
  if (gear.tanks.empty()) return {};
  computer.gases.clear();
  for (std::size_t i = 0; i < gear.tanks.size(); ++i) {
    PlanGas gas;
    gas.mix = gear.tanks[i].mix;
    if (i > 0) {
      gas.role = GasRole::kDeco;
      gas.switch_depth_m = root["tanks"].at(i)["switch_depth_m"].number(
          std::min(usual_switch_depth_m(gas.mix), 300.0), 0.0, 300.0);
    }
    computer.gases.push_back(gas);
  }
  return {};
}

}  // namespace

Result<DiverFile> parse_diver(std::string_view text, const std::string& name,
                              const std::filesystem::path& folder, double water_kg_m3,
                              double surface_pa) {
  NERITIC_TRY(CaseFile file, parse_case_toml(text, name, folder, {}));
  const CaseField root = file.root();
  root.allow(kDiverKeys);
  DiverFile out;
  out.name = root["name"].text();
  out.parameters.water_kg_m3 = water_kg_m3;
  out.parameters.surface_pa = surface_pa;
  read_person(root, out.parameters);
  read_gear(root, out.parameters.gear);
  read_kick(root["kick"], out.swimmer);
  const Status computer = read_computer(root, out.parameters, out.computer);
  if (file.failed()) return file.error();
  if (!computer.ok()) return bad_input("{}: computer: {}", name, computer.error().message);
  const auto body = make_body(out.parameters);
  if (!body.ok()) return bad_input("{}: {}", name, body.error().message);
  const auto made = DiveComputer::create(out.computer);
  if (!made.ok()) return bad_input("{}: computer: {}", name, made.error().message);
  return out;
}

Result<DiverFile> read_diver(const std::filesystem::path& path, double water_kg_m3,
                             double surface_pa) {
  NERITIC_TRY(const std::string text, read_text(path));
  return parse_diver(text, path.string(), path.parent_path(), water_kg_m3, surface_pa);
}

}  // namespace neritic::diver
