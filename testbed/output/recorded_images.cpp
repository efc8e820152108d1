#include "testbed/output/recorded_images.hpp"

#include <cmath>

#include "engine/core/ros_frames.hpp"
#include "engine/recording/cdr.hpp"
#include "engine/recording/ros_types.hpp"

namespace neritic::testbed {
namespace {

using recording::CdrWriter;

void put_image(CdrWriter& cdr, const ImageSample& image) {
  const ImageType& type = type_of(image.stream->kind);
  cdr.number(image.height);
  cdr.number(image.width);
  cdr.text(type.encoding);
  cdr.number(std::uint8_t{0});
  cdr.number(image.width * type.pixel_bytes);
  cdr.count(image.data.size());
  cdr.bytes(image.data);
}

// z is forward, x up and so y to starboard; rows are ranges, nearest first.
void put_echoes(CdrWriter& cdr, const ImageSample& image) {
  constexpr std::uint32_t kFloat32 = 8;
  const SonarFrame& sonar = *image.sonar;
  const double elevation_rad =
      sonar.grid.limits.elevation_max_rad - sonar.grid.limits.elevation_min_rad;
  cdr.number(sonar.terms.frequency_hz);
  cdr.number(sonar.sound_speed_m_s);
  cdr.count(image.width);
  for (std::uint32_t i = 0; i < image.width; ++i) cdr.number(static_cast<float>(elevation_rad));
  cdr.count(image.width);
  for (std::uint32_t i = 0; i < image.width; ++i)
    cdr.number(static_cast<float>(sonar.grid.azimuth_step_rad()));
  cdr.count(image.width);
  for (std::uint32_t i = 0; i < image.width; ++i) {
    const double azimuth_rad = sonar.grid.azimuth_rad(i);
    cdr.vector({0.0, std::sin(azimuth_rad), std::cos(azimuth_rad)});
  }
  cdr.count(image.height);
  for (std::uint32_t i = 0; i < image.height; ++i)
    cdr.number(static_cast<float>(sonar.grid.range_m(i)));
  cdr.number(std::uint8_t{0});
  cdr.number(kFloat32);
  cdr.number(image.width);
  cdr.count(image.data.size());
  cdr.bytes(image.data);
}

std::string topic_from(const std::string& stream) {
  std::string topic = "/";
  for (const char c : stream)
    topic += (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '/'
                 ? c
                 : '_';
  return topic;
}

}  // namespace

std::uint16_t RecordedImages::channel(const std::string& topic, const char* type,
                                      const std::string& stream) {
  if (const auto at = channels_.find(topic); at != channels_.end()) return at->second;
  auto schema = schemas_.find(type);
  if (schema == schemas_.end())
    schema = schemas_.emplace(type, out_.add_schema(recording::ros_schema(type))).first;
  const std::uint16_t id =
      out_.add_channel({schema->second, topic, "cdr", {{"stream", stream}, {"way", "out"}}});
  channels_.emplace(topic, id);
  return id;
}

Status RecordedImages::accept(const ImageSample& image) {
  const ImageStream& stream = *image.stream;
  const auto at_ns = static_cast<std::uint64_t>(std::max<TimeNs>(image.header.captured_ns, 0));
  const auto sequence = static_cast<std::uint32_t>(image.header.sequence);
  const bool echoes = stream.kind == ImageKind::kEchoes && image.sonar != nullptr;
  std::string bytes;
  CdrWriter cdr(bytes);
  cdr.header(image.header.captured_ns, topic_from(stream.frame_id).substr(1));
  echoes ? put_echoes(cdr, image) : put_image(cdr, image);
  out_.message(
      {channel(topic_from(stream.name),
               echoes ? "marine_acoustic_msgs/msg/ProjectedSonarImage" : "sensor_msgs/msg/Image",
               stream.name),
       sequence, at_ns, at_ns, std::as_bytes(std::span(bytes))});
  // Once, however many images are taken from there.
  const auto [said, first] = poses_.try_emplace(stream.frame_id, image.header.sequence);
  if (!first && said->second == image.header.sequence) return {};
  said->second = image.header.sequence;
  std::string pose;
  CdrWriter out(pose);
  out.header(image.header.captured_ns, "map");
  out.vector(ros::enu_from_world(image.world_from_frame.position_m));
  out.quaternion(ros::enu_from_optical(image.world_from_frame.rotation));
  const std::string topic = topic_from(stream.frame_id) + "/pose";
  out_.message({channel(topic, "geometry_msgs/msg/PoseStamped", stream.frame_id + "/pose"),
                sequence, at_ns, at_ns, std::as_bytes(std::span(pose))});
  return {};
}

}  // namespace neritic::testbed
