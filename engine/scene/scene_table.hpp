// Tables of two columns as scenes write them: a .csv file, or a list of pairs. One thread, while a
// scene loads.
#pragma once

#include <string>

#include "engine/scene/scene_reader.hpp"
#include "engine/scene/sonar_settings.hpp"

namespace neritic::scene {

struct TableFormat {
  const char* columns;  // "depth_m, m/s"
  Interval x, y;
};

// Whether the value is meant as a table: the name of a .csv file, or a list.
bool is_table(const TomlValue& value);
// "rows [depth_m, m/s] or a .csv file of them", for messages.
std::string table_text(const TableFormat& format);
// Empty where the key is absent or its table is refused: columns in their intervals, x rising.
SonarTable read_table(TableReader& reader, Key key, const TableFormat& format);

}  // namespace neritic::scene
