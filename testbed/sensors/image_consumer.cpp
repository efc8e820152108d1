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

Status check_image_rate(const std::string& stream, double sensor_hz, double rate_hz) {
  constexpr double kRounding = 1e-9;  // of a rate that is 1 over a period
  if (rate_hz >= 0.0 && rate_hz <= sensor_hz * (1.0 + kRounding)) return {};
  return refusal("images of " + stream, fmt::format("{} Hz", rate_hz),
                 fmt::format("0 (the sensor's own rate) to {} Hz, which is that rate", sensor_hz));
}

ImageConsumer::ImageConsumer(std::vector<ImageStream> all, ImageSink& sink)
    : all_(std::move(all)), schedule_({}), sink_(&sink) {}

Result<ImageConsumer> ImageConsumer::create(const scene::Scene& scene,
                                            const std::vector<Wish>& wishes, ImageSink& sink) {
  ImageConsumer made(image_streams(scene), sink);
  NERITIC_TRY_STATUS(made.wish(wishes));
  return made;
}

Status ImageConsumer::check(const scene::Scene& scene, const std::vector<Wish>& wishes) {
  struct : ImageSink {
    Status accept(const ImageSample&) override { return {}; }
  } none;
  const auto made = create(scene, wishes, none);
  return made.ok() ? Status() : made.error();
}

Status ImageConsumer::wish(const std::vector<Wish>& wishes) {
  std::vector<StreamId> ids;
  std::vector<double> rates_hz;
  std::vector<Counts> counts;
  for (const Wish& wish : wishes) {
    const auto found = std::ranges::find(all_, wish.stream, &ImageStream::name);
    if (found == all_.end()) {
      std::string names;
      for (const ImageStream& stream : all_) names += (names.empty() ? "" : ", ") + stream.name;
      return refusal("images", wish.stream,
                     names.empty() ? "none: the scene has no sensor" : names);
    }
    NERITIC_TRY_STATUS(check_image_rate(wish.stream, found->rate_hz, wish.rate_hz));
    const auto id = static_cast<StreamId>(found - all_.begin());
    if (std::ranges::find(ids, id) != ids.end())
      return refusal("images", wish.stream + " twice", "each stream once");
    ids.push_back(id);
    rates_hz.push_back(wish.rate_hz == 0.0 ? found->rate_hz
                                           : std::min(wish.rate_hz, found->rate_hz));
    counts.push_back({wish.stream});
  }
  PingSchedule schedule(rates_hz, PingSchedule::Begin::kOnBeat);
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (const auto before = std::ranges::find(ids_, ids[i]); before != ids_.end())
      schedule.go_on(i, schedule_, static_cast<std::size_t>(before - ids_.begin()));
  ids_ = std::move(ids);
  schedule_ = std::move(schedule);
  counts_ = std::move(counts);
  return {};
}

std::vector<ImageConsumer::Asked> ImageConsumer::ask(FrameRequest& request) {
  std::vector<Asked> asked;
  for (const PingSchedule::Due& due : schedule_.due(request.time_s)) {
    const ImageStream& stream = all_[ids_[due.sensor]];
    if (!sink_->ready(stream)) {
      ++counts_[due.sensor].dropped;
      continue;
    }
    const std::uint64_t beat = beat_at(request.time_s, stream.rate_hz);
    if (!stream.sonar)
      (void)add(request.cameras, request.camera_captures, stream);
    else if (add(request.sonars, request.sonar_captures, stream))
      request.pings.push_back(static_cast<std::uint32_t>(beat));
    asked.push_back({ids_[due.sensor], beat});
  }
  return asked;
}

Status ImageConsumer::give(const scene::Scene& scene, const std::vector<Asked>& asked,
                           FrameResult& result) {
  for (const Asked& one : asked) {
    const auto wish = std::ranges::find(ids_, one.stream);
    if (wish == ids_.end()) continue;
    const ImageStream& stream = all_[one.stream];
    std::optional<ImageSample> image = image_of(stream, scene, result);
    if (!image) continue;
    image->header = {.stream = one.stream,
                     .sequence = one.beat,
                     .captured_ns = std::llround(result.time_s * 1e9),
                     .arrived_ns = now_ns()};
    if (sink_->takes()) {
      // The sample's span stays: the pixels move, not their bytes.
      NERITIC_TRY_STATUS(sink_->take(*image, take_pixels(stream, scene, result)));
    } else {
      NERITIC_TRY_STATUS(sink_->accept(*image));
    }
    ++counts_[static_cast<std::size_t>(wish - ids_.begin())].given;
  }
  return {};
}

}  // namespace neritic::testbed
