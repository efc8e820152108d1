// The output of `neritic tradeoff physiology` (physiology_tradeoff.hpp).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "diver/breath_monitor.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tools/common/curves.hpp"
#include "tools/common/picture.hpp"
#include "tools/tradeoff/physiology_tradeoff.hpp"

namespace neritic::tools {
namespace {

// A logarithmic axis has no zero: smaller errors are drawn as this.
constexpr double kLeastError_bpm = 0.01;

std::string physiology_csv(const PhysiologyTradeoff& t) {
  std::string out = "what,signals,estimator,window,latency_s,error,right,answered,doubled,us\n";
  for (const BreathPoint& p : t.breath)
    out += fmt::format("breath,{},{},{:g} s,{:g},{:.4g},{:.3f},{:.3f},{:.3f},{:.4g}\n", p.signals,
                       name_of(p.estimator), p.window_s, p.window_s, p.median_bpm, p.right,
                       p.answered, p.doubled, p.us);
  for (const HeartPoint& p : t.heart)
    out += fmt::format("heart,made,{},{} intervals,{:.3g},{:.4g},,,,\n", name_of(p.estimator),
                       p.intervals, p.latency_s, p.rms_bpm);
  for (const DetectorPoint& p : t.detector)
    out += fmt::format("detector,made,Pan-Tompkins,{:g} Hz,,{:.4g},{:.4f},,,{:.4g}\n", p.rate_hz,
                       p.timing_ms, static_cast<double>(p.found) / (p.found + p.missed + p.extra),
                       p.us_a_second);
  return out;
}

std::string breath_table(const PhysiologyTradeoff& t, const std::string& signals) {
  std::string out = fmt::format(
      "\n## Breath, {} sounds\n\n| estimator | window, s | error in the middle, breaths/min | "
      "within "
      "2 | no answer | doubled | us an estimate |\n|---|---|---|---|---|---|---|\n",
      signals);
  std::size_t rows = 0;
  for (const BreathPoint& p : t.breath) {
    if (p.signals != signals) continue;
    ++rows;
    out += fmt::format("| {} | {:g} | {:.2f} | {:.0f} % | {:.0f} % | {:.0f} % | {:.0f} |\n",
                       name_of(p.estimator), p.window_s, p.median_bpm, 100.0 * p.right,
                       100.0 * (1.0 - p.answered), 100.0 * p.doubled, p.us);
  }
  if (const BreathPoint* p = breath_knee(t, signals))
    out += fmt::format("\nThe knee of multiband lies at {:g} s.\n", p->window_s);
  return rows > 0 ? out : std::string();
}

// "recorded", each sensor of it, "made".
std::vector<std::string> signals_of(const PhysiologyTradeoff& t) {
  std::vector<std::string> out;
  for (const BreathPoint& p : t.breath)
    if (std::ranges::find(out, p.signals) == out.end()) out.push_back(p.signals);
  return out;
}

std::string coverage_table(const PhysiologyTradeoff& t) {
  if (t.coverage.empty()) return {};
  std::string out =
      "\n## Error against what is refused (multiband)\n\n| sounds | confidence asked | answered | "
      "right of these | error in the middle, worst | answered without rhythm "
      "|\n|---|---|---|---|---|---|\n";
  for (const BreathCoverage& c : t.coverage)
    out += fmt::format("| {} | {:g} | {:.0f} % | {:.0f} % | {:.2f}, {:.1f} | {:.0f} % |\n",
                       c.signals, c.least_confidence, 100.0 * c.answered,
                       100.0 * c.right / std::max(c.answered, 1e-9), c.median_bpm, c.worst_bpm,
                       100.0 * c.without_rhythm);
  return out;
}

std::string physiology_md(const PhysiologyTradeoff& t) {
  std::string out =
      "# Heart and breath: error over latency and cost\n\nAn estimate over a window is as late as "
      "the "
      "window is long. Shares are of all windows; an estimate that says it does not know is no "
      "wrong "
      "one.\n";
  for (const std::string& signals : signals_of(t)) out += breath_table(t, signals);
  out += coverage_table(t);
  out +=
      "\n## Heart rate, from rest over effort and back, with extra beats, 6 dB of noise\n\n| "
      "estimator "
      "| intervals | latency, s | error, bpm rms |\n|---|---|---|---|\n";
  for (const HeartPoint& p : t.heart)
    out += fmt::format("| {} | {} | {:.1f} | {:.2f} |\n", name_of(p.estimator), p.intervals,
                       p.latency_s, p.rms_bpm);
  if (const HeartPoint* p = heart_choice(t))
    out += fmt::format(
        "\nThe default of the median: {} intervals, the most whose error is within 10 % of the "
        "least.\n",
        p->intervals);
  out +=
      "\n## Beats by sampling rate\n\n| Hz | found | extra | missed | timing, ms rms | us a second "
      "|\n|---|---|---|---|---|---|\n";
  for (const DetectorPoint& p : t.detector)
    out += fmt::format("| {:g} | {} | {} | {} | {:.2f} | {:.0f} |\n", p.rate_hz, p.found, p.extra,
                       p.missed, p.timing_ms, p.us_a_second);
  return out;
}

nlohmann::json physiology_json(const PhysiologyTradeoff& t) {
  nlohmann::json json;
  for (const BreathPoint& p : t.breath)
    json["breath"].push_back({{"signals", p.signals},
                              {"estimator", name_of(p.estimator)},
                              {"window_s", p.window_s},
                              {"median_error_bpm", p.median_bpm},
                              {"within_2", p.right},
                              {"answered", p.answered},
                              {"doubled", p.doubled},
                              {"us", p.us}});
  for (const HeartPoint& p : t.heart)
    json["heart"].push_back({{"estimator", name_of(p.estimator)},
                             {"intervals", p.intervals},
                             {"latency_s", p.latency_s},
                             {"rms_error_bpm", p.rms_bpm}});
  for (const DetectorPoint& p : t.detector)
    json["detector"].push_back({{"rate_hz", p.rate_hz},
                                {"found", p.found},
                                {"extra", p.extra},
                                {"missed", p.missed},
                                {"timing_ms", p.timing_ms},
                                {"us_a_second", p.us_a_second}});
  for (const BreathCoverage& c : t.coverage)
    json["coverage"].push_back({{"signals", c.signals},
                                {"least_confidence", c.least_confidence},
                                {"answered", c.answered},
                                {"right", c.right},
                                {"median_error_bpm", c.median_bpm},
                                {"worst_error_bpm", c.worst_bpm},
                                {"answered_without_rhythm", c.without_rhythm}});
  for (const std::string& signals : signals_of(t))
    if (const BreathPoint* p = breath_knee(t, signals))
      json["knees"]["breath_" + signals] = {{"window_s", p->window_s}};
  if (const HeartPoint* p = heart_choice(t))
    json["knees"]["heart_median"] = {{"intervals", p->intervals}};
  return json;
}

// The error, and the share of windows that are right.
void add_breath(Page& page, const PhysiologyTradeoff& t, const std::string& signals) {
  const Axis x{"window, s: as late as that"};
  Panel errors{"Breath, " + signals + " sounds: error", x, {"median error, breaths/min"}};
  Panel rights{"Breath, " + signals + " sounds: right within 2", x, {"% of all windows", false}};
  for (const diver::BreathEstimator e :
       {diver::BreathEstimator::kSpectrum, diver::BreathEstimator::kAutocorrelation,
        diver::BreathEstimator::kMultiBand}) {
    Series error{name_of(e), {}, {}}, right = error;
    for (const BreathPoint& p : t.breath) {
      if (p.signals != signals || p.estimator != e) continue;
      if (p.answered > 0.0) {
        error.x.push_back(p.window_s);
        error.y.push_back(std::max(p.median_bpm, kLeastError_bpm));
      }
      right.x.push_back(p.window_s);
      right.y.push_back(100.0 * p.right);
    }
    errors.series.push_back(std::move(error));
    rights.series.push_back(std::move(right));
  }
  const BreathPoint* knee = breath_knee(t, signals);
  for (const BreathPoint& p : t.breath) {
    if (p.signals != signals || p.estimator != diver::BreathEstimator::kMultiBand) continue;
    const bool at_knee = knee != nullptr && p.window_s == knee->window_s;
    const bool chosen = p.window_s == diver::BreathSettings{}.window_s;
    if (!at_knee && !chosen) continue;
    const char* words = at_knee && chosen ? "knee, default" : at_knee ? "knee" : "default";
    if (p.answered > 0.0)
      errors.marks.push_back({p.window_s, std::max(p.median_bpm, kLeastError_bpm), words});
    rights.marks.push_back({p.window_s, 100.0 * p.right, words});
  }
  page.panels.push_back(std::move(errors));
  page.panels.push_back(std::move(rights));
}

void add_heart(Page& page, const PhysiologyTradeoff& t) {
  Panel rates{"Heart rate through effort, with extra beats",
              {"latency, s (intervals beside the points)"},
              {"error, bpm rms"}};
  for (const RateOver e : {RateOver::kCount, RateOver::kMean, RateOver::kMedian}) {
    Series s{name_of(e), {}, {}};
    for (const HeartPoint& p : t.heart) {
      if (p.estimator != e || !(p.rms_bpm > 0.0)) continue;
      s.x.push_back(p.latency_s);
      s.y.push_back(p.rms_bpm);
      if (e == RateOver::kMedian) s.notes.push_back(fmt::format("{}", p.intervals));
    }
    rates.series.push_back(std::move(s));
  }
  if (const HeartPoint* p = heart_choice(t))
    rates.marks.push_back({p->latency_s, p->rms_bpm, "default"});
  Panel detector{"Pan and Tompkins by sampling rate, 6 dB of noise",
                 {"µs of one core a second of ECG"},
                 {"error of the R wave's time, ms rms"}};
  Series timing{"R wave's time", {}, {}};
  for (const DetectorPoint& p : t.detector) {
    timing.x.push_back(p.us_a_second);
    timing.y.push_back(p.timing_ms);
    timing.notes.push_back(fmt::format("{:g} Hz", p.rate_hz));
  }
  detector.series.push_back(std::move(timing));
  page.panels.push_back(std::move(rates));
  page.panels.push_back(std::move(detector));
}

Page physiology_page(const PhysiologyTradeoff& t) {
  std::vector<std::string> kinds = signals_of(t);
  if (kinds.size() > 2) std::erase(kinds, "recorded");  // its sensors say it
  Page page{"Heart and breath: error over latency and cost", {}};
  for (const std::string& signals : kinds) add_breath(page, t, signals);
  add_heart(page, t);
  return page;
}

}  // namespace

Result<bool> write_physiology_tradeoff(const std::filesystem::path& folder,
                                       const PhysiologyTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "physiology.csv", physiology_csv(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "physiology.md", physiology_md(tradeoff)));
  NERITIC_TRY_STATUS(write_json(folder / "physiology.json", physiology_json(tradeoff)));
  return write_picture(folder / "physiology.png", page_data(physiology_page(tradeoff)));
}

}  // namespace neritic::tools
