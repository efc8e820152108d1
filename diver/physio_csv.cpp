#include "diver/physio_csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::diver {
namespace {

constexpr std::size_t kMostCsvColumns = 64;
constexpr double kMostTime_s = 1e12;
// A step longer than kGapSteps usual steps and kGapDeviations deviations of the steps is a gap.
constexpr double kGapSteps = 1.5, kGapDeviations = 6.0;
// A stamp later than its place by more than kLateSteps steps and kLateDeviations deviations of the
// jitter belongs to the next place: a sample is missing.
constexpr double kLateSteps = 0.75, kLateDeviations = 4.0;
// A stamp up to this part of a step before its predecessor is jitter; more is a clock set back.
constexpr double kBackSteps = 0.75;
constexpr double kDeviationOfMedian = 1.4826;  // of a normal distribution
// A few rows with a clock that leaps must not fill the memory with what is missing.
constexpr double kMostMissingSamples = 1e6, kMostMissingARow = 100.0;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double cell_number(std::string_view cell, const char* separators = ",;") {
  const double value = number_of(cell, separators).value_or(kNothing);
  return std::isfinite(value) ? value : kNothing;
}

// Neither empty, nor how programs write that there is no number.
bool is_word(std::string_view cell, const char* separators) {
  constexpr std::string_view kNone[] = {"",    "nan",  "inf",  "infinity", "na",
                                        "n/a", "null", "none", "-"};
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  return std::isnan(cell_number(cell, separators)) &&
         std::ranges::find(kNone, lower_case(cell)) == std::end(kNone);
}

// The unit of "time_ms", "time (ms)", "time [ms]", "time ms"; seconds if there is no unit.
double seconds_of_unit(std::string_view name) {
  const auto last = name.find_last_not_of(" )]");
  name = name.substr(0, last == name.npos ? 0 : last + 1);
  const auto before = name.find_last_of(" _([");
  const std::string_view unit = before == name.npos ? "" : name.substr(before + 1);
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"ms", 1e-3},      {"msec", 1e-3}, {"milliseconds", 1e-3}, {"us", 1e-6},
      {"\u00b5s", 1e-6}, {"ns", 1e-9},   {"min", 60.0},          {"minutes", 60.0}};
  for (const auto& [text, seconds] : kUnits)
    if (unit == text) return seconds;
  return 1.0;
}

// A cell of a column of flags: 1, 0, or nothing if it is empty.
std::optional<double> cell_flag(std::string_view cell) {
  constexpr std::string_view kYes[] = {"true", "yes", "valid", "ok", "y", "t"};
  constexpr std::string_view kNo[] = {"false", "no", "invalid", "lost", "n", "f"};
  const std::string word = lower_case(cell);
  if (std::ranges::find(kYes, word) != std::end(kYes)) return 1.0;
  if (std::ranges::find(kNo, word) != std::end(kNo)) return 0.0;
  if (word.empty() || word == "nan") return kNothing;
  const double number = cell_number(cell);
  return std::isnan(number) ? std::nullopt : std::optional(number);
}

bool is_flag(std::string_view column) {
  return column == "status" || column == "valid";
}

// A column that counts its rows is not what was measured.
bool counts_rows(const std::string& name, const std::vector<double>& values) {
  constexpr std::string_view kNames[] = {"",  "sample", "samples", "index", "idx", "i",  "n",
                                         "#", "no",     "nr",      "row",   "id",  "seq"};
  if (std::ranges::find(kNames, name) == std::end(kNames)) return false;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(values[i] - values[i - 1] == 1.0)) return false;
  return true;
}

// "... fs_hz=1000 ..." in a comment.
std::optional<double> rate_in(std::string_view comment) {
  for (const std::string_view key : {"fs_hz=", "rate_hz="}) {
    const auto at = comment.find(key);
    if (at == comment.npos) continue;
    comment.remove_prefix(at + key.size());
    const double rate = cell_number(comment.substr(0, comment.find_first_of(" \t\r,;")));
    if (rate >= kLeastRate_hz && rate <= kMostRate_hz) return rate;
  }
  return std::nullopt;
}

