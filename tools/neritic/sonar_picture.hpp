// `neritic sonar sidescan --method image`: lines from a camera's pictures, for comparison with the
// acoustic ones. Any thread.
#pragma once

#include "sonar/sidescan_from_image.hpp"
#include "tools/neritic/sonar_frame.hpp"

namespace neritic::tools {

struct PictureLine {
  sonar::SidescanLine line;
  nlohmann::json facts;
};
// kBadInput that names the file or flag.
Result<PictureLine> load_picture_line(const SonarJob& job, const sonar::FrameFiles& files,
                                      SonarNotes& notes);
// sonar.npy float32 [2, n_range], port then starboard, nearest first; sonar.json last.
Status write_picture_line(const SonarJob& job, const std::filesystem::path& folder,
                          PictureLine line);
// waterfall.npy float32 [frames, 2 n_range], port reversed at the left, and waterfall.png, from the
// sonar.npy of the frames' folders that are there, in their order.
Status write_waterfall(const SonarJob& job, const std::vector<sonar::FrameFiles>& frames);

}  // namespace neritic::tools
