// A dive as a picture: the path from above over what is solid, depth, thrust, error and speed over
// time. One thread.
#pragma once

#include <filesystem>

#include "testbed/record/dive_record.hpp"

namespace neritic::tools {
using namespace testbed;

// .png. Precondition: rows as a DiveRecorder kept them.
Status write_dive_plot(const std::filesystem::path& path, const PhysicsWorld& world,
                       const std::vector<DiveRow>& rows, const std::vector<HumanRow>& human_rows);

}  // namespace neritic::tools
