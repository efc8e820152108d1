// Every key of the scene format, table by table: the one list from which unknown keys are told and
// suggestions made, and which the format's page (assets/scenes/README.md) is tested against.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace neritic::scene {

using Key = std::string_view;
using KeyList = std::span<const Key>;

inline constexpr auto kSceneKeys =
    std::to_array<Key>({"title", "seed", "include", "classes", "sun", "water", "objects",
                        "vehicles", "cameras", "sonars", "lamps"});

inline constexpr auto kSunKeys = std::to_array<Key>({"elevation_deg", "azimuth_deg", "intensity"});

inline constexpr auto kWaterKeys = std::to_array<Key>({"type", "scattering", "surface"});

// Of [[objects]] and [[vehicles]].
inline constexpr auto kObjectKeys = std::to_array<Key>({"name",
                                                        "include",
                                                        "class",
                                                        "reflectivity",
                                                        "model",
                                                        "node",
                                                        "shape",
                                                        "terrain",
                                                        "radius_m",
                                                        "size_m",
                                                        "height_m",
                                                        "segments",
                                                        "inside_out",
                                                        "cell_m",
                                                        "height_scale",
                                                        "height_offset_m",
                                                        "texture_m",
                                                        "color",
                                                        "color_texture",
                                                        "normal_texture",
                                                        "roughness",
                                                        "metallic",
                                                        "double_sided",
                                                        "position_m",
                                                        "yaw_deg",
                                                        "pitch_deg",
                                                        "roll_deg",
                                                        "rotation_xyzw",
                                                        "look_at_m",
                                                        "look_at",
                                                        "on",
                                                        "scale",
                                                        "clip",
                                                        "clip_offset_s",
                                                        "clip_rate",
                                                        "copies",
                                                        "copies_file",
                                                        "scatter",
                                                        "cameras",
                                                        "sonars",
                                                        "lamps"});

inline constexpr auto kScatterKeys =
    std::to_array<Key>({"count", "seed", "area_m", "on", "scale", "align", "sink_m", "keep_out_m"});

inline constexpr auto kCameraKeys = std::to_array<Key>(
    {"name", "include", "on", "position_m", "yaw_deg", "pitch_deg", "roll_deg", "rotation_xyzw",
     "look_at_m", "look_at", "width", "height", "fov_deg", "near_m", "rate_hz", "stereo_baseline_m",
     "antialias", "exposure", "exposure_compensation_ev"});

inline constexpr auto kSonarKeys =
    std::to_array<Key>({"name", "include", "on", "position_m", "yaw_deg", "pitch_deg", "roll_deg",
                        "rotation_xyzw", "look_at_m", "look_at", "kind", "range_m", "azimuth_deg",
                        "elevation_deg", "bins", "rate_hz", "gbuffer_scale", "gather", "near_m"});

inline constexpr auto kLampKeys = std::to_array<Key>(
    {"name", "include", "on", "position_m", "yaw_deg", "pitch_deg", "roll_deg", "rotation_xyzw",
     "look_at_m", "look_at", "color", "intensity_cd", "cone_deg"});

}  // namespace neritic::scene
