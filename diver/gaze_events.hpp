// Fixations and saccades out of gaze as it comes, by velocity (I-VT) or by dispersion (I-DT), after
// Salvucci and Goldberg 2000 (Eye Tracking Research and Applications, 71). Bounded memory. One
// owner, one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diver/gaze.hpp"
#include "diver/gaze_noise.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

enum class GazeMethod : std::uint8_t { kVelocity, kDispersion };
enum class GazeClass : std::uint64_t { kLost, kFixation, kSaccade };

// Neither method knows smooth pursuit; what says so.
inline constexpr const char* kPursuitNote =
    "smooth pursuit is unsupported: I-VT reads it as a fixation, I-DT as none or many; fixations "
    "that wander are marked";

struct GazeSettings {
  GazeMethod method = GazeMethod::kVelocity;
  // Olsen 2012 (Tobii's I-VT filter): 30 degrees a second; gaps of 75 ms are bridged; fixations
  // less than 75 ms and half a degree apart are one; shorter ones than 60 ms are none. His window
  // of 20 ms blurs the ends of saccades at 1 kHz: kappa against a person's marks 0.67, of 10 ms
  // 0.71.
  double velocity_rad_s = radians(30.0);
  double velocity_window_s = 0.010;
  // Noise that would pass for saccades is averaged over windows up to the widest one; where that
  // does not suffice the threshold rises to a multiple of the noise's deviation (Engbert and
  // Kliegl 2003: 6; their velocity, the difference of means, in windows wider than the above).
  double widest_window_s = 0.040, noise_deviations = 6.0;
  double bridge_s = 0.075, merge_s = 0.075, merge_rad = radians(0.5), least_fixation_s = 0.060;
  // Salvucci and Goldberg: 1 degree for 100 ms.
  double dispersion_rad = radians(1.0), dispersion_s = 0.100;
};
// Eyes in a headset: 1 degree for 250 ms (Llanes-Jurado 2020, Sensors 20, 4956).
GazeSettings headset_gaze(GazeMethod method);
Status check_gaze_settings(const GazeSettings& settings);

struct GazeSample {
  double time_s = 0.0;             // of capture, not of arrival
  Vec3 direction{0.0, 0.0, -1.0};  // eye in head, turned by the head's pose: in the world
  bool valid = true;               // the tracker saw the eye
};

struct Fixation {
  double start_s = 0.0, end_s = 0.0;
  Vec3 direction{0.0, 0.0, -1.0};  // the mean, of length 1
  double spread_rad = 0.0;         // root mean square angle from the mean
  double drift_rad = 0.0;          // from its first to its last direction
  std::uint32_t samples = 0;
  bool may_be_pursuit = false;  // it wandered by more than two degrees
};

// The lid moves what a tracker takes for the eye: before the eye is lost and after it is found
// again, so long (a lid closes in some 70 ms, VanderWerf 2003, J. Neurophysiol. 89, 2784; half of
// that hides the pupil). Faster than that no eye turns (Nystrom and Holmqvist 2010, Behav. Res.
// Methods 42, 188).
inline constexpr double kLid_s = 0.050, kFastestEye_rad_s = radians(1000.0);

struct Saccade {
  double start_s = 0.0, end_s = 0.0;
  double amplitude_rad = 0.0, peak_rad_s = 0.0;
};

// The noise of a recording, and the velocity and window that I-VT used because of it: means over
// its samples.
struct GazeNoiseFound {
  double deviation_rad = 0.0;  // of one axis, from sample to sample; 0: not known
  double velocity_rad_s = 0.0, window_s = 0.0;
  double span_s = 0.0;  // between the places whose distance, over it, is the velocity
};
// The amplitude of saccades whose largest speed is this one: Baloh 1975 (Neurology 25, 1065),
// 551 (1 - exp(-A / 14)) degrees a second of A degrees.
double amplitude_of_peak_rad(double peak_rad_s);
// The smallest saccade that such a velocity in such a window finds: its largest speed must reach
// it, and so must its mean over the span.
double smallest_saccade_rad(const GazeNoiseFound& noise);

// A snapshot's data about the gaze. Always finite.
struct GazeState {
  double time_s = 0.0;
  Vec3 direction{0.0, 0.0, -1.0};  // the last good one
  double velocity_rad_s = 0.0;     // some 10 ms ago
  GazeClass now = GazeClass::kLost;
  double fixated_s = 0.0;  // for so long
  Vec3 fixation{0.0, 0.0, -1.0};
  double last_amplitude_rad = 0.0, last_peak_rad_s = 0.0;
  std::uint64_t fixations = 0, saccades = 0;  // blinks are none
  std::uint64_t refused = 0;  // not finite, no direction, or not after the one before

