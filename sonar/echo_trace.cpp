#include "sonar/echo_trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/image_file.hpp"
#include "sonar/bottom_detection.hpp"
#include "sonar/levels.hpp"

namespace neritic::sonar {
namespace {

constexpr double kNoEcho = std::numeric_limits<double>::quiet_NaN();

// Half as much again as the pulse: what a return may be long and be a point's.
constexpr double kPointLength = 1.5;

// The beginning of the return whose flank contains a bin.
double return_bins(std::span<const float> profile, std::size_t at, double pulse_bins) {
  const auto value = [&](std::size_t i) {
    return i < profile.size() ? double{heard(profile[i])} : 0.0;
  };
  while (value(at + 1) > value(at)) ++at;
  const double peak = value(at);
  double before = 0.0, after = 0.0;
  for (std::size_t i = at; i > 0 && value(i - 1) > 0.0 && value(i - 1) <= value(i); --i)
    before += value(i - 1) / peak;
  for (std::size_t i = at; value(i + 1) > 0.0 && value(i + 1) <= value(i); ++i)
    after += value(i + 1) / peak;
  const auto bin = static_cast<double>(at);
  if (1.0 + before + after > kPointLength * pulse_bins) return bin - before;
  return bin + 0.5 + sub_bin_offset(at > 0 ? value(at - 1) : 0.0, peak, value(at + 1));
}

std::string csv_number(double v) {
  return std::isnan(v) ? std::string() : fmt::format("{:.9g}", v);
}

std::string csv_of(const EchoTrace& trace) {
  std::string csv =
      "ping,time_s,sonar_depth_m,first_range_m,strongest_range_m,first_depth_m,"
      "strongest_depth_m\n";
  for (std::size_t i = 0; i < trace.pings().size(); ++i) {
    const EchoPing& p = trace.pings()[i];
    csv +=
        fmt::format("{},{},{},{},{},{},{}\n", i, csv_number(p.time_s), csv_number(p.sonar_depth_m),
                    csv_number(p.first_m), csv_number(p.strongest_m), csv_number(p.first_depth_m()),
                    csv_number(p.strongest_depth_m()));
  }
  return csv;
}

}  // namespace

Status validate(const EchoTraceOptions& o) {
  if (o.n_range == 0 || o.n_range > kMaxBins)
    return refusal("echo trace", fmt::format("{} range bins", o.n_range),
                   fmt::format("1 to {}", kMaxBins));
  if (!(o.range_min_m >= 0.0 && o.range_max_m > o.range_min_m) || !std::isfinite(o.range_max_m))
    return refusal("echo trace",
                   fmt::format("a range from {} to {} m", o.range_min_m, o.range_max_m),
                   "from 0 or more, increasing");
  if (!(o.relative_threshold > 0.0 && o.relative_threshold <= 1.0))
    return refusal("echo trace", fmt::format("relative threshold {}", o.relative_threshold),
                   "above 0, at most 1");
  if (!(o.floor >= 0.0) || !std::isfinite(o.floor))
    return refusal("echo trace", fmt::format("floor {}", o.floor), "0 or more");
  if (!(o.pulse_bins >= 1.0) || !std::isfinite(o.pulse_bins))
    return refusal("echo trace", fmt::format("a pulse of {} bins", o.pulse_bins), "1 or more");
  if (!o.floor_by_bin.empty() && o.floor_by_bin.size() != o.n_range)
    return refusal("echo trace", fmt::format("a floor of {} bins", o.floor_by_bin.size()),
                   fmt::format("none, or {}", o.n_range));
  return {};
}

std::optional<LineFit> fit_line(std::span<const double> x, std::span<const double> y) {
  NERITIC_CHECK(x.size() == y.size(), "{} x for {} y", x.size(), y.size());
  LineFit fit;
  double mean_x = 0.0, mean_y = 0.0;
  const auto each = [&](auto&& f) {
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!std::isnan(x[i]) && !std::isnan(y[i])) f(x[i], y[i]);
  };
  each([&](double u, double v) {
    ++fit.count;
    mean_x += u;
    mean_y += v;
  });
  if (fit.count < 2) return std::nullopt;
  const double n = static_cast<double>(fit.count);
  mean_x /= n;
  mean_y /= n;
  double xx = 0.0, xy = 0.0, left = 0.0;
  each([&](double u, double v) {
    xx += (u - mean_x) * (u - mean_x);
    xy += (u - mean_x) * (v - mean_y);
  });
  if (!(xx > 0.0)) return std::nullopt;
  fit.slope = xy / xx;
  fit.at_zero = mean_y - fit.slope * mean_x;
  each([&](double u, double v) {
    const double rest = v - mean_y - fit.slope * (u - mean_x);
    left += rest * rest;
  });
  fit.rms = std::sqrt(left / n);
  return fit;
}

