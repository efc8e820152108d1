// A diver's recorded depths, from a table as computers and simulations write them. Any thread.
//
// The form: text, a row a line, columns as physio_csv.hpp parts them. The first row names them, in
// any order: time_s or time_min (as SampleTable::time_column has it); depth_m, "depth (m)"; gas
// (air, ean32, 18/45), optional; vehicle, the participant of the row, if there are several. Other
// columns are ignored, and so are empty lines and lines that begin with #. A depth that is "nan" or
// empty is a sample that failed; times may not go back. Depths count downwards, or upwards
// if asked; a computer at the surface may show up to a metre the other way, more is refused.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diver/gas_mix.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

struct DepthSample {
  double time_s = 0.0, depth_m = 0.0;  // the depth is no number where the sample failed
  std::size_t gas = 0;                 // of the log
};

struct DepthLog {
  std::vector<DepthSample> samples;  // at least one
  std::vector<GasMix> gases;         // in the order of their first use; empty without such a column
};

// name stands in messages. Errors name the line, what was found, what is accepted.
// upwards: depths are negative below the surface.
// vehicle: the participant whose rows are read, if the column vehicle names several; else empty.
Result<DepthLog> read_depth_log(std::string_view text, const std::string& name,
                                std::string_view vehicle = {}, bool upwards = false);

}  // namespace neritic::diver
