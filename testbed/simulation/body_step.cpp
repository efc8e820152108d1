#include "testbed/simulation/body_step.hpp"

#include <algorithm>
#include <cmath>

#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// Coulomb's, of a vehicle on another: that of a scene's things.
constexpr double kVehicleFriction = sim::Surface{}.friction;

sim::BodyMotion motion_of(const rov::State& state) {
  return {rov::world_pose(state.position_ned_m, state.attitude),
          {rov::world_from_ned(state.velocity.linear()),
           rov::world_from_ned(state.velocity.angular())}};
}

rov::State step_once(const sim::StaticWorld& solid, const SolidBody& body, const rov::State& before,
                     rov::State free, double dt_s, sim::ContactMemory& memory,
                     ContactReport& report) {
  const sim::Twist started = motion_of(before).velocity;
  const sim::BodyMotion moved = sim::move_body(
      solid, body.shape, body.inverse_mass, rov::world_pose(before.position_ned_m, before.attitude),
      motion_of(free), dt_s, memory, &report.motion, &started);
  if (!report.motion.touched) return free;
  const rov::Vec6 without = velocity_ned(free);
  set_motion(moved, free);
  report.change_ned = velocity_ned(free) - without;
  return free;
}

// One step, or some in a row: where it leads, and what touched.
struct Taken {
  rov::State after;
  ContactReport told;
};

// No half is shorter, and no more steps are taken in place of one: a body that is wedged has no
// path to come nearer to. A hit acts with the speed of its step's end, so steps with a hit are
// halved as far as that.
constexpr double kShortest_s = 2e-7;
constexpr int kMostSteps = 2000;
// Thrusters that set in let go of the ground within a step, and then pull on as they set in: some
// 250 m/s3 for a small vehicle. In steps no longer than this many times the root of the error, s
// per root of m, what that hides from two halves is smaller than the error.
constexpr double kLongest = 0.5;
// The start of a step in which a body that lay may still be held.
constexpr double kProbe_s = 2e-5;
// A difference in velocity counts by the way that it leads in this time: drag then has taken it.
constexpr double kVelocityTime_s = 0.3;

rov::Vec6 along(const rov::Vec6& coarse, const rov::Vec6& fine) {
  return fine + (fine - coarse);
}

// Where steps without end would lead, by one whole and two halves: the error is of first order in
// the length as long as the same contacts act in the same way (Studer, Leine and Glocker 2008,
// "Step size adjustment and extrapolation for time-stepping schemes in non-smooth dynamics").
Taken extrapolated(const Taken& coarse, Taken fine) {
  const rov::State& one = coarse.after;
  rov::State& two = fine.after;
  two.position_ned_m += two.position_ned_m - one.position_ned_m;
  const Quat near = glm::dot(one.attitude, two.attitude) < 0.0 ? -one.attitude : one.attitude;
  two.attitude = glm::normalize(2.0 * two.attitude - near);
  two.velocity = along(one.velocity, two.velocity);
  fine.told.change_ned = along(coarse.told.change_ned, fine.told.change_ned);
  fine.told.motion.impulse_n_s += fine.told.motion.impulse_n_s - coarse.told.motion.impulse_n_s;
  return fine;
}

// Halves a step that touches until it is known as well as is asked.
class Halving {
 public:
  Halving(const sim::StaticWorld& solid, const VehicleStep& step, sim::ContactMemory& memory)
      : solid_(solid),
        step_(step),
        memory_(memory),
        longest_s_(kLongest * std::sqrt(step.method.contact_error_m)) {}

  // whole: the same in one step.
  Taken run(const rov::State& before, const Taken& whole, double from_s, double length_s) {
    const bool touched = whole.told.motion.touched;
    if (!touched && !held_first(before, whole.told.motion.lies, from_s, length_s)) return whole;
    const double half_s = 0.5 * length_s;
    Taken first = once(before, from_s, half_s);
    if (touched) {
      const Taken second = once(first.after, from_s + half_s, half_s);
      Taken halves{second.after, first.told};
      add_part(second.told, halves.told);
      const bool hit = whole.told.motion.hits + halves.told.motion.hits > 0;
      if (!hit && length_s <= longest_s_ &&
          apart_m(whole.after, halves.after) <= step_.method.contact_error_m)
        return extrapolated(whole, halves);
      if (half_s < kShortest_s || steps_ >= kMostSteps) return halves;
    }
    first = run(before, first, from_s, half_s);
    const Taken rest =
        run(first.after, once(first.after, from_s + half_s, half_s), from_s + half_s, half_s);
    add_part(rest.told, first.told);
    return {rest.after, first.told};
  }

  Taken once(const rov::State& before, double from_s, double length_s) {
    ++steps_;
    rov::Inputs inputs = step_.inputs;
    inputs.current_ned_m_s += from_s * inputs.current_change_ned_m_s2;
    const rov::State free =
        free_step({step_.body, step_.vehicle, before, inputs, length_s, step_.method});
    Taken taken;
    taken.after = step_once(solid_, step_.body, before, free, length_s, memory_, taken.told);
    taken.told.motion.deepest_m = 0.0;  // within the step
    return taken;
  }