std::optional<double> first_return_bins(std::span<const float> profile, double relative_threshold,
                                        double floor, double pulse_bins) {
  double strongest = 0.0;
  for (const float v : profile) strongest = std::max(strongest, double{heard(v)});
  if (!(strongest > std::max(floor, 0.0))) return std::nullopt;
  const double level = std::max(relative_threshold * strongest, floor);
  std::size_t i = 0;
  while (heard(profile[i]) < level) ++i;
  return return_bins(profile, i, pulse_bins);
}

std::optional<double> strongest_return_bins(std::span<const float> profile, double floor,
                                            double pulse_bins) {
  std::size_t peak = 0;
  for (std::size_t i = 1; i < profile.size(); ++i)
    if (heard(profile[i]) > heard(profile[peak])) peak = i;
  if (profile.empty() || !(heard(profile[peak]) > std::max(floor, 0.0))) return std::nullopt;
  return return_bins(profile, peak, pulse_bins);
}

EchoTrace::EchoTrace(const EchoTraceOptions& options) : options_(options) {
  const Status valid = validate(options);
  NERITIC_CHECK(valid.ok(), "{}", valid.error().message);
}

void EchoTrace::append(std::span<const float> intensity, double time_s, double sonar_depth_m) {
  NERITIC_CHECK(intensity.size() == options_.n_range, "{} values for {} bins", intensity.size(),
                options_.n_range);
  const std::size_t from = intensity_.size();
  for (const float v : intensity) intensity_.push_back(heard(v));
  const std::vector<float> profile =
      above_floor(std::span<const float>(intensity_).subspan(from), options_.floor_by_bin);
  const auto range = [&](std::optional<double> bins) {
    return bins ? options_.range_min_m + *bins * options_.range_step_m() : kNoEcho;
  };
  pings_.push_back({time_s, sonar_depth_m,
                    range(first_return_bins(profile, options_.relative_threshold, options_.floor,
                                            options_.pulse_bins)),
                    range(strongest_return_bins(profile, options_.floor, options_.pulse_bins))});
}

std::optional<LineFit> EchoTrace::first_return_slope() const {
  std::vector<double> times, ranges;
  for (const EchoPing& ping : pings_) {
    times.push_back(ping.time_s);
    ranges.push_back(ping.first_m);
  }
  return fit_line(times, ranges);
}

Status write_echo_trace(const std::filesystem::path& folder, const EchoTrace& trace,
                        const nlohmann::json& facts, const EchoPictureOptions& picture) {
  NERITIC_TRY_STATUS(make_folder(folder));
  const EchoTraceOptions& o = trace.options();
  NERITIC_TRY_STATUS(write_npy(folder / "echo_trace.npy", trace.intensity(),
                               {trace.pings().size(), std::size_t{o.n_range}}));
  NERITIC_TRY_STATUS(write_text(folder / "echo_trace.csv", csv_of(trace)));
  NERITIC_TRY_STATUS(scene::write_png8(folder / "echo_trace.png", draw_echo_trace(trace, picture)));
  nlohmann::json json = facts;
  json["range_m"] = {o.range_min_m, o.range_max_m};
  json["bins"] = o.n_range;
  json["pings"] = trace.pings().size();
  json["detection"] = {{"relative_threshold", o.relative_threshold},
                       {"floor", o.floor},
                       {"pulse_bins", o.pulse_bins}};
  json["layout"] = "echo_trace.npy [ping, range]: linear intensity, column 0 nearest";
  if (const auto fit = trace.first_return_slope())
    json["first_return_fit"] = {{"slope_m_s", fit->slope},
                                {"range_at_time_0_m", fit->at_zero},
                                {"rms_m", fit->rms},
                                {"pings", fit->count}};
  return write_json(folder / "echo_trace.json", json);
}

}  // namespace neritic::sonar
