#include "engine/draw2d/color_maps.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "engine/core/check.hpp"

namespace neritic::draw2d {
namespace {

constexpr std::array<Color, 6> kCopper{{{0.055f, 0.035f, 0.022f},
                                        {0.30f, 0.125f, 0.045f},
                                        {0.62f, 0.285f, 0.075f},
                                        {0.89f, 0.52f, 0.16f},
                                        {0.99f, 0.80f, 0.42f},
                                        {1.0f, 0.975f, 0.88f}}};
constexpr std::array<Color, 6> kBronze{{{0.02f, 0.012f, 0.006f},
                                        {0.22f, 0.11f, 0.035f},
                                        {0.50f, 0.28f, 0.08f},
                                        {0.80f, 0.52f, 0.17f},
                                        {0.97f, 0.80f, 0.42f},
                                        {1.0f, 0.97f, 0.85f}}};
constexpr std::array<Color, 7> kEcho{{{0.015f, 0.025f, 0.075f},
                                      {0.05f, 0.13f, 0.42f},
                                      {0.06f, 0.47f, 0.72f},
                                      {0.10f, 0.68f, 0.36f},
                                      {0.94f, 0.87f, 0.18f},
                                      {0.93f, 0.36f, 0.10f},
                                      {0.62f, 0.05f, 0.09f}}};
constexpr std::array<Color, 7> kDepth{{{0.27f, 0.12f, 0.45f},
                                       {0.15f, 0.28f, 0.68f},
                                       {0.14f, 0.58f, 0.78f},
                                       {0.30f, 0.76f, 0.56f},
                                       {0.80f, 0.85f, 0.36f},
                                       {0.96f, 0.64f, 0.26f},
                                       {0.80f, 0.24f, 0.18f}}};

std::span<const Color> stops_of(ColorMap map) {
  switch (map) {
    case ColorMap::kCopper:
      return kCopper;
    case ColorMap::kBronze:
      return kBronze;
    case ColorMap::kEcho:
      return kEcho;
    case ColorMap::kDepth:
      return kDepth;
  }
  NERITIC_CHECK(false, "colour map {}", static_cast<int>(map));
  return {};
}

}  // namespace

Color map_color(ColorMap map, double value) {
  const auto stops = stops_of(map);
  const double clamped = value > 0.0 ? std::min(value, 1.0) : 0.0;
  const double at = clamped * static_cast<double>(stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  return mix(stops[i], stops[i + 1], static_cast<float>(at - static_cast<double>(i)));
}

}  // namespace neritic::draw2d
