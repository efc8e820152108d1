#include "diver/depth_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diver/gas_label.hpp"
#include "diver/physio_csv.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::diver {
namespace {

constexpr std::size_t kMostLogSamples = 10'000'000;
constexpr std::size_t kMostVehicles = 8;  // that are named
constexpr double kMostAbove_m = 1.0;      // the surface: waves, and sensors that drift
constexpr double kMostTime = 1e12, kUntimed = std::numeric_limits<double>::quiet_NaN();
constexpr double kAtSurface_m = 0.5;  // a log that comes as near has been at the surface

// A field's text for one line: other bytes become '?'.
std::string shown(std::string_view cell) {
  std::string text(cell.substr(0, 40));
  for (char& c : text)
    if (c < 0x20 || c == 0x7f) c = '?';
  return text;
}

class LogReader {
 public:
  LogReader(const std::string& name, std::string_view vehicle, bool upwards)
      : name_(name), vehicle_(vehicle), upwards_(upwards) {}

  Result<DepthLog> read(std::string_view text) {
    text = without_mark(text);
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = text.substr(0, end), words = trimmed_cell(line);
      ++line_;
      text = end == text.npos ? std::string_view() : text.substr(end + 1);
      if (words.empty() || words.front() == '#') continue;
      NERITIC_TRY_STATUS(width_ == 0 ? read_names(line) : read_row(line));
    }
    if (width_ == 0) return refusal(name_, "no row of names", "time_s and depth_m");
    if (vehicles_.size() > 1 && vehicle_.empty())
      return refusal(name_, fmt::format("rows of {}", fmt::join(vehicles_, ", ")),
                     "one, choose by --vehicle");
    if (!vehicle_.empty() && log_.samples.empty())
      return refusal(
          fmt::format("{}: --vehicle", name_), fmt::format("'{}'", vehicle_),
          fmt::format("{}", vehicles_.empty() ? std::string("a file with a column vehicle")
                                              : fmt::format("{}", fmt::join(vehicles_, ", "))));
    if (log_.samples.empty()) return refusal(name_, "no sample", "at least one");
    NERITIC_TRY_STATUS(end_of_gap(log_.samples.size()));
    NERITIC_TRY_STATUS(add_notes());
    return std::move(log_);
  }

 private:
  Status read_names(std::string_view line) {
    separators_ = separators_of(line);
    std::vector<std::string> names;
    for (const std::string_view cell : csv_cells(line, separators_))
      names.push_back(lower_case(cell));
    width_ = names.size();
    const auto find = [&](std::string_view name) {
      return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    };
    time_ = time_column_of(names, unit_s_).value_or(width_);
    for (const char* name : {"depth_m", "depth (m)", "depth [m]"})
      if (depth_ = find(name); depth_ < width_) break;
    gas_ = find("gas");
    of_ = find("vehicle");
    if (trimmed_cell(line).starts_with('<'))
      return refusal(fmt::format("{}: line {}", name_, line_),
                     fmt::format("XML, '{}'", shown(trimmed_cell(line))),
                     "a table (CSV) with the columns time_s and depth_m, as dive logs export it");
    if (time_ == width_ || depth_ == width_)
      return refusal(fmt::format("{}: line {}", name_, line_),
                     fmt::format("columns '{}'", shown(trimmed_cell(line))),
                     "with time_s or time_min, and depth_m");
    return {};
  }

  Status read_row(std::string_view line) {
    const std::vector<std::string_view> cells = csv_cells(line, separators_);
    if (cells.size() != width_)
      return refusal(
          fmt::format("{}: line {}", name_, line_), fmt::format("{} cells", cells.size()),
          fmt::format("{}{}", width_, decimal_comma_words(cells.size(), width_, separators_)));
    const std::string_view whose = of_ < width_ ? cells[of_] : std::string_view();
    if (of_ < width_ && vehicles_.size() < kMostVehicles &&
        std::ranges::find(vehicles_, shown(whose)) == vehicles_.end())
      vehicles_.push_back(shown(whose));
    if (!vehicle_.empty() && whose != vehicle_) return {};
    DepthSample sample;
    sample.time_s = number_of(cells[time_], separators_).value_or(kUntimed);
    if (!(std::abs(sample.time_s) <= kMostTime))
      return refusal(fmt::format("{}: line {}", name_, line_),
                     fmt::format("time '{}'", shown(cells[time_])), "a number");
    sample.time_s *= unit_s_;
    if (!log_.samples.empty() && sample.time_s < log_.samples.back().time_s)
      return refusal(fmt::format("{}: line {}", name_, line_),
                     fmt::format("time {} after {}", shown(cells[time_]),
                                 log_.samples.back().time_s / unit_s_),
                     "times that do not go back");
    if (cells[depth_].empty())
      sample.failed = true;
    else if (const auto depth_m = number_of(cells[depth_], separators_))
      sample.depth_m = *depth_m;
    else
      return refusal(fmt::format("{}: line {}", name_, line_),
                     fmt::format("depth '{}'", shown(cells[depth_])), "a number");
    if (upwards_) sample.depth_m = 0.0 - sample.depth_m;  // not -0
    sample.failed = sample.failed || !(sample.depth_m <= kDeepestLogged_m);
    if (!sample.failed && sample.depth_m < -kMostAbove_m)
      return refusal(fmt::format("{}: line {}", name_, line_),
                     fmt::format("depth '{}'", shown(cells[depth_])),
                     upwards_ ? "up to 1 with --depths-up, where depths are negative"
                              : "from -1; --depths-up reads depths that are negative");
    if (gas_ < width_) NERITIC_TRY_STATUS(read_gas(cells[gas_], sample));
    if (log_.samples.size() == kMostLogSamples)
      return refusal(name_, "more samples", fmt::format("up to {}", kMostLogSamples));
    NERITIC_TRY_STATUS(add(sample, cells[depth_]));
    return {};
  }

