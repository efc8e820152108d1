#include "testbed/server/client_mail.hpp"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "engine/net/message_pack.hpp"

namespace neritic::testbed {
namespace {

using nlohmann::json;

template <class T>
void append(std::vector<std::byte>& out, T value) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

json facts_of(const WorldImage& image) {
  constexpr const char* kTypes[] = {"<u1", "<u2", "<f4"};
  return {{"stream", image.stream},
          {"sequence", image.sequence},
          {"stamp_ns", image.stamp_ns},
          {"arrival_ns", image.arrival_ns},
          {"shape", {image.height, image.width, image.channels}},
          {"type", kTypes[image.pixels.index()]},
          {"position", image.position},
          {"orientation", image.orientation},
          {"intrinsics", image.intrinsics},
          {"range_m", image.range_m},
          {"azimuth", image.azimuth},
          {"elevation", image.elevation}};
}

}  // namespace

void NewestTable::put(const Reading& reading) {
  if (reading.stream >= rows_.size()) return;
  rows_[reading.stream] = {reading, ++version_};
}

std::vector<Reading> NewestTable::after(std::uint64_t& version) const {
  std::vector<Reading> readings;
  for (const Row& row : rows_)
    if (row.version > version) readings.push_back(row.reading);
  version = version_;
  return readings;
}

json add_rows(std::span<const Reading> readings, Outgoing& message) {
  std::size_t columns = 0;
  for (const Reading& one : readings) columns = std::max<std::size_t>(columns, one.count);
  std::vector<std::byte> bytes;
  bytes.reserve(readings.size() * (32 + 8 * columns));
  for (const Reading& one : readings) {
    append(bytes, one.stream);
    append(bytes, one.count);
    append(bytes, one.sequence);
    append(bytes, one.stamp_ns);
    append(bytes, one.arrival_ns);
    for (std::size_t i = 0; i < columns; ++i) append(bytes, i < one.count ? one.values[i] : 0.0);
  }
  message.frames.push_back(std::move(bytes));
  return {{"rows", readings.size()}, {"columns", columns}, {"frame", message.frames.size() - 1}};
}

void ClientMail::put(const Reading& reading) {
  if (readings_.size() >= kMostKept) {
    readings_.pop_front();
    ++lost_readings_;
  }
  readings_.push_back(reading);
}

void ClientMail::put(const WorldImage& image, std::optional<std::uint64_t> position) {
  const auto drop = [&](std::deque<Image>::iterator at) {
    image_bytes_ -= at->bytes.size();
    ++lost_images_;
    return images_.erase(at);
  };
  if (!images.at(image.stream))
    for (auto at = images_.begin(); at != images_.end();)
      at = at->stream == image.stream ? drop(at) : at + 1;
  Image entry{image.stream, net::pack(facts_of(image)), position, {}};
  if (!position) {
    const auto bytes = image.bytes();
    if (bytes.size() > kMostImageBytes) {
      ++lost_images_;
      return;
    }
    entry.bytes.assign(bytes.begin(), bytes.end());
  }
  image_bytes_ += entry.bytes.size();
  images_.push_back(std::move(entry));
  while (image_bytes_ > kMostImageBytes || images_.size() > kMostKept) drop(images_.begin());
}

bool ClientMail::any(const NewestTable& newest) const {
  return !readings_.empty() || !images_.empty() || newest.version() > seen;
}

void ClientMail::take(const NewestTable& newest, json& map, Outgoing& message) {
  const std::vector<Reading> changed = newest.after(seen);
  if (!changed.empty()) map["newest"] = add_rows(changed, message);
  if (!readings_.empty()) {
    const std::vector<Reading> all(readings_.begin(), readings_.end());
    readings_.clear();
    map["arrived"] = add_rows(all, message);
  }
  if (!images_.empty()) {
    json& list = map["images"] = json::array();
    for (Image& image : images_) {
      json facts = net::unpack(image.facts).value();
      if (image.position) {
        facts["shared"] = *image.position;
      } else {
        message.frames.push_back(std::move(image.bytes));
        facts["frame"] = message.frames.size() - 1;
      }
      list.push_back(std::move(facts));
    }
    images_.clear();
    image_bytes_ = 0;
  }
  if (lost_readings_ > 0) map["lost_readings"] = lost_readings_;
  if (lost_images_ > 0) map["lost_images"] = lost_images_;
}

}  // namespace neritic::testbed
