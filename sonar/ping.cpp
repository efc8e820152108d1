#include "sonar/ping.hpp"

#include <algorithm>
#include <cmath>

#include "sonar/acoustics.hpp"
#include "sonar/head_pattern.hpp"
#include "sonar/levels.hpp"
#include "sonar/range_correction.hpp"

namespace neritic::sonar {
namespace {

// Power of the field a unit of the gather's sum: what one beam's solid angle sends back from range
// r.
double field_gain(const scene::Sonar& sonar, const Head& head, const PingState& state, double r,
                  double absorption_db_per_m) {
  if (!sonar.terms.level) return head.sample_power;
  return echo_power(*sonar.terms.level, r, absorption_db_per_m, state.backscatter_scale,
                    head.sample_power);
}

// largest: of what it amplifies. A receiver saturates: its output stays a finite float.
double receiver_gain(const scene::Sonar& sonar, double r, double absorption_db_per_m,
                     double largest) {
  if (!sonar.terms.level) return 1.0;
  const double db = receiver_gain_db(*sonar.terms.level, r, absorption_db_per_m);
  return std::min(power_from_db(db), kLargestPower / std::max(largest, 1.0));
}

// A cell of scatterers has at least this size in bins, columns and rows: what moves on by a part
// of one stays in its cell, mostly, and a row misses none.
constexpr double kCellBins = 4.0, kCellColumns = 4.0, kCellRows = 2.0;

// The lattice's walls lie beside round coordinates, where a scene's flat surfaces are.
constexpr double kLatticeOffset = 0.3183;

std::uint32_t cell_index(double cell) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(cell));
}

// Where the eye lies in a lattice of cells fixed to the world.
void place_in_lattice(const Vec3& eye_m, double cell_m, glm::vec3& fraction, glm::uvec3& cell,
                      float& cells_per_m) {
  const Vec3 in_cells = eye_m / cell_m + kLatticeOffset;
  const Vec3 low = glm::floor(in_cells);
  fraction = glm::vec3(in_cells - low);
  cell = {cell_index(low.x), cell_index(low.y), cell_index(low.z)};
  cells_per_m = static_cast<float>(1.0 / cell_m);
}

void add_speckle(Ping& ping, const scene::Sonar& sonar, const Head& head, const Vec3& eye_m,
                 std::uint64_t seed) {
  if (!sonar.terms.speckle) return;
  const scene::SonarSpeckle& speckle = *sonar.terms.speckle;
  const double cell_m = speckle.scatterer_m > 0.0 ? speckle.scatterer_m : head.beams.range_step_m();
  place_in_lattice(eye_m, cell_m, ping.echo.cell_fraction, ping.echo.origin_cell,
                   ping.echo.cells_per_m);
  place_in_lattice(eye_m, speckle.texture_m, ping.echo.patch_fraction, ping.echo.origin_patch,
                   ping.echo.patches_per_m);
  const double column_rad = head.samples.azimuth_step_rad();
  const double sampled_rad =
      std::max(kCellColumns * column_rad, kCellRows * head.samples.elevation_step_rad());
  ping.echo.cells_per_range = static_cast<float>(sampled_rad / cell_m);
  ping.echo.least_cells = static_cast<float>(kCellBins * head.beams.range_step_m() / cell_m);
  ping.echo.column_rad = static_cast<float>(column_rad);
  ping.echo.turns_per_m = static_cast<float>(2.0 * sonar.terms.frequency_hz / ping.sound_speed_m_s);
  ping.echo.seed = static_cast<std::uint32_t>(seed ^ (seed >> 32));
}

