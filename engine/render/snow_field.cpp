#include "engine/render/snow_field.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

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

// Brings what will be read soon into the cache. The driver's work between two frames drives it out,
// and cells lie anywhere in memory.
template <typename T>
void fetch(std::span<const T> data) {
  constexpr std::size_t kLine = 64;
  const auto* const bytes = reinterpret_cast<const char*>(data.data());
  for (std::size_t i = 0; i < data.size_bytes(); i += kLine) __builtin_prefetch(bytes + i);
}

double cell_size_m(double density_m3) {
  return std::clamp(std::cbrt(kCellMean / density_m3), 0.1, 2.0);
}

}  // namespace

std::size_t SnowField::HashOf::operator()(const Place& p) const {
  return static_cast<std::size_t>(mix64(word(p.x) ^ mix64(word(p.y) ^ mix64(word(p.z)))));
}

SnowField::Cell& SnowField::cell_of(const Place& place) {
  const auto [found, is_new] = cells_.try_emplace(place);
  Cell& cell = found->second;
  cell.used = calls_;
  if (!is_new) return cell;
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
  return cell;
}

// Cells out of sight are let go of once they are more than those in sight; looking at all of them
// each time would cost more than they do.
void SnowField::forget_unused(std::size_t seen) {
  if (cells_.size() <= 4 * seen + 1024 || calls_ % kKeptCalls != 0) return;
  for (const Found& found : found_) found.cell->used = calls_;
  std::erase_if(cells_, [&](const auto& cell) { return cell.second.used + kKeptCalls < calls_; });
}

void SnowField::begin(const scene::Snow& snow, std::uint64_t seed) {
  if (seed != seed_ || snow.density_m3 != density_m3_ || snow.diameter_m != diameter_m_ ||
      snow.spread != spread_) {
    cells_.clear();
    found_.clear();
    turns_.clear();
    seed_ = seed;
    density_m3_ = snow.density_m3;
    diameter_m_ = snow.diameter_m;
    spread_ = snow.spread;
  }
  ++calls_;
}

SnowField::Water::Water(const scene::Snow& snow, const Vec3& at_m, double time_s,
                        double share_of_it)
    : cell_m(cell_size_m(snow.density_m3)),
      half_m(0.5 * std::sqrt(3.0) * cell_m),
      widest_m(0.5 * snow.diameter_m * std::exp(2.0 * snow.spread) + kSpotRoom_m),
      center_m(at_m - snow.drift_m_s * time_s),
      surface_m(-at_m.y),
      range_m(snow.range_m),
      fades_m(0.7 * snow.range_m),
      share(share_of_it) {}

// Visits each cell in range, by its place and its middle. narrow: leaves of the cells along x at a
// place those that are wanted, from the one x of their middles to the other; false: none.
template <typename Narrow, typename Visit>
void SnowField::visit_cells(const Water& water, const Narrow& narrow, const Visit& visit) {
  const auto cell_at = [&](int axis, double at_m) {
    return static_cast<std::int64_t>(std::floor((water.center_m[axis] + at_m) / water.cell_m));
  };
  const double range_m = water.range_m, reach_m = range_m + water.half_m;
  for (std::int64_t y = cell_at(1, -range_m); y <= cell_at(1, range_m); ++y)
    for (std::int64_t z = cell_at(2, -range_m); z <= cell_at(2, range_m); ++z) {
      double low_m = -reach_m, high_m = reach_m;
      if (!narrow(water.middle_of({0, y, z}), low_m, high_m)) continue;
      // With room for rounding.
      const std::int64_t first = std::max(cell_at(0, low_m) - 1, cell_at(0, -range_m));
      const std::int64_t last = std::min(cell_at(0, high_m) + 1, cell_at(0, range_m));
      for (std::int64_t x = first; x <= last; ++x) {
        const Vec3 middle_m = water.middle_of({x, y, z});
        if (glm::dot(middle_m, middle_m) < reach_m * reach_m) visit(Place{x, y, z}, middle_m);
      }
    }
}

// Visits a cell's grains of the share, in range and under the surface: the grain, its place from
// the center, and its opacity there.
template <typename Visit>
void SnowField::visit_grains(const Water& water, std::span<const Grain> grains,
                             const Vec3& middle_m, const Visit& visit) {
  const double range2_m2 = water.range_m * water.range_m;
  const double fades2_m2 = water.fades_m * water.fades_m;
  const bool deep = middle_m.y + water.cell_m < water.surface_m;  // all of it
  for (const Grain& grain : grains) {
    if (!(grain.look * 0x1p-32 < water.share)) continue;
    const Vec3 at_m = grain.place_m - water.center_m;
    const double distance2_m2 = glm::dot(at_m, at_m);
    if (distance2_m2 >= range2_m2 || !(deep || at_m.y - water.surface_m < 0.0)) continue;
    double opacity = grain.opacity;
    if (distance2_m2 > fades2_m2)
      opacity *= 1.0 - glm::smoothstep(water.fades_m, water.range_m, std::sqrt(distance2_m2));
    if (distance2_m2 < kNear_m * kNear_m)
      opacity *= glm::smoothstep(kNearest_m, kNear_m, std::sqrt(distance2_m2));
    visit(grain, at_m, opacity);
  }
}

