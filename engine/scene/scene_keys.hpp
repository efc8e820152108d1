// Every key of the scene format, table by table: the one list for finding unknown keys and making
// suggestions. A test compares the format's page (assets/scenes/README.md) with it.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace neritic::scene {

using Key = std::string_view;
using KeyList = std::span<const Key>;

inline constexpr auto kSceneKeys = std::to_array<Key>(
    {"title", "seed", "include", "classes", "sun", "ambient", "water", "physics", "current",
     "objects", "vehicles", "cameras", "sonars", "lamps", "lab", "sources", "acoustics"});

inline constexpr auto kLabKeys =
    std::to_array<Key>({"position_m", "yaw_deg", "pitch_deg", "roll_deg", "rotation_xyzw"});

inline constexpr auto kSunKeys =
    std::to_array<Key>({"elevation_deg", "azimuth_deg", "latitude_deg", "day", "hour", "intensity",
                        "overcast", "shadows", "caustics", "shafts"});
inline constexpr auto kSunShadowKeys =
    std::to_array<Key>({"size", "cascades", "reach_m", "full_resolution"});
inline constexpr auto kCausticsKeys =
    std::to_array<Key>({"waves", "wind_m_s", "direction_deg", "tile_m", "texels"});
inline constexpr auto kShaftKeys = std::to_array<Key>({"samples", "reach_m"});
inline constexpr auto kAmbientKeys = std::to_array<Key>(
    {"bottom_color", "bottom_depth_m", "occlusion_m", "occlusion_samples", "skylight"});
inline constexpr auto kSkylightKeys = std::to_array<Key>({"box_m", "cell_m", "samples"});

inline constexpr auto kWaterKeys =
    std::to_array<Key>({"type", "scattering", "surface", "forward_scatter", "snow", "waves", "murk",
                        "bubbles", "silt", "temperature_c", "salinity_psu", "layers"});
inline constexpr auto kLayerKeys = std::to_array<Key>(
    {"depth_m", "thickness_m", "temperature_c", "salinity_psu", "slope", "wavelength_m"});
inline constexpr auto kForwardScatterKeys = std::to_array<Key>({"angle_deg", "levels"});
inline constexpr auto kSnowKeys = std::to_array<Key>(
    {"density_m3", "diameter_mm", "spread", "range_m", "drift_m_s", "shutter_s"});
inline constexpr auto kWavesKeys =
    std::to_array<Key>({"wind_m_s", "fetch_km", "direction_deg", "components", "seed", "moves"});
inline constexpr auto kMurkKeys = std::to_array<Key>({"bed_depth_m", "thickness_m", "factor"});
inline constexpr auto kBubbleKeys = std::to_array<Key>(
    {"on", "joint", "position_m", "breath_s", "flow_l_min", "diameter_mm", "height_m"});
inline constexpr auto kSiltKeys =
    std::to_array<Key>({"on", "joint", "position_m", "bed_depth_m", "reach_m", "hang_s"});

// Keys of [[objects]] and [[vehicles]].
inline constexpr auto kObjectKeys = std::to_array<Key>({"name",
                                                        "include",
                                                        "track",
                                                        "class",
                                                        "reflectivity",
                                                        "material",
                                                        "backscatter_db",
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
                                                        "detail_texture",
                                                        "detail_m",
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
                                                        "joint",
                                                        "scale",
                                                        "clip",
                                                        "clip_offset_s",
                                                        "clip_rate",
                                                        "copies",
                                                        "copies_file",
                                                        "flock",
                                                        "afloat",
                                                        "scatter",
                                                        "collision",
                                                        "dynamics",
                                                        "mission",
                                                        "failed_thrusters",
                                                        "tether_anchor_m",
                                                        "tether",
                                                        "navigation",
                                                        "human",
                                                        "swim",
                                                        "jacket_buttons",
                                                        "condition",
                                                        "thing",
                                                        "gripper",
                                                        "wash",
                                                        "near_added_mass",
                                                        "hands",
                                                        "regulator",
                                                        "inputs",
                                                        "modem",
                                                        "cameras",
                                                        "sonars",
                                                        "lamps"});

// Keys of things that move.
inline constexpr auto kTrackKeys =
    std::to_array<Key>({"waypoints_m", "lawn_mower", "file", "recording", "participant",
                        "speed_m_s", "start_s", "heading", "turn_m", "repeat"});
inline constexpr auto kLawnMowerKeys =
    std::to_array<Key>({"area_m", "depth_m", "spacing_m", "legs"});

// Keys of things that are simulated.
inline constexpr auto kPhysicsKeys =
    std::to_array<Key>({"rate_hz", "integrator", "max_error_m", "water_kg_m3", "altitude_m"});
inline constexpr auto kCurrentKeys =
    std::to_array<Key>({"kind", "velocity_m_s", "deep_velocity_m_s", "depth_m", "exponent", "file",
                        "origin_m", "spacing_m", "start_s", "interval_s"});
