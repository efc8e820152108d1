// The reference cases of decompression that the tests of this folder share.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "diver/deco_check.hpp"
#include "diver/gas_label.hpp"
#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {

inline std::string deco_text(const std::string& name) {
  const auto text = read_text(test::source_dir() / "tests/diver/data" / name);
  EXPECT_TRUE(text.ok()) << text.error().message;
  return text.ok() ? *text : "";
}

inline DecoCases deco_cases(const std::string& name) {
  auto cases = read_deco_cases(deco_text(name), name);
  EXPECT_TRUE(cases.ok()) << cases.error().message;
  return cases.ok() ? *cases : DecoCases();
}

// A square dive under a set of conventions.
inline DivePlanRequest square_dive(double depth_m, double leave_min, const GasMix& mix = kAir,
                                   const char* conventions = "stop-minutes") {
  DivePlanRequest request;
  request.conventions = conventions_of(conventions).value();
  request.gases = {PlanGas{mix, 0.0, GasRole::kBottom}};
  request.levels = {{depth_m, leave_min}};
  return request;
}

}  // namespace neritic::diver
