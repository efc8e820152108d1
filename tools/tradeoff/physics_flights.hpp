// The flights on which integrators are measured: recorded commands, the true path, and what stands
// in the way. Body and world axes of rov/ (north, east, down). One thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "testbed/simulation/body_step.hpp"

namespace neritic::tools {

// Commands change so often: the longest step.
inline constexpr double kHold_s = 0.05;

struct Flight {
  std::string name;
  rov::Vehicle vehicle;
  testbed::SolidBody body;
  std::unique_ptr<const sim::StaticWorld> solid;  // nothing: open water
  rov::State start;
  std::vector<rov::Inputs> inputs;  // held for kHold_s each
  // The state at the end of each hold, and how sure that is.
  std::vector<rov::State> truth;
  double truth_error_m = 0.0;

  rov::State step(const rov::State& state, const rov::Inputs& held, double dt_s,
                  const testbed::StepMethod& method) const {
    const testbed::VehicleStep step{body, vehicle, state, held, dt_s, method};
    const rov::State free = testbed::free_step(step);
    return solid ? testbed::step_among(*solid, step, free) : free;
  }
};

// A BlueROV2 Heavy round a square of three metres in a current, as its controller flies it; the
// truth is an adaptive extrapolation of high order.
Result<Flight> square_flight(bool lag, double seconds);
// The same vehicle set down on sand, from 3 s on driven along it, lifted, from 10 s on driven
// against a wall, along that, and away; the truth is the recommended integrator at a step so short
// that it errs least.
Flight contact_flight(bool lag, double seconds);
// Without drag, onto and along a plane; the truth is the closed form. A ball that falls and
// bounces; a block that slides until friction has stopped it; a ball that slides until it rolls,
// with 5/7 of its speed.
Flight bounce_flight(double seconds);
Flight slide_flight(double seconds);
Flight roll_flight(double seconds);

}  // namespace neritic::tools
