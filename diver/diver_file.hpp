// A diver from a TOML file: body, gear, kick and dive computer. The keys are in diver/README.md.
// Any thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "diver/deco_live.hpp"
#include "diver/gas_switch.hpp"
#include "diver/swimmer.hpp"

namespace neritic::diver {

struct DiverFile {
  std::string name;
  BodyParameters parameters;
  SwimmerSettings swimmer;
  DiveComputerSettings computer;  // its gases are the tanks', in their order
  GasSwitching gas_switching;
};

// water_kg_m3 and surface_pa are the scene's: its water and the air over it.
// include: a file whose keys come first. Errors: file and key, found and accepted; those of
// make_body and DiveComputer::create too.
Result<DiverFile> read_diver(const std::filesystem::path& path, double water_kg_m3,
                             double surface_pa = kSurfacePressure_pa);
// The same of text in memory; folder is what an include is relative to.
Result<DiverFile> parse_diver(std::string_view text, const std::string& name,
                              const std::filesystem::path& folder, double water_kg_m3,
                              double surface_pa = kSurfacePressure_pa);

}  // namespace neritic::diver
