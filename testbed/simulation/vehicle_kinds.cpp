// Reading and checking of vehicle files (vehicle_kinds.hpp).
#include "testbed/simulation/vehicle_kinds.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/core/files.hpp"
#include "engine/core/hash.hpp"
#include "testbed/simulation/vehicle_shape.hpp"

namespace neritic::testbed {
namespace {

Status check_thrusters(const scene::Scene& scene, const scene::Object& object,
                       const rov::Vehicle& vehicle) {
  const std::uint64_t failed = object.dynamics->failed_thrusters;
  if ((failed >> vehicle.thruster_count) == 0) return {};
  return bad_input("{}: {}: failed_thrusters: thruster {} found; accepted: 1 to {}, as {} has",
                   scene.path, object.name, std::bit_width(failed), vehicle.thruster_count,
                   object.dynamics->file.string());
}

// A thrust table lies in a file of its own: the hash covers the forces over the commands' range.
std::uint64_t hash_of(const std::string& text, const rov::VehicleFile& file) {
  constexpr int kCommands = 64;
  constexpr double kMost_n = 200.0;
  Hash64 hash;
  hash.add_span(std::span<const char>(text));
  for (int i = -kCommands; i <= kCommands; ++i) {
    rov::Inputs commands;
    commands.thruster_n.fill(kMost_n * i / kCommands);
    rov::drive(file, commands);
    hash.add(commands.thruster_n);
  }
  return hash.value();
}

std::vector<double> rates_hz(const rov::SensorSet& sensors) {
  std::vector<double> out;
  const auto add = [&](const auto& sensor) {
    if (sensor) out.push_back(sensor->rate_hz);
  };
  add(sensors.imu);
  add(sensors.dvl);
  add(sensors.pressure);
  add(sensors.compass);
  add(sensors.altimeter);
  add(sensors.usbl);
  return out;
}

// The instants of control first, then of each sensor.
std::vector<Instants> instants_of(const rov::VehicleFile& file, double step_s) {
  std::vector<Instants> out{{1.0 / file.gains.period_s, step_s}};
  for (const double hz : rates_hz(file.sensors)) out.emplace_back(hz, step_s);
  return out;
}

}  // namespace

std::size_t earlier_in_step(const rov::SensorSet& sensors, double step_s) {
  constexpr double kSlack = 1e-9;  // of a rate that is the steps'
  std::size_t instants = 0;        // before the step's end
  bool faster = false;
  for (const double hz : rates_hz(sensors)) {
    faster = faster || hz * step_s > 1.0 + kSlack;
    instants += static_cast<std::size_t>(std::ceil(hz * step_s - kSlack));
  }
  return faster ? instants : 0;
}

Result<const VehicleModel*> VehicleKinds::model_of(const scene::Scene& scene,
                                                   const scene::Object& object, double step_s) {
  const std::filesystem::path& path = object.dynamics->file;
  auto& known = models_[path.string()];
  if (known) return known.get();
  NERITIC_TRY(const std::string text, read_text(path));
  VehicleModel model;
  NERITIC_TRY(model.file, rov::parse_vehicle(text, path.string(), path.parent_path(),
                                             scene.physics->water_kg_m3));
  model.hash = hash_of(text, model.file);
  model.instants = instants_of(model.file, step_s);
  NERITIC_TRY(model.vehicle, rov::make_vehicle(model.file.parameters));
  rov::prepare_steps(model.vehicle, std::array{step_s});
  known = std::make_unique<const VehicleModel>(std::move(model));
  return known.get();
}

Result<const VehicleKind*> VehicleKinds::of(const scene::Scene& scene, const scene::Object& object,
                                            double step_s) {
  const scene::Dynamics& dynamics = *object.dynamics;
  auto& known =
      kinds_[{dynamics.file.string(), dynamics.failed_thrusters, object.model,
              std::array{object.scale.x, object.scale.y, object.scale.z}, object.collision}];
  if (known) return known.get();
  NERITIC_TRY(const VehicleModel* model, model_of(scene, object, step_s));
  NERITIC_TRY_STATUS(check_thrusters(scene, object, model->vehicle));
  VehicleKind kind{.model = *model,
                   .allocator = rov::Allocator(model->vehicle, dynamics.failed_thrusters),
                   .solid = solid_body(model->vehicle)};
  Result<VehicleShape> shape = vehicle_shape(scene, object, model->file.outline);
  if (!shape.ok()) return bad_input("{}: {}: {}", scene.path, object.name, shape.error().message);
  kind.solid.shape = std::move(shape->body);
  kind.top_m = shape->top_m;
  kind.bottom_m = shape->bottom_m;
  if (object.model >= 0)
    kind.propellers =
        drawn_propellers(*scene.models[static_cast<std::size_t>(object.model)], model->vehicle);
  known = std::make_unique<const VehicleKind>(std::move(kind));
  return known.get();
}

}  // namespace neritic::testbed
