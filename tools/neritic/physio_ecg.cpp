// `neritic physio ecg`: beats, intervals and their variability.
#include <algorithm>

#include "diver/physio_wfdb.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "tools/neritic/physio_report.hpp"

namespace neritic::tools {
namespace {

// --annotations' file, or a record's own .atr beside it.
std::filesystem::path marks_path(const PhysioFlags& flags) {
  if (!flags.annotations.empty()) return flags.annotations;
  std::filesystem::path beside = flags.file;
  if (beside.extension() == ".csv" || beside.extension() == ".wav") return {};
  beside.replace_extension(".atr");
  std::error_code error;
  return std::filesystem::exists(beside, error) ? beside : std::filesystem::path();
}

std::string rate_words(double bpm) {
  return bpm > 0.0 ? fmt::format("{:.1f} bpm", bpm) : "no rate";
}

}  // namespace

const char* name_of(diver::IntervalKind kind) {
  switch (kind) {
    case diver::IntervalKind::kNormal:
      return "normal";
    case diver::IntervalKind::kNone:
      return "none";
    case diver::IntervalKind::kEctopic:
      return "ectopic";
    case diver::IntervalKind::kAfter:
      return "after-ectopic";
  }
  return "";
}

Result<EcgReport> analyse_ecg(const PhysioFlags& flags) {
  EcgReport report;
  NERITIC_TRY(report.ecg, load_recording(flags));
  const Status rate = diver::check_ecg_rate(report.ecg.rate_hz);
  if (!rate.ok()) return bad_input("{}: {}", flags.file, rate.error().message);
  const TimeNs start = now_ns();
  report.beats = diver::find_beats(report.ecg.rate_hz, report.ecg.samples, &report.counts);
  report.intervals = diver::intervals_of(report.beats);
  report.us_a_second = 1e-3 * static_cast<double>(now_ns() - start) / report.ecg.seconds();
  report.variability = diver::variability(report.intervals);
  report.spectrum = diver::heart_spectrum(report.intervals);
  diver::HeartMonitor monitor(report.ecg.rate_hz);
  monitor.push(report.ecg.samples);
  report.state = monitor.state();
  report.doubtful_share = monitor.doubtful_share();
  const auto marks_file = marks_path(flags);
  if (marks_file.empty()) return report;
  NERITIC_TRY(const auto bytes, read_file(marks_file));
  NERITIC_TRY(const auto marks,
              diver::parse_wfdb_beats(
                  bytes, report.ecg.frame_hz > 0.0 ? report.ecg.frame_hz : report.ecg.rate_hz,
                  marks_file.string()));
  report.reference = marks_file.string();
  report.score = diver::score_beats(marks, report.intervals);
  return report;
}

ReportText report_text(const PhysioFlags& flags, const EcgReport& r) {
  const auto ectopic =
      std::ranges::count(r.intervals, diver::IntervalKind::kEctopic, &diver::Interval::kind);
  std::string out = fmt::format(
      "# {}: {} at {:g} Hz, {:.1f} s; {} samples refused ({} as spikes), {} missing, {} gaps; "
      "signal "
      "{}\n",
      flags.file, r.ecg.channel.empty() ? "ECG" : r.ecg.channel, r.ecg.rate_hz, r.ecg.seconds(),
      r.refused(), r.counts.leaps, r.ecg.missing, r.counts.gaps, diver::name_of(r.quality()));
  const diver::Variability& v = r.variability;
  if (!r.rate_known())
    out += fmt::format(
        "# {} beats, some of them noise: the signal is poor, {:.0f} % of the beats found in noise; "
        "no rate, variability or spectrum is given\n",
        r.beats.size(), 100.0 * r.doubtful_share);
  else
    out += fmt::format("# {} beats, {} ectopic; mean rate {}, {} at the end\n", r.beats.size(),
                       ectopic, rate_words(v.mean_rate_bpm), rate_words(r.state.rate_bpm));
  if (r.rate_known() && !r.figures_known())
    out += fmt::format(
        "# no variability or spectrum: noise moves each beat by {:.1f} ms, too much beside SDNN "
        "{:.1f} and RMSSD {:.1f} ms\n",
        r.jitter_ms(), v.sdnn_ms, v.rmssd_ms);
  if (r.figures_known() && v.pairs > 0)
    out += fmt::format(
        "# {} normal intervals: SDNN {:.1f} ms, RMSSD {:.1f} ms, pNN50 {:.2f} %, SD1 {:.1f} ms, "
        "SD2 {:.1f} ms\n",
        v.intervals, v.sdnn_ms, v.rmssd_ms, v.pnn50_percent, v.sd1_ms, v.sd2_ms);
  if (r.figures_known() && r.spectrum.valid)
    out += fmt::format(
        "# spectrum (Lomb-Scargle, 300 s): VLF {:.0f}, LF {:.0f}, HF {:.0f} ms2, LF/HF {:.2f}\n",
        r.spectrum.vlf_ms2, r.spectrum.lf_ms2, r.spectrum.hf_ms2, r.spectrum.lf_over_hf);
  else if (r.figures_known())
    out += "# no spectrum: it needs two minutes of normal beats\n";
  if (r.score) {
    const diver::HeartScore& s = *r.score;
    out += fmt::format(
        "# compared with {}: {} beats found, {} extra, {} missed; sensitivity {:.4f}, positive "
        "predictivity {:.4f} (within 150 ms, AAMI EC57); median offset {:.1f} ms, 95 % within "
        "{:.1f} ms\n",
        r.reference, s.found, s.extra, s.missed, s.sensitivity, s.predictivity, s.median_offset_ms,
        s.p95_offset_ms);
    out += fmt::format("# ectopic beats: {} marked, {} found, {} both\n", s.ectopic_marked,
                       s.ectopic_flagged, s.ectopic_both);
  }
  out += fmt::format("# cost: {:.0f} us of one core per second of ECG\n", r.us_a_second);
  std::string table = "time_s,rr_ms,kind,amplitude\n";
  for (std::size_t i = 0; i < r.beats.size(); ++i)
    table += fmt::format("{:.4f},{},{},{:.6g}\n", r.ecg.start_s + r.beats[i].time_s,
                         r.intervals[i].kind == diver::IntervalKind::kNone
                             ? ""
                             : fmt::format("{:.1f}", 1e3 * r.intervals[i].length_s),
                         name_of(r.intervals[i].kind), r.beats[i].amplitude);
  return {std::move(out), std::move(table)};
}

}  // namespace neritic::tools
