// The state of one ping: the sonar's pose and velocity, and the numbers that the passes need and
// that follow from them. Pure functions of plain values; any thread.
#pragma once

#include <vector>

#include "engine/scene/scene.hpp"
#include "sonar/head.hpp"
#include "sonar/range_correction.hpp"

namespace neritic::sonar {

struct PingState {
  Pose world_from_sonar;
  Vec3 velocity_m_s{0.0};             // of the sonar, world axes
  double yaw_rate_rad_s = 0.0;        // about the sonar's y, positive to port
  std::uint64_t seed = 1;             // the scene's
  std::uint32_t stream = 0;           // which of the scene's sonars: its noise is its own
  std::uint32_t ping = 0;             // number of the ping
  double backscatter_scale = 1.0;     // what a strength of 1 in the reflectivity table stands for
  bool in_water = false;              // whose still surface is y = 0: sound does not leave it
  bool gbuffer_in_world_axes = true;  // else in the sonar's (images without a scene)
  RangeCorrections* corrections = nullptr;  // the head's or its mirror's, where it keeps them
};

// A mirror for ghosts: the horizontal plane y = height_m; amplitude reflection.
struct Mirror {
  double height_m = 0.0;
  double reflection = 1.0;
  bool water_below = true;  // a surface; else a bottom
};
// The mirrors that the settings name.
std::vector<Mirror> mirrors_of(const scene::Sonar& sonar);
// The head seen in a mirror: the view that sees what the mirror shows. Its elevation is turned over
// (its +y is the mirror image of -y), so that it is right-handed.
Pose mirrored(const Mirror& mirror, const Pose& world_from_head);

// A ghost's reciprocal paths, whose amplitudes add: the sound goes either way round.
inline constexpr double kGhostPaths = 2.0;
// Gather inputs' height of the water's surface over the sonar, or over its image in a mirror. A
// sonar above the water hears nothing.
double surface_over_eye_m(const PingState& state, const Mirror* mirror = nullptr);

// Weights of a ghost's gather: what the pattern lets through one way, rows turned over as the
// mirrored head's are. Empty where the head has none.
std::vector<float> ghost_weights(const scene::Sonar& sonar, const Head& head);

// Whether beams' weights hold the cosine of the elevation, which makes them solid angles.
bool counts_solid_angle(const scene::Sonar& sonar);

struct Ping {
  shared::SonarEcho echo{};
  std::vector<float> correction;
  std::vector<glm::vec2> gains;
  float noise_power = 0.0f, shift_columns_per_row = 0.0f, first_shift_columns = 0.0f;
  float shift_columns_right = 0.0f, shift_columns_back = 0.0f;
  std::uint32_t seed = 0, ping = 0;
  // The receiver's part of the ping; gains must live until the run.
  Receiver::Ping receiver() const {
    return {gains,
            noise_power,
            seed,
            ping,
            first_shift_columns,
            shift_columns_per_row,
            shift_columns_right,
            shift_columns_back};
  }
  double sound_speed_m_s = 1500.0;  // that turns time to range
  double absorption_db_per_m = 0.0;
};
// mirror: of a ghost's gather; nullptr: of the direct one.
Ping ping_of(const scene::Sonar& sonar, const Head& head, const PingState& state,
             const Mirror* mirror = nullptr);

}  // namespace neritic::sonar
