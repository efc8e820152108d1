// What `neritic tradeoff physiology` writes (physiology_tradeoff.hpp).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "diver/breath_monitor.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "tools/common/plot.hpp"
#include "tools/tradeoff/physiology_tradeoff.hpp"

namespace neritic::tools {
namespace {

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
        "\nThe default of the median: {} intervals, the most whose error is within 5 % of the "
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

void draw_breath(draw2d::Canvas& canvas, const Box& error_box, const Box& right_box,
                 const PhysiologyTradeoff& t, const std::string& signals) {
  std::vector<Series> errors, rights;
  std::vector<double> xs, ys;
  for (const diver::BreathEstimator e :
       {diver::BreathEstimator::kSpectrum, diver::BreathEstimator::kAutocorrelation,
        diver::BreathEstimator::kMultiBand}) {
    Series error{name_of(e), kSeriesColors[errors.size()], {}, {}, {}}, right = error;
    for (const BreathPoint& p : t.breath) {
      if (p.signals != signals || p.estimator != e) continue;
      if (p.answered > 0.0) {
        error.x.push_back(p.window_s);
        error.y.push_back(std::max(p.median_bpm, 0.01));
      }
      right.x.push_back(p.window_s);
      right.y.push_back(100.0 * p.right);
    }
    xs.insert(xs.end(), error.x.begin(), error.x.end());
    ys.insert(ys.end(), error.y.begin(), error.y.end());
    errors.push_back(std::move(error));
    rights.push_back(std::move(right));
  }
  const Axis x = axis_for("window, s: as late as that", xs, true);
  Axis y = axis_for("error in the middle, breaths/min", ys, true);
  y.max *= 4.0;
  draw_lines(canvas, error_box, "Breath, " + signals + " sounds: error", x, y, errors);
  const BreathPoint* knee = breath_knee(t, signals);
  for (const BreathPoint& p : t.breath) {
    if (p.signals != signals || p.estimator != diver::BreathEstimator::kMultiBand) continue;
    const bool at_knee = knee != nullptr && p.window_s == knee->window_s;
    const bool chosen = p.window_s == diver::BreathSettings{}.window_s;
    if (at_knee || chosen)
      draw_mark(canvas, error_box, x, y, p.window_s, std::max(p.median_bpm, 0.01),
                at_knee && chosen ? "knee, default"
                : at_knee         ? "knee"
                                  : "default");
  }
  draw_lines(canvas, right_box, "Breath, " + signals + " sounds: right within 2", x,
             {"% of all windows", 0.0, 125.0}, rights);
}

void draw_heart(draw2d::Canvas& canvas, const Box& rate_box, const Box& detector_box,
                const PhysiologyTradeoff& t) {
  std::vector<Series> rates;
  std::vector<double> xs, ys;
  for (const RateOver e : {RateOver::kCount, RateOver::kMean, RateOver::kMedian}) {
    Series s{name_of(e), kSeriesColors[rates.size()], {}, {}, {}};
    for (const HeartPoint& p : t.heart) {
      if (p.estimator != e || !(p.rms_bpm > 0.0)) continue;
      s.x.push_back(p.latency_s);
      s.y.push_back(p.rms_bpm);
      if (e == RateOver::kMedian) s.notes.push_back(fmt::format("{}", p.intervals));
    }
    xs.insert(xs.end(), s.x.begin(), s.x.end());
    ys.insert(ys.end(), s.y.begin(), s.y.end());
    rates.push_back(std::move(s));
  }
  const Axis x = axis_for("latency, s (intervals beside the points)", xs, true);
  Axis y = axis_for("error, bpm rms", ys, true);
  y.max *= 3.0;
  draw_lines(canvas, rate_box, "Heart rate through effort, with extra beats", x, y, rates);
  if (const HeartPoint* p = heart_choice(t))
    draw_mark(canvas, rate_box, x, y, p->latency_s, p->rms_bpm, "default");
  Series timing{"R wave's time", kSeriesColors[0], {}, {}, {}};
  for (const DetectorPoint& p : t.detector) {
    timing.x.push_back(p.us_a_second);
    timing.y.push_back(p.timing_ms);
    timing.notes.push_back(fmt::format("{:g} Hz", p.rate_hz));
  }
  draw_lines(canvas, detector_box, "Pan and Tompkins by sampling rate, 6 dB of noise",
             axis_for("us of one core a second of ECG", timing.x, true),
             axis_for("timing, ms rms", timing.y, true), {timing});
}

ImageU8 physiology_plot(const PhysiologyTradeoff& t) {
  constexpr double kWide = 900, kHigh = 480, kTop = 44;
  std::vector<std::string> rows_of = signals_of(t);
  if (rows_of.size() > 2) std::erase(rows_of, "recorded");  // its sensors say it
  const auto rows = static_cast<int>(rows_of.size()) + 1;
  draw2d::Canvas canvas(static_cast<std::uint32_t>(2 * kWide),
                        static_cast<std::uint32_t>(kTop + rows * kHigh), kPaper);
  canvas.text(24, 34, 18, "Heart and breath: error over latency and cost", kInk,
              draw2d::Align::kLeft, draw2d::Face::kBold);
  int row = 0;
  const auto boxes = [&] {
    const double top = kTop + kHigh * row++;
    return std::pair{Box{0, top, kWide, top + kHigh}, Box{kWide, top, 2 * kWide, top + kHigh}};
  };
  for (const std::string& signals : rows_of) {
    const auto [left, right] = boxes();
    draw_breath(canvas, left, right, t, signals);
  }
  const auto [left, right] = boxes();
  draw_heart(canvas, left, right, t);
  return canvas.take();
}

}  // namespace

Status write_physiology_tradeoff(const std::filesystem::path& folder,
                                 const PhysiologyTradeoff& tradeoff) {
  NERITIC_TRY_STATUS(make_folder(folder));
  NERITIC_TRY_STATUS(write_text(folder / "physiology.csv", physiology_csv(tradeoff)));
  NERITIC_TRY_STATUS(write_text(folder / "physiology.md", physiology_md(tradeoff)));
  NERITIC_TRY_STATUS(scene::write_png8(folder / "physiology.png", physiology_plot(tradeoff)));
  return write_json(folder / "physiology.json", physiology_json(tradeoff));
}

}  // namespace neritic::tools
