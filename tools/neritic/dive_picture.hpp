// The data of the picture of a dive (`neritic dive --plot`): testbed/record/LOG.md has every key.
// Pure function; any thread.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "testbed/record/dive_record.hpp"

namespace neritic::tools {

// title: of the scene. The recorder kept rows.
nlohmann::json dive_picture_data(const std::string& title, const testbed::PhysicsWorld& world,
                                 const testbed::DiveRecorder& recorder);
// The same of rows and figures alone, one of each diver.
nlohmann::json dive_picture_data(const std::string& title, const testbed::PhysicsWorld& world,
                                 const std::vector<testbed::DiveRow>& rows,
                                 const std::vector<testbed::HumanRow>& human_rows,
                                 const std::vector<testbed::HumanFigures>& figures);

}  // namespace neritic::tools
