#include "testbed/output/pictures.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

std::uint8_t byte_of(double unit) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(unit, 0.0, 1.0) * 255.0));
}

void set_rgb(ImageU8& image, std::size_t pixel, const Rgb& color) {
  std::copy(color.begin(), color.end(), image.data.begin() + std::ptrdiff_t(3 * pixel));
}

Rgb rgb(double r, double g, double b) {
  return {byte_of(r), byte_of(g), byte_of(b)};
}

// Hue in turns, saturation, value.
Rgb of_hue(double hue, double saturation, double value) {
  const auto channel = [&](double shift) {
    const double h = std::fmod(hue + shift, 1.0) * 6.0;
    const double ramp = std::clamp(std::abs(h - 3.0) - 1.0, 0.0, 1.0);
    return value * (1.0 - saturation + saturation * ramp);
  };
  return rgb(channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0));
}

}  // namespace

std::optional<std::pair<double, double>> depth_span(const ImageF32& depth_m) {
  double nearest = INFINITY, farthest = 0.0;
  for (const float d : depth_m.data)
    if (std::isfinite(d) && d > 0.0f) {
      nearest = std::min<double>(nearest, d);
      farthest = std::max<double>(farthest, d);
    }
  if (farthest == 0.0) return std::nullopt;
  return std::pair{nearest, farthest};
}

ImageU8 depth_picture(const ImageF32& depth_m) {
  ImageU8 out(depth_m.width, depth_m.height, 3);
  const auto shown = depth_span(depth_m);
  if (!shown) return out;
  const auto [nearest, farthest] = *shown;
  const double span = std::max(std::log(farthest / nearest), 1e-6);
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    const double d = depth_m.data[i];
    if (!std::isfinite(d) || d <= 0.0) continue;
    const double t = 1.0 - std::log(d / nearest) / span;
    set_rgb(
        out, i,
        rgb(0.08 + 0.92 * t * t, 0.10 + 0.80 * t, 0.25 + 0.50 * std::sqrt(t) * (1.2 - 0.6 * t)));
  }
  return out;
}

ImageU8 normals_picture(const ImageF32& normals) {
  ImageU8 out(normals.width, normals.height, 3);
  for (std::size_t i = 0; i < out.data.size() / 3; ++i) {
    const float* n = &normals.data[3 * i];
    if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f) continue;
    set_rgb(out, i, rgb(0.5 + 0.5 * n[0], 0.5 + 0.5 * n[1], 0.5 + 0.5 * n[2]));
  }
  return out;
}

Rgb label_color(std::uint16_t label) {
  if (label == 0) return {0, 0, 0};
  if (label == sonar::kShadow) return rgb(0.22, 0.22, 0.26);
  if (label == sonar::kGhost) return rgb(0.8, 0.8, 0.8);
  // Steps of the golden ratio round the colour circle keep neighbours in number apart in hue.
  return of_hue(std::fmod(label * 0.61803398875, 1.0), 0.65, 0.9);
}

ImageU8 labels_picture(const ImageU16& labels) {
  ImageU8 out(labels.width, labels.height, 3);
  for (std::size_t i = 0; i < labels.data.size(); ++i)
    if (labels.data[i]) set_rgb(out, i, label_color(labels.data[i]));
  return out;
}

ImageU8 motion_picture(const ImageF32& motion_px) {
  ImageU8 out(motion_px.width, motion_px.height, 3);
  double longest = 1e-6;
  for (std::size_t i = 0; i + 1 < motion_px.data.size(); i += 2)
    longest = std::max<double>(longest, std::hypot(motion_px.data[i], motion_px.data[i + 1]));
  for (std::size_t i = 0; i < out.data.size() / 3; ++i) {
    const double x = motion_px.data[2 * i], y = motion_px.data[2 * i + 1];
    if (!std::isfinite(x + y)) continue;
    const double turn = std::atan2(y, x) / (2.0 * kPi) + 0.5;
    set_rgb(out, i, of_hue(turn, 0.8, std::sqrt(std::hypot(x, y) / longest)));
  }
  return out;
}

ImageU8 resized(const ImageU8& image, std::uint32_t width, std::uint32_t height) {
  ImageU8 out(width, height, image.channels);
  for (std::uint32_t y = 0; y < height; ++y) {
    const std::uint32_t y0 = std::uint64_t{y} * image.height / height;
    const std::uint32_t y1 =
        std::max<std::uint32_t>(y0 + 1, std::uint64_t{y + 1} * image.height / height);
    for (std::uint32_t x = 0; x < width; ++x) {
      const std::uint32_t x0 = std::uint64_t{x} * image.width / width;
      const std::uint32_t x1 =
          std::max<std::uint32_t>(x0 + 1, std::uint64_t{x + 1} * image.width / width);
      for (std::uint32_t c = 0; c < image.channels; ++c) {
        std::uint64_t sum = 0;
        for (std::uint32_t v = y0; v < y1; ++v)
          for (std::uint32_t u = x0; u < x1; ++u) sum += image.at(u, v, c);
        const std::uint64_t count = std::uint64_t{y1 - y0} * (x1 - x0);
        out.at(x, y, c) = static_cast<std::uint8_t>((sum + count / 2) / count);
      }
    }
  }
  return out;
}

}  // namespace neritic::testbed
