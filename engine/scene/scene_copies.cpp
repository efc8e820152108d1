#include "engine/scene/scene_copies.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/files.hpp"
#include "engine/scene/scene_text.hpp"

namespace neritic::scene {
namespace {

constexpr double kMaxNumber = 4e7;

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// The text up to the separator, which is taken off the rest as well.
std::string_view take(std::string_view& rest, char separator) {
  const auto at = rest.find(separator);
  const std::string_view head = rest.substr(0, at);
  rest = at == std::string_view::npos ? std::string_view() : rest.substr(at + 1);
  return head;
}

bool is_heading(std::string_view row) {
  return !parse_number(trim(row.substr(0, row.find(','))));
}

Result<std::vector<double>> parse_row(std::string_view row, const std::string& place) {
  std::vector<double> values;
  while (!row.empty() && values.size() <= 5) {
    const std::string_view word = trim(take(row, ','));
    const auto value = parse_number(word);
    if (!value || !(std::abs(*value) <= kMaxNumber))
      return bad_input("{}: found '{}'; accepted: a number of at most {:g}", place, printable(word),
                       kMaxNumber);
    values.push_back(*value);
  }
  if (values.size() < 3 || values.size() > 5)
    return bad_input("{}: {} numbers; accepted: x, y, z, then yaw_deg and scale where wanted",
                     place, values.size() > 5 ? "more than 5" : std::to_string(values.size()));
  if (values.size() == 5 && !(values[4] > 0.0))
    return bad_input("{}: scale {}; accepted: a positive number", place, values[4]);
  return values;
}

}  // namespace

Mat4 copy_from_row(const std::vector<double>& row) {
  const double yaw_rad = row.size() > 3 ? radians(row[3]) : 0.0;
  const double scale = row.size() > 4 ? row[4] : 1.0;
  const Pose pose{{row[0], row[1], row[2]}, from_yaw_pitch_roll(yaw_rad, 0.0, 0.0)};
  return glm::scale(to_matrix(pose), Vec3(scale));
}

Result<std::vector<Mat4>> parse_copies(std::string_view text, const std::string& name) {
  std::vector<Mat4> copies;
  bool first = true;
  for (int line = 1; !text.empty(); ++line) {
    std::string_view rest = take(text, '\n');
    const std::string_view row = trim(take(rest, '#'));
    if (row.empty()) continue;
    const bool heading = first && is_heading(row);
    first = false;
    if (heading) continue;
    NERITIC_TRY(const auto values, parse_row(row, name + ":" + std::to_string(line)));
    if (copies.size() == kMaxInstances)
      return bad_input("{}:{}: more than {} copies", name, line, kMaxInstances);
    copies.push_back(copy_from_row(values));
  }
  if (copies.empty()) return bad_input("{}: no copy; accepted: one row or more", name);
  return copies;
}

Result<std::vector<Mat4>> read_copies_file(const std::filesystem::path& path) {
  NERITIC_TRY(const std::string text, read_text(path));
  return parse_copies(text, path.string());
}

}  // namespace neritic::scene