Status take_heading(const std::vector<std::string_view>& cells, const std::string& where,
                    SampleTable& table) {
  if (cells.size() > kMostCsvColumns)
    return refusal(where, fmt::format("{} columns", cells.size()),
                   fmt::format("at most {}", kMostCsvColumns));
  if (std::ranges::any_of(cells, [](std::string_view c) { return !std::isnan(cell_number(c)); }))
    return refusal(where, "a number in the heading", "names of columns");
  for (const std::string_view cell : cells) table.names.push_back(lower_case(cell));
  table.columns.resize(cells.size());
  table.words.resize(cells.size());
  return {};
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// A step that most others are whole multiples of, if `base` is nearly one: where samples are
// missing at random, few steps are of the usual length.
double common_step(const std::vector<double>& steps, double base, double clean) {
  constexpr double kMostClean = 0.9, kLeastSingle = 0.1, kLongest = 8.5;
  for (int refined = 0; refined < 3; ++refined) {
    double sum = 0.0, places = 0.0, clean_steps = 0.0, single = 0.0;
    for (const double step : steps) {
      const double ratio = step / base, whole = std::round(ratio);
      if (ratio > kLongest) continue;
      sum += step;
      places += whole;
      clean_steps += std::abs(ratio - whole) < clean;
      single += whole == 1.0;
    }
    const double all = static_cast<double>(steps.size());
    if (clean_steps < kMostClean * all || single < kLeastSingle * all) return 0.0;
    base = sum / places;
  }
  return base;
}

// The median of the positive steps, in seconds; 0: none.
double median_step(const std::vector<double>& stamps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i)
    if (stamps[i] > stamps[i - 1]) steps.push_back(stamps[i] - stamps[i - 1]);
  return steps.empty() ? 0.0 : median_of(std::move(steps));
}

// Seconds from one place to the next: of steps that are whole multiples of one, that one; else the
// mean of all but gaps, so that what jitters around an even clock comes out even.
double usual_step(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  if (steps.empty()) return 0.0;
  const double median = median_of(steps);
  for (int part = 1; part <= 4; ++part)
    if (const double base = common_step(steps, median / part, part == 1 ? 0.15 : 0.05); base > 0.0)
      return base;
  std::vector<double> off;
  for (const double step : steps) off.push_back(std::abs(step - median));
  const double longest =
      kGapSteps * median + kGapDeviations * kDeviationOfMedian * median_of(std::move(off));
  double sum = 0.0, count = 0.0;
  for (const double step : steps)
    if (step < longest) sum += step, count += 1.0;
  return sum / count;
}

// How much later than its place a stamp may be, in steps.
double late_steps(const std::vector<double>& time_s, double step_s) {
  std::vector<double> off;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double steps = (time_s[i] - time_s[i - 1]) / step_s;
    off.push_back(std::abs(steps - std::round(steps)));
  }
  if (off.empty()) return kLateSteps;
  // A step has the jitter of two stamps.
  const double jitter = kDeviationOfMedian * median_of(std::move(off)) / std::sqrt(2.0);
  return std::max(kLateSteps, kLateDeviations * jitter);
}