  Status add(const DepthSample& sample, std::string_view depth) {
    const std::size_t at = log_.samples.size();
    if (at > 0 && sample.time_s - log_.samples.back().time_s > longest_s_) {
      longest_s_ = sample.time_s - log_.samples.back().time_s;
      longest_from_ = last_line_;
      longest_to_ = line_;
    }
    last_line_ = line_;
    if (sample.failed) {
      if (gap_ == kNoGap) {
        gap_ = at;
        gap_line_ = line_;
        gap_depth_ = shown(depth);
      }
      if (log_.failed++ == 0) {
        failed_line_ = line_;
        failed_depth_ = gap_depth_;
      }
    }
    log_.samples.push_back(sample);
    return sample.failed ? Status() : end_of_gap(at);
  }

  // Samples from gap_ to this one, which is good or one past the last, get depths.
  Status end_of_gap(std::size_t end) {
    if (gap_ == kNoGap) return {};
    std::vector<DepthSample>& samples = log_.samples;
    const bool before = gap_ > 0, after = end < samples.size();
    if (!before && !after)
      return refusal(name_, fmt::format("no depth that a dive has in {} samples", samples.size()),
                     "a log with depths in metres");
    const DepthSample &from = samples[before ? gap_ - 1 : end],
                      &to = samples[after ? end : gap_ - 1];
    const double start_s = before ? from.time_s : samples.front().time_s;
    const double gap_s = (after ? to : samples.back()).time_s - start_s;
    if (gap_s > kLongestGap_s)
      return refusal(fmt::format("{}: line {}", name_, gap_line_),
                     fmt::format("depth '{}', and no depth for {:.4g} s", gap_depth_, gap_s),
                     fmt::format("metres from -1 to {:g}, and up to {:g} s without one",
                                 kDeepestLogged_m, kLongestGap_s));
    for (std::size_t i = gap_; i < end; ++i) {
      const double share = before && after && to.time_s > from.time_s
                               ? (samples[i].time_s - from.time_s) / (to.time_s - from.time_s)
                               : 0.0;
      const double from_m = before ? from.depth_m : to.depth_m;
      samples[i].depth_m = from_m + share * (to.depth_m - from_m);
    }
    gap_ = kNoGap;
    return {};
  }

  Status add_notes() {
    const double least_m =
        std::ranges::min_element(log_.samples, {}, &DepthSample::depth_m)->depth_m;
    if (least_m > kDeepestDive_m)
      return refusal(name_, fmt::format("no depth above {:.4g} m", least_m),
                     "a log with depths in metres");
    if (log_.failed > 0)
      log_.notes.push_back(fmt::format(
          "{} refused, first in line {}: found depth '{}'; accepted: metres from -1 to {:g}. {} on "
          "the line between the depths before and after",
          log_.failed == 1 ? "a sample was" : fmt::format("{} samples were", log_.failed),
          failed_line_, failed_depth_, kDeepestLogged_m,
          log_.failed == 1 ? "Its depth is taken" : "Their depths are taken"));
    if (longest_s_ > kLongestGap_s)
      log_.notes.push_back(
          fmt::format("from line {} to {}, {:.4g} s pass without a sample: the depth is taken to "
                      "change evenly from one to the next",
                      longest_from_, longest_to_, longest_s_));
    if (least_m > kAtSurface_m)
      log_.notes.push_back(
          fmt::format("no depth is nearer to the surface than {:.3g} m: a diver's way from the "
                      "surface is missing, or the depths are not in metres below it",
                      least_m));
    return {};
  }

  // An empty cell is the gas of the row before.
  Status read_gas(std::string_view cell, DepthSample& sample) {
    if (cell.empty() && !log_.samples.empty()) {
      sample.gas = log_.samples.back().gas;
      return {};
    }
    const auto mix = parse_mix(cell);
    if (!mix.ok())
      return refusal(fmt::format("{}: line {}", name_, line_), fmt::format("gas '{}'", shown(cell)),
                     "air, o2, ean32 or 18/45");
    const auto at = std::ranges::find(log_.gases, *mix);
    sample.gas = static_cast<std::size_t>(at - log_.gases.begin());
    if (at != log_.gases.end()) return {};
    if (log_.gases.size() == 32)
      return refusal(fmt::format("{}: line {}", name_, line_), "a 33rd gas", "at most 32");
    log_.gases.push_back(*mix);
    return {};
  }

  const std::string& name_;
  std::string_view vehicle_;
  bool upwards_;
  std::vector<std::string> vehicles_;  // that there are
  std::size_t line_ = 0, width_ = 0, time_ = 0, depth_ = 0, gas_ = 0, of_ = 0;
  const char* separators_ = ",;";
  double unit_s_ = 1.0;
  static constexpr std::size_t kNoGap = ~std::size_t{0};
  std::size_t gap_ = kNoGap, gap_line_ = 0;  // the first of the samples in a row that failed
  std::size_t failed_line_ = 0, last_line_ = 0, longest_from_ = 0, longest_to_ = 0;
  std::string gap_depth_, failed_depth_;
  double longest_s_ = 0.0;  // between two samples
  DepthLog log_;
};

}  // namespace

Result<DepthLog> read_depth_log(std::string_view text, const std::string& name,
                                std::string_view vehicle, bool upwards) {
  return LogReader(name, vehicle, upwards).read(text);
}

}  // namespace neritic::diver
