// The curve of each gas in a plan's picture. Pure function; any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/neritic/plan_report.hpp"

namespace neritic::tools {

// One gas over run time: the pressure of its tank, bar, until it is used up, or, without a given
// tank, the litres used.
struct GasCurve {
  std::string name;
  std::size_t gas = 0;
  bool bar = false;
  std::vector<double> run_min, value;
  // The minimum gas in bar, and what the tank has at that moment.
  std::optional<double> minimum_run_min, minimum, then;
  bool used_up = false;  // at the last point: it gives no full breath any more
};
std::vector<GasCurve> gas_curves(const PlanReport& report);

}  // namespace neritic::tools