// Values at times, on an even grid. A sample goes to the next place, unless the time has leapt or
// the clock has drifted off by more than a step. Samples of one time came in one packet: the first
// has the packet's place, and what arrives unevenly stays within half a packet of it.
Status spread_evenly(const std::vector<double>& time_s, const std::vector<double>& values,
                     const std::string& name, Recording& out) {
  double next_s = time_s.front();
  const double step_s = 1.0 / out.rate_hz;
  double stamps = 1.0, missing = 0.0;
  for (std::size_t i = 1; i < time_s.size(); ++i) stamps += time_s[i] != time_s[i - 1];
  const double packet = static_cast<double>(time_s.size()) / stamps;
  const double late =
      packet > 1.0 ? std::max(kLateSteps, 0.5 * packet) : late_steps(time_s, step_s);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool has_place = i == 0 || time_s[i] != time_s[i - 1];
    const double ahead = (time_s[i] - next_s) / step_s;
    if (has_place && ahead > late) {
      const double most =
          std::max(kMostMissingSamples, kMostMissingARow * static_cast<double>(values.size()));
      if ((missing += ahead) > most)
        return refusal(name, fmt::format("{:.0f} missing samples up to {:g} s", missing, time_s[i]),
                       fmt::format("at most {:.0f}", most));
      const auto places = static_cast<std::size_t>(std::lround(ahead));
      out.samples.resize(out.samples.size() + places, kNothing);
      out.missing += places;
      next_s = time_s[i];
    }
    out.samples.push_back(values[i]);
    // The grid follows the stamps slowly: what jitters stays put, what drifts is followed.
    if (has_place) next_s += 0.02 * (time_s[i] - next_s);
    next_s += step_s;
  }
  return {};
}

}  // namespace

std::string_view trimmed_cell(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::string_view without_mark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

const char* separators_of(std::string_view heading) {
  if (heading.find(',') != heading.npos) return ",;";
  return heading.find(';') == heading.npos ? "\t" : ";";
}

std::optional<double> number_of(std::string_view cell, const char* separators) {
  std::string with_point;
  if (separators == std::string_view(";")) {
    if (const auto comma = cell.find(','); comma != cell.npos) {
      with_point = cell;
      with_point[comma] = '.';
      cell = with_point;
    }
  }
  double value = 0.0;
  const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (read.ec != std::errc() || read.ptr != cell.data() + cell.size()) return std::nullopt;
  return value;
}

std::string_view decimal_comma_words(std::size_t cells, std::size_t width, const char* separators) {
  const bool commas = std::string_view(separators).find(',') != std::string_view::npos;
  return commas && cells > width
             ? " (commas part cells here; decimal commas are read where semicolons alone do)"
             : "";
}

std::vector<std::string_view> csv_cells(std::string_view line, const char* separators) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto end = std::min(line.find_first_of(separators), line.size());
    cells.push_back(trimmed_cell(line.substr(0, end)));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

std::optional<std::size_t> time_column_of(const std::vector<std::string>& names, double& scale) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& n = names[i];
    const bool is_t = n.starts_with("t") && (n.size() == 1 || n.find_first_of("_ ([") == 1);
    if (!is_t && !n.starts_with("time")) continue;
    scale = seconds_of_unit(n);
    return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> SampleTable::find(std::string_view name) const {
  const auto at = std::ranges::find(names, lower_case(name));
  if (at == names.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names.begin());
}

std::optional<std::size_t> SampleTable::time_column(double& scale) const {
  return time_column_of(names, scale);
}

Result<SampleTable> parse_sample_table(std::string_view text, const std::string& name) {
  SampleTable table;
  const char* separators = ",;";
  text = without_mark(text);
  for (std::uint32_t line_number = 1; !text.empty(); ++line_number) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (trimmed_cell(line).empty() || trimmed_cell(line).starts_with('#')) {
      if (!table.rate_hz) table.rate_hz = rate_in(line);
      continue;
    }
    if (table.names.empty()) separators = separators_of(line);
    const auto cells = csv_cells(line, separators);
    const auto where = [&] { return fmt::format("{}:{}", name, line_number); };
    if (table.names.empty()) {
      NERITIC_TRY_STATUS(take_heading(cells, where(), table));
      continue;
    }
    if (cells.size() != table.names.size())
      return refusal(
          where(), fmt::format("{} columns", cells.size()),
          fmt::format("{}{}", table.names.size(),
                      decimal_comma_words(cells.size(), table.names.size(), separators)));
    if (table.columns[0].size() == kMostSamples / table.names.size())
      return refusal(where(), fmt::format("more rows than {}", table.columns[0].size()), "fewer");
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto value = is_flag(table.names[i]) ? cell_flag(cells[i])
                                                 : std::optional(cell_number(cells[i], separators));
      if (!value)
        return refusal(where(), fmt::format("{} '{}'", table.names[i], cells[i].substr(0, 40)),
                       "true, false or a number");
      table.columns[i].push_back(*value);
      if (std::isnan(*value) && is_word(cells[i], separators)) table.words[i] = true;
    }
    table.lines.push_back(line_number);
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (std::ranges::any_of(table.columns[i], [](double v) { return !std::isnan(v); }))
      table.words[i] = false;
  if (table.names.empty() || table.columns[0].empty())
    return refusal(name, "no row", "a heading and one row or more");
  return table;
}

