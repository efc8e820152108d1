// A vehicle's physics from its TOML file (rov/VEHICLES.md lists the keys). One thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "rov/controller.hpp"
#include "rov/outline.hpp"
#include "rov/sensor_set.hpp"
#include "rov/thrust_curve.hpp"
#include "rov/vehicle.hpp"

namespace neritic::rov {

struct VehicleFile {
  VehicleParameters parameters;
  ControlGains gains;
  // Where the file names a thrust table: commands go through it at this voltage (drive()).
  std::optional<ThrustCurve> curve;
  double voltage_v = 16.0;
  double gravity_m_s2 = 9.82;
  SensorSet sensors;
  std::vector<OutlinePart> outline;  // none: what is drawn of it says it
};

// Errors in one line: file:line, key, what was found, what is accepted. Buoyancy is that of the
// file's volume in water of this density, unless it gives the buoyancy itself; so is the tether's
// drag, unless its table names another density.
Result<VehicleFile> read_vehicle(const std::filesystem::path& path, double water_kg_m3);
// The same from text; paths in it are relative to folder.
Result<VehicleFile> parse_vehicle(std::string_view text, const std::string& name,
                                  const std::filesystem::path& folder, double water_kg_m3);

// Commands in newtons as the speed controllers realise them: dead band, table, saturation. With a
// battery at its voltage, and none once it is empty.
void drive(const VehicleFile& file, Inputs& inputs, const BatteryState* battery = nullptr);
// Least and most force that any command gives a thruster, at the file's voltage: the table's ends,
// or the file's limits.
std::pair<double, double> thruster_limits_n(const VehicleFile& file, std::size_t thruster);

}  // namespace neritic::rov
