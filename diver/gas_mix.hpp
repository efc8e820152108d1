// A breathing gas: shares of oxygen and helium by moles, the rest nitrogen. A plain value, also in
// states (two doubles); any thread.
#pragma once

namespace neritic::diver {

struct GasMix {
  double oxygen = 0.21, helium = 0.0;
  constexpr double nitrogen() const { return 1.0 - oxygen - helium; }
  bool operator==(const GasMix&) const = default;

  static void fields(auto&& field, auto& self) {
    field("oxygen", self.oxygen);
    field("helium", self.helium);
  }
};

inline constexpr GasMix kAir{};

// Shares are 0 to 1 and their sum too. NaN fails.
constexpr bool is_mix(const GasMix& mix) {
  return mix.oxygen >= 0.0 && mix.helium >= 0.0 && mix.oxygen + mix.helium <= 1.0;
}

// kg/mol (CIAAW 2021 atomic weights).
constexpr double molar_mass(const GasMix& mix) {
  return 31.998e-3 * mix.oxygen + 4.0026e-3 * mix.helium + 28.014e-3 * mix.nitrogen();
}

}  // namespace neritic::diver
