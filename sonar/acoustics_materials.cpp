#include "sonar/acoustics_materials.hpp"

#include <array>
#include <vector>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::sonar {
namespace {

// Sources in full: Kinsler, Frey, Coppens, Sanders 2000, Fundamentals of Acoustics, 4th ed.,
// appendix A10. Hamilton 1980, "Geoacoustic modeling of the sea floor", JASA 68, 1313, table I,
// continental terrace. Jensen, Kuperman, Porter, Schmidt 2011, Computational Ocean Acoustics,
// table 1.3 (densities there are ratios to water's; 1000 kg/m3 here). ASTM E494, table X3.1.
// Tissue: middles of the ranges gathered in doi 10.1016/j.mechmat.2011.08.007, table 3. Plastics
// and rubbers: ultrasonic thickness gauge tables for the speed (Olympus 45MG manual, appendix B).
constexpr std::string_view kE494 = "ASTM E494 table X3.1";
constexpr std::string_view kHamilton = "Hamilton 1980, continental terrace";
constexpr std::string_view kJensen = "Jensen et al. 2011, table 1.3";
constexpr std::string_view kKinsler = "Kinsler et al. 2000, appendix A10";
constexpr std::string_view kTissue = "doi 10.1016/j.mechmat.2011.08.007, table 3";
constexpr std::string_view kGauge = "Olympus 45MG manual, appendix B; usual density";

constexpr auto kMaterials = std::to_array<Material>({
    {"water", kReferenceWater, "fresh water at 20 to 25 C"},
    {"air", {1.2, 343.0}, "dry air at 20 C, 101325 Pa"},
    {"steel", {7850.0, 5900.0}, "speed: ASTM E494 table X3.1; density of mild steel"},
    {"aluminium", {2700.0, 6420.0}, "CRC Handbook, rolled aluminium"},
    {"brass", {8100.0, 4370.0}, kE494},
    {"bronze", {8860.0, 3530.0}, kE494},
    {"cast_iron", {7200.0, 4550.0}, "ASTM E494 table X3.1, middle of 3500 to 5600 m/s"},
    {"lead", {11400.0, 2160.0}, kE494},
    {"titanium", {4540.0, 6240.0}, kE494},
    {"acrylic", {1180.0, 2670.0}, kE494},
    {"concrete", {2400.0, 3100.0}, "speed: Kinsler et al. 2000; density of normal concrete"},
    {"glass", {2300.0, 5600.0}, "Kinsler et al. 2000, appendix A10 (Pyrex)"},
    {"ice", {920.0, 3200.0}, kKinsler},
    {"oak", {720.0, 4000.0}, "Kinsler et al. 2000, appendix A10 (dry, along the grain)"},
    {"pine", {450.0, 3500.0}, "Kinsler et al. 2000, appendix A10 (dry, along the grain)"},
    {"rock", {2700.0, 5250.0}, "Jensen et al. 2011, table 1.3 (basalt)"},
    {"limestone", {2400.0, 3000.0}, kJensen},
    {"chalk", {2200.0, 2400.0}, kJensen},
    {"moraine", {2100.0, 1950.0}, kJensen},
    {"gravel", {2000.0, 1800.0}, kJensen},
    {"coarse_sand", {2034.0, 1836.0}, kHamilton},
    {"sand", {1941.0, 1749.0}, "Hamilton 1980, continental terrace (fine sand)"},
    {"silt", {1740.0, 1615.0}, kHamilton},
    {"mud", {1488.0, 1549.0}, "Hamilton 1980, continental terrace (clayey silt)"},
    {"clay", {1421.0, 1520.0}, "Hamilton 1980, continental terrace (silty clay)"},
    {"rubber", {1100.0, 1500.0}, "near Kinsler et al. 2000's rho-c rubber (1000, 1550)"},
    {"neoprene", {1300.0, 1600.0}, "solid; thickness gauge tables; usual density"},
    {"pvc", {1400.0, 2395.0}, kGauge},
    {"polyethylene", {950.0, 2460.0}, "Olympus 45MG manual, appendix B (HDPE); usual density"},
    {"tissue", {1050.0, 1558.0}, "doi 10.1016/j.mechmat.2011.08.007, table 3 (muscle)"},
    {"skin", {1090.0, 1615.0}, kTissue},
    {"fat", {950.0, 1478.0}, kTissue},
    {"bone", {2000.0, 3600.0}, "doi 10.1016/j.mechmat.2011.08.007, table 3 (cortical)"},
});

}  // namespace

std::span<const Material> materials() {
  return kMaterials;
}

Result<Medium> material_of(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Material& material : kMaterials) {
    if (material.name == name) return material.medium;
    names.push_back(material.name);
  }
  return refusal("material",
                 fmt::format("'{}' (nearest: {})", printable(name), nearest(name, names)),
                 join(names));
}

}  // namespace neritic::sonar
