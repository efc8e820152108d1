// ESRI ASCII grid (.asc): a header of key and number pairs, then rows from north to south. Source:
// Esri, "Esri ASCII raster format" (ArcGIS documentation); corner or centre registration, NODATA.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/shapes.hpp"

namespace neritic::scene {
namespace {

constexpr double kMaxAscSide = 32768.0;

// Words of a text with the line that each stands on.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  // The next word; empty at the end.
  std::string_view next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])))
      if (text_[at_++] == '\n') ++line_;
    const std::size_t start = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return text_.substr(start, at_ - start);
  }
  int line() const { return line_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

struct AscHeader {
  std::optional<double> columns, rows, cell_m, dx_m, dy_m;
  double no_data = -9999.0;  // the format's default
};

bool is_header_key(std::string_view word) {
  return !word.empty() && std::isalpha(static_cast<unsigned char>(word[0])) &&
         lower_case(word) != "nan";
}

// Stores the number under its key; false where the key is none of the format's.
bool set_header(AscHeader& header, const std::string& key, double value) {
  if (key == "ncols")
    header.columns = value;
  else if (key == "nrows")
    header.rows = value;
  else if (key == "cellsize")
    header.cell_m = value;
  else if (key == "dx")
    header.dx_m = value;
  else if (key == "dy")
    header.dy_m = value;
  else if (key == "nodata_value")
    header.no_data = value;
  else
    return key == "xllcorner" || key == "yllcorner" || key == "xllcenter" || key == "yllcenter";
  return true;
}

Status check_header(AscHeader& header, const std::string& name) {
  for (const auto& [key, value] : {std::pair("ncols", header.columns), {"nrows", header.rows}}) {
    if (!value) return refusal(name, fmt::format("no {} in the header", key), "one");
    if (!(*value >= 2.0 && *value <= kMaxAscSide && *value == std::floor(*value)))
      return refusal(fmt::format("{}: {}", name, key), fmt::format("{}", *value),
                     fmt::format("a whole number from 2 to {}", kMaxAscSide));
  }
  if (!header.cell_m && header.dx_m) {
    if (header.dy_m && *header.dy_m != *header.dx_m)
      return refusal(name, fmt::format("dx {} and dy {}", *header.dx_m, *header.dy_m),
                     "square cells");
    header.cell_m = header.dx_m;
  }
  if (header.cell_m && !(*header.cell_m > 0.0 && std::isfinite(*header.cell_m)))
    return refusal(fmt::format("{}: cellsize", name), fmt::format("{}", *header.cell_m),
                   "a positive number");
  return {};
}

}  // namespace

Result<Heightfield> parse_asc(std::string_view text, const std::string& name) {
  Words words(text);
  AscHeader header;
  std::string_view word = words.next();
  for (; is_header_key(word); word = words.next()) {
    const std::string key = lower_case(word);
    const int line = words.line();
    const std::string_view value_word = words.next();
    const auto value = parse_number(value_word);
    if (!value)
      return refusal(fmt::format("{}:{}: {}", name, line, printable(key)),
                     fmt::format("'{}'", printable(value_word)), "a number");
    if (!set_header(header, key, *value))
      return refusal(fmt::format("{}:{}", name, line), fmt::format("'{}'", printable(key)),
                     "ncols, nrows, xllcorner, yllcorner, xllcenter, yllcenter, cellsize, dx, dy, "
                     "nodata_value");
  }
  NERITIC_TRY_STATUS(check_header(header, name));

  Heightfield field;
  field.columns = static_cast<std::uint32_t>(*header.columns);
  field.rows = static_cast<std::uint32_t>(*header.rows);
  field.cell_m = header.cell_m.value_or(0.0);
  const std::size_t count = std::size_t{field.columns} * field.rows;
  // A forged header cannot exhaust the memory: a number takes two characters at least.
  if (count > text.size() / 2 + 1 || count > kMaxHeightfieldSamples)
    return refusal(name, fmt::format("a header for {} x {} numbers", field.columns, field.rows),
                   fmt::format("as many as the file holds, at most {}", kMaxHeightfieldSamples));
  field.heights_m.reserve(count);
  for (; !word.empty(); word = words.next()) {
    const auto value = parse_number(word);
    if (!value)
      return refusal(fmt::format("{}:{}", name, words.line()), fmt::format("'{}'", printable(word)),
                     "a number");
    if (field.heights_m.size() == count)
      return refusal(fmt::format("{}:{}", name, words.line()), "more numbers than ncols x nrows",
                     fmt::format("{}", count));
    const bool missing = std::isnan(*value) || *value == header.no_data;
    field.heights_m.push_back(missing ? std::numeric_limits<float>::quiet_NaN()
                                      : static_cast<float>(*value));
  }
  if (field.heights_m.size() != count)
    return refusal(name, fmt::format("{} numbers", field.heights_m.size()),
                   fmt::format("ncols x nrows = {}", count));
  return field;
}

}  // namespace neritic::scene
