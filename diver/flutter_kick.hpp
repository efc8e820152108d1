// The flutter kick as a wave that travels down the legs: both legs beat in turn, hip, knee and
// ankle so phased that thigh, shank and fin are chords of h(x, t) = a (x / l)^p sin(w t - k x), x
// from the hip to the tip at l. Arbitrary phases of plausible size would cost kilowatts. Pure
// functions; any thread.
#pragma once

#include "diver/kinematics.hpp"

namespace neritic::diver {

struct FlutterKick {
  // At the tips, half of the whole beat. Amplitude and exponent are those of the least power with
  // full gear at 0.6 m/s: 0.18 and 0.32 m, 1.0 and 1.6 take more
  // (Swimmer.NoOtherKickTakesLessAtThatSpeed).
  double amplitude_m = 0.25;
  double wavelength_m = 2.33;  // the wave runs at 2.33 m times the frequency (Zamparo et al. 2002)
  double exponent = 1.25;
  // Knees bend one way only: this much on average. Hips and ankles make up for it. Measured with
  // full gear at 0.5 m/s: 109 W; with 8 degrees 130 W, with 24 degrees 111 W.
  double knee_rad = radians(16.0);
  // Toes are pointed no farther than this from square: in line with the shin. Measured likewise: 70
  // degrees take 131 W, 50 degrees (an average ankle: AAOS 1965, Joint Motion) 192 W.
  double pointed_rad = radians(90.0);
  // Both legs out of the line, to the belly's side: steers in pitch.
  double lift_rad = 0.0;
  // How much wider the left leg beats than the right one, of the mean: steers to starboard.
  double left_more = 0.0;
  // Moves the left leg by this angle to the belly's side, the right one back: rolls to starboard.
  double twist_rad = 0.0;
};

// Legs of a body at that phase (2 pi a beat of both legs), with the other joints as they are. The
// phase is the left leg's; the right one is half a beat later. Angles stay in the range of joints.
void set_flutter(JointAngles& joints, const Body& body, const FlutterKick& kick, double phase_rad);

// A swimmer's posture: arms along the sides, legs straight, toes pointed, looking ahead.
JointAngles streamlined(const Body& body);

}  // namespace neritic::diver
