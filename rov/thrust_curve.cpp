#include "rov/thrust_curve.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::rov {
namespace {

constexpr std::size_t kMostRows = 10000, kMostColumns = 100;
constexpr double kMostNumber = 1e6;

// The nearest sequence that never falls.
void make_monotone(std::vector<std::vector<double>>& rows, std::size_t column) {
  struct Pool {
    double mean;
    std::size_t count;
  };
  std::vector<Pool> pools;
  for (const auto& row : rows) {
    pools.push_back({row[column], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean > pools.back().mean) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& pool = pools.back();
      const auto a = static_cast<double>(pool.count), b = static_cast<double>(last.count);
      pool = {(a * pool.mean + b * last.mean) / (a + b), pool.count + last.count};
    }
  }
  std::size_t i = 0;
  for (const Pool& pool : pools)
    for (std::size_t k = 0; k < pool.count; ++k) rows[i++][column] = pool.mean;
}

bool rises(const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(std::abs(values[i]) <= kMostNumber) || (i > 0 && !(values[i] > values[i - 1])))
      return false;
  return true;
}

// Where x lies among the rising values: index of the lower neighbour and the share of the upper.
std::pair<std::size_t, double> place(const std::vector<double>& values, double x) {
  if (values.size() < 2 || !(x > values.front())) return {0, 0.0};
  if (x >= values.back()) return {values.size() - 2, 1.0};
  const auto upper = std::ranges::upper_bound(values, x);
  const auto i = static_cast<std::size_t>(upper - values.begin()) - 1;
  return {i, (x - values[i]) / (values[i + 1] - values[i])};
}

double blend(double a, double b, double share) {
  return share == 0.0 ? a : a + share * (b - a);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\r')) cell.remove_suffix(1);
    cells.push_back(cell);
    if (comma == line.npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

bool read_number(std::string_view text, double& out) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), out);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() && std::isfinite(out);
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

struct Heading {
  std::size_t columns = 0;
  std::vector<std::size_t> thrust;  // which of them are thrusts
  std::vector<double> volts;        // at these voltages
};

// "pwm_us,thrust_n_16v,...": the number between the last '_' and the 'v' is the voltage.
Result<Heading> read_heading(std::string_view line, const std::string& where) {
  const auto cells = cells_of(line);
  Heading out;
  out.columns = cells.size();
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const std::string name = lower(cells[i]);
    constexpr std::string_view kPrefix = "thrust_n_";
    double volts = 0.0;
    if (!name.starts_with(kPrefix)) continue;
    if (!name.ends_with('v') ||
        !read_number(
            std::string_view(name).substr(kPrefix.size(), name.size() - kPrefix.size() - 1), volts))
      return refusal(where, fmt::format("column {}", i + 1), "a name like thrust_n_16v");
    out.thrust.push_back(i);
    out.volts.push_back(volts);
  }
  if (lower(cells[0]) != "pwm_us" || out.volts.empty() || cells.size() > kMostColumns)
    return refusal(where, "another heading", "\"pwm_us,thrust_n_16v,...\"");
  return out;
}

}  // namespace

Result<ThrustCurve> ThrustCurve::make(std::vector<double> pwm_us, std::vector<double> volts,
                                      std::vector<std::vector<double>> thrust_n) {
  if (pwm_us.size() < 2 || pwm_us.size() != thrust_n.size() || volts.empty())
    return refusal(
        "", fmt::format("{} pulse widths of {} rows of thrust", pwm_us.size(), thrust_n.size()),
        "two or more, a row each");
  if (!rises(pwm_us) || !rises(volts))
    return refusal("", "pulse widths or voltages that do not rise", "rising ones");
  for (const auto& row : thrust_n)
    if (row.size() != volts.size() ||
        !std::ranges::all_of(row, [](double x) { return std::abs(x) <= kMostNumber; }))
      return refusal("", fmt::format("a row of {} thrusts", row.size()),
                     fmt::format("{} finite numbers", volts.size()));
  ThrustCurve out;
  for (std::size_t k = 0; k < volts.size(); ++k) make_monotone(thrust_n, k);
  out.pwm_us_ = std::move(pwm_us);
  out.volts_ = std::move(volts);
  out.thrust_n_ = std::move(thrust_n);
  return out;
}

Result<ThrustCurve> ThrustCurve::parse(std::string_view text, const std::string& name) {
  Heading heading;
  std::vector<double> pwm_us;
  std::vector<std::vector<double>> thrust_n;
  int number = 0;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    ++number;
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    const std::string where = fmt::format("{}:{}", name, number);
    if (heading.columns == 0) {
      NERITIC_TRY(heading, read_heading(line, where));
      continue;
    }
    const auto cells = cells_of(line);
    std::vector<double> row(cells.size());
    bool good = cells.size() == heading.columns && pwm_us.size() < kMostRows;
    for (std::size_t i = 0; i < cells.size(); ++i) good = good && read_number(cells[i], row[i]);
    if (!good)
      return refusal(where, "another row",
                     fmt::format("{} numbers, in up to {} rows", heading.columns, kMostRows));
    pwm_us.push_back(row[0]);
    thrust_n.emplace_back();
    for (const std::size_t i : heading.thrust) thrust_n.back().push_back(row[i]);
  }
  Result<ThrustCurve> curve = make(std::move(pwm_us), heading.volts, std::move(thrust_n));
  if (!curve.ok()) return bad_input("{}: {}", name, curve.error().message);
  return curve;
}

Result<ThrustCurve> ThrustCurve::read(const std::filesystem::path& path) {
  NERITIC_TRY(const std::string text, read_text(path));
  return parse(text, path.string());
}

double ThrustCurve::at(std::size_t row, double volts) const {
  const auto [column, share] = place(volts_, volts);
  const auto& r = thrust_n_[row];
  return share == 0.0 ? r[column] : blend(r[column], r[column + 1], share);
}

double ThrustCurve::thrust_n(double pwm_us, double volts) const {
  const auto [row, share] = place(pwm_us_, pwm_us);
  return blend(at(row, volts), at(row + 1, volts), share);
}

std::pair<double, double> ThrustCurve::dead_band_us(double volts) const {
  // The first row that is not below 0, and the last that is not above.
  std::size_t first = 0, last = pwm_us_.size() - 1;
  while (first < last && at(first, volts) < 0.0) ++first;
  while (last > first && at(last, volts) > 0.0) --last;
  return {pwm_us_[first], pwm_us_[last]};
}

double ThrustCurve::pwm_us(double thrust_n, double volts) const {
  const auto [from, to] = dead_band_us(volts);
  if (!(thrust_n != 0.0)) return 0.5 * (from + to);
  std::size_t low = 0, high = pwm_us_.size() - 1;
  if (thrust_n <= at(low, volts)) return pwm_us_[low];
  if (thrust_n >= at(high, volts)) return pwm_us_[high];
  while (high - low > 1) {  // at(low) < thrust_n <= at(high)
    const std::size_t middle = (low + high) / 2;
    (at(middle, volts) < thrust_n ? low : high) = middle;
  }
  const double a = at(low, volts), b = at(high, volts);
  return blend(pwm_us_[low], pwm_us_[high], (thrust_n - a) / (b - a));
}

double ThrustCurve::realised_n(double commanded_n, double volts) const {
  if (!std::isfinite(commanded_n)) return commanded_n;
  return thrust_n(std::round(pwm_us(commanded_n, volts)), volts);
}

}  // namespace neritic::rov
