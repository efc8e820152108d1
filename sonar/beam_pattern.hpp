// What a transducer hears from an angle off its axis: one-way amplitude, 1 on the axis, negative
// in side lobes of opposite phase. One plane at a time: azimuth and elevation of a line array or a
// rectangle multiply. Pure functions in double; any thread.
//
// Exact sine law: u = L / lambda * sin(theta). All but the omnidirectional and the table are
// baffled: from behind (|theta| > pi/2) they hear nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "sonar/acoustics_csv.hpp"

namespace neritic::sonar {

enum class BeamKind {
  kOmni,     // 1 everywhere
  kSinc,     // uniform line or rectangle side L: sin(pi u) / (pi u)
  kHamming,  // line with Hamming weights, continuous: side lobes below -42 dB
  kPiston,   // circular, L its diameter: 2 J1(pi u) / (pi u)
  kTable,    // measured
};
const char* name_of(BeamKind kind);
// "omni", "sinc", "hamming", "piston"; kBadInput names the others (a table is read from a file).
Result<BeamKind> beam_kind_of(std::string_view name);

struct SideLobe {
  double angle_rad = 0.0;  // of its peak, > 0
  double level_db = 0.0;   // one way, re the axis
};

class BeamPattern {
 public:
  static BeamPattern omni();
  // Length in wavelengths, in [1e-3, 1e5]. kBadInput otherwise, and for kOmni and kTable.
  static Result<BeamPattern> of_length(BeamKind kind, double length_wavelengths);
  static Result<BeamPattern> of_length(BeamKind kind, double length_m, double frequency_hz,
                                       double sound_speed_m_s);
  // The length whose one-way half-power width (both sides together) is width_rad, in (0, pi).
  static Result<BeamPattern> of_half_power_width(BeamKind kind, double width_rad);
  // Rows of degrees, rising in [-180, 180], and dB in [-300, 0], linear in between. Without
  // negative angles both sides are alike. Beyond its last angles a table hears nothing.
  static Result<BeamPattern> of_table(Table degrees_db);
  static Result<BeamPattern> from_file(const std::filesystem::path& path);

  // theta_rad in [-pi, pi] off the axis.
  double amplitude(double theta_rad) const;
  // An array steered electronically to steer_rad: u = L / lambda (sin theta - sin steer), so beams
  // widen towards the sides. Both angles off the array's normal. Omni and tables turn as they are.
  double steered_amplitude(double theta_rad, double steer_rad) const;
  // Power heard and, where the same pattern sends, power there and back.
  double one_way_power(double theta_rad) const;
  double two_way_power(double theta_rad) const;

  BeamKind kind() const { return kind_; }
  // 0 for kOmni and kTable.
  double length_wavelengths() const { return length_; }
  // One way, both sides together. Where nothing falls to one half: pi (baffled), 2 pi (omni) or
  // the table's extent.
  double half_power_width_rad() const;
  // The first peak beyond the first minimum; none where it lies beyond pi/2 or the table's end.
  std::optional<SideLobe> first_side_lobe() const;

 private:
  BeamPattern(BeamKind kind, double length) : kind_(kind), length_(length) {}
  double table_amplitude(double theta_rad) const;
  BeamKind kind_;
  double length_;
  Table table_;  // radians and dB, symmetric tables mirrored
};

// Constants of the closed forms, in u. Uniform line: half power at 0.44295, so a width of 0.886
// lambda / L; first side lobe -13.26 dB at 1.4303. Piston: ka sin(theta) = pi u = 1.6163; side
// lobe -17.57 dB at 5.136.
double beam_response(BeamKind kind, double u);  // kSinc, kHamming, kPiston
double half_power_u(BeamKind kind);

}  // namespace neritic::sonar
