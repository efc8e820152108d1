#include "engine/scene/picture_detail.hpp"

#include <algorithm>
#include <array>

#include "engine/core/check.hpp"

namespace neritic::scene {
namespace {

// Errors: `neritic tradeoff camera`, see engine/render/TRADE.md.
constexpr std::array<PictureLevel, 3> kLevels{{
    {"draft",
     {.resolution = 0.4,
      .shadow_size = 0.5,
      .cascades = 2,
      .shadow_samples = 5,
      .visibility_step = 3,
      .mesh_error = 1.0,
      .occlusion_samples = 0.5,
      .inscatter_samples = 1,
      .waves = 8,
      .shaft_samples = 0.5,
      .particles = 0.5},
     0.065},
    {"standard", {}, 0.03},
    {"reference",
     {.resolution = 2.0,
      .shadow_size = 2.0,
      .shadow_samples = 18,
      .visibility_step = 1,
      .mesh_error = 0.0,
      .occlusion_samples = 4.0,
      .inscatter_samples = 16,
      .shaft_samples = 4.0},
     0.012},
}};

}  // namespace

const PictureLevel& picture_level(std::string_view name) {
  const auto at = std::ranges::find(kLevels, name, &PictureLevel::name);
  NERITIC_CHECK(at != kLevels.end(), "picture level {}", name);
  return *at;
}

const PictureLevel* picture_level_within(double error) {
  const auto at = std::ranges::find_if(
      kLevels, [&](const PictureLevel& level) { return level.error <= error; });
  return at == kLevels.end() ? nullptr : &*at;
}

}  // namespace neritic::scene
