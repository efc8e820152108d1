#include "diver/diver_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diver/oxygen_exposure.hpp"
#include "engine/core/case_toml.hpp"
#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

constexpr std::string_view kDiverKeys[] = {
    "name",         "sex",  "height_m", "mass_kg",      "model",   "strips_a_segment",
    "suit_mm",      "fins", "tanks",    "jacket",       "lead_kg", "lead_at_shoulders",
    "drag_area_m2", "kick", "computer", "gas_switches", "fitness"};
constexpr std::string_view kFinKeys[] = {"length_m", "width_m", "angle_deg", "mass_kg", "volume_l"};
constexpr std::string_view kTankKeys[] = {"volume_l", "pressure_bar", "oxygen",
                                          "helium",   "empty_kg",     "outer_l",
                                          "radius_m", "length_m",     "switch_depth_m"};
constexpr std::string_view kJacketKeys[] = {"capacity_l", "mass_kg", "volume_l"};
constexpr std::string_view kKickKeys[] = {"amplitude_m", "wavelength_m", "exponent",
                                          "knee_deg",    "pointed_deg",  "most_hz"};
constexpr std::string_view kComputerKeys[] = {"conventions", "gf_low",     "gf_high",
                                              "last_stop_m", "saturation", "desaturation"};

constexpr std::string_view kGasSwitchKeys[] = {"reaction_s"};
constexpr std::string_view kFitnessKeys[] = {"most_oxygen_l_min", "critical_share", "reserve_kj"};

constexpr double kLitre_m3 = 1e-3, kBar_pa = 1e5;
constexpr double kThinnestSuit_m = 0.5e-3;

// false: not worn. An absent table means the default gear.
bool taken_off(const CaseField& field) {
  return field.present() && !field.is_object() && !field.is_array() && !field.boolean(false);
}

// Reads a value in the file's unit; unit: one of it in SI. An absent field keeps the value.
void read_bounded(const CaseField& field, double unit, const Bounds& in, double& value) {
  if (!field.present()) return;
  const auto said = [&](double si) { return std::round(si / unit * 1e6) / 1e6; };
  value = unit * field.number(said(value), said(in.low), said(in.high));
}

int whole_number(const CaseField& field, int fallback, int least, int most) {
  const double value = field.number(fallback);
  if (value == std::floor(value) && value >= least && value <= most) return static_cast<int>(value);
  field.refuse(fmt::format("a whole number from {} to {}", least, most));
  return fallback;
}

void read_person(const CaseField& file, BodyParameters& p) {
  const std::string sex = file["sex"].text("male");
  if (sex == "female")
    p.build.sex = Sex::kFemale;
  else if (sex != "male")
    file["sex"].refuse("male or female");
  p.build.height_m = file["height_m"].number(p.build.height_m);
  p.build.mass_kg = file["mass_kg"].number(p.build.mass_kg);
  const std::string model = file["model"].text("full");
  if (model == "planar")
    p.model = Model::kPlanar;
  else if (model != "full")
    file["model"].refuse("full or planar");
  p.strips_a_segment = whole_number(file["strips_a_segment"], p.strips_a_segment, 1, 64);
}

void read_fins(const CaseField& field, std::optional<Fins>& fins) {
  if (taken_off(field)) {
    fins.reset();
    return;
  }
  field.allow(kFinKeys);
  read_bounded(field["length_m"], 1.0, kFinLength_m, fins->length_m);
  read_bounded(field["width_m"], 1.0, kFinWidth_m, fins->width_m);
  read_bounded(field["angle_deg"], radians(1.0), kFinAngle_rad, fins->angle_rad);
  read_bounded(field["mass_kg"], 1.0, kFinMass_kg, fins->mass_kg);
  read_bounded(field["volume_l"], kLitre_m3, kFinVolume_m3, fins->volume_m3);
}

Tank read_tank(const CaseField& field) {
  field.allow(kTankKeys);
  double water_volume_m3 = Tank{}.water_volume_m3;
  read_bounded(field["volume_l"], kLitre_m3, kTankVolume_m3, water_volume_m3);
  Tank tank = tank_of(water_volume_m3);
  read_bounded(field["pressure_bar"], kBar_pa, kTankPressure_pa, tank.pressure_pa);
  tank.mix.oxygen = field["oxygen"].number(tank.mix.oxygen, 0.0, 1.0);
  tank.mix.helium = field["helium"].number(tank.mix.helium, 0.0, 1.0);
  if (!is_mix(tank.mix))
    field["helium"].fail(found_accepted(
        fmt::format("{} beside {} of oxygen", tank.mix.helium, tank.mix.oxygen), "shares of 1"));
  read_bounded(field["empty_kg"], 1.0, kTankMass_kg, tank.empty_mass_kg);
  read_bounded(field["outer_l"], kLitre_m3, kTankOuterVolume_m3, tank.outer_volume_m3);
  read_bounded(field["radius_m"], 1.0, kTankRadius_m, tank.radius_m);
  read_bounded(field["length_m"], 1.0, kTankLength_m, tank.length_m);
  return tank;
}

