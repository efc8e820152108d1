// The data that vehicles of one file and one model share: parameters, allocation, shape. Each is
// read and made once, so that a thousand vehicles of one kind load as fast as one and lie in the
// caches together. Built with the world, then only read; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "engine/scene/scene.hpp"
#include "rov/allocation.hpp"
#include "rov/vehicle_file.hpp"
#include "testbed/simulation/body_step.hpp"
#include "testbed/simulation/instants.hpp"
#include "testbed/simulation/propellers.hpp"

namespace neritic::testbed {

// The content of a vehicle file.
struct VehicleModel {
  rov::VehicleFile file;
  rov::Vehicle vehicle;
  // Hash of the file's bytes, and of what its thrust table makes of commands.
  std::uint64_t hash = 0;
  std::vector<Instants> instants;  // at which its steps end a part; control's first
};

struct VehicleKind {
  const VehicleModel& model;
  rov::Allocator allocator;  // without the thrusters that have failed at the start
  SolidBody solid;
  double top_m = 0.0, bottom_m = 0.0;      // of the shape, above the origin
  std::vector<DrawnPropeller> propellers;  // of the model
};

class VehicleKinds {
 public:
  // The kind of a vehicle of the scene whose steps take step_s: one object for all of a kind, valid
  // as long as this. Always the same scene and step. Errors in one line.
  Result<const VehicleKind*> of(const scene::Scene& scene, const scene::Object& object,
                                double step_s);

 private:
  Result<const VehicleModel*> model_of(const scene::Scene& scene, const scene::Object& object,
                                       double step_s);

  // File, failed thrusters, drawn model, scale, collision.
  using Key = std::tuple<std::string, std::uint64_t, int, std::array<double, 3>, scene::Collision>;
  std::map<std::string, std::unique_ptr<const VehicleModel>> models_;
  std::map<Key, std::unique_ptr<const VehicleKind>> kinds_;
};

// The most parts of a step but its last in which a sensor reads, where one is faster than the
// steps; else 0, since each has one reading at most in a step.
std::size_t earlier_in_step(const rov::SensorSet& sensors, double step_s);

}  // namespace neritic::testbed
