#include "diver/gaze_csv.hpp"

#include <cmath>

#include "diver/physio_csv.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

using Column = const std::vector<double>*;

Column column_of(const SampleTable& table, std::string_view name) {
  const auto at = table.find(name);
  return at ? &table.columns[*at] : nullptr;
}

}  // namespace

Result<GazeRecording> parse_gaze_csv(std::string_view text, const std::string& name,
                                     double rate_hz) {
  NERITIC_TRY(const SampleTable table, parse_sample_table(text, name));
  double time_scale = 1.0, scale = radians(1.0);
  const auto time = table.time_column(time_scale);
  const double rate = rate_hz > 0.0 ? rate_hz : table.rate_hz.value_or(0.0);
  if (!time && !(rate > 0.0))
    return refusal(name, "no time", "a column t_s, a comment with fs_hz= or --rate");
  Column x = column_of(table, "x_deg"), y = column_of(table, "y_deg");
  if (!x || !y) {
    x = column_of(table, "x_rad");
    y = column_of(table, "y_rad");
    scale = 1.0;
  }
  const Column dx = column_of(table, "dx"), dy = column_of(table, "dy"),
               dz = column_of(table, "dz");
  const bool has_angles = x && y;
  if (!has_angles && !(dx && dy && dz))
    return refusal(name, fmt::format("columns {}", fmt::join(table.names, ", ")),
                   "x_deg and y_deg, x_rad and y_rad, or dx, dy, dz");
  Column status = column_of(table, "status");
  if (!status) status = column_of(table, "valid");
  const Column marks = column_of(table, "evt");
  GazeRecording out;
  const std::size_t rows = table.columns[0].size();
  for (std::size_t i = 0; i < rows; ++i) {
    GazeSample sample;
    sample.time_s = time ? time_scale * table.columns[*time][i] : static_cast<double>(i) / rate;
    sample.direction = has_angles ? direction_of_angles(scale * (*x)[i], scale * (*y)[i])
                                  : Vec3((*dx)[i], (*dy)[i], (*dz)[i]);
    // A missing value means that the eye was not seen.
    sample.valid = !status || (std::isfinite((*status)[i]) && (*status)[i] != 0.0);
    out.samples.push_back(sample);
    if (!marks) continue;
    const double mark = (*marks)[i];
    out.marks.push_back(mark >= 0.0 && mark <= 9.0 ? static_cast<int>(mark) : 0);
  }
  return out;
}

}  // namespace neritic::diver
