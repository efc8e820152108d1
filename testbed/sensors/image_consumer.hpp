// Someone who takes images of a run as samples, each stream at a rate of its own. A loop asks each
// of its consumers what is due in a frame, computes just that, and gives it. The thread of the
// loop.
#pragma once

#include "testbed/sensors/image_sample.hpp"
#include "testbed/sensors/ping_schedule.hpp"

namespace neritic::testbed {

class ImageSink {
 public:
  virtual ~ImageSink() = default;
  // Whether it takes an image of that stream now. False: the image is counted as dropped, and not
  // computed if nobody else takes it. A sink with a slow receiver has a bounded queue and a thread
  // of its own, and says false while the queue is full.
  virtual bool ready(const ImageStream&) { return true; }
  // An Error ends the run.
  virtual Status accept(const ImageSample& image) = 0;
  // Whether it keeps the pixels themselves: take() is called then instead, without a copy of them.
  // Such a sink's consumer is the only one of its loop, without frame sinks, and wishes for no
  // stream twice.
  virtual bool takes() const { return false; }
  virtual Status take(const ImageSample& image, ImagePixels) { return accept(image); }
  // After the last frame, also of a run that failed.
  virtual Status finish() { return {}; }
};

// kBadInput unless images of that stream, whose sensor runs at sensor_hz, can come at rate_hz: 0,
// which is the sensor's own rate, to the sensor's own rate.
Status check_image_rate(const std::string& stream, double sensor_hz, double rate_hz);

class ImageConsumer {
 public:
  struct Wish {
    std::string stream;    // its name
    double rate_hz = 0.0;  // 0: the sensor's; at most that; counted from time 0
  };
  struct Counts {
    std::string stream;
    std::uint64_t given = 0, dropped = 0;
  };
  // An image that a frame computes for a consumer.
  struct Asked {
    StreamId stream = 0;
    std::uint64_t beat = 0;
  };

  // Borrows the sink. kBadInput for a name that no stream of the scene has, and for a rate that
  // check_image_rate() refuses.
  static Result<ImageConsumer> create(const scene::Scene& scene, const std::vector<Wish>& wishes,
                                      ImageSink& sink);
  // The errors of create().
  static Status check(const scene::Scene& scene, const std::vector<Wish>& wishes);
  // Other wishes from the next frame on; errors as create(), which leave it as it was. Images on
  // their way for which nobody wishes any more are left out.
  Status wish(const std::vector<Wish>& wishes);

  // Adds what is due at the request's time to the request: each stream at the multiples of its
  // period, whenever it was wished for.
  std::vector<Asked> ask(FrameRequest& request);
  // The images of a frame for which it asked.
  Status give(const scene::Scene& scene, const std::vector<Asked>& asked, FrameResult& result);
  // The run goes on from another time.
  void restart() { schedule_.restart(); }
  bool takes() const { return sink_->takes(); }
  Status finish() { return sink_->finish(); }
  // One for each wish.
  const std::vector<Counts>& counts() const { return counts_; }

 private:
  ImageConsumer(std::vector<ImageStream> all, ImageSink& sink);

  std::vector<ImageStream> all_;  // by id
  std::vector<StreamId> ids_;     // of each wish
  PingSchedule schedule_;
  std::vector<Counts> counts_;
  ImageSink* sink_;
};

}  // namespace neritic::testbed
