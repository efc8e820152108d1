#include "engine/render/snow_field.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/random.hpp"

namespace neritic::render {
namespace {

constexpr std::uint64_t kSnowStream = 0x736e6f77;
// Mean number of particles in a cell of the lattice.
constexpr double kCellMean = 24.0;
// Particles fade in between these distances from the eye: nearer there is the camera's housing.
constexpr double kNearest_m = 0.20, kNear_m = 0.80;
// Calls after which a cell that none of them saw is forgotten: several views take turns.
constexpr std::uint64_t kKeptCalls = 64;

std::uint64_t word(std::int64_t cell) {
  return static_cast<std::uint64_t>(cell);
}

// Whether a grain, lit as the water about it is, changes a pixel by less than half a level of 255:
// its soft spot has twice the light of its middle spread over a disk of 0.75 pixels at least
// (shaders/shared/particle_vertex.glsl).
bool fades_away(double radius_m, double opacity, double range2_m2, double pixels) {
  // With p the square of its radius in pixels: 2 p / (p + 0.56) opacity < 0.003, without a
  // division.
  const double own2 = radius_m * radius_m * pixels * pixels;
  return own2 * (2.0 * opacity - 0.003) < 0.003 * 0.56 * std::max(range2_m2, 1e-6);
}

double cell_size_m(double density_m3) {
  return std::clamp(std::cbrt(kCellMean / density_m3), 0.1, 2.0);
}

}  // namespace

std::size_t SnowField::HashOf::operator()(const Place& p) const {
  return static_cast<std::size_t>(mix64(word(p.x) ^ mix64(word(p.y) ^ mix64(word(p.z)))));
}

const std::vector<SnowField::Grain>& SnowField::grains_of(const Place& place) {
  const auto [found, is_new] = cells_.try_emplace(place);
  Cell& cell = found->second;
  cell.used = calls_;
  if (!is_new) return cell.grains;
  const double cell_m = cell_size_m(density_m3_);
  // A number of slots, each taken by chance: the count has a binomial spread.
  const double mean = density_m3_ * cell_m * cell_m * cell_m;
  const auto slots = static_cast<std::uint64_t>(std::ceil(2.0 * mean + 1.0));
  const double taken = mean / static_cast<double>(slots);
  const RandomKey key{seed_, kSnowStream ^ mix64(word(place.y)),
                      mix64(word(place.x)) ^ (word(place.z) << 1)};
  for (std::uint64_t i = 0; i < slots; ++i) {
    if (random_uniform(key, 8 * i) >= taken) continue;
    Grain grain;
    grain.look = static_cast<std::uint32_t>(random_bits(key, 8 * i + 7));
    grain.place_m = cell_m * (Vec3(place.x, place.y, place.z) +
                              Vec3(random_uniform(key, 8 * i + 1), random_uniform(key, 8 * i + 2),
                                   random_uniform(key, 8 * i + 3)));
    grain.radius_m = 0.5 * diameter_m_ *
                     std::exp(spread_ * std::clamp(normal_of(random_uniform(key, 8 * i + 4),
                                                             random_uniform(key, 8 * i + 5)),
                                                   -2.5, 2.0));
    grain.opacity = 0.10 + 0.50 * random_uniform(key, 8 * i + 6);
    cell.grains.push_back(grain);
  }
  return cell.grains;
}

void SnowField::forget_unused() {
  std::erase_if(cells_, [&](const auto& cell) { return cell.second.used + kKeptCalls < calls_; });
}

void SnowField::begin(const scene::Snow& snow, std::uint64_t seed) {
  if (seed != seed_ || snow.density_m3 != density_m3_ || snow.diameter_m != diameter_m_ ||
      snow.spread != spread_) {
    cells_.clear();
    seed_ = seed;
    density_m3_ = snow.density_m3;
    diameter_m_ = snow.diameter_m;
    spread_ = snow.spread;
  }
  ++calls_;
}

// Shows each cell in range by its middle and the radius about it, from the center, and each grain
// of those wanted: the grain, its place from the center, and its opacity there.
template <typename Wanted, typename Visit>
void SnowField::visit(const scene::Snow& snow, const Vec3& center_m, double time_s, double share,
                      const Wanted& wanted, const Visit& visit_grain) {
  const double cell_m = cell_size_m(snow.density_m3);
  const double half_m = 0.5 * std::sqrt(3.0) * cell_m;  // of a cell's diagonal
  const double widest_m = 0.5 * snow.diameter_m * std::exp(2.0 * snow.spread) + 0.02;
  const Vec3 center = center_m - snow.drift_m_s * time_s;  // in the water's own frame
  const auto low = [&](int axis) {
    return static_cast<std::int64_t>(std::floor((center[axis] - snow.range_m) / cell_m));
  };
  const auto high = [&](int axis) {
    return static_cast<std::int64_t>(std::floor((center[axis] + snow.range_m) / cell_m));
  };
  const double reach_m = snow.range_m + half_m, range2_m2 = snow.range_m * snow.range_m;
  const double fades_m = 0.7 * snow.range_m;  // from there on
  std::size_t seen = 0;
  for (std::int64_t y = low(1); y <= high(1); ++y)
    for (std::int64_t z = low(2); z <= high(2); ++z)
      for (std::int64_t x = low(0); x <= high(0); ++x) {
        // Most cells lie beside or behind the views, or out of range.
        const Vec3 middle = cell_m * (Vec3(x, y, z) + 0.5) - center;
        if (glm::dot(middle, middle) >= reach_m * reach_m) continue;
        if (!wanted(middle, half_m + widest_m)) continue;
        ++seen;
        for (const Grain& grain : grains_of({x, y, z})) {
          if (!(grain.look * 0x1p-32 < share)) continue;
          const Vec3 at = grain.place_m - center;
          const double distance2_m2 = glm::dot(at, at);
          if (distance2_m2 >= range2_m2 || center_m.y + at.y >= 0.0) continue;
          double opacity = grain.opacity;
          if (distance2_m2 < kNear_m * kNear_m || distance2_m2 > fades_m * fades_m) {
            const double range_m = std::sqrt(distance2_m2);
            opacity *= (1.0 - glm::smoothstep(fades_m, snow.range_m, range_m)) *
                       glm::smoothstep(kNearest_m, kNear_m, range_m);
          }
          visit_grain(grain, at, opacity);
        }
      }
  // Cells out of sight are let go of once they are more than those in sight; looking at all of them
  // each time would cost more than they do.
  if (cells_.size() > 4 * seen + 1024 && calls_ % kKeptCalls == 0) forget_unused();
}

void SnowField::place(const scene::Snow& snow, std::uint64_t seed, const SphereCulling& sight,
                      double time_s, double share, double faint_pixels,
                      std::vector<shared::Particle>& out, std::vector<Run>& runs) {
  if (!(snow.density_m3 > 0.0 && share > 0.0)) return;
  begin(snow, seed);
  const Vec3f moved(snow.drift_m_s * snow.shutter_s);
  out.reserve(out.size() + placed_ + placed_ / 8);
  const std::size_t before = out.size();
  bool whole = false;  // the cell is in sight
  const auto wanted = [&](const Vec3& middle_m, double radius_m) {
    if (!sight.may_see(middle_m, radius_m)) return false;
    whole = sight.sees_all_of(middle_m, radius_m);
    runs.push_back({glm::dot(middle_m, middle_m), out.size(), 0});
    return true;
  };
  visit(snow, sight.origin_m(), time_s, share, wanted,
        [&](const Grain& grain, const Vec3& at_m, double opacity) {
          if (!(opacity > 0.0)) return;
          if (faint_pixels > 0.0 &&
              fades_away(grain.radius_m, opacity, glm::dot(at_m, at_m), faint_pixels))
            return;
          if (!whole && !sight.may_see(at_m, grain.radius_m + kSpotRoom_m)) return;
          out.push_back({Vec3f(at_m), static_cast<float>(grain.radius_m), moved,
                         static_cast<float>(opacity), shared::kParticleSnow, grain.look});
          ++runs.back().count;
        });
  placed_ = out.size() - before;
}

void SnowField::append(const scene::Snow& snow, std::uint64_t seed, const Vec3& center_m,
                       double time_s, double share, std::vector<WorldParticle>& out) {
  if (!(snow.density_m3 > 0.0 && share > 0.0)) return;
  begin(snow, seed);
  visit(
      snow, center_m, time_s, share, [](const Vec3&, double) { return true; },
      [&](const Grain& grain, const Vec3& at_m, double opacity) {
        out.push_back({center_m + at_m, snow.drift_m_s, grain.radius_m, opacity,
                       shared::kParticleSnow, grain.look});
      });
}

}  // namespace neritic::render