void SnowField::find(const scene::Snow& snow, std::uint64_t seed, const SphereCulling& sight,
                     double time_s, double share, double faint_pixels) {
  turns_.clear();
  placed_ = 0;
  if (!(snow.density_m3 > 0.0 && share > 0.0)) return;
  begin(snow, seed);
  sight_ = &sight;
  water_.emplace(snow, sight.origin_m(), time_s, share);
  moved_m_ = Vec3f(snow.drift_m_s * snow.shutter_s);
  faint_pixels_ = faint_pixels;
  const double ball_m = water_->half_m + water_->widest_m;
  std::swap(found_, before_);
  found_.clear();
  // Most cells were in sight a frame ago: both lists go on side by side, without a search.
  const auto order = [](const Place& p) { return std::tuple(p.y, p.z, p.x); };
  auto old = before_.begin();
  const auto find_cell = [&](const Place& place, const Vec3& middle_m) {
    if (!sight.may_see(middle_m, ball_m)) return;
    while (old != before_.end() && order(old->place) < order(place)) ++old;
    const bool known = old != before_.end() && old->place == place;
    Cell& cell = known ? *old->cell : cell_of(place);
    turns_.push_back({glm::dot(middle_m, middle_m), found_.size()});
    found_.push_back({place, middle_m, &cell, known ? old->grains : std::span(cell.grains)});
  };
  visit_cells(
      *water_,
      [&](const Vec3& line_m, double& low_m, double& high_m) {
        return sight.narrow(line_m, ball_m, low_m, high_m);
      },
      find_cell);
  std::ranges::sort(turns_, [](const Turn& a, const Turn& b) {
    return a.distance2_m2 != b.distance2_m2 ? a.distance2_m2 > b.distance2_m2 : a.which < b.which;
  });
  forget_unused(found_.size());
}

void SnowField::place(double beyond2_m2, std::vector<shared::Particle>& out) {
  if (placed_ == 0) {
    out.reserve(out.size() + grains_ + grains_ / 8);
    grains_ = 0;
  }
  const std::size_t before = out.size();
  for (; placed_ < turns_.size() && turns_[placed_].distance2_m2 > beyond2_m2; ++placed_) {
    const Found& found = found_[turns_[placed_].which];
    if (placed_ + 1 < turns_.size()) fetch(found_[turns_[placed_ + 1].which].grains);
    // Grains in the part of the sight that no plane cuts are all seen.
    sight_->may_see(found.middle_m, water_->half_m + water_->widest_m, part_);
    const auto place_grain = [&](const Grain& grain, const Vec3& at_m, double opacity) {
      if (!(opacity > 0.0)) return;
      if (faint_pixels_ > 0.0 &&
          fades_away(grain.radius_m, opacity, glm::dot(at_m, at_m), faint_pixels_))
        return;
      if (!part_.may_see(at_m, grain.radius_m + kSpotRoom_m)) return;
      out.push_back({Vec3f(at_m), static_cast<float>(grain.radius_m), moved_m_,
                     static_cast<float>(opacity), shared::kParticleSnow, grain.look});
    };
    visit_grains(*water_, found.grains, found.middle_m, place_grain);
  }
  grains_ += out.size() - before;
}

void SnowField::append(const scene::Snow& snow, std::uint64_t seed, const Vec3& center_m,
                       double time_s, double share, std::vector<WorldParticle>& out) {
  if (!(snow.density_m3 > 0.0 && share > 0.0)) return;
  begin(snow, seed);
  const Water water(snow, center_m, time_s, share);
  std::size_t seen = 0;
  const auto add_grain = [&](const Grain& grain, const Vec3& at_m, double opacity) {
    out.push_back({center_m + at_m, snow.drift_m_s, grain.radius_m, opacity, shared::kParticleSnow,
                   grain.look});
  };
  visit_cells(
      water, [](const Vec3&, double&, double&) { return true; },
      [&](const Place& place, const Vec3& middle_m) {
        ++seen;
        visit_grains(water, cell_of(place).grains, middle_m, add_grain);
      });
  forget_unused(seen);
}

}  // namespace neritic::render