void add_motion(Ping& ping, const scene::Sonar& sonar, const Head& head, const PingState& state) {
  if (!sonar.terms.motion) return;
  const scene::SonarMotion& motion = *sonar.terms.motion;
  const double c = ping.sound_speed_m_s;
  const Mat3 gbuffer_from_world =
      state.gbuffer_in_world_axes ? Mat3(1.0)
                                  : glm::mat3_cast(glm::conjugate(state.world_from_sonar.rotation));
  const Vec3 velocity = gbuffer_from_world * state.velocity_m_s;
  if (motion.within_ping) {
    // The echo comes back to where the sonar is by then: half the path is shorter by v . d * 2r/c.
    ping.echo.motion = glm::vec3(-velocity / c);
    const double columns_per_m = -state.yaw_rate_rad_s * 2.0 / c / head.samples.azimuth_step_rad();
    ping.shift_columns_per_row = static_cast<float>(columns_per_m * head.beams.range_step_m());
    ping.first_shift_columns = static_cast<float>(columns_per_m * head.beams.range_m(0));
    // By then a target d r away is seen at d r - v 2r/c: its bearing b shifts by -2/c times the
    // speed across it, v . (cos b, 0, sin b) in the head's axes (as of a level path).
    const Vec3 in_head = glm::conjugate(state.world_from_sonar.rotation) * state.velocity_m_s;
    const double columns_per_m_s = 2.0 / c / head.samples.azimuth_step_rad();
    ping.shift_columns_right = static_cast<float>(columns_per_m_s * in_head.x);
    ping.shift_columns_back = static_cast<float>(columns_per_m_s * in_head.z);
  }
  // An up-chirp of pulse T over bandwidth B: a closing speed v shortens the range by v f T / B.
  if (motion.doppler && sonar.terms.range_spread)
    ping.echo.doppler = glm::vec3(-velocity * (sonar.terms.frequency_hz * motion.pulse_s /
                                               sonar.terms.range_spread->bandwidth_hz));
}

// Where directions lie in the head's tables. axes: the head's, as columns, in those of the normals.
void add_head(shared::SonarEcho& echo, const scene::Sonar& sonar, const Head& head,
              const Mat3& axes) {
  echo.solid_angle = counts_solid_angle(sonar);
  echo.head_right = glm::vec3(axes[0]);
  echo.head_up = glm::vec3(axes[1]);
  echo.head_back = glm::vec3(axes[2]);
  const BeamGrid& g = head.samples;
  echo.elevation_min_rad = static_cast<float>(g.limits.elevation_min_rad);
  echo.rows_per_rad = static_cast<float>(1.0 / g.elevation_step_rad());
  echo.azimuth_min_rad = static_cast<float>(g.limits.azimuth_min_rad);
  echo.columns_per_rad = static_cast<float>(1.0 / g.azimuth_step_rad());
}

void add_mirror(Ping& ping, const Mirror& mirror, const scene::Sonar& sonar, const PingState& state,
                const Vec3& eye_m) {
  shared::SonarEcho& echo = ping.echo;
  echo.ghost_source = glm::vec3(state.world_from_sonar.position_m - eye_m);
  echo.water_level_m = static_cast<float>(mirror.height_m - eye_m.y);
  echo.water_sign = mirror.water_below ? 1.0f : -1.0f;
  echo.mirror_class = mirror.water_below ? 0u : scene::kClasses[0].id;
  // Out by the mirror and back directly, and the other way round: by reciprocity both have the same
  // length, the same phase and the same amplitude at every scatterer, so that amplitudes add
  // (Akkermans, Wolf and Maynard 1986, Phys. Rev. Lett. 56, 1471).
  echo.ghost_weight =
      static_cast<float>(kGhostPaths * kGhostPaths * mirror.reflection * mirror.reflection);
  const auto& level = sonar.terms.level;
  echo.ghost_spreading = !level             ? shared::kSonarGhostPlain
                         : level->spreading ? shared::kSonarGhostSpreading
                                            : shared::kSonarGhostNoSpreading;
}

}  // namespace

bool counts_solid_angle(const scene::Sonar& sonar) {
  return sonar.terms.level || sonar.kind == scene::SonarKind::kEchoSounder;
}

std::vector<Mirror> mirrors_of(const scene::Sonar& sonar) {
  std::vector<Mirror> mirrors;
  if (!sonar.terms.ghosts) return mirrors;
  const scene::SonarGhosts& ghosts = *sonar.terms.ghosts;
  if (ghosts.surface) mirrors.push_back({0.0, ghosts.surface_reflection, true});
  if (ghosts.bottom_m) mirrors.push_back({-*ghosts.bottom_m, ghosts.bottom_reflection, false});
  return mirrors;
}

double surface_over_eye_m(const PingState& state, const Mirror* mirror) {
  constexpr double kEverything_m = 1e30;
  if (!state.in_water) return kEverything_m;
  const double sonar_m = state.world_from_sonar.position_m.y;
  if (sonar_m > 0.0) return -kEverything_m;
  return mirror ? -mirrored(*mirror, state.world_from_sonar).position_m.y : -sonar_m;
}

