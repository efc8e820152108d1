// Tables of two columns, x rising: gain over range, response over angle, sound speed over depth.
// Scenes read and check them (engine/scene/scene_table.hpp). Pure functions; any thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/scene/sonar_settings.hpp"

namespace neritic::sonar {

using scene::SonarRow;
using scene::SonarTable;

// Accepted values of a table's columns.
struct TableLimits {
  double x_min = -1e9, x_max = 1e9, y_min = -1e9, y_max = 1e9;
};
// kBadInput names the row: none, out of range, x not rising.
Status validate(std::span<const SonarRow> rows, const std::string& name, const TableLimits& limits);

// Linear between rows, the end rows' values beyond them. NaN for NaN. At least one row.
double interpolate(std::span<const SonarRow> rows, double x);

}  // namespace neritic::sonar
