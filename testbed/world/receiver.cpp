#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/core/ros_frames.hpp"
#include "testbed/world/ros_samples.hpp"
#include "testbed/world/world_parts.hpp"

namespace neritic::testbed {

Receiver::Receiver(const PhysicsWorld& world, std::uint64_t seed, std::size_t streams)
    : recording(world),
      links(streams),
      newest(world.streams().size()),
      kept(streams, 0),
      outputs_(OutputSamples::all(world)),
      seed_(seed),
      newest_image_ns_(streams) {}

Status Receiver::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) {
  // The next loop begins with the step that the last one ended with.
  if (last_step_ == step.step) return {};
  last_step_ = step.step;
  NERITIC_TRY_STATUS(recording.accept(step, outputs));
  receive(outputs, step.scene_from_host_ns());
  deliver(std::llround(step.time_s * 1e9));
  return {};
}

void Receiver::receive(std::span<const Sample> outputs, TimeNs shift_ns) {
  for (const Sample& sample : outputs) {
    const SampleHeader& header = sample.header;
    const LinkOptions& link = links[header.stream];
    const auto arrival_ns =
        arrival_of(link, seed_, header.stream, header.sequence, header.arrived_ns + shift_ns);
    if (!arrival_ns) continue;
    Reading reading{.stream = header.stream,
                    .sequence = header.sequence,
                    .stamp_ns = header.captured_ns + shift_ns,
                    .arrival_ns = *arrival_ns};
    reading.count = static_cast<std::uint32_t>(ros::write_values(sample.payload, reading.values));
    if (!link.direct()) {
      readings_.send(*arrival_ns, reading);
      continue;
    }
    // In the order of arrival among all streams, whatever steps a tick has.
    while (readings_.due(*arrival_ns)) arrive(readings_.take());
    arrive(reading);
  }
}

void Receiver::arrive(const Reading& reading) {
  // One that was overtaken on its way comes, and is not the newest.
  Reading& last = newest[reading.stream];
  if (last.count == 0 ||
      std::pair(reading.stamp_ns, reading.sequence) >= std::pair(last.stamp_ns, last.sequence))
    last = reading;
  if (!kept[reading.stream]) return;
  if (arrived.size() == World::kMostKept) {
    arrived.pop_front();
    ++dropped;
  }
  arrived.push_back(reading);
}

void Receiver::take(WorldImage image) {
  const LinkOptions& link = links[image.stream];
  const auto arrival_ns = arrival_of(link, seed_, image.stream, image.sequence, image.arrival_ns);
  if (!arrival_ns) return;
  image.arrival_ns = *arrival_ns;
  auto kept_image = std::make_unique<WorldImage>(std::move(image));
  if (!link.direct()) return images_.send(*arrival_ns, std::move(kept_image));
  while (images_.due(*arrival_ns)) arrive(images_.take());
  arrive(std::move(kept_image));
}

void Receiver::arrive(std::unique_ptr<WorldImage> image) {
  // Without someone who wants them all the newest makes the one before it go, and one that it has
  // overtaken.
  std::optional<TimeNs>& last_ns = newest_image_ns_[image->stream];
  const bool overtaken = last_ns && image->stamp_ns < *last_ns;
  if (!kept[image->stream]) {
    if (overtaken) return;
    std::erase_if(images, [&](const auto& one) { return one->stream == image->stream; });
  }
  if (!overtaken) last_ns = image->stamp_ns;
  constexpr std::size_t kMostImages = 64;
  if (images.size() == kMostImages) {
    images.pop_front();
    ++dropped;
  }
  images.push_back(std::move(image));
}

void Receiver::deliver(TimeNs now_ns) {
  while (readings_.due(now_ns)) arrive(readings_.take());
  while (images_.due(now_ns)) arrive(images_.take());
}

void Receiver::forget(std::optional<std::uint64_t> seen) {
  for (Reading& reading : newest) reading = {};
  arrived.clear();
  images.clear();
  readings_.clear();
  images_.clear();
  std::ranges::fill(newest_image_ns_, std::nullopt);
  last_step_ = seen;
}

Status ImageReceiver::accept(const ImageSample& image) {
  const auto copied = [&]<class T>(std::vector<T> pixels) -> ImagePixels {
    pixels.resize(image.data.size() / sizeof(T));
    std::memcpy(pixels.data(), image.data.data(), pixels.size() * sizeof(T));
    return pixels;
  };
  switch (image.stream->kind) {
    case ImageKind::kColor:
      return take(image, copied(std::vector<std::uint8_t>()));
    case ImageKind::kLabels:
    case ImageKind::kInstances:
    case ImageKind::kEchoLabels:
      return take(image, copied(std::vector<std::uint16_t>()));
    default:
      return take(image, copied(std::vector<float>()));
  }
}

Status ImageReceiver::take(const ImageSample& image, ImagePixels pixels) {
  WorldImage out{.stream = first_ + image.header.stream,
                 .sequence = image.header.sequence,
                 .stamp_ns = image.header.captured_ns,
                 // Simulated time, as of readings: the image is there when its step is.
                 .arrival_ns = image.header.captured_ns,
                 .width = image.width,
                 .height = image.height,
                 .pixels = std::move(pixels)};
  const auto bytes = image.data.size();
  const std::uint32_t pixel_bytes = type_of(image.stream->kind).pixel_bytes;
  NERITIC_CHECK(bytes == std::size_t{pixel_bytes} * out.width * out.height, "{} bytes", bytes);
  const std::size_t item = std::visit([](const auto& v) { return sizeof v[0]; }, out.pixels);
  out.channels = static_cast<std::uint32_t>(pixel_bytes / item);
  const Pose& pose = image.world_from_frame;
  const Vec3 at = ros::enu_from_world(pose.position_m);
  out.position = {at.x, at.y, at.z};
  const bool echoes =
      image.stream->kind == ImageKind::kEchoes || image.stream->kind == ImageKind::kEchoLabels;
  out.orientation =
      ros::xyzw(echoes ? ros::enu_from_body(pose.rotation) : ros::enu_from_optical(pose.rotation));
  if (image.view) {
    const Intrinsics& pinhole = image.view->intrinsics;
    out.intrinsics = {pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy};
  }
  if (image.sonar) {
    const sonar::Limits& limits = image.sonar->grid.limits;
    out.range_m = {limits.range_min_m, limits.range_max_m};
    // Columns go from port to starboard: from the most positive angle to the least.
    out.azimuth = {-limits.azimuth_min_rad, -limits.azimuth_max_rad};
    out.elevation = {limits.elevation_min_rad, limits.elevation_max_rad};
  }
  receiver_.take(std::move(out));
  return {};
}

std::span<const std::byte> WorldImage::bytes() const {
  return std::visit([](const auto& data) { return std::as_bytes(std::span(data)); }, pixels);
}

}  // namespace neritic::testbed
