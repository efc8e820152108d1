// Pictures of what the display shows, as .png files: one by key, one of the last frame. Rendering
// thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/xr/display.hpp"
#include "testbed/sensors/readback.hpp"

namespace neritic::testbed {

class Screenshots {
 public:
  // final_path: of the last frame's picture; empty: none. A run may end at any time, so each frame
  // is brought to the host for it.
  Screenshots(gpu::Device& device, gpu::Frames& frames, std::filesystem::path final_path)
      : device_(device), frames_(frames), final_path_(std::move(final_path)) {}

  // One of the next frame, to a free name in the current folder: all of it, or a part.
  void ask(const xr::PanelPart& part = {}) { asked_ = part; }
  // Brings the shown picture to the host, if this frame's is wanted. kUnsupported where the last
  // frame's is wanted and the display's images cannot be read.
  Status declare(graph::FrameGraph& graph, const xr::ShownPicture& shown, bool last);
  void submitted(std::uint64_t value);
  // Writes a picture by key that is done; where that fails, only the note says so.
  Status write_done(std::uint64_t completed);
  // After the last frame: writes what is still to be written.
  Status finish();
  // Something to tell the user, once.
  std::optional<std::string> take_note() { return std::exchange(note_, std::nullopt); }

 private:
  struct Shot {
    std::filesystem::path path;
    Readback texels;
    std::uint32_t width = 0, height = 0;
    bool bgra = false, by_key = false;
    xr::PanelPart part;
    std::uint64_t done = 0;  // the submission that fills it; 0: not submitted yet
  };
  Status write();

  gpu::Device& device_;
  gpu::Frames& frames_;
  std::filesystem::path final_path_;
  std::optional<xr::PanelPart> asked_;
  ReadbackPool readback_;
  std::optional<Shot> shot_;
  std::optional<std::string> note_;
};

}  // namespace neritic::testbed
