// How often a vehicle is stepped for the error that a user accepts: measured by `neritic tradeoff
// physics`, a BlueROV2 Heavy that flies for 20 s by recorded commands, by a controller in the loop
// in currents that change, and on missions of scenes as users fly them, with pulses of thrusters in
// whole microseconds. Pure function; any thread.
#pragma once

#include <span>

#include "engine/core/result.hpp"

namespace neritic::rov {

struct MeasuredRate {
  double hz;  // of kGuarded, which stays stable where plain RK4 would not
  // The largest distance from the true path, with room: of the flights, and of 140 missions in open
  // water against RK4 at 3 or 8 kHz. By recorded commands it is 2.9e-6 at 80 Hz. A controller whose
  // pulses are whole microseconds turns a difference of 1e-7 into one of a pulse sooner or later,
  // and that into the error here; the last rate's is that of missions on which none was turned.
  double error_m;
  double us_a_second;  // of one core (a shared Xeon core), lag included
};
// From the cheapest to the best. Below 80 Hz the guard takes as many substeps and nothing is saved.
std::span<const MeasuredRate> measured_rates();

// No rate promises less than these to a vehicle under control, whose decisions are not continuous:
// a thruster's pulse that is rounded to the other microsecond (at 1000 Hz on 8 of 140 missions, by
// up to 1.1e-4 m off; at 80 Hz on half of them), and contacts under control (8 missions; their
// truths, RK4 at 16 and 32 kHz, are up to 3.6e-3 m apart). Nor does any rate promise that a
// waypoint is left in the same control period: on 5 missions it was not, which led up to 1.7e-2 m
// off.
inline constexpr double kTurnedPulse_m = 5e-4, kTouchedUnderControl_m = 5e-3;

// The solid things among which a vehicle moves.
enum class Touchable {
  kNothing,
  kEven,    // flat ground and things without inner edges: planes, boxes, hulls
  kUneven,  // ground or meshes whose faces meet at inner edges, where a body hits as it slides
};

// How far steps that touch something lead off the path, by the change at which halving them ends:
// the worst of all that was flown at the rate that cheapest_step() sets beside it. 20 s along flat
// sand and a wall, by recorded commands with and without lag and by a controller in the loop, at
// rest and in a current that changes; a ball that bounces, a block that slides, a ball that rolls,
// against closed forms. Uneven: sand in waves, and a wreck's mesh, in that current.
// 0: such steps are not halved.
struct MeasuredContact {
  double within_m, error_m, uneven_error_m;
};
std::span<const MeasuredContact> measured_contacts();

struct StepChoice {
  double hz;
  double contact_error_m;  // at which halving a step that touches ends; 0: it is not halved
};
// The cheapest that holds the error among what can be touched. kBadInput where none does.
Result<StepChoice> cheapest_step(double max_error_m, Touchable touchable);

}  // namespace neritic::rov
