#include "diver/limb_recording.hpp"

#include <algorithm>
#include <cmath>

#include "diver/kinematics.hpp"
#include "diver/physio_csv.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

constexpr double kMostAngle_deg = 360.0;

// Where a column's numbers go.
struct AngleColumn {
  std::size_t column, joint;
  int axis;
};

// SEGMENT_y_deg; nothing where the name is no joint's.
std::optional<AngleColumn> angle_column(std::string_view name, std::size_t column) {
  constexpr std::string_view kAxes[] = {"_x_deg", "_y_deg", "_z_deg"};
  for (int axis = 0; axis < 3; ++axis) {
    if (!name.ends_with(kAxes[axis])) continue;
    const std::string_view segment = name.substr(0, name.size() - kAxes[axis].size());
    const auto at = std::ranges::find(kSegmentNames, segment);
    if (at == kSegmentNames.begin() || at == kSegmentNames.end()) return std::nullopt;
    return AngleColumn{column, static_cast<std::size_t>(at - kSegmentNames.begin()) - 1, axis};
  }
  return std::nullopt;
}

std::vector<AngleColumn> angle_columns(const SampleTable& table) {
  std::vector<AngleColumn> out;
  for (std::size_t i = 0; i < table.names.size(); ++i)
    if (const auto column = angle_column(table.names[i], i)) out.push_back(*column);
  return out;
}

}  // namespace

JointRotations LimbRecording::at(double when_s, bool repeat) const {
  if (repeat) when_s = std::fmod(std::max(when_s, 0.0), length_s());
  const auto after = std::ranges::upper_bound(time_s, when_s);
  if (after == time_s.begin()) return joints.front();
  if (after == time_s.end()) return joints.back();
  const auto i = static_cast<std::size_t>(after - time_s.begin());
  const double share = (when_s - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
  JointRotations out;
  for (std::size_t j = 0; j < kJoints; ++j)
    out[j] = glm::slerp(joints[i - 1][j], joints[i][j], share);
  return out;
}

Result<LimbRecording> read_limb_recording(std::string_view text, const std::string& name) {
  NERITIC_TRY(const SampleTable table, parse_sample_table(text, name));
  double unit_s = 1.0;
  const auto time = table.time_column(unit_s);
  const std::vector<AngleColumn> columns = angle_columns(table);
  if (!time || columns.empty())
    return refusal(name, fmt::format("columns {}", fmt::join(table.names, ", ")),
                   "t_s and angles such as upper_leg_l_y_deg");
  LimbRecording out;
  const std::vector<double>& times = table.columns[*time];
  for (std::size_t row = 0; row < times.size(); ++row) {
    const double at_s = unit_s * (times[row] - times[0]);
    if (!std::isfinite(at_s) || (row > 0 && !(at_s > out.time_s.back())))
      return refusal(fmt::format("{}:{}", name, table.lines[row]),
                     fmt::format("time {}", times[row]), "times that rise");
    JointAngles angles{};
    for (const AngleColumn& column : columns) {
      const double deg = table.columns[column.column][row];
      if (!(std::abs(deg) <= kMostAngle_deg))
        return refusal(fmt::format("{}:{}: {}", name, table.lines[row], table.names[column.column]),
                       fmt::format("{}", deg), "-360 to 360");
      angles[column.joint][column.axis] = radians(deg);
    }
    out.time_s.push_back(at_s);
    out.joints.push_back(rotations_of(angles));
  }
  if (out.time_s.size() < 2)
    return refusal(name, fmt::format("{} rows", out.time_s.size()), "two or more");
  return out;
}

}  // namespace neritic::diver
