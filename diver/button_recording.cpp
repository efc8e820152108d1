#include "diver/button_recording.hpp"

#include <algorithm>
#include <cmath>

#include "diver/jacket.hpp"
#include "diver/physio_csv.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

constexpr double kMostButtonTime_s = 1e9;

constexpr struct {
  std::string_view name;
  std::uint64_t bit;
} kButtonColumns[] = {{"inflate", kInflate}, {"deflate", kDeflate}, {"dump", kDump}};

// Bits of each column; 0: the time's.
Result<std::vector<std::uint64_t>> button_columns(const SampleTable& table, std::size_t time,
                                                  const std::string& name) {
  std::vector<std::uint64_t> bits(table.names.size(), 0);
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    if (i == time) continue;
    const auto found = std::ranges::find(kButtonColumns, table.names[i],
                                         [](const auto& column) { return column.name; });
    if (found == std::end(kButtonColumns))
      return refusal(name, fmt::format("a column {}", table.names[i]),
                     "t_s, inflate, deflate, dump");
    bits[i] = found->bit;
  }
  return bits;
}

}  // namespace

std::optional<std::uint64_t> ButtonRecording::at(double when_s) const {
  const auto after = std::ranges::upper_bound(time_s, when_s);
  if (after == time_s.begin()) return std::nullopt;
  return buttons[static_cast<std::size_t>(after - time_s.begin()) - 1];
}

Result<ButtonRecording> read_button_recording(std::string_view text, const std::string& name) {
  NERITIC_TRY(const SampleTable table, parse_sample_table(text, name));
  double unit_s = 1.0;
  const auto time = table.time_column(unit_s);
  if (!time || table.names.size() < 2)
    return refusal(name, fmt::format("columns {}", fmt::join(table.names, ", ")),
                   "t_s and any of inflate, deflate, dump");
  NERITIC_TRY(const std::vector<std::uint64_t> bits, button_columns(table, *time, name));
  ButtonRecording out;
  for (std::size_t row = 0; row < table.columns[*time].size(); ++row) {
    const double at_s = unit_s * table.columns[*time][row];
    if (!(std::abs(at_s) <= kMostButtonTime_s) ||
        (!out.time_s.empty() && !(at_s > out.time_s.back())))
      return refusal(fmt::format("{}:{}", name, table.lines[row]),
                     fmt::format("time {}", table.columns[*time][row]),
                     "times that rise, to 1e9 s");
    std::uint64_t pressed = 0;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      const double value = table.columns[i][row];
      if (bits[i] == 0) continue;
      if (value != 0.0 && value != 1.0)  // NaN too
        return refusal(fmt::format("{}:{}: {}", name, table.lines[row], table.names[i]),
                       fmt::format("{}", value), "0 and 1");
      if (value == 1.0) pressed |= bits[i];
    }
    out.time_s.push_back(at_s);
    out.buttons.push_back(pressed);
  }
  return out;
}

}  // namespace neritic::diver
