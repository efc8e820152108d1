// How finely a camera's picture is made: what each knob does to the terms that a scene names, and
// three levels of them. Knobs never add a term. Measured by `neritic tradeoff camera`.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace neritic::scene {

struct PictureDetail {
  // Share of the picture's sides that is shaded; a camera's own terms: 1. Above 1 a whole number: a
  // pixel is the mean of so many a side, whatever the camera's terms.
  double resolution = 1.0;
  double shadow_size = 1.0;           // texels a side of the sun's maps, times those named
  std::uint32_t cascades = 4;         // of those named, at most: the widest are kept
  std::uint32_t shadow_samples = 9;   // rings of taps round a shadow's middle
  std::uint32_t visibility_step = 2;  // pixels a side to one of the visibility image: 1 to 4
  // Pixels by which coarser meshes may differ (MeshLevel); of the sun's maps texels. 0: none is
  // coarser.
  double mesh_error = 0.5;
  double occlusion_samples = 1.0;       // times those named
  std::uint32_t inscatter_samples = 4;  // of a lamp's beam along a sight
  std::uint32_t waves = 48;             // of the surface, the longest first; at most
  std::uint32_t scatter_levels = 8;     // octaves of forward scatter, at most
  double shaft_samples = 1.0;           // times those named
  double particles = 1.0;               // share of the snow named
  friend bool operator==(const PictureDetail&, const PictureDetail&) = default;
};

inline constexpr double kMostResolution = 4.0;
// Beyond (seen at 4), sand has a shadow that nothing throws.
inline constexpr double kMostMeshError = 2.5;

inline constexpr std::string_view kPictureLevels[] = {"draft", "standard", "reference"};
struct PictureLevel {
  std::string_view name;
  PictureDetail detail;
  // Root mean square difference of the display picture (1: from black to white) from the one with
  // every knob at its best and a resolution of 4: the largest of the shipped scenes' first cameras.
  double error;
};
// From the cheapest to the best.
const PictureLevel& picture_level(std::string_view name);
// The cheapest whose error is at most that; absent where none is.
const PictureLevel* picture_level_within(double error);

}  // namespace neritic::scene