inline constexpr auto kMissionKeys = std::to_array<Key>(
    {"waypoints", "acceptance_m", "speed_m_s", "speed_over", "repeat", "hold", "orbit", "follow",
     "stand_between", "heading_deg", "look_at", "look_at_m", "tilt"});
inline constexpr auto kMissionWaypointKeys =
    std::to_array<Key>({"position_m", "heading_deg", "look_at", "look_at_m", "tilt", "hold_s"});
inline constexpr auto kOrbitKeys =
    std::to_array<Key>({"object", "point_m", "radius_m", "speed_m_s", "speed_over"});
inline constexpr auto kFollowKeys = std::to_array<Key>({"object", "offset_m"});
inline constexpr auto kSwimKeys = std::to_array<Key>(
    {"waypoints_m", "speed_m_s", "speed_over", "acceptance_m", "repeat", "motion"});
inline constexpr auto kTetherKeys = std::to_array<Key>(
    {"from_m", "from", "attachment_m", "length_m", "segments", "diameter_m", "net_weight_n_m",
     "stiffness_n", "damping_n_s", "normal_drag", "tangential_drag", "friction", "color", "winch"});
inline constexpr auto kWinchKeys = std::to_array<Key>({"hold_n", "speed_m_s", "least_m", "most_m"});
inline constexpr auto kWashKeys = std::to_array<Key>({"diameter_m", "reach_m"});
inline constexpr auto kThingKeys =
    std::to_array<Key>({"mass_kg", "volume_l", "drag_area_m2", "racked"});
inline constexpr auto kGripperKeys =
    std::to_array<Key>({"position_m", "reach_m", "strength_n", "most_m_s"});
inline constexpr auto kHandsKeys = std::to_array<Key>({"reach_m", "strength_n", "most_m_s"});
inline constexpr auto kConditionKeys =
    std::to_array<Key>({"effects", "acts", "water_c", "fat_share", "oxygen_tolerance"});
inline constexpr auto kRegulatorKeys =
    std::to_array<Key>({"donor", "donor_tank", "hose_m", "reaction_s", "free_flow"});
inline constexpr auto kFreeFlowKeys = std::to_array<Key>({"at_s", "until_s", "tank", "area_mm2"});
inline constexpr auto kDiverInputKeys =
    std::to_array<Key>({"body", "hands", "head", "gaze", "buttons", "breath", "heart", "gas"});
inline constexpr auto kVehicleInputKeys = std::to_array<Key>({"wrench", "setpoint", "fault"});
inline constexpr auto kObjectInputKeys = std::to_array<Key>({"pose"});
inline constexpr auto kInputChoiceKeys = std::to_array<Key>({"from", "hold_s", "then"});
inline constexpr auto kModemKeys = std::to_array<Key>(
    {"position_m", "source_level_db", "frequency_hz", "bandwidth_hz", "bit_rate_hz", "preamble_s",
     "coding_gain_db", "detection_db", "self_noise_db", "fading", "turnaround_s", "usbl"});
inline constexpr auto kModemUsblKeys =
    std::to_array<Key>({"target", "interval_s", "offset_s", "wait_s", "range_noise_m",
                        "direction_noise_deg", "sound_m_s"});
inline constexpr auto kAcousticsKeys =
    std::to_array<Key>({"temperature_c", "salinity_psu", "ph", "profile", "path", "spreading",
                        "wind_m_s", "shipping"});
inline constexpr auto kSourceKeys = std::to_array<Key>({"device", "diver", "character", "rate_hz"});
inline constexpr auto kStandBetweenKeys = std::to_array<Key>({"a", "b", "distance_m"});

inline constexpr auto kFlockKeys =
    std::to_array<Key>({"count", "kind", "radius_m", "speed_m_s", "seed", "avoid", "avoid_m"});
inline constexpr auto kAfloatKeys = std::to_array<Key>({"length_m", "breadth_m"});
inline constexpr auto kScatterKeys =
    std::to_array<Key>({"count", "seed", "area_m", "on", "scale", "align", "sink_m", "keep_out_m"});

inline constexpr auto kCameraKeys =
    std::to_array<Key>({"name",          "include",   "on",
                        "joint",         "track",     "position_m",
                        "yaw_deg",       "pitch_deg", "roll_deg",
                        "rotation_xyzw", "look_at_m", "look_at",
                        "width",         "height",    "fov_deg",
                        "near_m",        "rate_hz",   "stereo_baseline_m",
                        "antialias",     "exposure",  "exposure_compensation_ev",
                        "quality",       "max_error", "detail",
                        "lens",          "port",      "focus",
                        "shutter",       "sensor",    "white_balance",
                        "vignette",      "linear",    "spectrum"});
