// The reference cases that the tests of this folder share.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/core/files.hpp"
#include "rov/control_cases.hpp"
#include "rov/trajectory_cases.hpp"
#include "tests/support/support.hpp"

namespace neritic::rov {

inline std::string data_text(const std::string& name) {
  const auto text = read_text(test::source_dir() / "tests/rov/data" / name);
  return text.ok() ? *text : "";
}

inline std::vector<TrajectoryCase> trajectories(const std::string& name = "trajectories.json") {
  auto cases = read_trajectories(data_text(name), name);
  EXPECT_TRUE(cases.ok()) << cases.error().message;
  return cases.ok() ? *cases : std::vector<TrajectoryCase>();
}

inline TrajectoryCase trajectory(const std::string& id) {
  for (TrajectoryCase& one : trajectories())
    if (one.id == id) return one;
  ADD_FAILURE() << "no case " << id;
  return {};
}

}  // namespace neritic::rov
