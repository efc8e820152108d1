#include "engine/scene/scene_copies.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/number_rows.hpp"

namespace neritic::scene {

Mat4 copy_from_row(const std::vector<double>& row) {
  const double yaw_rad = row.size() > 3 ? radians(row[3]) : 0.0;
  const double scale = row.size() > 4 ? row[4] : 1.0;
  const Pose pose{{row[0], row[1], row[2]}, from_yaw_pitch_roll(yaw_rad, 0.0, 0.0)};
  return glm::scale(to_matrix(pose), Vec3(scale));
}

Result<std::vector<Mat4>> parse_copies(std::string_view text, const std::string& name) {
  const RowFormat format{.min_columns = 3,
                         .max_columns = 5,
                         .max_rows = kMaxInstances,
                         .columns = "x, y, z, then yaw_deg and scale where wanted"};
  NERITIC_TRY(const std::vector<NumberRow> rows, parse_rows(text, name, format));
  std::vector<Mat4> copies;
  for (const NumberRow& row : rows) {
    if (row.values.size() == 5 && !(row.values[4] > 0.0))
      return refusal(fmt::format("{}:{}", name, row.line), fmt::format("scale {}", row.values[4]),
                     "a positive number");
    copies.push_back(copy_from_row(row.values));
  }
  return copies;
}

Result<std::vector<Mat4>> read_copies_file(const std::filesystem::path& path) {
  NERITIC_TRY(const std::string text, read_text(path));
  return parse_copies(text, path.string());
}

}  // namespace neritic::scene
