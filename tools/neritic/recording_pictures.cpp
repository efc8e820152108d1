#include "tools/neritic/recording_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::tools {
namespace {

using recording::RosMessage;
using recording::RosValue;

constexpr std::uint64_t kMostSide = 32768;
constexpr double kShown_db = 60.0;

struct MessagePicture {
  std::uint64_t width = 0, height = 0;
  std::string encoding;
  std::vector<std::byte> data;
};

std::uint64_t whole_number(const std::vector<RosValue>& values, std::optional<std::size_t> column) {
  return column ? static_cast<std::uint64_t>(recording::number_of(values[*column])) : 0;
}

template <class T>
Raster<T> raster_of(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                    std::vector<T> pixels) {
  Raster<T> out;
  out.width = width, out.height = height, out.channels = channels, out.data = std::move(pixels);
  return out;
}

template <class T>
std::vector<T> pixels_of(const MessagePicture& picture) {
  std::vector<T> out(picture.data.size() / sizeof(T));
  std::memcpy(out.data(), picture.data.data(), out.size() * sizeof(T));
  return out;
}

Status write_floats(const std::filesystem::path& path, const MessagePicture& picture, bool sonar) {
  const std::vector<float> values = pixels_of<float>(picture);
  const auto width = static_cast<std::uint32_t>(picture.width),
             height = static_cast<std::uint32_t>(picture.height);
  if (!sonar) {
    std::vector<std::uint16_t> pixels;
    for (const float metres : values) {
      const double mm = std::isfinite(metres)
                            ? std::clamp(static_cast<double>(metres) * 1e3, 0.0, 65534.0)
                            : 65535.0;
      pixels.push_back(static_cast<std::uint16_t>(std::lround(mm)));
    }
    return scene::write_png16(path, raster_of(width, height, 1, std::move(pixels)));
  }
  float most = 0.0f;
  for (const float value : values) most = std::isfinite(value) ? std::max(most, value) : most;
  std::vector<std::uint8_t> pixels;
  for (const float value : values) {
    const double db = value > 0.0f && most > 0.0f
                          ? 20.0 * std::log10(static_cast<double>(value / most))
                          : -kShown_db;
    pixels.push_back(
        static_cast<std::uint8_t>(std::clamp(255.0 * (1.0 + db / kShown_db), 0.0, 255.0)));
  }
  return scene::write_png8(path, raster_of(width, height, 1, std::move(pixels)));
}

}  // namespace

bool is_picture(const std::string& type_name) {
  return type_name == "sensor_msgs/msg/Image" ||
         type_name == "marine_acoustic_msgs/msg/ProjectedSonarImage";
}

Status write_message_picture(const std::filesystem::path& path, const std::string& topic,
                             const std::string& type_name, const RosMessage& type,
                             std::span<const std::byte> message) {
  const bool sonar = type_name != "sensor_msgs/msg/Image";
  const auto values = type.read(message);
  const auto data = type.column(sonar ? "image_data" : "data");
  const auto bytes = data ? type.read_bytes(message, *data) : std::nullopt;
  if (!values || !bytes) return bad_input("{}: a message that does not fit its schema", topic);
  MessagePicture picture{0, 0, {}, *bytes};
  if (sonar) {
    constexpr std::uint64_t kFloat32 = 8;
    const auto ranges = type.column("ranges");
    picture.width = whole_number(*values, type.column("image_beam_count"));
    picture.height = ranges ? std::get<std::vector<double>>((*values)[*ranges]).size() : 0;
    if (whole_number(*values, type.column("image_dtype")) == kFloat32) picture.encoding = "32FC1";
  } else {
    picture.width = whole_number(*values, type.column("width"));
    picture.height = whole_number(*values, type.column("height"));
    if (const auto at = type.column("encoding"))
      if (const auto* text = std::get_if<std::string>(&(*values)[*at])) picture.encoding = *text;
  }
  const auto fits = [&](std::uint64_t pixel_bytes) {
    return picture.width > 0 && picture.height > 0 && picture.width <= kMostSide &&
           picture.height <= kMostSide &&
           picture.data.size() == picture.width * picture.height * pixel_bytes;
  };
  const auto width = static_cast<std::uint32_t>(picture.width),
             height = static_cast<std::uint32_t>(picture.height);
  if (picture.encoding == "32FC1" && fits(4)) return write_floats(path, picture, sonar);
  if (picture.encoding == "rgb8" && fits(3))
    return scene::write_png8(path, raster_of(width, height, 3, pixels_of<std::uint8_t>(picture)));
  if (picture.encoding == "mono8" && fits(1))
    return scene::write_png8(path, raster_of(width, height, 1, pixels_of<std::uint8_t>(picture)));
  if ((picture.encoding == "mono16" || picture.encoding == "16UC1") && fits(2))
    return scene::write_png16(path, raster_of(width, height, 1, pixels_of<std::uint16_t>(picture)));
  return refusal(topic,
                 fmt::format("a picture of '{}', {} x {}, {} bytes", printable(picture.encoding),
                             picture.width, picture.height, picture.data.size()),
                 "rgb8, mono8, mono16 or 32FC1 with as many bytes as pixels");
}

}  // namespace neritic::tools