 private:
  // Whether what lies is let go of only after the step's start, although all of it lifts.
  bool held_first(const rov::State& before, bool lies, double from_s, double length_s) {
    if (!lies || steps_ >= kMostSteps) return false;
    for (double part_s = 0.5 * length_s; part_s > kProbe_s; part_s *= 0.5)
      if (once(before, from_s, part_s).told.motion.touched) return true;
    return false;
  }

  // How far two ends are apart, and will be.
  double apart_m(const rov::State& a, const rov::State& b) const {
    const double reach_m = step_.body.shape.reach_m();
    const Quat off = glm::conjugate(a.attitude) * b.attitude;
    const rov::Vec6 faster = b.velocity - a.velocity;
    return glm::distance(a.position_ned_m, b.position_ned_m) +
           2.0 * glm::length(Vec3(off.x, off.y, off.z)) * reach_m +
           kVelocityTime_s *
               (glm::length(faster.linear()) + glm::length(faster.angular()) * reach_m);
  }

  const sim::StaticWorld& solid_;
  const VehicleStep& step_;
  sim::ContactMemory& memory_;
  const double longest_s_;
  int steps_ = 0;
};

}  // namespace

void add_part(const ContactReport& part, ContactReport& whole) {
  whole.motion.contacts = part.motion.contacts;
  whole.motion.pieces += part.motion.pieces;
  whole.motion.hits += part.motion.hits;
  whole.motion.lies = whole.motion.lies || part.motion.lies;
  whole.motion.touched = whole.motion.touched || part.motion.touched;
  whole.motion.converged = whole.motion.converged && part.motion.converged;
  whole.motion.lost_s += part.motion.lost_s;
  whole.motion.deepest_m = std::max(whole.motion.deepest_m, part.motion.deepest_m);
  whole.motion.impulse_n_s += part.motion.impulse_n_s;
  whole.change_ned = whole.change_ned + part.change_ned;
}

SolidBody solid_body(const rov::Vehicle& vehicle) {
  return {{}, rov::world_from_ned(vehicle.inverse_mass).m};
}

rov::Vec6 velocity_ned(const rov::State& state) {
  return rov::vec6(state.attitude * state.velocity.linear(),
                   state.attitude * state.velocity.angular());
}

rov::State free_step(const VehicleStep& step) {
  return rov::step(step.vehicle, step.before, step.inputs, step.dt_s, step.method.integrator);
}

sim::PairBody pair_body(const VehicleStep& step, const rov::State& free) {
  return {step.body.shape, step.body.inverse_mass,
          rov::world_pose(step.before.position_ned_m, step.before.attitude), motion_of(free)};
}

void set_motion(const sim::BodyMotion& motion, rov::State& state) {
  state.position_ned_m = rov::ned_from_world(motion.world_from_body.position_m);
  state.attitude = rov::ned_from_world(motion.world_from_body.rotation);
  state.velocity = rov::vec6(rov::ned_from_world(motion.velocity.linear),
                             rov::ned_from_world(motion.velocity.angular));
}

bool part_vehicles(const VehicleStep& a, rov::State& free_a, const VehicleStep& b,
                   rov::State& free_b, sim::PairMemory& memory) {
  sim::PairBody pair_a = pair_body(a, free_a), pair_b = pair_body(b, free_b);
  if (!sim::part_bodies(pair_a, pair_b, kVehicleFriction, a.dt_s, memory)) return false;
  set_motion(pair_a.free, free_a);
  set_motion(pair_b.free, free_b);
  return true;
}

rov::State step_among(const sim::StaticWorld& solid, const VehicleStep& step,
                      const rov::State& free, bool parted, sim::ContactMemory& memory,
                      ContactReport* report) {
  Taken taken;
  taken.after = step_once(solid, step.body, step.before, free, step.dt_s, memory, taken.told);
  const bool near = taken.told.motion.touched || taken.told.motion.lies;
  if (near && !parted && step.method.contact_error_m > 0.0) {
    const double deepest_m = taken.told.motion.deepest_m;
    memory.solver.precise = true;
    Halving halving(solid, step, memory);
    if (taken.told.motion.touched) taken = halving.once(step.before, 0.0, step.dt_s);
    taken = halving.run(step.before, taken, 0.0, step.dt_s);
    memory.solver.precise = false;
    taken.told.motion.deepest_m = deepest_m;
  }
  if (report) *report = taken.told;
  return taken.after;
}

rov::State step_among(const sim::StaticWorld& solid, const VehicleStep& step,
                      const rov::State& free) {
  sim::ContactMemory memory;
  return step_among(solid, step, free, false, memory);
}

}  // namespace neritic::testbed