std::vector<float> ghost_weights(const scene::Sonar& sonar, const Head& head) {
  const BeamGrid& g = head.samples;
  std::vector<float> out(head.echo ? head.echo->weights.size() : 0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto row = static_cast<std::uint32_t>(i / g.bins.azimuth);
    const std::size_t column = i % g.bins.azimuth;
    const std::size_t from = std::size_t{g.bins.elevation - 1 - row} * g.bins.azimuth + column;
    const double cosine =
        counts_solid_angle(sonar) ? std::cos(g.elevation_rad(g.bins.elevation - 1 - row)) : 1.0;
    out[i] = static_cast<float>(std::sqrt(head.echo->weights[from] / cosine));
  }
  return out;
}

Pose mirrored(const Mirror& mirror, const Pose& world_from_head) {
  Pose out = world_from_head;
  out.position_m.y = 2.0 * mirror.height_m - out.position_m.y;
  // The columns of the rotation are the head's axes; a mirror turns their y over, and the head's
  // own y with it, so that the axes stay right-handed.
  Mat3 axes = glm::mat3_cast(world_from_head.rotation);
  for (int i = 0; i < 3; ++i) axes[i].y = -axes[i].y;
  axes[1] = -axes[1];
  out.rotation = glm::normalize(glm::quat_cast(axes));
  return out;
}

Ping ping_of(const scene::Sonar& sonar, const Head& head, const PingState& state,
             const Mirror* mirror) {
  const Vec3 sonar_m = state.world_from_sonar.position_m;
  const Vec3 eye_m = mirror ? mirrored(*mirror, state.world_from_sonar).position_m : sonar_m;
  Ping ping;
  ping.ping = state.ping;
  ping.seed = static_cast<std::uint32_t>(state.seed * 0x9e3779b97f4a7c15ull >> 32) ^
              state.stream * 0x85ebca6bu;
  ping.sound_speed_m_s = sound_speed_of(sonar.terms.water, -sonar_m.y);
  ping.absorption_db_per_m = absorption_of(sonar.terms, -sonar_m.y);
  const double noise = sonar.terms.noise ? power_from_db(noise_level_db(sonar.terms)) : 0.0;
  ping.noise_power = static_cast<float>(noise);
  for (std::uint32_t row = 0; row < head.samples.bins.range; ++row) {
    const double r = std::max(head.samples.range_m(row), kNearestRange_m);
    const double field = field_gain(sonar, head, state, r, ping.absorption_db_per_m);
    ping.gains.emplace_back(static_cast<float>(sonar.terms.speckle ? std::sqrt(field) : field),
                            static_cast<float>(receiver_gain(sonar, r, ping.absorption_db_per_m,
                                                             std::max(field, noise))));
  }
  ping.echo.world_up =
      state.gbuffer_in_world_axes
          ? glm::vec3(0, 1, 0)
          : glm::vec3(glm::conjugate(state.world_from_sonar.rotation) * Vec3(0, 1, 0));
  add_speckle(ping, sonar, head, eye_m, state.seed);
  add_motion(ping, sonar, head, state);
  add_head(
      ping.echo, sonar, head,
      state.gbuffer_in_world_axes ? glm::mat3_cast(state.world_from_sonar.rotation) : Mat3(1.0));
  if (sonar.terms.profile) {
    // The longer of a ghost's legs may be beyond the range by as much as the other is within.
    const double range_max_m = head.samples.limits.range_max_m * (mirror ? 2.0 : 1.0);
    RangeCorrections own;
    std::optional<ProfileMirror> beyond;
    if (mirror) beyond = ProfileMirror{-mirror->height_m, mirror->water_below};
    const RangeCorrection& table = (state.corrections ? *state.corrections : own)
                                       .at(*sonar.terms.profile, -sonar_m.y, range_max_m, beyond);
    ping.echo.correction_width = table.width;
    ping.echo.correction_height = table.height;
    ping.echo.correction_range_m = static_cast<float>(range_max_m);
    for (const float factor : table.factors)
      ping.correction.push_back(static_cast<float>(factor * ping.sound_speed_m_s));
    ping.correction.insert(ping.correction.end(), table.bends.begin(), table.bends.end());
  }
  if (mirror) add_mirror(ping, *mirror, sonar, state, eye_m);
  return ping;
}

}  // namespace neritic::sonar
