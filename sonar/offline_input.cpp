#include "sonar/offline_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/refusal.hpp"

namespace neritic::sonar {
namespace {

// "ViewLayer.Depth.Z" is channel Z of the layer "ViewLayer.Depth".
std::string layer_of(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot);
}
std::string proper_name_of(const std::string& channel) {
  return channel.substr(channel.rfind('.') + 1);
}

// The channel of that name in that layer.
std::optional<std::uint32_t> channel_in(const MapFile& map, const std::string& layer,
                                        const std::string& name) {
  const std::string whole = layer.empty() ? name : layer + "." + name;
  const auto at = std::find(map.channel_names.begin(), map.channel_names.end(), whole);
  if (at == map.channel_names.end()) return std::nullopt;
  return static_cast<std::uint32_t>(at - map.channel_names.begin());
}

// Is it grey, kept as colour? Alpha does not count.
bool is_grey(const MapFile& map) {
  if (map.channels == 2) return map.coding != MapFile::Coding::kNumbers;
  for (std::size_t i = 0; i < map.pixels(); ++i)
    for (std::uint32_t c = 1; c < 3; ++c) {
      const double first = map.at(i, 0), other = map.at(i, c);
      if (first != other && !(std::isnan(first) && std::isnan(other))) return false;
    }
  return true;
}

// The channel that holds depth: named so in an EXR, in whatever layer (not beside an X: that is a
// vector's), else the first of a grey image.
Result<std::uint32_t> depth_channel(const MapFile& map) {
  if (map.palette) return refusal(map.path, "a palette's indices", "grey numbers as depth");
  for (const char* name : {"Z", "depth", "V", "Y"}) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t c = 0; c < map.channel_names.size(); ++c)
      if (proper_name_of(map.channel_names[c]) == name &&
          !channel_in(map, layer_of(map.channel_names[c]), "X"))
        found.push_back(c);
    if (found.size() > 1)
      return refusal(map.path,
                     fmt::format("channels {} and {}", map.channel_names[found[0]],
                                 map.channel_names[found[1]]),
                     "one channel of depth");
    if (!found.empty()) return found[0];
  }
  if (map.channels > 1 && !is_grey(map))
    return refusal(map.path, fmt::format("{} channels that differ", map.channels),
                   "one channel of depth (in an EXR also Z, depth, V or Y of any layer)");
  return 0u;
}

// The channels that hold a vector: of an EXR the layer of X, Y and Z, else the one of R, G and B;
// else the first three.
Result<std::array<std::uint32_t, 3>> normal_channels(const MapFile& map) {
  if (map.channels < 3)
    return refusal(map.path, fmt::format("{} channels", map.channels), "x, y and z");
  for (const auto& names : {std::array{"X", "Y", "Z"}, {"R", "G", "B"}}) {
    std::vector<std::array<std::uint32_t, 3>> found;
    for (std::uint32_t c = 0; c < map.channel_names.size(); ++c) {
      if (proper_name_of(map.channel_names[c]) != names[0]) continue;
      const std::string layer = layer_of(map.channel_names[c]);
      const auto y = channel_in(map, layer, names[1]), z = channel_in(map, layer, names[2]);
      if (y && z) found.push_back({c, *y, *z});
    }
    if (found.size() > 1)
      return refusal(map.path,
                     fmt::format("vectors {} and {}", map.channel_names[found[0][0]],
                                 map.channel_names[found[1][0]]),
                     "one");
    if (!found.empty()) return found[0];
  }
  return std::array{0u, 1u, 2u};
}

Status check_size(const MapFile& depth, const MapFile& other) {
  if (other.width == depth.width && other.height == depth.height) return {};
  return refusal(other.path, fmt::format("{} x {} pixels", other.width, other.height),
                 fmt::format("{} x {}, the size of {}", depth.width, depth.height, depth.path));
}

Vec3 to_sonar_axes(const Vec3& n, NormalAxes axes) {
  switch (axes) {
    case NormalAxes::kOpencv:
      return {n.x, -n.y, -n.z};
    case NormalAxes::kRos:
      return {-n.y, n.z, -n.x};
    case NormalAxes::kOpengl:
      break;
  }
  return n;
}