  static void fields(auto&& field, auto& self) {
    field("time_s", self.time_s);
    field("direction", self.direction);
    field("velocity_rad_s", self.velocity_rad_s);
    field("now", self.now);
    field("fixated_s", self.fixated_s);
    field("fixation", self.fixation);
    field("last_amplitude_rad", self.last_amplitude_rad);
    field("last_peak_rad_s", self.last_peak_rad_s);
    field("fixations", self.fixations);
    field("saccades", self.saccades);
    field("refused", self.refused);
  }
};

struct GazeEvents {
  std::vector<Fixation> fixations;
  std::vector<Saccade> saccades;
  // Movements like saccades while the eye was lost, or (I-VT, which measures it) faster than eyes
  // turn: blinks, and no eye.
  std::vector<Saccade> blinks;
  // The class of every pushed sample, in order, by the method alone, before anything is merged
  // or dropped. Refused samples count as lost.
  std::vector<GazeClass> classes;
};

class GazeMonitor {
 public:
  // Precondition: check_gaze_settings(settings).
  explicit GazeMonitor(const GazeSettings& settings) : settings_(settings) {}

  // Appends the events that this sample completes to `out`.
  void push(const GazeSample& sample, GazeEvents& out);
  void finish(GazeEvents& out);
  const GazeState& state() const { return state_; }
  GazeNoiseFound noise() const;

 private:
  struct Seen {
    double time_s;
    Vec3 direction;             // of length 1
    std::uint32_t lost_before;  // samples without a direction, since the one before
  };
  // A fixation that grows.
  struct Growing {
    Fixation fixation;
    Vec3 sum{0.0}, first{0.0}, last{0.0};
    bool open = false;
    void add(const Seen& s);
    Fixation result() const;
  };

  // Width and height of a set of directions, as angles about one of them.
  struct Extent {
    Extent() = default;
    explicit Extent(const Vec3& middle);
    void add(const Vec3& direction);
    double size() const { return high_x - low_x + high_y - low_y; }
    Vec3 ahead{0.0}, right{0.0}, above{0.0};
    double low_x = 0.0, high_x = 0.0, low_y = 0.0, high_y = 0.0;
  };

  // The velocity at a waiting sample over a window; nothing where samples after it are wanted.
  struct Velocity {
    Vec3 rad_s{0.0};
    double size_rad_s = 0.0;
  };
  std::optional<Velocity> velocity_at(std::size_t sample, double window_s, bool all) const;
  struct Asked {
    double window_s = 0.0, velocity_rad_s = 0.0, span_s = 0.0;
  };
  Asked asked() const;
  void learn_noise(double time_s, double window_s, const Vec3& velocity_rad_s);
  void settle_velocity(bool all, GazeEvents& out);
  void settle_dispersion(bool all, GazeEvents& out);
  void classify(const Seen& seen, GazeClass is, double velocity_rad_s, GazeEvents& out);
  void leave_fixation(GazeEvents& out);
  void end_fixation(GazeEvents& out);
  void emit(GazeEvents& out);
  void break_off(GazeEvents& out);
  void note_loss(double from_s, double to_s, GazeEvents& out);
  bool at_loss(const Saccade& saccade) const;
  void add_blink(const Saccade& blink, GazeEvents& out) const;

  GazeSettings settings_;
  std::vector<Seen> waiting_;  // oldest first: not all settled yet
  std::size_t settled_ = 0;    // of them
  GazeNoise noise_;
  bool learnt_ = false;
  MedianDeviation slow_noise_;  // of velocities over the window that is in use, rad/s
  double deviation_sum_rad_ = 0.0;
  Asked asked_sum_;
  double seen_samples_ = 0.0, asked_samples_ = 0.0;
  double slow_window_s_ = 0.0, slow_time_s_ = 0.0;
  std::optional<Vec3> slow_velocity_rad_s_;
  std::uint32_t lost_ = 0;
  bool in_fixation_ = false;  // I-DT: the window has become one, this large
  Extent extent_;
  double last_time_s_ = 0.0, last_seen_s_ = 0.0;      // of any sample, of a valid one
  double loss_from_s_ = -1e300, loss_to_s_ = -1e300;  // the last one: seen before, seen after
  bool has_time_ = false, has_seen_ = false;
  int late_in_a_row_ = 0;
  Growing growing_;
  Fixation held_;  // ended, but the next may be the same
  bool has_held_ = false;
  Saccade saccade_;  // since the held one
  bool in_saccade_ = false, has_saccade_ = false;
  Seen before_{}, saccade_start_{};
  bool has_before_ = false;
  GazeState state_;
};

GazeEvents find_gaze_events(const std::vector<GazeSample>& samples, const GazeSettings& settings);

// The samples that lie within a saccade, its first and its last one included. Both in the order of
// time.
std::vector<bool> in_saccades(const std::vector<GazeSample>& samples,
                              const std::vector<Saccade>& saccades);

// Cohen's kappa of saccade or none, sample by sample; 1: agreement, 0: no more than by chance.
double saccade_kappa(const std::vector<bool>& marked, const std::vector<bool>& found);

}  // namespace neritic::diver
