// `neritic physio` as JSON.
#include <nlohmann/json.hpp>

#include "tools/neritic/physio_report.hpp"

namespace neritic::tools {
namespace {

using nlohmann::json;

// Null: not known.
json known_json(bool known, double value) {
  return known ? json(value) : json();
}

// varies: not hidden by noise.
json variability_json(bool known, bool varies, const diver::Variability& v) {
  if (!known) return json();
  const bool any = v.intervals > 0, some = varies && any, paired = varies && v.pairs > 0;
  return {{"intervals", v.intervals},
          {"mean_rr_ms", known_json(any, v.mean_rr_ms)},
          {"mean_rate_bpm", known_json(any, v.mean_rate_bpm)},
          {"sdnn_ms", known_json(some, v.sdnn_ms)},
          {"rmssd_ms", known_json(paired, v.rmssd_ms)},
          {"nn50", paired ? json(v.nn50) : json()},
          {"pairs", v.pairs},
          {"pnn50_percent", known_json(paired, v.pnn50_percent)},
          {"sd1_ms", known_json(paired, v.sd1_ms)},
          {"sd2_ms", known_json(paired, v.sd2_ms)}};
}

json errors_json(const RateErrors& e) {
  const bool some = e.answered > 0;
  return {{"answered", e.answered},
          {"refused", e.refused},
          {"median_error_bpm", known_json(some, e.median_bpm)},
          {"mean_error_bpm", known_json(some, e.mean_bpm)},
          {"within_2", known_json(some, e.within_2)},
          {"doubled", known_json(some, e.doubled)}};
}

json pixel_json(const GazeReport& r, const Vec3& direction) {
  const auto pixel = diver::gaze_pixel(Vec3(0.0), direction, INFINITY, *r.camera);
  return pixel ? json{pixel->x, pixel->y} : json();
}

}  // namespace

json report_json(const PhysioFlags& flags, const EcgReport& r) {
  json out{{"file", flags.file},
           {"signal", r.ecg.channel},
           {"rate_hz", r.ecg.rate_hz},
           {"seconds", r.ecg.seconds()},
           {"refused", r.refused()},
           {"missing", r.ecg.missing},
           {"gaps", r.counts.gaps},
           {"leaps", r.counts.leaps},
           {"relearned", r.counts.relearned},
           {"quality", diver::name_of(r.quality())},
           {"doubtful_share", r.doubtful_share},
           {"rate_bpm", known_json(r.rate_known() && r.state.rate_bpm > 0.0, r.state.rate_bpm)},
           {"jitter_ms", r.jitter_ms()},
           {"us_a_second", r.us_a_second}};
  out["variability"] = variability_json(r.rate_known(), r.figures_known(), r.variability);
  out["last_five_minutes"] =
      variability_json(r.rate_known(), r.figures_known(), r.state.over_five_minutes);
  out["spectrum"] = r.figures_known() && r.spectrum.valid
                        ? json{{"method", "Lomb-Scargle, pieces of 300 s"},
                               {"vlf_ms2", r.spectrum.vlf_ms2},
                               {"lf_ms2", r.spectrum.lf_ms2},
                               {"hf_ms2", r.spectrum.hf_ms2},
                               {"lf_over_hf", r.spectrum.lf_over_hf}}
                        : json();
  out["beats"] = json::array();
  for (std::size_t i = 0; i < r.beats.size(); ++i)
    out["beats"].push_back({{"time_s", r.ecg.start_s + r.beats[i].time_s},
                            {"rr_ms", r.intervals[i].kind == diver::IntervalKind::kNone
                                          ? json()
                                          : json(1e3 * r.intervals[i].length_s)},
                            {"kind", name_of(r.intervals[i].kind)},
                            {"amplitude", r.beats[i].amplitude}});
  if (!r.score) return out;
  const diver::HeartScore& s = *r.score;
  out["score"] = {{"reference", r.reference},
                  {"tolerance_ms", 1e3 * diver::kBeatTolerance_s},
                  {"found", s.found},
                  {"extra", s.extra},
                  {"missed", s.missed},
                  {"sensitivity", s.sensitivity},
                  {"predictivity", s.predictivity},
                  {"median_offset_ms", s.median_offset_ms},
                  {"p95_offset_ms", s.p95_offset_ms},
                  {"ectopic_marked", s.ectopic_marked},
                  {"ectopic_flagged", s.ectopic_flagged},
                  {"ectopic_both", s.ectopic_both}};
  return out;
}

json report_json(const PhysioFlags& flags, const BreathReport& r) {
  json out{{"file", flags.file},
           {"rate_hz", r.sound.rate_hz},
           {"seconds", r.sound.seconds()},
           {"estimator", diver::name_of(r.settings.estimator)},
           {"window_s", r.settings.window_s},
           {"block_s", r.settings.block_s},
           {"us_a_second", known_json(r.us_a_second.has_value(), r.us_a_second.value_or(0.0))}};
  out["estimates"] = json::array();
  for (const diver::BreathState& s : r.states)
    out["estimates"].push_back(
        {{"time_s", s.time_s},
         {"rate_bpm", known_json(s.estimate.breathing != 0, s.estimate.rate_bpm)},
         {"breathing", s.estimate.breathing != 0},
         {"quality", diver::name_of(diver::quality_of(s.estimate, r.settings.estimator))},
         {"confidence", s.estimate.confidence},
         {"depth_db", s.estimate.depth_db},
         {"quiet_s", s.quiet_s}});
  out["refused"] = r.states.back().refused;
  if (!r.true_bpm) return out;
  out["score"] = {
      {"reference_bpm", *r.true_bpm},
      {"errors", errors_json(rate_errors(
                     r.states, *r.true_bpm,
                     std::min(r.settings.window_s, r.sound.seconds() - r.settings.block_s)))},
      {"plain_spectrum", errors_json(rate_errors(r.plain, *r.true_bpm, r.settings.block_s))}};
  return out;
}

json report_json(const PhysioFlags& flags, const GazeReport& r) {
  json out{{"file", flags.file},
           {"method", r.velocity() ? "ivt" : "idt"},
           {"note", diver::kPursuitNote},
           {"samples", r.recording.samples.size()},
           {"refused", r.state.refused},
           {"us_a_second", r.us_a_second},
           {"noise_deg", known_json(r.noise.deviation_rad > 0.0, degrees(r.noise.deviation_rad))},
           {"velocity_deg_s", known_json(r.velocity(), degrees(r.noise.velocity_rad_s))},
           {"window_s", known_json(r.velocity(), r.noise.window_s)},
           {"warning", noise_warning(r).empty() ? json() : json(noise_warning(r))},
           {"fixations", json::array()},
           {"saccades", json::array()},
           {"blinks", json::array()}};
  for (const diver::Fixation& f : r.events.fixations) {
    json one{{"start_s", f.start_s},
             {"end_s", f.end_s},
             {"direction", {f.direction.x, f.direction.y, f.direction.z}},
             {"x_deg", screen_x_deg(f.direction)},
             {"y_deg", screen_y_deg(f.direction)},
             {"spread_deg", degrees(f.spread_rad)},
             {"drift_deg", degrees(f.drift_rad)},
             {"may_be_pursuit", f.may_be_pursuit}};
    if (r.camera) one["pixel"] = pixel_json(r, f.direction);
    out["fixations"].push_back(std::move(one));
  }
  const auto add = [&](const char* kind, const std::vector<diver::Saccade>& events) {
    for (const diver::Saccade& s : events)
      out[kind].push_back({{"start_s", s.start_s},
                           {"end_s", s.end_s},
                           {"amplitude_deg", degrees(s.amplitude_rad)},
                           {"peak_deg_s", degrees(s.peak_rad_s)}});
  };
  add("saccades", r.events.saccades);
  add("blinks", r.events.blinks);
  if (r.kappa) out["score"] = {{"kappa", *r.kappa}, {"plain_kappa", *r.plain_kappa}};
  return out;
}

}  // namespace neritic::tools
