// The images of a run in its recording: cameras as sensor_msgs/Image, sonars' echoes as
// marine_acoustic_msgs/ProjectedSonarImage, and where each was taken from (/CAMERA/pose, the
// optical frame in "map"). An image that comes while the disk is behind is dropped and counted by
// its consumer. The thread of the loop.
#pragma once

#include <functional>
#include <map>

#include "engine/recording/mcap_out.hpp"
#include "testbed/sensors/image_consumer.hpp"

namespace neritic::testbed {

class RecordedImages final : public ImageSink {
 public:
  // Borrows out. ready: whether it takes another image now.
  RecordedImages(recording::McapOut& out, std::function<bool()> ready)
      : out_(out), ready_(std::move(ready)) {}
  bool ready(const ImageStream&) override { return ready_(); }
  Status accept(const ImageSample& image) override;

 private:
  std::uint16_t channel(const std::string& topic, const char* type, const std::string& stream);

  recording::McapOut& out_;
  std::function<bool()> ready_;
  std::map<std::string, std::uint16_t> channels_, schemas_;  // by topic, by type
  std::map<std::string, std::uint64_t> poses_;               // the last one said, by frame
};

}  // namespace neritic::testbed