// The value of each code of a channel; empty if the map holds numbers.
std::vector<double> decode_table(MapFile::Coding coding, double gamma) {
  if (coding == MapFile::Coding::kNumbers) return {};
  std::vector<double> table(coding == MapFile::Coding::kCoded8 ? 256 : 65536);
  const double max = static_cast<double>(table.size() - 1);
  for (std::size_t code = 0; code < table.size(); ++code)
    table[code] = decode_normal(static_cast<double>(code), max, gamma);
  return table;
}

std::vector<double> normals_of(const MapFile& map, const std::array<std::uint32_t, 3>& channels,
                               const OfflineOptions& options) {
  std::vector<double> out(3 * map.pixels());
  const std::vector<double> table = decode_table(map.coding, options.gamma);
  for (std::size_t i = 0; i < map.pixels(); ++i) {
    Vec3 n(map.at(i, channels[0]), map.at(i, channels[1]), map.at(i, channels[2]));
    if (!table.empty())
      for (int k = 0; k < 3; ++k) n[k] = table[static_cast<std::size_t>(n[k])];
    // A marker of "unknown" stays one in any axes.
    if (n != Vec3(-1.0)) {
      if (options.world_from_camera) n = glm::transpose(*options.world_from_camera) * n;
      n = to_sonar_axes(n, options.axes);
    }
    std::copy_n(&n[0], 3, &out[3 * i]);
  }
  return out;
}

Result<std::vector<std::uint16_t>> labels_of(const MapFile& map) {
  if (map.channels > 1 && !is_grey(map))
    return refusal(map.path, fmt::format("{} channels that differ", map.channels),
                   "one channel of class numbers (of a PNG with a palette, its indices)");
  std::vector<std::uint16_t> out(map.pixels());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double value = map.at(i, 0);
    if (!(value >= 0.0 && value <= 65535.0 && value == std::floor(value)))
      return refusal(
          map.path,
          fmt::format("label {:g} at column {}, row {}", value, i % map.width, i / map.width),
          "a whole number from 0 to 65535");
    out[i] = static_cast<std::uint16_t>(value);
  }
  return out;
}

}  // namespace

double decode_normal(double code, double max, double gamma) {
  return 2.0 * std::pow(code / max, gamma) - 1.0;
}

Result<SonarInput> make_input(const MapFile& depth, const MapFile* normals, const MapFile* labels,
                              const Intrinsics& intrinsics, const OfflineOptions& options,
                              NormalEstimate* estimate) {
  SonarInput in;
  in.width = depth.width;
  in.height = depth.height;
  in.intrinsics = intrinsics;
  in.depth_is_range = options.depth_kind == DepthKind::kRange;
  in.normals_face_sensor = options.normals_face_sensor;
  NERITIC_TRY(const std::uint32_t channel, depth_channel(depth));
  in.depth.resize(depth.pixels());
  for (std::size_t i = 0; i < in.depth.size(); ++i) {
    const double stored = depth.at(i, channel) * options.depth_scale;
    if (options.depth_kind != DepthKind::kDisparity)
      in.depth[i] = stored;
    else if (stored > 0.0)  // else nothing was matched
      in.depth[i] = intrinsics.fx * options.baseline_m / stored;
  }
  if (normals != nullptr) {
    NERITIC_TRY_STATUS(check_size(depth, *normals));
    NERITIC_TRY(const auto channels, normal_channels(*normals));
    in.normals = normals_of(*normals, channels, options);
  } else {
    DepthNormals made = normals_from_depth(in);
    in.normals = std::move(made.normals);
    in.normals_face_sensor = true;
    if (estimate != nullptr) *estimate = made.estimate;
  }
  if (labels != nullptr) {
    NERITIC_TRY_STATUS(check_size(depth, *labels));
    NERITIC_TRY(in.labels, labels_of(*labels));
  }
  NERITIC_TRY_STATUS(validate(in));
  return in;
}

}  // namespace neritic::sonar
