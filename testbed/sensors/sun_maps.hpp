// The sun's depth maps of each view set of a session, kept from frame to frame: a layer is drawn
// anew if the sun, the layer's place or what stands still has changed. Moving things are drawn over
// a copy, in a frame in which some of it is in sight. Frames run in the order in which they are
// declared. Private to testbed/sensors; rendering thread.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/render/renderer.hpp"

namespace neritic::testbed {

struct FrameParts;
struct ViewsWork;

class SunMaps {
 public:
  // The maps that a view set's shading reads, of work.cascades. prefix: of the view set's passes.
  Result<graph::ImageHandle> declare(const FrameParts& frame, const std::string& prefix,
                                     ViewsWork& work);

 private:
  struct Kept {
    gpu::Image image;
    std::vector<std::uint64_t> drawn;  // a layer: hash of what it shows; 0: nothing yet
  };
  std::map<std::string, Kept> kept_;
};

}  // namespace neritic::testbed
