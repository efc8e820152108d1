#include "testbed/sensors/image_consumer.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/clock.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::testbed {
namespace {

// The sensor's beats since time 0; times are sums of fractions.
std::uint64_t beat_at(double time_s, double rate_hz) {
  return static_cast<std::uint64_t>(std::max(0.0, std::floor(time_s * rate_hz + 1e-6)));
}

void add(Capture& to, const Capture& more) {
  to.color |= more.color;
  to.depth |= more.depth;
  to.normals |= more.normals;
  to.labels |= more.labels;
  to.instances |= more.instances;
  to.motion |= more.motion;
  to.echoes |= more.echoes;
  to.to_host |= more.to_host;
}

// Adds what a stream needs to the sensors of one sort; true: the sensor is new in the request.
bool add(std::vector<std::size_t>& sensors, std::vector<Capture>& captures,
         const ImageStream& stream) {
  const auto found = std::ranges::find(sensors, stream.sensor);
  const Capture needed = capture_of(stream.kind);
  if (found == sensors.end()) {
    sensors.push_back(stream.sensor);
    captures.push_back(needed);
    return true;
  }
  add(captures[static_cast<std::size_t>(found - sensors.begin())], needed);
  return false;
}

}  // namespace

ImageConsumer::ImageConsumer(std::vector<ImageStream> streams, std::vector<StreamId> ids,
                             const std::vector<double>& rates_hz, ImageSink& sink)
    : streams_(std::move(streams)), ids_(std::move(ids)), schedule_(rates_hz), sink_(&sink) {
  for (const ImageStream& stream : streams_) counts_.push_back({stream.name});
}

Result<ImageConsumer> ImageConsumer::create(const scene::Scene& scene,
                                            const std::vector<Wish>& wishes, ImageSink& sink) {
  const std::vector<ImageStream> all = image_streams(scene);
  std::vector<ImageStream> streams;
  std::vector<StreamId> ids;
  std::vector<double> rates_hz;
  for (const Wish& wish : wishes) {
    const auto found = std::ranges::find(all, wish.stream, &ImageStream::name);
    if (found == all.end()) {
      std::string names;
      for (const ImageStream& stream : all) names += (names.empty() ? "" : ", ") + stream.name;
      return refusal("images", wish.stream,
                     names.empty() ? "none: the scene has no sensor" : names);
    }
    if (!(wish.rate_hz >= 0.0 && std::isfinite(wish.rate_hz)))
      return refusal("images of " + wish.stream, fmt::format("{} Hz", wish.rate_hz),
                     "0 (the sensor's own rate) or more");
    streams.push_back(*found);
    ids.push_back(static_cast<StreamId>(found - all.begin()));
    rates_hz.push_back(wish.rate_hz == 0.0 ? found->rate_hz
                                           : std::min(wish.rate_hz, found->rate_hz));
  }
  return ImageConsumer(std::move(streams), std::move(ids), rates_hz, sink);
}

std::vector<ImageConsumer::Asked> ImageConsumer::ask(FrameRequest& request) {
  std::vector<Asked> asked;
  for (const PingSchedule::Due& due : schedule_.due(request.time_s)) {
    const ImageStream& stream = streams_[due.sensor];
    if (!sink_->ready(stream)) {
      ++counts_[due.sensor].dropped;
      continue;
    }
    const std::uint64_t beat = beat_at(request.time_s, stream.rate_hz);
    if (!stream.sonar)
      (void)add(request.cameras, request.camera_captures, stream);
    else if (add(request.sonars, request.sonar_captures, stream))
      request.pings.push_back(static_cast<std::uint32_t>(beat));
    asked.push_back({due.sensor, beat});
  }
  return asked;
}

Status ImageConsumer::give(const scene::Scene& scene, const std::vector<Asked>& asked,
                           FrameResult& result) {
  for (const Asked& one : asked) {
    std::optional<ImageSample> image = image_of(streams_[one.wish], scene, result);
    if (!image) continue;
    image->header = {.stream = ids_[one.wish],
                     .sequence = one.beat,
                     .captured_ns = std::llround(result.time_s * 1e9),
                     .arrived_ns = now_ns()};
    if (sink_->takes()) {
      // The sample's span stays: the pixels move, not their bytes.
      NERITIC_TRY_STATUS(sink_->take(*image, take_pixels(streams_[one.wish], scene, result)));
    } else {
      NERITIC_TRY_STATUS(sink_->accept(*image));
    }
    ++counts_[one.wish].given;
  }
  return {};
}

}  // namespace neritic::testbed
