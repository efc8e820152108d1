// A diver's recorded depths, from a table as computers and simulations write them. Any thread.
//
// The form: text, a row a line, columns and decimal commas as physio_csv.hpp has them. The first
// row names them, in any order: time_s or time_min (as SampleTable::time_column has it); depth_m,
// "depth (m)"; gas (air, ean32, 18/45), optional; vehicle, the participant of the row, if there are
// several. Other columns are ignored, and so are empty lines and lines that begin with #. Times may
// not go back. Depths count downwards, or upwards if asked; a computer at the surface may show up
// to a metre the other way, more is refused.
//
// A depth that is "nan", empty or beyond kDeepestLogged_m is a sample that failed: its depth lies
// on the line between its neighbours that did not fail, or is that of the only one. Without a depth
// for longer than kLongestGap_s, the log is refused: nobody knows that dive.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diver/gas_mix.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

// Metres; a dive computer reads depths as far.
inline constexpr double kDeepestLogged_m = 2000.0;
// Half of the slowest usual interval of a computer's log (a minute) either side of a depth.
inline constexpr double kLongestGap_s = 60.0;
// The deepest dive from the surface with a tank (Gabr 2014, 332.35 m): depths that never come
// nearer to the surface are in another unit.
inline constexpr double kDeepestDive_m = 332.35;

struct DepthSample {
  double time_s = 0.0, depth_m = 0.0;
  std::size_t gas = 0;  // of the log
  bool failed = false;  // the depth is that between its neighbours
};

struct DepthLog {
  std::vector<DepthSample> samples;  // at least one
  std::vector<GasMix> gases;         // in the order of their first use; empty without such a column
  std::size_t failed = 0;            // samples
  // A sentence each: samples that failed, long times between two samples, depths that stay away
  // from the surface.
  std::vector<std::string> notes;
};

// name stands in messages. Errors name the line, what was found, what is accepted.
// upwards: depths are negative below the surface.
// vehicle: the participant whose rows are read, if the column vehicle names several; else empty.
Result<DepthLog> read_depth_log(std::string_view text, const std::string& name,
                                std::string_view vehicle = {}, bool upwards = false);

}  // namespace neritic::diver
