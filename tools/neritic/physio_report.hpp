// The findings of `neritic physio` in a recording, and their output: a summary and a table (.csv),
// the same as JSON, and a picture. physio_ecg.cpp, physio_breath.cpp and physio_gaze.cpp analyse,
// physio_json.cpp and physio_picture.cpp show. One thread.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "diver/breath_monitor.hpp"
#include "diver/gaze_csv.hpp"
#include "diver/heart_monitor.hpp"
#include "diver/heart_score.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

// By the file's name: .csv, .wav, or a WFDB record (.hea, .dat, or without an ending).
Result<diver::Recording> load_recording(const PhysioFlags& flags);

struct EcgReport {
  diver::Recording ecg;
  std::vector<diver::Beat> beats;
  std::vector<diver::Interval> intervals;  // one a beat
  diver::HeartState state;                 // as a live monitor would end
  double doubtful_share = 0.0;             // of the beats: found in a poor signal
  diver::Variability variability;          // of the whole recording
  diver::HeartSpectrum spectrum;
  diver::EcgCounts counts;
  std::string reference;  // the file of marked beats; empty: none
  std::optional<diver::HeartScore> score;
  double us_a_second = 0.0;  // of one core, a second of ECG
  // Rows and samples that say nothing; what is missing between rows is no sample.
  std::uint64_t refused() const { return ecg.refused + counts.refused - ecg.missing; }
  // The signal is poor if it is so at the end, or was for too many of its beats. Then neither a
  // rate nor figures of the intervals are given; figures neither where noise moves the beats by too
  // much beside them.
  diver::SignalQuality quality() const {
    return doubtful_share > diver::kMostDoubtful ? diver::SignalQuality::kPoor : state.quality;
  }
  bool rate_known() const { return quality() != diver::SignalQuality::kPoor; }
  double jitter_ms() const { return 1e3 * diver::beat_jitter_s(intervals); }
  bool figures_known() const { return rate_known() && !diver::noise_hides(intervals, variability); }
};
Result<EcgReport> analyse_ecg(const PhysioFlags& flags);

// How far estimates are from a known rate.
struct RateErrors {
  int answered = 0, refused = 0;
  double median_bpm = 0.0, mean_bpm = 0.0;  // of the sizes
  double within_2 = 0.0;                    // share of those answered
  double doubled = 0.0;                     // the same, of more than 1.6 times the rate
};
RateErrors rate_errors(const std::vector<diver::BreathState>& states, double true_bpm,
                       double from_s);

struct BreathReport {
  diver::Recording sound;
  diver::BreathSettings settings;
  std::vector<diver::BreathState> states, plain;  // by the settings; by the spectrum alone
  std::optional<double> true_bpm;
  std::optional<double> us_a_second;  // none of what was analysed at the recording's own pace
};
Result<BreathReport> analyse_sound(const PhysioFlags& flags);
// The same of the recording at its own pace, through both threads, whole blocks alone; each row on
// standard output as its block is done, but with --json.
Result<BreathReport> play_sound(const PhysioFlags& flags);

struct GazeReport {
  diver::GazeRecording recording;
  diver::GazeSettings settings;
  diver::GazeEvents events;
  diver::GazeState state;
  diver::GazeNoiseFound noise;
  std::optional<diver::GazeCamera> camera;
  // Cohen's kappa against a person's marks, sample by sample, saccade or not: of the reported
  // saccades, and of the method's raw output for each sample, blinks and noise included.
  std::optional<double> kappa, plain_kappa;
  double us_a_second = 0.0;
  bool velocity() const { return settings.method == diver::GazeMethod::kVelocity; }
};
// One line if the noise hides saccades or breaks fixations up; empty: it does not.
std::string noise_warning(const GazeReport& report);
Result<GazeReport> analyse_gaze(const PhysioFlags& flags);
// The screen angles of a direction, degrees.
double screen_x_deg(const Vec3& direction);
double screen_y_deg(const Vec3& direction);

// Lines with '#' for people; and the table, a heading and its rows alone, as every reader of .csv
// takes it.
struct ReportText {
  std::string summary, table;
};
ReportText report_text(const PhysioFlags& flags, const EcgReport& report);
ReportText report_text(const PhysioFlags& flags, const BreathReport& report);
ReportText report_text(const PhysioFlags& flags, const GazeReport& report);
nlohmann::json report_json(const PhysioFlags& flags, const EcgReport& report);
nlohmann::json report_json(const PhysioFlags& flags, const BreathReport& report);
nlohmann::json report_json(const PhysioFlags& flags, const GazeReport& report);
// The data of the picture.
nlohmann::json report_picture(const PhysioFlags& flags, const EcgReport& report);
nlohmann::json report_picture(const PhysioFlags& flags, const BreathReport& report);
nlohmann::json report_picture(const PhysioFlags& flags, const GazeReport& report);

const char* name_of(diver::IntervalKind kind);

}  // namespace neritic::tools
