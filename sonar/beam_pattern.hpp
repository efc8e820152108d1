// Beam patterns: one-way amplitude at an angle off a transducer's axis, 1 on the axis, negative in
// side lobes of opposite phase. One plane at a time: azimuth and elevation of a line array or a
// rectangle multiply. Pure functions in double; any thread.
//
// Exact sine law: u = L / lambda * sin(theta). All but the table are
// baffled: from behind (|theta| > pi/2) they hear nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "sonar/table.hpp"

namespace neritic::sonar {

using scene::BeamShape;
// "sinc", "hamming", "piston", "table", as scenes name them.
const char* name_of(BeamShape shape);
class BeamPattern {
 public:
  // Length in wavelengths, in [1e-3, 1e5]. kBadInput otherwise, and for kTable.
  static Result<BeamPattern> of_length(BeamShape shape, double length_wavelengths);
  // The length whose one-way half-power width (both sides together) is width_rad, in (0, pi).
  static Result<BeamPattern> of_half_power_width(BeamShape shape, double width_rad);
  // Rows of degrees, rising in [-180, 180], and dB in [-300, 0], linear in between. Without
  // negative angles both sides are alike. Beyond its last angles a table hears nothing.
  static Result<BeamPattern> of_table(SonarTable degrees_db);

  // theta_rad in [-pi, pi] off the axis.
  double amplitude(double theta_rad) const;
  // An array steered electronically to steer_rad: u = L / lambda (sin theta - sin steer), so beams
  // widen towards the sides. Both angles off the array's normal. Tables turn as they are.
  double steered_amplitude(double theta_rad, double steer_rad) const;
  // Power there and back, where the same pattern sends and hears.
  double two_way_power(double theta_rad) const;

  BeamShape shape() const { return shape_; }
  // Both sides together, how far off the axis one way keeps half the power that it has on it; of a
  // table at most to its ends.
  double half_power_width_rad() const;
  // Off the axis, where the first side lobe ends: the second null of a closed form, at most pi/2; a
  // table's farthest angle.
  double second_null_rad() const;

 private:
  BeamPattern(BeamShape shape, double length) : shape_(shape), length_(length) {}
  double table_amplitude(double theta_rad) const;
  BeamShape shape_;
  double length_;
  SonarTable table_;  // radians and dB, symmetric tables mirrored
};

// Constants of the closed forms, in u. Uniform line: half power at 0.44295, so a width of 0.886
// lambda / L; first side lobe -13.26 dB at 1.4303. Piston: ka sin(theta) = pi u = 1.6163; side
// lobe -17.57 dB at 5.136.
double beam_response(BeamShape shape, double u);  // kSinc, kHamming, kPiston
double half_power_u(BeamShape shape);

}  // namespace neritic::sonar
