// `neritic physio --plot`: what was found, as a person would look at it.
#include <algorithm>
#include <cmath>

#include "diver/vitals.hpp"
#include "tools/common/plot.hpp"
#include "tools/neritic/physio_report.hpp"

namespace neritic::tools {
namespace {

constexpr std::uint32_t kPlotWidth = 1600, kPlotHeight = 1000;
constexpr double kMargin = 10.0, kTitlePart = 60.0;
constexpr std::size_t kMostPlotted = 4000;

draw2d::Canvas titled(const std::string& title, const std::string& under) {
  draw2d::Canvas canvas(kPlotWidth, kPlotHeight, kPaper);
  canvas.text(24, 30, 16, title, kInk, draw2d::Align::kLeft, draw2d::Face::kBold);
  canvas.text(24, 52, 10, under, kInk.with_alpha(0.7f));
  return canvas;
}

std::string name_only(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

Series line(const std::string& name, std::size_t color, bool marked = false, bool joined = true) {
  Series out{name, kSeriesColors[color], {}, {}};
  out.marked = marked;
  out.joined = joined;
  return out;
}

// Holds all finite values, with room; at least so wide.
Axis axis_over(const std::string& label, const std::vector<Series>& all,
               std::vector<double> Series::*values, double least, double room = 0.06) {
  double low = 1e300, high = -1e300;
  for (const Series& s : all)
    for (const double v : s.*values) low = std::min(low, v), high = std::max(high, v);
  if (low > high) low = 0.0, high = 1.0;
  const double middle = 0.5 * (low + high);
  const double half = 0.5 * std::max((1.0 + 2.0 * room) * (high - low), least);
  return {label, middle - half, middle + half};
}

void draw(draw2d::Canvas& canvas, const Box& box, const std::string& title, const std::string& x,
          const std::string& y, const std::vector<Series>& series, double least_y) {
  draw_lines(canvas, box, title, axis_over(x, series, &Series::x, 1e-3, 0.0),
             axis_over(y, series, &Series::y, least_y), series);
}

// Ten seconds of the ECG: around the first ectopic beat, else the middle.
std::vector<Series> ecg_excerpt(const EcgReport& r) {
  double middle_s = 0.5 * r.ecg.seconds();
  for (const diver::Interval& i : r.intervals)
    if (i.kind == diver::IntervalKind::kEctopic) {
      middle_s = i.end_s;
      break;
    }
  const double from_s = std::max(0.0, std::min(middle_s, r.ecg.seconds() - 5.0) - 5.0);
  const auto first = static_cast<std::size_t>(from_s * r.ecg.rate_hz);
  const auto last =
      std::min(first + static_cast<std::size_t>(10.0 * r.ecg.rate_hz), r.ecg.samples.size());
  const std::size_t every = (last - first) / kMostPlotted + 1;
  Series ecg = line("ECG", 4), beats = line("beats", 0, true, false),
         ectopic = line("ectopic", 1, true, false);
  for (std::size_t i = first; i < last; i += every) {
    if (!std::isfinite(r.ecg.samples[i])) continue;
    ecg.x.push_back(static_cast<double>(i) / r.ecg.rate_hz);
    ecg.y.push_back(r.ecg.samples[i]);
  }
  for (std::size_t i = 0; i < r.beats.size(); ++i) {
    const auto at = static_cast<std::size_t>(std::lround(r.beats[i].time_s * r.ecg.rate_hz));
    if (at < first || at >= last || !std::isfinite(r.ecg.samples[at])) continue;
    Series& s = r.intervals[i].kind == diver::IntervalKind::kEctopic ? ectopic : beats;
    s.x.push_back(r.beats[i].time_s);
    s.y.push_back(r.ecg.samples[at]);
  }
  return {ecg, beats, ectopic};
}

// Intervals over time, and each against the one before.
std::pair<std::vector<Series>, std::vector<Series>> interval_series(const EcgReport& r) {
  Series normal = line("normal", 0, true, false),
         odd = line("ectopic, and the pause after", 1, true, false);
  Series pairs = line("normal pairs", 0, true, false);
  const std::size_t every = r.intervals.size() / kMostPlotted + 1;
  for (std::size_t i = 0; i < r.intervals.size(); ++i) {
    const diver::Interval& one = r.intervals[i];
    if (one.kind == diver::IntervalKind::kNone) continue;
    const bool is_normal = one.kind == diver::IntervalKind::kNormal;
    if (is_normal && i % every != 0) continue;
    Series& s = is_normal ? normal : odd;
    s.x.push_back(one.end_s);
    s.y.push_back(1e3 * one.length_s);
    if (!is_normal || i == 0 || r.intervals[i - 1].kind != diver::IntervalKind::kNormal) continue;
    pairs.x.push_back(1e3 * r.intervals[i - 1].length_s);
    pairs.y.push_back(1e3 * one.length_s);
  }
  return {{normal, odd}, {pairs}};
}

// Estimates in a row, a line each: where no rate is known there is a gap. The first has the name.
std::vector<Series> rate_lines(const std::vector<diver::BreathState>& states, const Series& like) {
  std::vector<Series> out{like};
  bool joined = true;
  for (const diver::BreathState& s : states) {
    const bool known = s.estimate.breathing != 0;
    if (known && !joined) {
      out.push_back(like);
      out.back().name.clear();
    }
    if (known) {
      out.back().x.push_back(s.time_s);
      out.back().y.push_back(s.estimate.rate_bpm);
    }
    joined = known;
  }
  return out;
}

// Where an estimate is no rate: no breath since when, or not sure of one.
void mark_silence(draw2d::Canvas& canvas, const Box& box, const Axis& x, const BreathReport& r) {
  const Box in = inside(box);
  double before_s = 0.0;
  std::string before;
  for (const diver::BreathState& s : r.states) {
    const bool quiet = s.quiet_s >= diver::kPauseHeard_s;
    const std::string words = s.estimate.breathing != 0 ? "" : quiet ? "no breath" : "no rate";
    if (!words.empty()) {
      const bool anew = words != before;
      const double from_s = quiet && anew ? s.time_s - s.quiet_s : before_s;
      const double left = place(x, std::max(from_s, 0.0), in.left, in.right),
                   end = place(x, s.time_s, in.left, in.right);
      const draw2d::Color color = quiet ? draw2d::Color{0.75f, 0.1f, 0.1f} : kInk;
      canvas.fill_rectangle(left, in.top, end, in.bottom, color.with_alpha(quiet ? 0.14f : 0.06f));
      if (anew) canvas.text(left + 4.0, in.bottom - 8.0, 8.0, words, color);
    }
    before_s = s.time_s;
    before = words;
  }
}

}  // namespace

ImageU8 report_plot(const PhysioFlags& flags, const EcgReport& r) {
  const diver::Variability& v = r.variability;
  std::string under = fmt::format(
      "{} beats, mean {:.1f} bpm; SDNN {:.1f} ms, RMSSD {:.1f} ms, pNN50 {:.1f} %; signal {}",
      r.beats.size(), v.mean_rate_bpm, v.sdnn_ms, v.rmssd_ms, v.pnn50_percent,
      diver::name_of(r.state.quality));
  if (r.score)
    under += fmt::format("; against marks {} found, {} extra, {} missed", r.score->found,
                         r.score->extra, r.score->missed);
  draw2d::Canvas canvas = titled("Heart: " + name_only(flags.file), under);
  const double right = kPlotWidth - kMargin, half = kTitlePart + 0.5 * (kPlotHeight - kTitlePart);
  draw(canvas, {kMargin, kTitlePart, right, half - 20.0}, "Ten seconds", "time, s",
       r.ecg.channel.empty() ? "ECG" : r.ecg.channel, ecg_excerpt(r), 1e-6);
  const auto [over_time, pairs] = interval_series(r);
  draw(canvas, {kMargin, half, 800, kPlotHeight - kMargin}, "Intervals between beats", "time, s",
       "RR, ms", over_time, 100.0);
  const Axis both = axis_over("RR, ms", pairs, &Series::y, 100.0);
  draw_lines(canvas, {810, half, 1210, kPlotHeight - kMargin}, "Each against the one before", both,
             {"next RR, ms", both.min, both.max}, pairs);
  if (r.spectrum.valid)
    draw_bars(canvas, {1220, half, right, kPlotHeight - kMargin},
              fmt::format("Power; LF/HF {:.2f}", r.spectrum.lf_over_hf), "ms2",
              {{"VLF", kSeriesColors[4], r.spectrum.vlf_ms2},
               {"LF", kSeriesColors[1], r.spectrum.lf_ms2},
               {"HF", kSeriesColors[0], r.spectrum.hf_ms2}});
  return canvas.take();
}

ImageU8 report_plot(const PhysioFlags& flags, const BreathReport& r) {
  draw2d::Canvas canvas =
      titled("Breath: " + name_only(flags.file),
             fmt::format(
                 "{} over {:g} s, an estimate every {:g} s; an estimate looks back over its window",
                 diver::name_of(r.settings.estimator), r.settings.window_s, r.settings.block_s));
  diver::BreathBands bands(r.sound.rate_hz);
  std::vector<diver::BreathFrame> frames;
  for (const double sample : r.sound.samples) bands.push(sample, frames);
  Series level = line("level", 4);
  const std::size_t every = frames.size() / kMostPlotted + 1;
  for (std::size_t i = 0; i + every <= frames.size(); i += every) {
    double sum = 0.0;
    for (std::size_t k = i; k < i + every; ++k) sum += frames[k].envelope;
    level.x.push_back(static_cast<double>(i) / diver::kBreathFrames_hz);
    level.y.push_back(20.0 * std::log10(sum / static_cast<double>(every) + 1e-6));
  }
  const double right = kPlotWidth - kMargin, half = kTitlePart + 0.5 * (kPlotHeight - kTitlePart);
  draw(canvas, {kMargin, kTitlePart, right, half - 20.0}, "Sound", "time, s", "dB of full scale",
       {level}, 10.0);
  Series found = line(diver::name_of(r.settings.estimator), 0, true),
         plain = line(fmt::format("plain spectrum, {:g} s", r.settings.block_s), 1, true),
         truth = line("reference", 2);
  std::vector<Series> rates = rate_lines(r.states, found);
  const std::vector<Series> plain_lines = rate_lines(r.plain, plain);
  rates.insert(rates.end(), plain_lines.begin(), plain_lines.end());
  if (r.true_bpm) {
    truth.x = {0.0, r.sound.seconds()};
    truth.y = {*r.true_bpm, *r.true_bpm};
    rates.push_back(truth);
  }
  const Box box{kMargin, half, right, kPlotHeight - kMargin};
  const Axis x{"time, s", 0.0, std::max(r.sound.seconds(), 1.0)};
  draw_lines(canvas, box, "Breaths a minute; shaded: no breath heard, or no rate known", x,
             {"breaths/min", 0.0, 45.0}, rates);
  mark_silence(canvas, box, x, r);
  return canvas.take();
}

ImageU8 report_plot(const PhysioFlags& flags, const GazeReport& r) {
  std::string under =
      fmt::format("{}: {} fixations, {} saccades, {} blinks", r.velocity() ? "I-VT" : "I-DT",
                  r.events.fixations.size(), r.events.saccades.size(), r.events.blinks.size());
  if (r.kappa) under += fmt::format("; kappa {:.2f} against a person's marks", *r.kappa);
  draw2d::Canvas canvas =
      titled("Gaze: " + name_only(flags.file), under + "; smooth pursuit is unsupported");
  const auto& samples = r.recording.samples;
  const std::size_t every = samples.size() / kMostPlotted + 1;
  Series x = line("x", 0), y = line("y", 1), path = line("gaze", 4);
  for (std::size_t i = 0; i < samples.size(); i += every) {
    const diver::GazeSample& s = samples[i];
    if (!s.valid || !is_finite(s.direction) || !std::isfinite(s.time_s)) continue;
    for (Series* over_time : {&x, &y}) over_time->x.push_back(s.time_s);
    x.y.push_back(screen_x_deg(s.direction));
    y.y.push_back(screen_y_deg(s.direction));
    path.x.push_back(x.y.back());
    path.y.push_back(y.y.back());
  }
  path.color = path.color.with_alpha(0.35f);
  Series fixed = line("fixations", 0, true, false), held_x = line("fixations", 4, true, false);
  for (const diver::Fixation& f : r.events.fixations) {
    fixed.x.push_back(screen_x_deg(f.direction));
    fixed.y.push_back(screen_y_deg(f.direction));
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
      for (const double angle : {fixed.x.back(), fixed.y.back()}) {
        held_x.x.push_back(f.start_s + share * (f.end_s - f.start_s));
        held_x.y.push_back(angle);
      }
  }
  const double right = kPlotWidth - kMargin, half = kTitlePart + 0.5 * (kPlotHeight - kTitlePart);
  draw(canvas, {kMargin, kTitlePart, right, half - 20.0}, "Angles, with fixations' means",
       "time, s", "degrees", {x, y, held_x}, 1.0);
  draw(canvas, {kMargin, half, 800, kPlotHeight - kMargin}, "Where it went", "x, degrees",
       "y, degrees", {path, fixed}, 1.0);
  Series sizes = line("saccades", 1, true, false);
  for (const diver::Saccade& s : r.events.saccades) {
    sizes.x.push_back(degrees(s.amplitude_rad));
    sizes.y.push_back(degrees(s.peak_rad_s));
  }
  draw(canvas, {810, half, right, kPlotHeight - kMargin}, "Saccades: peak speed over size",
       "amplitude, degrees", "peak, deg/s", {sizes}, 10.0);
  return canvas.take();
}

}  // namespace neritic::tools
