// What a plan's picture draws of each gas. Pure function; any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/neritic/plan_report.hpp"

namespace neritic::tools {

// Of one gas over run time: what its tank shows, bar, until it is used up, or where none is given
// the litres used.
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
