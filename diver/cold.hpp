// The heat of a diver in water: a core, a skin, a suit. Pure functions over plain bytes; any
// thread. Celsius, watts, square metres.
//
// Model. Heat goes from the core through a shell of tissue that has heat of its own, a suit and a
// film of water to the water, and out with the breath:
//   C_core T_core' = M - E - (T_core - T_shell) A / (0.3 R_t)
//   C_shell T_shell' = (T_core - T_shell) A / (0.3 R_t) - (T_shell - T_w) A / (0.7 R_t + R_s)
// with 3470 J/(kg K) times mass in all, three quarters of it the core's. The shell gives its heat
// first: for a quarter of an hour the core hardly cools. These shares, R_t and the most shivering
// are fitted to the cooling of people in water of 5 to 15 C (Hayward et al. 1975, Can. J. Physiol.
// Pharmacol. 53, 21: CHECKS.md).
//   R_t: 0.12 m^2 K/W with vessels narrow, 0.03 with vessels wide: from 36.8 to 37.4 C of the core,
//        and from 31 to 34 C of the skin.
//   R_s: the suit's thickness, of which gas shrinks with depth, by 0.054 W/(m K) of foamed neoprene
//        (Bardy et al. 2005, J. Phys. D 38, 3832), and the film: 230 W/(m^2 K) at rest, 580 while
//        swimming (Nadel et al. 1974, J. Appl. Physiol. 36, 465).
//   E: the breath leaves at 34 C, saturated (Fanger 1970), and came dry at the water's temperature.
//   Shivering by Tikuisis and Giesbrecht (1999, Eur. J. Appl. Physiol. 79, 285), at most 50 W/m^2
//        (fitted), fading from 32 to 30 C of the core.
// Not modelled: hands and feet apart, after-drop, water that flushes a suit, dry suits, heating.
#pragma once

namespace neritic::diver {

struct ColdSettings {
  double water_c = 12.0;
  double mass_kg = 75.0, height_m = 1.78;
  double suit_m = 0.005, suit_gas_share = 0.65;  // at the surface
  double fat_share = 0.15;
};

struct ColdState {
  double core_c = 37.0, shell_c = 36.1, skin_c = 34.0, shiver_w = 0.0;

  static void fields(auto&& field, auto& self) {
    field("core_c", self.core_c);
    field("shell_c", self.shell_c);
    field("skin_c", self.skin_c);
    field("shiver_w", self.shiver_w);
  }
};

struct ColdInputs {
  double heat_w = 110.0;  // of the body without shivering: metabolism less work done outside
  double ventilation_l_min = 8.0, gas_density_kg_m3 = 1.2;
  double ambient_pa = 101325.0, surface_pa = 101325.0;
  double speed_m_s = 0.0;  // through the water
};

// Du Bois and Du Bois 1916, Arch. Intern. Med. 17, 863.
double skin_area_m2(double mass_kg, double height_m);
// Between core and skin; between skin and water. m^2 K/W.
double tissue_resistance(double core_c, double skin_c);
double suit_resistance(const ColdSettings& settings, const ColdInputs& inputs);
// The skin of a body with that shell, once the suit has the water's temperature outside.
double skin_temperature_c(const ColdSettings& settings, const ColdInputs& inputs,
                          const ColdState& state);
double breath_heat_w(const ColdSettings& settings, const ColdInputs& inputs);
double shivering_w(const ColdSettings& settings, double core_c, double skin_c);

// dt_s later, exactly if resistances and heat stay as they are in it; stable for any dt_s.
void step_cold(const ColdSettings& settings, const ColdInputs& inputs, double dt_s,
               ColdState& state);

}  // namespace neritic::diver
