// `neritic physio gaze`: fixations and saccades.
#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/core/clock.hpp"
#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/physio_report.hpp"

namespace neritic::tools {
namespace {

Result<diver::GazeSettings> gaze_settings(const PhysioFlags& flags) {
  const std::string name = !flags.method.empty() ? flags.method : flags.headset ? "idt" : "ivt";
  if (name != "ivt" && name != "idt")
    return refusal("--method", fmt::format("'{}'", name), "ivt or idt");
  const auto method = name == "ivt" ? diver::GazeMethod::kVelocity : diver::GazeMethod::kDispersion;
  if (flags.headset && method == diver::GazeMethod::kVelocity)
    return refusal("--headset", "--method ivt", "idt");
  if (flags.headset) return diver::headset_gaze(method);
  diver::GazeSettings settings;
  settings.method = method;
  return settings;
}

// A camera at the eye: its pixels are those of the directions alone.
Result<std::optional<diver::GazeCamera>> gaze_camera(const PhysioFlags& flags) {
  if (flags.intrinsics.empty()) return std::optional<diver::GazeCamera>();
  NERITIC_TRY(const auto numbers, parse_numbers("intrinsics", flags.intrinsics, 4, 4));
  if (!(numbers[0] > 0.0 && numbers[1] > 0.0))
    return refusal("--intrinsics", fmt::format("'{}'", flags.intrinsics), "fx and fy above 0");
  return std::optional<diver::GazeCamera>({{}, numbers[0], numbers[1], numbers[2], numbers[3]});
}

std::string pixel_cells(const GazeReport& r, const Vec3& direction) {
  if (!r.camera) return "";
  const auto pixel = diver::gaze_pixel(Vec3(0.0), direction, INFINITY, *r.camera);
  return pixel ? fmt::format(",{:.1f},{:.1f}", pixel->x, pixel->y) : ",,";
}

// A saccade of some 50 ms must not lie between two samples.
constexpr double kLeastGaze_hz = 20.0;

// The rate by the median step, so that a few odd stamps do not matter; none below three samples.
std::optional<double> sampling_hz(const std::vector<diver::GazeSample>& samples) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (const double step_s = samples[i].time_s - samples[i - 1].time_s; step_s > 0.0)
      steps_s.push_back(step_s);
  if (steps_s.size() < 2) return std::nullopt;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::ranges::nth_element(steps_s, middle);
  return 1.0 / *middle;
}

}  // namespace

double screen_x_deg(const Vec3& direction) {
  return degrees(std::atan2(direction.x, -direction.z));
}
double screen_y_deg(const Vec3& direction) {
  return degrees(std::atan2(direction.y, -direction.z));
}

Result<GazeReport> analyse_gaze(const PhysioFlags& flags) {
  GazeReport report;
  NERITIC_TRY(report.settings, gaze_settings(flags));
  NERITIC_TRY(report.camera, gaze_camera(flags));
  if (std::filesystem::path(flags.file).extension() != ".csv")
    return refusal(flags.file, "another kind of file", "gaze as .csv");
  NERITIC_TRY(const std::string text, read_text(flags.file));
  NERITIC_TRY(report.recording, diver::parse_gaze_csv(text, flags.file, flags.rate_hz));
  const auto& samples = report.recording.samples;
  if (const auto hz = sampling_hz(samples); hz && *hz < 0.98 * kLeastGaze_hz)
    return refusal(flags.file, fmt::format("gaze at {:.3g} Hz", *hz),
                   fmt::format("{:g} Hz or more", kLeastGaze_hz));
  const TimeNs start = now_ns();
  diver::GazeMonitor monitor(report.settings);
  for (const diver::GazeSample& sample : samples) monitor.push(sample, report.events);
  monitor.finish(report.events);
  const double seconds = std::max(samples.back().time_s - samples.front().time_s, 1e-3);
  report.us_a_second = 1e-3 * static_cast<double>(now_ns() - start) / seconds;
  report.state = monitor.state();
  report.noise = monitor.noise();
  if (report.recording.marks.empty()) return report;
  std::vector<bool> marked, found;
  for (const int mark : report.recording.marks) marked.push_back(mark == 2);
  for (const diver::GazeClass c : report.events.classes)
    found.push_back(c == diver::GazeClass::kSaccade);
  report.kappa = diver::saccade_kappa(marked, diver::in_saccades(samples, report.events.saccades));
  report.plain_kappa = diver::saccade_kappa(marked, found);
  return report;
}

