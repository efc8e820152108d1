#include "sonar/sidescan_from_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/refusal.hpp"

namespace neritic::sonar {
namespace {

Status check(const SeabedPicture& p, const PictureLineOptions& o) {
  const ImageF32& b = p.brightness;
  if (b.channels != 1 || b.width == 0 || b.height == 0)
    return refusal("side-scan from a picture",
                   fmt::format("{} x {} pixels of {} channels", b.width, b.height, b.channels),
                   "one channel, at least one pixel");
  if (!p.depth_m.empty() && p.depth_m.size() != b.data.size())
    return refusal("side-scan from a picture",
                   fmt::format("{} depths for {} pixels", p.depth_m.size(), b.data.size()),
                   "one a pixel");
  if (!(p.intrinsics.fx > 0.0) || !(p.intrinsics.fy > 0.0) || !std::isfinite(p.intrinsics.cx) ||
      !std::isfinite(p.intrinsics.cy))
    return refusal("side-scan from a picture",
                   fmt::format("focal lengths {}, {}", p.intrinsics.fx, p.intrinsics.fy),
                   "above 0");
  if (p.depth_m.empty() && !(p.altitude_m > 0.0 && std::isfinite(p.altitude_m)))
    return refusal("side-scan from a picture", fmt::format("altitude {} m", p.altitude_m),
                   "above 0");
  if (o.n_range == 0 || o.n_range > kMaxBins || !(o.range_min_m >= 0.0) ||
      !(o.range_max_m > o.range_min_m) || !std::isfinite(o.range_max_m))
    return refusal("side-scan from a picture",
                   fmt::format("{} bins from {} to {} m", o.n_range, o.range_min_m, o.range_max_m),
                   fmt::format("1 to {} bins, ranges from 0 or more, increasing", kMaxBins));
  if (!(o.beam_along_rad > 0.0 && o.beam_along_rad < kPi))
    return refusal("side-scan from a picture",
                   fmt::format("a beam of {} degrees along the track", degrees(o.beam_along_rad)),
                   "above 0, below 180");
  return {};
}

// Adds value to the bins of [from, to) metres of one side, in proportion.
void spread(std::vector<double>& side, const PictureLineOptions& o, double from_m, double to_m,
            double value) {
  if (!(to_m > from_m)) return;
  const double step = (o.range_max_m - o.range_min_m) / o.n_range;
  const double first = (from_m - o.range_min_m) / step, end = (to_m - o.range_min_m) / step;
  const double last = std::min(std::ceil(end), static_cast<double>(o.n_range));
  for (auto i = static_cast<std::uint32_t>(std::clamp(std::floor(first), 0.0, std::max(last, 0.0)));
       i < last; ++i)
    side[i] +=
        value * std::max(0.0, std::min(end, i + 1.0) - std::max(first, double(i))) / (end - first);
}

// The pixel's slant ranges across the track, split at the track where it lies on it.
void add_pixel(const SeabedPicture& p, const PictureLineOptions& o, std::uint32_t column,
               std::uint32_t row, double weight, std::array<std::vector<double>, 2>& sides) {
  const std::size_t at = std::size_t{row} * p.brightness.width + column;
  const double planar = p.depth_m.empty() ? p.altitude_m : double{p.depth_m[at]};
  const double value = p.brightness.data[at];
  if (!std::isfinite(planar) || planar <= 0.0 || !std::isfinite(value) || value <= 0.0) return;
  const Intrinsics& k = p.intrinsics;
  const double ahead = (row + 0.5 - k.cy) / k.fy;
  const double left = (column - k.cx) / k.fx, right = (column + 1.0 - k.cx) / k.fx;
  for (const int side : {0, 1}) {  // port, starboard
    const double near = side == 0 ? std::max(0.0, -right) : std::max(0.0, left),
                 far = side == 0 ? -left : right;
    if (!(far > near)) continue;
    const auto slant = [&](double across) {
      return planar * std::sqrt(1.0 + across * across + ahead * ahead);
    };
    const double cosine = o.incidence ? planar / slant((near + far) / 2.0) : 1.0;
    spread(sides[static_cast<std::size_t>(side)], o, slant(near), slant(far),
           value * weight * cosine * (far - near) / (right - left));
  }
}

float linear(std::uint8_t byte) {
  const double v = byte / 255.0;
  return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
}

}  // namespace

ImageF32 brightness_of(const ImageU8& picture) {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = linear(static_cast<std::uint8_t>(i));
  ImageF32 out(picture.width, picture.height, 1);
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const std::uint8_t* p = &picture.data[i * picture.channels];
    out.data[i] = picture.channels < 3
                      ? table[p[0]]
                      : 0.2126f * table[p[0]] + 0.7152f * table[p[1]] + 0.0722f * table[p[2]];
  }
  return out;
}

Result<SidescanLine> sidescan_from_picture(const SeabedPicture& picture,
                                           const PictureLineOptions& options) {
  NERITIC_TRY_STATUS(check(picture, options));
  const double reach = picture.intrinsics.fy * std::tan(options.beam_along_rad / 2.0);
  const double top = picture.intrinsics.cy - reach, bottom = picture.intrinsics.cy + reach;
  const double height = picture.brightness.height;
  if (bottom <= 0.0 || top >= height)
    return refusal(
        "side-scan from a picture", fmt::format("rows {:.1f} to {:.1f} in the beam", top, bottom),
        fmt::format("a beam that meets the picture's {} rows", picture.brightness.height));
  std::array<std::vector<double>, 2> sides{std::vector<double>(options.n_range),
                                           std::vector<double>(options.n_range)};
  double rows = 0.0;
  for (auto row = static_cast<std::uint32_t>(std::max(0.0, std::floor(top)));
       row < std::min(bottom, height); ++row) {
    const double part = std::min(bottom, row + 1.0) - std::max(top, static_cast<double>(row));
    if (!(part > 0.0)) continue;
    rows += part;
    for (std::uint32_t column = 0; column < picture.brightness.width; ++column)
      add_pixel(picture, options, column, row, part, sides);
  }
  const auto finish = [&](const std::vector<double>& side) {
    std::vector<float> out;
    for (const double v : side) out.push_back(static_cast<float>(v / rows));
    return out;
  };
  return SidescanLine{finish(sides[0]), finish(sides[1])};
}

}  // namespace neritic::sonar
