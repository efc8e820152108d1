// The data of the picture of a dive (`neritic dive --plot`): testbed/record/LOG.md has every key.
// Pure function; any thread.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/neritic/plot_rows.hpp"

namespace neritic::tools {

// title: of the scene; figures: one of each diver.
nlohmann::json dive_picture_data(const std::string& title, const testbed::PhysicsWorld& world,
                                 const PlotRows& rows,
                                 const std::vector<testbed::HumanFigures>& figures);

}  // namespace neritic::tools
