#include "diver/physio_csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace neritic::diver {
namespace {

constexpr std::size_t kMostCsvColumns = 64;
// A step so much longer than usual is a gap.
constexpr double kGapSteps = 1.5;
// A stamp so much after its place is the next place's: a missing sample makes it one.
constexpr double kLateSteps = 0.75;
// A few rows with a clock that leaps must not fill the memory with what is missing.
constexpr double kMostMissing = 1e6, kMostMissingARow = 100.0;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string_view> csv_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto end = std::min(line.find_first_of(",;"), line.size());
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

double cell_number(std::string_view cell) {
  double value = 0.0;
  const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool whole = read.ec == std::errc() && read.ptr == cell.data() + cell.size();
  return whole && std::isfinite(value) ? value : kNothing;
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

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

Status take_heading(const std::vector<std::string_view>& cells, const std::string& where,
                    SampleTable& table) {
  if (cells.size() > kMostCsvColumns)
    return bad_input("{}: {} columns found, at most {} are accepted", where, cells.size(),
                     kMostCsvColumns);
  if (std::ranges::any_of(cells, [](std::string_view c) { return !std::isnan(cell_number(c)); }))
    return bad_input("{}: a number found in the heading, names of columns are accepted", where);
  for (const std::string_view cell : cells) table.names.push_back(lower_case(cell));
  table.columns.resize(cells.size());
  return {};
}

// Seconds a usual step: the mean of those that are no gap.
double usual_step(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  const double median = *middle;
  double sum = 0.0, count = 0.0;
  for (const double step : steps)
    if (step < kGapSteps * median) sum += step, count += 1.0;
  return sum / count;
}

// Values at rising times, on an even grid. A sample goes to the next place, unless the time has
// leapt or the clock has drifted off by more than a step.
Status spread_evenly(const std::vector<double>& time_s, const std::vector<double>& values,
                     const std::string& name, Recording& out) {
  double next_s = time_s.front();
  const double step_s = 1.0 / out.rate_hz;
  double missing = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double ahead = (time_s[i] - next_s) / step_s;
    if (ahead > kLateSteps) {
      const double most =
          std::max(kMostMissing, kMostMissingARow * static_cast<double>(values.size()));
      if ((missing += ahead) > most)
        return bad_input(
            "{}: {:.0f} missing samples up to {:g} s found, at most {:.0f} are accepted", name,
            missing, time_s[i], most);
      out.samples.resize(out.samples.size() + static_cast<std::size_t>(std::lround(ahead)),
                         kNothing);
      next_s = time_s[i];
    }
    out.samples.push_back(values[i]);
    // The grid follows the stamps slowly: what jitters stays put, what drifts is followed.
    next_s += step_s;
    next_s += 0.02 * (time_s[i] + step_s - next_s);
  }
  return {};
}

}  // namespace

std::optional<std::size_t> SampleTable::find(std::string_view name) const {
  const auto at = std::ranges::find(names, lower_case(name));
  if (at == names.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names.begin());
}

std::optional<std::size_t> SampleTable::time_column(double& scale) const {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& n = names[i];
    if (n != "t" && !n.starts_with("t_") && !n.starts_with("time")) continue;
    scale = n.ends_with("_ms") ? 1e-3 : n.ends_with("_us") ? 1e-6 : n.ends_with("_ns") ? 1e-9 : 1.0;
    return i;
  }
  return std::nullopt;
}

Result<SampleTable> parse_sample_table(std::string_view text, const std::string& name) {
  SampleTable table;
  for (int line_number = 1; !text.empty(); ++line_number) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.starts_with('#')) {
      if (!table.rate_hz) table.rate_hz = rate_in(line);
      continue;
    }
    const auto cells = csv_cells(line);
    const auto where = [&] { return fmt::format("{}:{}", name, line_number); };
    if (table.names.empty()) {
      NERITIC_TRY_STATUS(take_heading(cells, where(), table));
      continue;
    }
    if (cells.size() != table.names.size())
      return bad_input("{}: {} columns found, {} are accepted", where(), cells.size(),
                       table.names.size());
    if (table.columns[0].size() == kMostSamples / table.names.size())
      return bad_input("{}: more rows than {} found, fewer are accepted", where(),
                       table.columns[0].size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      table.columns[i].push_back(cell_number(cells[i]));
  }
  if (table.names.empty() || table.columns[0].empty())
    return bad_input("{}: no row found, a heading and one row or more are accepted", name);
  return table;
}

Result<Recording> parse_csv(std::string_view text, const std::string& name,
                            const CsvChannel& channel) {
  NERITIC_TRY(SampleTable table, parse_sample_table(text, name));
  double scale = 1.0;
  const auto time = table.time_column(scale);
  std::optional<std::size_t> column = table.find(channel.column);
  if (channel.column.empty())
    for (std::size_t i = 0; i < table.names.size() && !column; ++i)
      if (i != time) column = i;
  if (!column)
    return bad_input("{}: no column '{}' found, {} is accepted", name, channel.column,
                     fmt::join(table.names, ", "));
  Recording out{table.names[*column]};
  std::vector<double> time_s, values;
  if (time) {
    for (std::size_t i = 0; i < table.columns[0].size(); ++i) {
      const double at_s = scale * table.columns[*time][i];
      if (!(std::abs(at_s) < 1e12) || (!time_s.empty() && !(at_s > time_s.back()))) {
        ++out.refused;
        continue;
      }
      time_s.push_back(at_s);
      values.push_back(table.columns[*column][i]);
    }
  }
  out.rate_hz = channel.rate_hz > 0.0 ? channel.rate_hz : table.rate_hz.value_or(0.0);
  const double step_s = usual_step(time_s);
  if (step_s > 0.0 && channel.rate_hz <= 0.0) out.rate_hz = 1.0 / step_s;
  if (!(out.rate_hz >= kLeastRate_hz && out.rate_hz <= kMostRate_hz))
    return bad_input(
        "{}: no rate of {:g} to {:g} Hz found, a column of time with two rows or more, a comment "
        "with fs_hz= or --rate is accepted",
        name, kLeastRate_hz, kMostRate_hz);
  if (time_s.empty()) {
    out.samples = std::move(table.columns[*column]);
    return out;
  }
  out.start_s = time_s.front();
  NERITIC_TRY_STATUS(spread_evenly(time_s, values, name, out));
  return out;
}

}  // namespace neritic::diver
