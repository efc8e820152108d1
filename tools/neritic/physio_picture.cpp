// The data of the picture of a recording (`neritic physio --plot`): diver/OUTPUT.md has every key.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "diver/vitals.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/physio_report.hpp"

namespace neritic::tools {
namespace {

using nlohmann::json;

// More points of a curve than this cannot be seen in a picture.
constexpr std::size_t kMostPoints = 4000;

std::string name_only(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

// Ten seconds of the ECG: around the first ectopic beat, else in the middle.
std::pair<std::size_t, std::size_t> excerpt(const EcgReport& r) {
  double middle_s = 0.5 * r.ecg.seconds();
  const auto ectopic =
      std::ranges::find(r.intervals, diver::IntervalKind::kEctopic, &diver::Interval::kind);
  if (ectopic != r.intervals.end()) middle_s = ectopic->end_s;
  const double from_s = std::max(0.0, std::min(middle_s, r.ecg.seconds() - 5.0) - 5.0);
  const auto first = static_cast<std::size_t>(from_s * r.ecg.rate_hz);
  return {first,
          std::min(first + static_cast<std::size_t>(10.0 * r.ecg.rate_hz), r.ecg.samples.size())};
}

json excerpt_data(const EcgReport& r) {
  const auto [first, last] = excerpt(r);
  const std::size_t every = (last - first) / kMostPoints + 1;
  json out{{"signal", r.ecg.channel},
           {"time_s", json::array()},
           {"value", json::array()},
           {"beats", json::array()}};
  for (std::size_t i = first; i < last; i += every) {
    out["time_s"].push_back(six_digits(static_cast<double>(i) / r.ecg.rate_hz));
    out["value"].push_back(six_digits(r.ecg.samples[i]));
  }
  for (std::size_t i = 0; i < r.beats.size(); ++i) {
    const auto at = static_cast<std::size_t>(std::lround(r.beats[i].time_s * r.ecg.rate_hz));
    if (at < first || at >= last) continue;
    out["beats"].push_back({{"at_s", six_digits(r.beats[i].time_s)},
                            {"at_value", six_digits(r.ecg.samples[at])},
                            {"kind", name_of(r.intervals[i].kind)}});
  }
  return out;
}

// Every interval that is not normal, and evenly thinned the normal ones.
json intervals_data(const EcgReport& r) {
  json out = json::array();
  const std::size_t every = r.intervals.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < r.intervals.size(); ++i) {
    const diver::Interval& one = r.intervals[i];
    const bool normal = one.kind == diver::IntervalKind::kNormal;
    if (one.kind == diver::IntervalKind::kNone || (normal && i % every != 0)) continue;
    const bool paired = normal && i > 0 && r.intervals[i - 1].kind == diver::IntervalKind::kNormal;
    out.push_back({{"end_s", six_digits(one.end_s)},
                   {"rr_ms", six_digits(1e3 * one.length_s)},
                   {"before_ms",
                    paired ? json(six_digits(1e3 * r.intervals[i - 1].length_s)) : json(nullptr)},
                   {"kind", name_of(one.kind)}});
  }
  return out;
}

json estimates_data(const std::vector<diver::BreathState>& states) {
  json out = json::array();
  for (const diver::BreathState& s : states)
    out.push_back({{"at_s", six_digits(s.time_s)},
                   {"rate_bpm", s.estimate.breathing != 0 ? json(six_digits(s.estimate.rate_bpm))
                                                          : json(nullptr)},
                   {"quiet_s", six_digits(s.quiet_s)}});
  return out;
}

// The sound's envelope in dB of full scale, as means over equal times.
json level_data(const BreathReport& r) {
  diver::BreathBands bands(r.sound.rate_hz);
  std::vector<diver::BreathFrame> frames;
  for (const double sample : r.sound.samples) bands.push(sample, frames);
  json out{{"time_s", json::array()}, {"db", json::array()}};
  const std::size_t every = frames.size() / kMostPoints + 1;
  for (std::size_t i = 0; i + every <= frames.size(); i += every) {
    double sum = 0.0;
    for (std::size_t k = i; k < i + every; ++k) sum += frames[k].envelope;
    out["time_s"].push_back(six_digits(static_cast<double>(i) / diver::kBreathFrames_hz));
    // A floor of -120 dB: silence has no logarithm.
    out["db"].push_back(six_digits(20.0 * std::log10(sum / static_cast<double>(every) + 1e-6)));
  }
  return out;
}

}  // namespace

json report_picture(const PhysioFlags& flags, const EcgReport& r) {
  const diver::Variability& v = r.variability;
  std::string facts =
      r.rate_known()
          ? fmt::format(
                "{} beats, mean {:.1f} bpm; noise moves each by {:.1f} ms: no "
                "variability; signal {}",
                r.beats.size(), v.mean_rate_bpm, r.jitter_ms(), diver::name_of(r.quality()))
          : fmt::format("{} beats; signal poor: no figures", r.beats.size());
  if (r.figures_known())
    facts = fmt::format(
        "{} beats, mean {:.1f} bpm; SDNN {:.1f} ms, RMSSD {:.1f} ms, pNN50 {:.1f} %; signal {}",
        r.beats.size(), v.mean_rate_bpm, v.sdnn_ms, v.rmssd_ms, v.pnn50_percent,
        diver::name_of(r.quality()));
  if (r.score)
    facts += fmt::format("; against marks {} found, {} extra, {} missed", r.score->found,
                         r.score->extra, r.score->missed);
  json out{{"picture", "physio ecg"},
           {"title", "Heart: " + name_only(flags.file)},
           {"facts", {facts}},
           {"excerpt", excerpt_data(r)},
           {"intervals", intervals_data(r)},
           {"spectrum", nullptr}};
  if (r.figures_known() && r.spectrum.valid)
    out["spectrum"] = {{"vlf_ms2", six_digits(r.spectrum.vlf_ms2)},
                       {"lf_ms2", six_digits(r.spectrum.lf_ms2)},
                       {"hf_ms2", six_digits(r.spectrum.hf_ms2)},
                       {"lf_over_hf", six_digits(r.spectrum.lf_over_hf)}};
  return out;
}

json report_picture(const PhysioFlags& flags, const BreathReport& r) {
  return {{"picture", "physio breath"},
          {"title", "Breath: " + name_only(flags.file)},
          {"facts",
           {fmt::format(
               "{} over {:g} s, an estimate every {:g} s, which looks back over its window",
               diver::name_of(r.settings.estimator), r.settings.window_s, r.settings.block_s)}},
          {"seconds", six_digits(r.sound.seconds())},
          {"estimator", diver::name_of(r.settings.estimator)},
          {"block_s", r.settings.block_s},
          {"pause_heard_s", diver::kPauseHeard_s},
          {"level", level_data(r)},
          {"estimates", estimates_data(r.states)},
          {"plain_spectrum", estimates_data(r.plain)},
          {"reference_bpm", r.true_bpm ? json(*r.true_bpm) : json(nullptr)}};
}

json report_picture(const PhysioFlags& flags, const GazeReport& r) {
  std::string facts =
      fmt::format("{}: {} fixations, {} saccades, {} blinks", r.velocity() ? "I-VT" : "I-DT",
                  r.events.fixations.size(), r.events.saccades.size(), r.events.blinks.size());
  if (!noise_warning(r).empty()) facts += "; " + noise_warning(r);
  if (r.kappa) facts += fmt::format("; kappa {:.2f} against a person's marks", *r.kappa);
  json out{{"picture", "physio gaze"},
           {"title", "Gaze: " + name_only(flags.file)},
           {"facts", {facts + "; smooth pursuit is not detected"}},
           {"time_s", json::array()},
           {"x_deg", json::array()},
           {"y_deg", json::array()},
           {"fixations", json::array()},
           {"saccades", json::array()},
           {"blinks", json::array()}};
  const auto& samples = r.recording.samples;
  const std::size_t every = samples.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < samples.size(); i += every) {
    const diver::GazeSample& s = samples[i];
    if (!std::isfinite(s.time_s)) continue;
    const bool known = s.valid && is_finite(s.direction);
    out["time_s"].push_back(six_digits(s.time_s));
    out["x_deg"].push_back(known ? json(six_digits(screen_x_deg(s.direction))) : json(nullptr));
    out["y_deg"].push_back(known ? json(six_digits(screen_y_deg(s.direction))) : json(nullptr));
  }
  for (const diver::Fixation& f : r.events.fixations)
    out["fixations"].push_back({{"start_s", six_digits(f.start_s)},
                                {"end_s", six_digits(f.end_s)},
                                {"mean_x_deg", six_digits(screen_x_deg(f.direction))},
                                {"mean_y_deg", six_digits(screen_y_deg(f.direction))}});
  for (const diver::Saccade& s : r.events.saccades)
    out["saccades"].push_back({{"amplitude_deg", six_digits(degrees(s.amplitude_rad))},
                               {"peak_deg_s", six_digits(degrees(s.peak_rad_s))}});
  for (const diver::Saccade& s : r.events.blinks)
    out["blinks"].push_back({{"start_s", six_digits(s.start_s)}, {"end_s", six_digits(s.end_s)}});
  return out;
}

}  // namespace neritic::tools
