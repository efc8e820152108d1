// One sonar's image summed from rays: every return enters with its own range, bearing and power,
// in double, and is spread by the pulse and the beams in closed form. Knows nothing of G-buffers,
// gathers or taps. One owner, one thread.
//
// It shares with the sonar under test only the formulas of the physics (patterns, pulse,
// absorption, sound speed), which have tests of their own against published values.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/scene/scene.hpp"
#include "sonar/head.hpp"
#include "sonar/head_pattern.hpp"
#include "sonar/range_correction.hpp"
#include "sonar/sound_speed_profile.hpp"

namespace neritic::tools {

// Where a head is and how it moves.
struct TruthView {
  Vec3 origin_m{0.0};         // in the frame of the rays' world, axes of the scene's
  Mat3 world_from_head{1.0};  // a head looks along its -z
  double depth_m = 0.0;       // below the surface
  Vec3 velocity_m_s{0.0};     // world axes
  double yaw_rate_rad_s = 0.0;
};

// One ray out of the head.
struct TruthRay {
  Vec3 direction{0.0};  // unit, world axes
  double elevation_rad = 0.0;
  double elevation_width_rad = 0.0;  // what it stands for
  double off_axis_rad = 0.0;
  double pattern = 1.0;  // elevation pattern (a cone's own), power there and back
  bool inside = true;    // heard at all: of a cone, of an aperture
};

// An echo: out along `out_m` in one or two legs, back along one straight leg.
struct TruthEcho {
  double out_m = 0.0, back_m = 0.0;
  Vec3 target_m{0.0};   // from the sonar, world axes
  double cosine = 0.0;  // between the normal and the way back
  double reflectivity = 1.0, backscatter = 1.0;
  bool ghost = false;
  double bounce = 1.0;   // power that a mirror leaves, both ways counted
  double seconds = 0.0;  // of both ways over the profile's straight paths, where one is named
};

class TermImage {
 public:
  // head: of that sonar. kBadInput as its patterns say.
  static Result<TermImage> create(const scene::Sonar& sonar, const sonar::Head& head,
                                  const TruthView& view);

  void begin_column(double azimuth_rad, double width_rad);
  void add(const TruthRay& ray, const TruthEcho& echo);
  void add_solid_angle(const TruthRay& ray);  // every ray of a cone, whether it hits or not
  // half: which of two halves of the columns it is summed into.
  void end_column(int half);

  // [range][beams]; the mean of both halves, and half of their difference, which is about what the
  // mean is off by.
  std::vector<double> image() const;
  std::vector<double> half_difference() const;
  void merge(const TermImage& other);
  const sonar::BeamGrid& grid() const { return grid_; }
  const scene::Sonar& settings() const { return *sonar_; }
  bool wants_ghosts() const { return sonar_->terms.ghosts.has_value(); }
  const std::optional<sonar::SoundSpeedProfile>& profile() const { return profile_; }
  // The angle by which a bent ray leaves higher than the straight one, for an end at range_m in a
  // direction with this sine above the horizon; 0 for straight rays.
  double bend_rad(double range_m, double sine, bool ghost) const;
  double sound_speed_m_s() const { return sound_speed_m_s_; }

 private:
  static constexpr int kSubBins = 8;  // a return goes to its two nearest eighths of a bin
  TermImage() = default;
  double power(const TruthRay& ray, const TruthEcho& echo) const;
  double heard_range_m(const TruthRay& ray, const TruthEcho& echo) const;
  double bent_m(const TruthRay& ray, const TruthEcho& echo) const;
  void make_weights();
  double beam_weight(double off_rad) const;
  double weight_reach_rad() const;
  void make_kernel();
  void spread_column();

  const scene::Sonar* sonar_ = nullptr;
  TruthView view_;
  sonar::BeamGrid grid_;
  bool folded_ = false;
  sonar::HeadPatterns patterns_;
  std::optional<sonar::SoundSpeedProfile> profile_;
  sonar::RangeCorrection bent_, bent_ghosts_;  // along bent rays; by a mirror
  double sound_speed_m_s_ = 1500.0, absorption_db_per_m_ = 0.0;
  std::vector<double> weights_;  // of a pattern over the angle off its axis
  double weight_step_rad_ = 0.0;
  std::vector<double> gain_;  // of the receiver, by row
  // Share of a return that a row gets, for each eighth of a bin where it may lie, by rows.
  std::array<std::vector<double>, kSubBins> kernel_;
  int reach_ = 0;  // bins that the kernel reaches
  double column_rad_ = 0.0, width_rad_ = 0.0;
  bool any_ = false;
  std::vector<double> column_;  // sub-bins (bins where nothing spreads), from -reach on
  std::vector<double> spread_;  // by row
  std::vector<double> halves_[2];
  double solid_angle_[2] = {0.0, 0.0}, column_solid_angle_ = 0.0;
};

}  // namespace neritic::tools
