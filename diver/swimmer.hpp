// A simulated person who swims to a place: joints for the kick and for steering, breath and buttons
// for the depth. It replaces the motion suit and the jacket's buttons where nobody wears them.
// Plain bytes in, plain bytes out; pure functions, any thread. World north, east, down.
#pragma once

#include <optional>

#include "diver/flutter_kick.hpp"
#include "diver/human_step.hpp"

namespace neritic::diver {

struct SwimGoal {
  // The swimmer rises to a place well above by less than 9 m a minute, in wide turns if it lies
  // straight above, and sinks to one well below by about 9 m a minute.
  Vec3 target_ned_m{0.0};
  // Through the water; 0: hovers there, level: hands and fins hold the place, in a current as far
  // as legs last.
  double speed_m_s = 0.5;
  // Up, negative down, at this rate, reached and left within seconds, whatever depth the target
  // has: a person steers the depth himself. Nothing: to the target's depth, as above.
  std::optional<double> climb_m_s;
};

struct SwimmerSettings {
  FlutterKick kick;
  // With full gear 0.68 m/s at 231 W (105 W at 1 Hz, diver/README.md; power goes with the cube).
  // Bare feet reach 1.6 Hz at 0.8 m/s (Zamparo et al. 2006, Eur. J. Appl. Physiol. 96, 459).
  double most_frequency_hz = 1.3;
  double gliding_speed_m_s = 0.05;  // below: legs rest
};

// A second-order filter that stops one frequency: a kick's own rolling. Plain bytes.
struct BeatNotch {
  double first = 0.0, second = 0.0;

  static void fields(auto&& field, auto& self) {
    field("first", self.first);
    field("second", self.second);
  }
};

struct SwimmerState {
  double phase_rad = 0.0, frequency_hz = 0.0;
  double effort = 0.0;     // kick amplitude, 0 to 1 of the settings': grows within a second
  double speed_sum = 0.0;  // m: too slow so far
  double climb_sum = 0.0;  // m: sunk too much so far
  double pitch_sum = 0.0;  // rad s: too low so far
  double roll_sum = 0.0;   // rad s: too far to starboard so far, while resting
  double lift_sum = 0.0;   // litres times seconds of breath that was asked for
  double breath_bias_m3 = 0.0;
  double lift_rad = 0.0, twist_rad = 0.0, left_more = 0.0, bend_rad = 0.0;
  double knees_rad = 0.0;                     // bent while resting: buoyant shins lie farther ahead
  double legs_aside_rad = 0.0;                // with little way: to starboard
  double stoop_rad = 0.0;                     // while hovering too steeply
  double tread = 0.0, tread_phase_rad = 0.0;  // while resting: shins beat, 0 to 1
  // While hovering, hands push the water aft by this amplitude, left and right, or ahead
  // (negative).
  double scull_left_rad = 0.0, scull_right_rad = 0.0, scull_phase_rad = 0.0;
  double sculls = 0.0;     // forearms are down for it, 0 to 1
  double turn_side = 0.0;  // 1: comes round to starboard, -1: to port
  // Roll and its rate without the kick's own rolling.
  BeatNotch roll, roll_rate;
  double rests = 1.0;     // 1: lies still in the water, 0: has way
  double button_s = 0.0;  // since a button was last let go; negative: still to be pressed
  // The share of the rate at which the swimmer rises to a place well above; negative: sinks to one
  // well below; 0: neither.
  double rises = 0.0;
  // While hovering, 1: drifted off and swims back; 2: tilted, and swims to right himself; 3: sunk
  // too deep with nothing to fill a jacket, and kicks up.
  std::uint64_t goes_back = 0;

  static void fields(auto&& field, auto& self) {
    field("phase_rad", self.phase_rad);
    field("frequency_hz", self.frequency_hz);
    field("effort", self.effort);
    field("speed_sum", self.speed_sum);
    field("climb_sum", self.climb_sum);
    field("pitch_sum", self.pitch_sum);
    field("roll_sum", self.roll_sum);
    field("lift_sum", self.lift_sum);
    field("breath_bias_m3", self.breath_bias_m3);
    field("lift_rad", self.lift_rad);
    field("twist_rad", self.twist_rad);
    field("left_more", self.left_more);
    field("bend_rad", self.bend_rad);
    field("knees_rad", self.knees_rad);
    field("legs_aside_rad", self.legs_aside_rad);
    field("stoop_rad", self.stoop_rad);
    field("tread", self.tread);
    field("tread_phase_rad", self.tread_phase_rad);
    field("scull_left_rad", self.scull_left_rad);
    field("scull_right_rad", self.scull_right_rad);
    field("scull_phase_rad", self.scull_phase_rad);
    field("sculls", self.sculls);
    field("turn_side", self.turn_side);
    field("roll", self.roll);
    field("roll_rate", self.roll_rate);
    field("rests", self.rests);
    field("button_s", self.button_s);
    field("rises", self.rises);
    field("goes_back", self.goes_back);
  }
};

// The next dt_s of swimming: joints, breath and buttons into inputs; the rest of them stays.
void swim(const Body& body, const SwimmerSettings& settings, const SwimGoal& goal,
          const HumanState& state, SwimmerState& swimmer, double dt_s, HumanInputs& inputs);

// Heading, pitch and roll from ned_from_body.
struct HumanAttitude {
  double heading_rad = 0.0, pitch_rad = 0.0, roll_rad = 0.0;  // of the line from hips to head
};
HumanAttitude attitude_of(const Quat& ned_from_body);

}  // namespace neritic::diver
