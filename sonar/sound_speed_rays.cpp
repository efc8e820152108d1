// Bent rays of SoundSpeedProfile: from layer to layer in closed form.
//
// In a layer c = c0 + g (z - z0), z down. With the grazing angle a (positive down) Snell keeps
// cos(a) / c. Time and angle are tied by the Gudermannian: F(a) = atanh(sin a) falls by g t. All
// differences of nearly equal numbers are written as products, so that grazing rays, thin layers
// and vanishing gradients keep their digits.
#include <cmath>
#include <limits>

#include "engine/core/math.hpp"
#include "sonar/sound_speed_profile.hpp"

namespace neritic::sonar {

class RayTracer {
 public:
  RayTracer(const SoundSpeedProfile& profile, double depth_m, double elevation_rad)
      : profile_(profile), depth_m_(depth_m), angle_rad_(-elevation_rad) {
    at_ = profile.layer_at(depth_m);
    // On a boundary, upwards rays start in the layer above.
    if (layer().top_m == depth_m_ && goes_up_from_top()) --at_;
  }

  RayPoint trace(double time_s) {
    while (time_s > 0.0) {
      if (held()) {
        const double depth_m = depth_m_;
        straight(time_s);
        depth_m_ = depth_m;
        break;
      }
      const Exit exit = layer().gradient_s == 0.0 ? straight_exit() : curved_exit();
      if (!(exit.time_s < time_s)) {
        stay(time_s);
        break;
      }
      leave(exit);
      time_s -= exit.time_s;
    }
    return {horizontal_m_, depth_m_, arc_m_, -angle_rad_};
  }

 private:
  using Layer = SoundSpeedProfile::Layer;
  struct Exit {
    double time_s = std::numeric_limits<double>::infinity();
    double turn_rad = 0.0;  // change of angle on the way
    double arc_m = 0.0;
    bool bottom = false;  // through the layer's bottom, else its top
  };

  const Layer& layer() const { return profile_.layers_[at_]; }
  double speed() const { return layer().speed_at(depth_m_); }

  // Whether a ray on the layer's top heads out of it: upwards, or level and bent upwards by the
  // layer above while this one does not pull it down.
  bool goes_up_from_top() const {
    const double sine = std::sin(angle_rad_);
    if (sine != 0.0) return sine < 0.0;
    return layer().gradient_s >= 0.0 && at_ > 0 && profile_.layers_[at_ - 1].gradient_s > 0.0;
  }

  // Whether the ray lies so flat on a boundary at the speed's minimum that it never gets 1 um away:
  // it rises c a^2 / (2 |g|). Without this such a ray takes endless tiny arcs.
  bool held() const {
    constexpr double kDepthTolerance_m = 1e-6;
    const Layer& here = layer();
    const bool on_top = depth_m_ == here.top_m, on_bottom = depth_m_ == here.bottom_m;
    if (!on_top && !on_bottom) return false;
    const double above = on_top ? profile_.layers_[at_ - 1].gradient_s : here.gradient_s;
    const double below = on_top ? here.gradient_s : profile_.layers_[at_ + 1].gradient_s;
    if (above > 0.0 || below < 0.0) return false;
    const double rise = 0.5 * speed() * angle_rad_ * angle_rad_;
    return rise <= kDepthTolerance_m * std::min(-above, below) || angle_rad_ == 0.0;
  }

  Exit straight_exit() const {
    const double sine = std::sin(angle_rad_);
    if (sine == 0.0) return {};
    Exit exit;
    exit.bottom = sine > 0.0;
    exit.arc_m = ((exit.bottom ? layer().bottom_m : layer().top_m) - depth_m_) / sine;
    exit.time_s = exit.arc_m / speed();
    return exit;
  }

