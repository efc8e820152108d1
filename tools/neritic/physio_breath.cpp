// `neritic physio breath`: how often the diver breathes.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "engine/core/clock.hpp"
#include "engine/core/refusal.hpp"
#include "tools/neritic/physio_report.hpp"

namespace neritic::tools {
namespace {

// Shorter sounds give no estimate (breath_rate.hpp).
constexpr double kLeastSound_s = 4.0;

// --reference, or a rate in the file's name: ..._12bpm_...
std::optional<double> known_rate(const PhysioFlags& flags) {
  if (flags.reference_bpm) return flags.reference_bpm;
  const std::string name = std::filesystem::path(flags.file).filename().string();
  const auto at = name.find("bpm");
  if (at == name.npos) return std::nullopt;
  auto from = at;
  while (from > 0 && ((name[from - 1] >= '0' && name[from - 1] <= '9') || name[from - 1] == '.'))
    --from;
  double rate = 0.0;
  const auto read = std::from_chars(name.data() + from, name.data() + at, rate);
  if (read.ec != std::errc() || read.ptr != name.data() + at || !(rate > 0.0)) return std::nullopt;
  return rate;
}

Result<diver::BreathSettings> breath_settings(const PhysioFlags& flags) {
  diver::BreathSettings settings;
  NERITIC_TRY(settings.estimator, diver::breath_estimator_of(flags.estimator));
  if (flags.reference_bpm && !(*flags.reference_bpm > 0.0 && *flags.reference_bpm <= 120.0))
    return refusal("--reference", fmt::format("{}", *flags.reference_bpm),
                   "above 0 to 120 breaths a minute");
  settings.window_s = flags.window_s.value_or(settings.window_s);
  if (!(settings.window_s >= kLeastSound_s && settings.window_s <= 300.0))
    return refusal("--window", fmt::format("{}", settings.window_s),
                   fmt::format("{:g} to 300 s", kLeastSound_s));
  settings.block_s = std::min(settings.block_s, settings.window_s);
  NERITIC_TRY_STATUS(diver::check_breath_settings(settings));
  return settings;
}

Result<diver::Recording> load_sound(const PhysioFlags& flags) {
  NERITIC_TRY(diver::Recording sound, load_recording(flags));
  const Status rate = diver::check_sound_rate(sound.rate_hz);
  if (!rate.ok()) return bad_input("{}: {}", flags.file, rate.error().message);
  return sound;
}

// The same sound by the published method: each ten seconds on its own.
std::vector<diver::BreathState> plain_states(const BreathReport& report) {
  const double block_s = report.settings.block_s;
  return diver::analyse_breath(report.sound, {diver::BreathEstimator::kSpectrum, block_s, block_s});
}

constexpr const char* kBreathHeading =
    "time_s,rate_bpm,breathing,confidence,depth_db,quiet_s,refused,quality\n";

std::string breath_row(const diver::BreathState& s, diver::BreathEstimator estimator) {
  return fmt::format("{:.2f},{:.2f},{},{:.3f},{:.1f},{:.2f},{},{}\n", s.time_s, s.estimate.rate_bpm,
                     s.estimate.breathing ? 1 : 0, s.estimate.confidence, s.estimate.depth_db,
                     s.quiet_s, s.refused,
                     diver::name_of(diver::quality_of(s.estimate, estimator)));
}

std::string errors_line(const char* name, const RateErrors& e) {
  if (e.answered == 0)
    return fmt::format("# {}: no window has an answer, {} have none\n", name, e.refused);
  return fmt::format(
      "# {}: {} windows have an answer, {} have none; median error {:.2f} breaths/min, mean "
      "{:.2f}; "
      "{:.0f} % within 2, {:.0f} % at twice the rate\n",
      name, e.answered, e.refused, e.median_bpm, e.mean_bpm, 100.0 * e.within_2, 100.0 * e.doubled);
}

// The rate, where it is known.
std::string rate_line(const std::vector<diver::BreathState>& states) {
  std::vector<double> rates;
  for (const diver::BreathState& s : states)
    if (s.estimate.breathing) rates.push_back(s.estimate.rate_bpm);
  if (rates.empty())
    return fmt::format("# no rate: none of {} estimates knows one\n", states.size());
  std::ranges::sort(rates);
  return fmt::format("# {:.1f} breaths/min ({:.1f} to {:.1f}), known in {} of {} estimates\n",
                     rates[rates.size() / 2], rates.front(), rates.back(), rates.size(),
                     states.size());
}

}  // namespace

RateErrors rate_errors(const std::vector<diver::BreathState>& states, double true_bpm,
                       double from_s) {
  RateErrors out;
  std::vector<double> sizes;
  for (const diver::BreathState& s : states) {
    if (s.time_s < from_s - 1e-6) continue;
    if (!s.estimate.breathing) {
      ++out.refused;
      continue;
    }
    sizes.push_back(std::abs(s.estimate.rate_bpm - true_bpm));
    out.within_2 += sizes.back() <= 2.0;
    out.doubled += s.estimate.rate_bpm > 1.6 * true_bpm;
    out.mean_bpm += sizes.back();
  }
  out.answered = static_cast<int>(sizes.size());
  if (sizes.empty()) return out;
  for (double* sum : {&out.within_2, &out.doubled, &out.mean_bpm}) *sum /= out.answered;
  std::ranges::sort(sizes);
  out.median_bpm = 0.5 * (sizes[(sizes.size() - 1) / 2] + sizes[sizes.size() / 2]);
  return out;
}

Result<BreathReport> analyse_sound(const PhysioFlags& flags) {
  BreathReport report;
  NERITIC_TRY(report.settings, breath_settings(flags));
  NERITIC_TRY(report.sound, load_sound(flags));
  const double least_s = std::min(report.settings.block_s, kLeastSound_s);
  if (report.sound.seconds() < least_s)
    return refusal(flags.file, fmt::format("{:.1f} s of sound", report.sound.seconds()),
                   fmt::format("{:g} s or more", least_s));
  report.true_bpm = known_rate(flags);
  const TimeNs start = now_ns();
  report.states = diver::analyse_breath(report.sound, report.settings);
  report.us_a_second = 1e-3 * static_cast<double>(now_ns() - start) / report.sound.seconds();
  report.plain = plain_states(report);
  return report;
}

Result<BreathReport> play_sound(const PhysioFlags& flags) {
  BreathReport report;
  NERITIC_TRY(report.settings, breath_settings(flags));
  NERITIC_TRY(report.sound, load_sound(flags));
  const diver::Recording& sound = report.sound;
  if (sound.seconds() < report.settings.block_s)
    return refusal(flags.file, fmt::format("{:.1f} s of sound", sound.seconds()),
                   fmt::format("{:g} s or more with --realtime", report.settings.block_s));
  report.true_bpm = known_rate(flags);
  diver::BreathMonitor monitor(sound.rate_hz, report.settings);
  const std::vector<float> samples(sound.samples.begin(), sound.samples.end());
  // A sound card hands over some twentieth of a second at a time.
  const auto piece = static_cast<std::size_t>(std::max(1.0, 0.05 * sound.rate_hz));
  const auto start = std::chrono::steady_clock::now();
  std::uint64_t shown = 0;
  const auto show = [&] {
    const diver::BreathState& state = monitor.state();
    if (state.blocks == shown) return;
    shown = state.blocks;
    report.states.push_back(state);
    if (flags.json) return;
    fmt::print("{}", breath_row(state, report.settings.estimator));
    std::fflush(stdout);
  };
  if (!flags.json) fmt::print("{}", kBreathHeading);
  for (std::size_t from = 0; from < samples.size(); from += piece) {
    const std::size_t count = std::min(piece, samples.size() - from);
    std::this_thread::sleep_until(
        start + std::chrono::duration<double>(static_cast<double>(from + count) / sound.rate_hz));
    monitor.record(std::span(samples).subspan(from, count));
    show();
  }
  monitor.wait();
  show();
  monitor.finish();
  show();
  report.plain = plain_states(report);
  return report;
}

ReportText report_text(const PhysioFlags& flags, const BreathReport& r) {
  std::string out =
      fmt::format("# {}: {:g} Hz, {:.1f} s; {} over {:g} s, an estimate every {:g} s\n", flags.file,
                  r.sound.rate_hz, r.sound.seconds(), diver::name_of(r.settings.estimator),
                  r.settings.window_s, r.settings.block_s) +
      rate_line(r.states);
  if (r.true_bpm) {
    out += fmt::format("# true rate: {:g} breaths/min\n", *r.true_bpm);
    out += errors_line(
        fmt::format("{} over {:g} s", diver::name_of(r.settings.estimator), r.settings.window_s)
            .c_str(),
        rate_errors(r.states, *r.true_bpm,
                    std::min(r.settings.window_s, r.sound.seconds() - r.settings.block_s)));
    out += errors_line(fmt::format("plain spectrum over {:g} s", r.settings.block_s).c_str(),
                       rate_errors(r.plain, *r.true_bpm, r.settings.block_s));
  }
  if (r.us_a_second)
    out += fmt::format("# cost: {:.0f} us of one core per second of sound\n", *r.us_a_second);
  std::string table = kBreathHeading;
  for (const diver::BreathState& s : r.states) table += breath_row(s, r.settings.estimator);
  return {std::move(out), std::move(table)};
}

}  // namespace neritic::tools
