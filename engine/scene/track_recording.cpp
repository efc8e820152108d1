#include "engine/scene/track_recording.hpp"

#include <cmath>
#include <map>

#include "engine/core/refusal.hpp"
#include "engine/core/ros_frames.hpp"
#include "engine/core/text.hpp"
#include "engine/recording/cdr.hpp"
#include "engine/recording/mcap_reader.hpp"

namespace neritic::scene {
namespace {

constexpr std::string_view kOdometry = "/odometry";
constexpr double kFarthestPlace_m = 4e7;

class OdometryReader final : public recording::McapVisitor {
 public:
  explicit OdometryReader(const std::string& participant) : wanted_(participant + "/odometry") {}

  Status channel(std::uint16_t id, const recording::McapChannel& channel) override {
    for (const auto& [key, value] : channel.metadata)
      if (key == "stream" && value.ends_with(kOdometry)) {
        names_[id] = value;
        if (value == wanted_) wanted_ids_[id] = true;
      }
    return {};
  }
  Status message(const recording::McapMessage& message) override {
    if (!wanted_ids_.contains(message.channel)) return {};
    recording::CdrReader in(message.data);
    const auto seconds = in.number<std::int32_t>();
    const auto nanoseconds = in.number<std::uint32_t>();
    in.text(), in.text();  // the frames
    const double x = in.number<double>(), y = in.number<double>(), z = in.number<double>();
    const double qx = in.number<double>(), qy = in.number<double>();
    const double qz = in.number<double>(), qw = in.number<double>();
    const double time_s = seconds + 1e-9 * nanoseconds;
    const Quat q(qw, qx, qy, qz);
    const double length = glm::length(q);
    const bool good = in.whole() && std::abs(x) <= kFarthestPlace_m &&
                      std::abs(y) <= kFarthestPlace_m && std::abs(z) <= kFarthestPlace_m &&
                      std::abs(length - 1.0) <= 1e-3;
    if (!good) return bad_input("a place of {} that is none", wanted_);
    if (!track.places.empty() && !(time_s > track.places.back().time_s)) return {};
    if (track.places.size() == kMostRecordedPlaces)
      return bad_input("more than {} places of {}", kMostRecordedPlaces, wanted_);
    track.places.push_back({time_s, ros::world_from_enu({x, y, z})});
    track.attitudes.push_back({time_s, glm::normalize(ros::body_from_enu(q))});
    return {};
  }
  std::string names() const {
    constexpr int kMostNamed = 20;
    std::string all;
    int named = 0;
    for (const auto& [id, name] : names_) {
      if (++named > kMostNamed) return all + " ...";
      all += (all.empty() ? "" : ", ") + printable(name.substr(0, name.size() - kOdometry.size()));
    }
    return all.empty() ? "none: it has no odometry" : all;
  }

  Track track;

 private:
  std::string wanted_;
  std::map<std::uint16_t, std::string> names_;
  std::map<std::uint16_t, bool> wanted_ids_;
};

}  // namespace

Result<Track> read_recorded_track(const std::filesystem::path& file,
                                  const std::string& participant) {
  NERITIC_TRY(const auto source, recording::open_mcap(file));
  OdometryReader reader(participant);
  NERITIC_TRY_STATUS(recording::read_mcap(*source, file.string(), reader));
  if (reader.track.places.size() < 2)
    return refusal(
        file.string(),
        fmt::format("{} places of '{}'", reader.track.places.size(), printable(participant)),
        reader.names());
  return std::move(reader.track);
}

}  // namespace neritic::scene