Result<Recording> parse_csv(std::string_view text, const std::string& name,
                            const CsvChannel& channel) {
  NERITIC_TRY(SampleTable table, parse_sample_table(text, name));
  double scale = 1.0;
  const auto time = table.time_column(scale);
  std::optional<std::size_t> column;
  if (!channel.column.empty()) column = table.find(channel.column);
  for (const bool words : {false, true})  // words only where there is nothing else
    for (std::size_t i = 0; channel.column.empty() && i < table.names.size() && !column; ++i)
      if (i != time && table.words[i] == words && !counts_rows(table.names[i], table.columns[i]))
        column = i;
  if (!column)
    return refusal(name, fmt::format("no column '{}'", channel.column),
                   fmt::format("{}", fmt::join(table.names, ", ")));
  if (table.words[*column])
    return refusal(name, fmt::format("column '{}' of words", table.names[*column]), "numbers");
  Recording out{table.names[*column]};
  std::vector<double> time_s, values;
  if (time) {
    std::vector<double>& stamps = table.columns[*time];
    for (double& stamp : stamps) stamp *= scale;
    const double back_s = kBackSteps * median_step(stamps);
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      // Where the rate is known, several samples may have come at one time; stamps that jitter may
      // overtake one another.
      const bool on = time_s.empty() || stamps[i] > time_s.back() - back_s;
      const bool again = !time_s.empty() && stamps[i] == time_s.back() && channel.rate_hz <= 0.0;
      if (!(std::abs(stamps[i]) < kMostTime_s) || !on || again) {
        ++out.refused;
        continue;
      }
      time_s.push_back(stamps[i]);
      values.push_back(table.columns[*column][i]);
    }
    if (time_s.empty())
      return refusal(name, fmt::format("no time in column '{}'", table.names[*time]),
                     fmt::format("seconds up to {:g} (or _ms, _us)", kMostTime_s));
  }
  out.rate_hz = channel.rate_hz > 0.0 ? channel.rate_hz : table.rate_hz.value_or(0.0);
  const double step_s = usual_step(time_s);
  // Stamps are rounded: the rate is to six digits.
  if (step_s > 0.0 && channel.rate_hz <= 0.0) {
    const double scale = std::pow(10.0, 5.0 - std::floor(std::log10(1.0 / step_s)));
    out.rate_hz = std::round(scale / step_s) / scale;
  }
  if (!(out.rate_hz >= kLeastRate_hz && out.rate_hz <= kMostRate_hz))
    return refusal(name, fmt::format("no rate of {:g} to {:g} Hz", kLeastRate_hz, kMostRate_hz),
                   "a column of time with two rows or more, a comment with fs_hz= or --rate");
  if (time_s.empty()) {
    out.samples = std::move(table.columns[*column]);
    return out;
  }
  out.start_s = time_s.front();
  NERITIC_TRY_STATUS(spread_evenly(time_s, values, name, out));
  return out;
}

}  // namespace neritic::diver