  Exit curved_exit() const {
    const double sine = std::sin(angle_rad_), gradient = layer().gradient_s;
    const bool down = sine > 0.0 || (sine == 0.0 && gradient < 0.0);
    const double edge = down ? layer().bottom_m : layer().top_m;
    // sin^2 of the angle at that edge; not positive: the ray turns before it.
    if (sine_squared(edge) > 0.0) return crossing(edge, down, down ? 1.0 : -1.0);
    const double other = down ? layer().top_m : layer().bottom_m;
    return crossing(other, !down, down ? -1.0 : 1.0);
  }

  // Snell: cos a = cos a0 (1 + r), r = g dz / c0.
  double relative_rise(double edge_m) const {
    return layer().gradient_s * (edge_m - depth_m_) / speed();
  }
  double sine_squared(double edge_m) const {
    const double s = std::sin(angle_rad_), c = std::cos(angle_rad_), r = relative_rise(edge_m);
    return s * s - c * c * r * (2.0 + r);
  }

  // On the way to edge_m, where the angle has the sign given.
  Exit crossing(double edge_m, bool bottom, double sign) const {
    const double s0 = std::sin(angle_rad_), c0 = std::cos(angle_rad_), r = relative_rise(edge_m);
    const double s1 = sign * std::sqrt(std::max(0.0, sine_squared(edge_m)));
    const double c1 = c0 * (1.0 + r);
    const double ds = s0 * s1 > 0.0 ? -c0 * c0 * r * (2.0 + r) / (s0 + s1) : s1 - s0;
    const double half_chord = 0.5 * std::hypot(ds, c0 * r);  // sin of half the turn
    const double g = layer().gradient_s;
    Exit exit;
    exit.bottom = bottom;
    exit.turn_rad = std::copysign(2.0 * std::asin(std::min(1.0, half_chord)), -g);
    exit.arc_m = -exit.turn_rad * speed() / (g * c0);
    // F(a0) - F(a1) = atanh((s0 - s1) / (1 - s0 s1)), and 1 - s0 s1 = 1 - cos(turn) + c0 c1.
    exit.time_s = std::atanh(-ds / (2.0 * half_chord * half_chord + c0 * c1)) / g;
    return exit;
  }

  // Along an arc of the length and turn given (a line where turn is 0).
  void advance(double arc_m, double turn_rad) {
    const double half = 0.5 * turn_rad;
    const double chord = arc_m * (half == 0.0 ? 1.0 : std::sin(half) / half);
    horizontal_m_ += chord * std::cos(angle_rad_ + half);
    depth_m_ += chord * std::sin(angle_rad_ + half);
    arc_m_ += arc_m;
    angle_rad_ += turn_rad;
  }

  void leave(const Exit& exit) {
    const double edge = exit.bottom ? layer().bottom_m : layer().top_m;
    advance(exit.arc_m, exit.turn_rad);
    depth_m_ = edge;
    at_ += exit.bottom ? 1 : -1;
  }

  void straight(double time_s) { advance(speed() * time_s, 0.0); }

  // The rest of the time within the layer. gd(F + d) - gd(F) = 2 atan(sinh(d/2) / cosh(F + d/2)).
  void stay(double time_s) {
    const double g = layer().gradient_s;
    if (g == 0.0) return straight(time_s);
    const double d = -g * time_s, f = std::asinh(std::tan(angle_rad_));
    const double turn = 2.0 * std::atan(std::sinh(0.5 * d) / std::cosh(f + 0.5 * d));
    advance(-turn * speed() / (g * std::cos(angle_rad_)), turn);
  }

  const SoundSpeedProfile& profile_;
  std::size_t at_ = 0;
  double depth_m_, angle_rad_;
  double horizontal_m_ = 0.0, arc_m_ = 0.0;
};

RayPoint SoundSpeedProfile::bent(double launch_depth_m, double elevation_rad, double time_s) const {
  if (std::isnan(launch_depth_m) || std::isnan(elevation_rad) || std::isnan(time_s)) {
    const double nan = launch_depth_m + elevation_rad + time_s;
    return {nan, nan, nan, nan};
  }
  return RayTracer(*this, launch_depth_m, elevation_rad).trace(time_s);
}

}  // namespace neritic::sonar