void read_jacket(const CaseField& field, std::optional<Jacket>& jacket) {
  if (taken_off(field)) {
    jacket.reset();
    return;
  }
  field.allow(kJacketKeys);
  read_bounded(field["capacity_l"], kLitre_m3, kJacketCapacity_m3, jacket->capacity_m3);
  read_bounded(field["mass_kg"], 1.0, kJacketMass_kg, jacket->mass_kg);
  read_bounded(field["volume_l"], kLitre_m3, kJacketVolume_m3, jacket->volume_m3);
}

void read_suit(const CaseField& field, std::optional<Suit>& suit) {
  read_bounded(field, 1e-3, kSuitThickness_m, suit->thickness_m);
  if (suit->thickness_m == 0.0)
    suit.reset();
  else if (suit->thickness_m < kThinnestSuit_m)  // metres, taken for millimetres
    field.refuse("0 or 0.5 to 12 millimetres");
}

void read_gear(const CaseField& file, Gear& gear) {
  read_suit(file["suit_mm"], gear.suit);
  read_fins(file["fins"], gear.fins);
  read_jacket(file["jacket"], gear.jacket);
  if (file["tanks"].present()) {
    gear.tanks.clear();
    const std::size_t count = file["tanks"].size();
    if (count > kMaxTanks)
      file["tanks"].fail(
          found_accepted(fmt::format("{}", count), fmt::format("up to {}", kMaxTanks)));
    for (std::size_t i = 0; i < std::min(count, kMaxTanks); ++i)
      gear.tanks.push_back(read_tank(file["tanks"].at(i)));
  }
  const struct {
    const char* key;
    std::optional<double> Gear::*member;
    Bounds in;
  } chosen[] = {{"lead_kg", &Gear::lead_kg, kLead_kg},
                {"lead_at_shoulders", &Gear::lead_at_shoulders, kLeadShare},
                {"drag_area_m2", &Gear::drag_area_m2, kGearDragArea_m2}};
  for (const auto& one : chosen)
    if (file[one.key].present())
      read_bounded(file[one.key], 1.0, one.in, (gear.*one.member).emplace(one.in.low));
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

void read_fitness(const CaseField& field, Fitness& fitness) {
  fitness.tires = !taken_off(field);
  if (!fitness.tires) return;
  field.allow(kFitnessKeys);
  read_bounded(field["most_oxygen_l_min"], 1.0, kMostOxygenUptake_l_min, fitness.most_oxygen_l_min);
  read_bounded(field["critical_share"], 1.0, kCriticalShare, fitness.critical_share);
  read_bounded(field["reserve_kj"], 1e3, kWorkReserve_j, fitness.reserve_j);
}

void read_gas_switches(const CaseField& field, GasSwitching& switching) {
  switching.by_plan = !taken_off(field);
  if (!switching.by_plan) return;
  field.allow(kGasSwitchKeys);
  switching.reaction_s = field["reaction_s"].number(switching.reaction_s, 0.0, kMostReaction_s);
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
  computer.gf_low = field["gf_low"].number(computer.gf_low, 0.01, 1.5);
  computer.gf_high = field["gf_high"].number(computer.gf_high, 0.01, 1.5);
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

// A message that begins with a key of the file, at that key.
void fail_at_its_key(const CaseField& root, const std::string& message) {
  const std::string key = message.substr(0, message.find(": "));
  if (std::ranges::find(kDiverKeys, key) == std::end(kDiverKeys) || key == message)
    root.fail(message);
  else
    root[key].fail(message.substr(key.size() + 2));
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
  read_fitness(root["fitness"], out.parameters.fitness);
  read_gas_switches(root["gas_switches"], out.gas_switching);
  const Status computer = read_computer(root, out.parameters, out.computer);
  if (!file.failed() && !computer.ok()) root["computer"].fail(computer.error().message);
  if (file.failed()) return file.error();
  if (const auto body = make_body(out.parameters); !body.ok())
    fail_at_its_key(root, body.error().message);
  else if (const auto made = DiveComputer::create(out.computer); !made.ok())
    root["computer"].fail(made.error().message);
  if (file.failed()) return file.error();
  return out;
}

Result<DiverFile> read_diver(const std::filesystem::path& path, double water_kg_m3,
                             double surface_pa) {
  NERITIC_TRY(const std::string text, read_text(path));
  return parse_diver(text, path.string(), path.parent_path(), water_kg_m3, surface_pa);
}

}  // namespace neritic::diver