inline constexpr auto kDetailKeys =
    std::to_array<Key>({"resolution", "shadow_size", "cascades", "shadow_samples",
                        "visibility_step", "mesh_error", "occlusion_samples", "inscatter_samples",
                        "waves", "scatter_levels", "shaft_samples", "particles"});
inline constexpr auto kPortKeys = std::to_array<Key>({"kind", "offset"});
inline constexpr auto kFocusKeys =
    std::to_array<Key>({"distance_m", "f_number", "focal_length_mm", "samples"});
inline constexpr auto kShutterKeys = std::to_array<Key>({"exposure_s", "readout_s", "samples"});
inline constexpr auto kLensKeys = std::to_array<Key>({"model", "k", "p"});
inline constexpr auto kSpectrumKeys = std::to_array<Key>({"bands", "response"});
inline constexpr auto kImageSensorKeys = std::to_array<Key>(
    {"gain_db", "full_well_e", "read_noise_e", "saturation_ev", "bits", "bayer"});

inline constexpr auto kSonarKeys =
    std::to_array<Key>({"name",          "include",        "on",
                        "joint",         "track",          "position_m",
                        "yaw_deg",       "pitch_deg",      "roll_deg",
                        "rotation_xyzw", "look_at_m",      "look_at",
                        "kind",          "range_m",        "azimuth_deg",
                        "elevation_deg", "semi_angle_deg", "depression_deg",
                        "step_deg",      "bins",           "rate_hz",
                        "gbuffer_scale", "gather",         "near_m",
                        "quality",       "max_error",      "picture_camera",
                        "frequency_hz",  "bandwidth_hz",   "water",
                        "level",         "beam",           "range_spread",
                        "speckle",       "noise",          "ghosts",
                        "sound_speed",   "motion",         "labels",
                        "output",        "detection"});

// The terms of a sonar, each a table.
inline constexpr auto kSonarWaterKeys =
    std::to_array<Key>({"temperature_c", "salinity_psu", "ph", "depth_m", "sound_speed_m_s"});
inline constexpr auto kSonarLevelKeys = std::to_array<Key>(
    {"source_level_db", "absorption", "spreading", "tvg", "tvg_absorption", "gain_db"});
inline constexpr auto kSonarBeamKeys = std::to_array<Key>(
    {"azimuth", "azimuth_deg", "elevation", "elevation_deg", "samples", "steering", "two_way"});
inline constexpr auto kSonarRangeSpreadKeys = std::to_array<Key>({"bandwidth_hz", "window"});
inline constexpr auto kSonarSpeckleKeys = std::to_array<Key>({"scatterer_m", "shape", "texture_m"});
inline constexpr auto kSonarNoiseKeys =
    std::to_array<Key>({"level_db", "wind_m_s", "shipping", "directivity_db", "self_db"});
inline constexpr auto kSonarGhostKeys =
    std::to_array<Key>({"surface", "bottom_m", "surface_reflection", "bottom_reflection"});
inline constexpr auto kSonarSoundSpeedKeys = std::to_array<Key>({"profile", "rays"});
inline constexpr auto kSonarMotionKeys = std::to_array<Key>({"within_ping", "doppler", "pulse_s"});
inline constexpr auto kSonarLabelKeys = std::to_array<Key>({"energy", "coco"});
inline constexpr auto kSonarDetectionKeys =
    std::to_array<Key>({"threshold", "floor_db", "quality", "pings"});
inline constexpr auto kSonarOutputKeys = std::to_array<Key>({"bits", "floor_db", "span_db"});
// Where a key belongs that is written a table too high.
struct KeyTable {
  Key name;
  KeyList keys;
};
inline constexpr auto kSonarTables =
    std::to_array<KeyTable>({{"water", kSonarWaterKeys},
                             {"level", kSonarLevelKeys},
                             {"beam", kSonarBeamKeys},
                             {"range_spread", kSonarRangeSpreadKeys},
                             {"speckle", kSonarSpeckleKeys},
                             {"noise", kSonarNoiseKeys},
                             {"ghosts", kSonarGhostKeys},
                             {"sound_speed", kSonarSoundSpeedKeys},
                             {"motion", kSonarMotionKeys},
                             {"labels", kSonarLabelKeys},
                             {"detection", kSonarDetectionKeys},
                             {"output", kSonarOutputKeys}});

inline constexpr auto kLampKeys = std::to_array<Key>({"name",
                                                      "include",
                                                      "on",
                                                      "joint",
                                                      "track",
                                                      "position_m",
                                                      "yaw_deg",
                                                      "pitch_deg",
                                                      "roll_deg",
                                                      "rotation_xyzw",
                                                      "look_at_m",
                                                      "look_at",
                                                      "color",
                                                      "temperature_k",
                                                      "intensity_cd",
                                                      "cone_deg",
                                                      "half_intensity_deg",
                                                      "profile",
                                                      "flux_lm",
                                                      "shadows",
                                                      "shadow_size",
                                                      "strobe_s"});

}  // namespace neritic::scene
