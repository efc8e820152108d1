// The flights on which integrators are measured: recorded commands or a controller, the true path,
// and what stands in the way. Body and world axes of rov/ (north, east, down). One thread.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/sim/current.hpp"
#include "rov/closed_loop.hpp"
#include "rov/thrust_curve.hpp"
#include "testbed/simulation/body_step.hpp"

namespace neritic::tools {

// Commands change so often: the longest step.
inline constexpr double kHold_s = 0.05;

// A controller in the loop: it acts at the start of each hold.
struct Loop {
  rov::Allocator allocator;
  rov::ControlGains gains;
  rov::Guide guide;                        // of the time alone, so that it can be flown again
  std::optional<rov::ThrustCurve> pulses;  // commands go through it in whole microseconds
};

struct Flight {
  std::string name;
  rov::Vehicle vehicle;
  testbed::SolidBody body;
  std::unique_ptr<const sim::StaticWorld> solid;  // nothing: open water
  rov::State start;
  std::vector<rov::Inputs> inputs;      // held for kHold_s each
  std::optional<Loop> loop;             // makes the commands anew, in place of those
  std::optional<sim::Current> current;  // in place of the inputs' own
  // The state at the end of each hold, and how sure that is.
  std::vector<rov::State> truth;
  double truth_error_m = 0.0;

  // The commands of a hold that begins at this state.
  rov::Inputs commands(std::size_t hold, const rov::State& state, rov::ControlState& control) const;
  // With the water's motion over the next dt_s.
  rov::Inputs in_water(rov::Inputs inputs, const rov::State& state, double time_s,
                       double dt_s) const;
  rov::State step(const rov::State& state, const rov::Inputs& held, double time_s, double dt_s,
                  const testbed::StepMethod& method) const;

  // Flies it in these steps a hold; seen(hold, state) after each hold.
  template <class Seen>
  void fly(int count, const testbed::StepMethod& method, const Seen& seen) const {
    rov::State state = start;
    rov::ControlState control;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      const rov::Inputs held = commands(k, state, control);
      const double dt_s = kHold_s / count;
      for (int i = 0; i < count; ++i)
        state = step(state, held, static_cast<double>(k) * kHold_s + i * dt_s, dt_s, method);
      seen(k, state);
    }
  }
};

// A BlueROV2 Heavy round a square of three metres in a current, as its controller flies it; the
// truth is an adaptive extrapolation of high order.
Result<Flight> square_flight(bool lag, double seconds);
// The same vehicle by a controller in the loop, between moving setpoints in a current that is
// sheared and turns with time; or with pulses in whole microseconds, which turn the least
// difference into one of a whole pulse.
Result<Flight> mission_flight(bool pulses, double seconds);
// The same vehicle set down on sand, from 3 s on driven along it, lifted, from 10 s on driven
// against a wall, along that, and away; the truth are steps of 1 ms, those that touch halved until
// they err least.
Flight contact_flight(bool lag, double seconds);
// The same way by a controller in the loop.
Flight contact_mission_flight(double seconds);
// In a current that is sheared and turns with time, by a controller in the loop: set down on sand,
// flat or uneven, driven along it, lifted and set down again.
Flight landing_flight(bool uneven, double seconds);
// In the same current the first vehicle of the scene with the wreck, against the wreck's side and
// along it, then on its deck: the mesh of 190 000 triangles that is drawn.
Result<Flight> wreck_flight(const std::filesystem::path& scene_file, double seconds);
// Without drag, onto and along a plane; the truth is the closed form. A ball that falls and
// bounces; a block that slides until friction has stopped it; a ball that slides until it rolls,
// with 5/7 of its speed.
Flight bounce_flight(double seconds);
Flight slide_flight(double seconds);
Flight roll_flight(double seconds);

}  // namespace neritic::tools