// I-DT: a fixation's samples spread by some four deviations each way and axis.
std::string noise_warning(const GazeReport& r) {
  constexpr double kRaised = 1.2, kSpread = 8.0;
  const double noise_deg = degrees(r.noise.deviation_rad);
  if (r.velocity() && r.noise.velocity_rad_s > kRaised * r.settings.velocity_rad_s)
    return fmt::format(
        "noise of {:.2f} deg rms: I-VT asks for {:.0f} deg/s instead of {:g}, and misses saccades "
        "under about {:.1f} deg",
        noise_deg, degrees(r.noise.velocity_rad_s), degrees(r.settings.velocity_rad_s),
        degrees(diver::smallest_saccade_rad(r.noise)));
  if (!r.velocity() && kSpread * r.noise.deviation_rad > r.settings.dispersion_rad)
    return fmt::format(
        "noise of {:.2f} deg rms: fixations spread as wide as the {:g} deg of I-DT and break up; "
        "--method ivt bears it",
        noise_deg, degrees(r.settings.dispersion_rad));
  return {};
}

ReportText report_text(const PhysioFlags& flags, const GazeReport& r) {
  std::string out = fmt::format(
      "# {}: {} samples, {} refused; {} {}\n", flags.file, r.recording.samples.size(),
      r.state.refused, r.velocity() ? "I-VT" : "I-DT",
      r.velocity()
          ? fmt::format("above {:.3g} deg/s over {:.2g} ms", degrees(r.noise.velocity_rad_s),
                        1e3 * r.noise.window_s)
          : fmt::format("within {:g} deg for {:g} ms or more", degrees(r.settings.dispersion_rad),
                        1e3 * r.settings.dispersion_s));
  out += fmt::format("# {} fixations, {} saccades, {} blinks (too fast for an eye)\n# {}\n",
                     r.events.fixations.size(), r.events.saccades.size(), r.events.blinks.size(),
                     diver::kPursuitNote);
  if (const std::string warning = noise_warning(r); !warning.empty())
    out += fmt::format("# {}\n", warning);
  if (r.kappa)
    out += fmt::format(
        "# compared with a person's marks, saccade or not: kappa {:.3f} for these saccades, {:.3f} "
        "for plain {} of each sample\n",
        *r.kappa, *r.plain_kappa, r.velocity() ? "I-VT" : "I-DT");
  out += fmt::format("# cost: {:.0f} us of one core per second of gaze\n", r.us_a_second);
  std::string table =
      "kind,start_s,end_s,duration_ms,x_deg,y_deg,spread_deg,amplitude_deg,peak_deg_s,pursuit";
  table += r.camera ? ",u_px,v_px\n" : "\n";
  for (const diver::Fixation& f : r.events.fixations)
    table += fmt::format("fixation,{:.4f},{:.4f},{:.1f},{:.3f},{:.3f},{:.3f},{:.3f},,{}{}\n",
                         f.start_s, f.end_s, 1e3 * (f.end_s - f.start_s), screen_x_deg(f.direction),
                         screen_y_deg(f.direction), degrees(f.spread_rad), degrees(f.drift_rad),
                         f.may_be_pursuit ? "maybe" : "no", pixel_cells(r, f.direction));
  const auto add_rows = [&](const char* kind, const std::vector<diver::Saccade>& events) {
    for (const diver::Saccade& s : events)
      table += fmt::format("{},{:.4f},{:.4f},{:.1f},,,,{:.3f},{:.1f},{}\n", kind, s.start_s,
                           s.end_s, 1e3 * (s.end_s - s.start_s), degrees(s.amplitude_rad),
                           degrees(s.peak_rad_s), r.camera ? ",," : "");
  };
  add_rows("saccade", r.events.saccades);
  add_rows("blink", r.events.blinks);
  return {std::move(out), std::move(table)};
}

}  // namespace neritic::tools
