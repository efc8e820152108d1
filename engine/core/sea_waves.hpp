// Waves of a wind sea as a sum of sines: the one model that the picture of the surface, its
// caustics, buoyancy and a floating hull share. Deep water, linear (Airy): height(x, z, t) = sum a
// cos(k.p - w t + phase). World frame, still water at y = 0. Made once from the spectrum; then a
// plain value, any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/math.hpp"

namespace neritic {

struct SeaState {
  double wind_m_s = 5.0;       // at 10 m
  double fetch_m = 10000.0;    // of open water upwind
  double direction_rad = 0.0;  // towards which wind and waves go, from north (-z) towards east (+x)
  std::uint32_t components = 32;
  std::uint64_t seed = 1;
};

struct SeaWave {
  Vec2 wave_number_m;  // 1/m, x and z
  double amplitude_m = 0.0, angular_s = 0.0, phase_rad = 0.0;
};

// JONSWAP's spectrum of a growing wind sea: Hasselmann et al. 1973 (alpha, peak and gamma over the
// dimensionless fetch), m^2 s, at an angular frequency in 1/s. 0 at and below 0.
double jonswap(const SeaState& sea, double angular_s);
double jonswap_peak(const SeaState& sea);  // 1/s

// The water at a point under waves.
struct WaveFlow {
  Vec3 velocity_m_s{0.0};
  Mat3 gradient_per_s{0.0};  // column j: d velocity / d x_j
  Vec3 rate_m_s2{0.0};       // d velocity / d time, at the point
  // The pressure is that of still water deeper by this much; at the surface the waves' height.
  double head_m = 0.0;
};

class SeaWaves {
 public:
  SeaWaves() = default;  // still water
  explicit SeaWaves(const SeaState& sea);

  const std::vector<SeaWave>& waves() const { return waves_; }  // from long to short
  double height_m(double x_m, double z_m, double time_s) const;
  // Slopes of the height along x and z.
  Vec2 slope(double x_m, double z_m, double time_s) const;
  // The water's velocity at a point (Airy); above the surface that at the surface.
  Vec3 velocity_m_s(const Vec3& point_m, double time_s) const {
    return flow(point_m, time_s).velocity_m_s;
  }
  WaveFlow flow(const Vec3& point_m, double time_s) const;
  // A floating body's place: the mean height over a footprint of this length and breadth, whose
  // long side faces heading_rad, and the slopes along x and z of the plane that fits. Waves much
  // shorter than the footprint do not move it.
  Vec3 height_and_slopes(const Vec2& center_m, const Vec2& length_breadth_m, double heading_rad,
                         double time_s) const;
  double height_rms_m() const { return height_rms_m_; }
  double slope2() const { return slope2_; }
  // Mean square slope, both axes, of waves shorter than those of the sum: what Cox and Munk
  // measured less the sum's own.
  double fine_slope2() const { return fine_slope2_; }
  // Share of the surface under whitecaps (Monahan and O'Muircheartaigh 1980, eq. 5), at most 1.
  double foam_share() const { return foam_share_; }
  // A wave's angle at a place and time, in [-pi, pi], reduced in double.
  static double angle_rad(const SeaWave& wave, double x_m, double z_m, double time_s);

 private:
  std::vector<SeaWave> waves_;
  double height_rms_m_ = 0.0, slope2_ = 0.0, fine_slope2_ = 0.0, foam_share_ = 0.0;
};

}  // namespace neritic
