// Bubbles and silt: each particle's place follows in closed form from when and where it was set
// free.
#include <algorithm>
#include <numbers>
#include <optional>

#include "engine/core/random.hpp"
#include "engine/render/particles.hpp"

namespace neritic::render {
namespace {

constexpr std::uint64_t kBubbleStream = 0x627562, kSiltStream = 0x73696c74;
constexpr double kFreeFall_m_s2 = 9.81, kDensity_kg_m3 = 1026.0, kAir_pa = 101325.0;
// Surface tension of sea water, N/m.
constexpr double kTension_n_m = 0.0735;
// Deviation of the logarithm of bubbles' radii, and the most deviations from the median: breakup in
// a turbulent burst leaves a broad lognormal spectrum, a few large caps among many small ones.
constexpr double kBubbleSpread = 1.1, kFewest = -1.8, kMost = 2.5;
// Bubbles of a smaller diameter slow down in proportion.
constexpr double kSmall_m = 1.3e-3;
// Share of a breath that breathing out takes, and the most bubbles that stand for one.
constexpr double kOutShare = 0.40, kMostBubbles = 650.0;
// The valve gurgles: gas leaves in gulps, so many a second, each over a share of the time between.
constexpr double kGulps_hz = 9.0, kGulpShare = 0.35;
// A wider bubble breaks up as it rises, after so many seconds, into so many at most, which part
// over so many widths.
constexpr double kBreaks_m = 9e-3, kBreakFirst_s = 0.25, kBreakLast_s = 2.0, kPartWidths = 2.5;
constexpr std::uint64_t kFewestParts = 3, kMostParts = 6;
// Random numbers of a breath's gulps come from here on.
constexpr std::uint64_t kOfGulps = std::uint64_t{1} << 40;
// A burst rises as one at first: its bubbles share the speed of caps of this radius, and go over to
// their own within this time.
constexpr double kBurst_m = 15e-3, kBurst_s = 0.7;
// The plume drags water up with it, m/s.
constexpr double kPlumeRise_m_s = 0.12;
// Silt: seconds from puff to puff; its first radius; how it spreads (m^2/s).
constexpr double kPuffEvery_s = 0.4, kPuff_m = 0.10, kPuffSpread_m2_s = 2e-3;

double bounded_normal(const MixedKey& key, std::uint64_t index) {
  return std::clamp(normal_of(random_uniform(key, index), random_uniform(key, index + 1)), kFewest,
                    kMost);
}

// Mean of exp(3 spread z) over the bounded normal z: a lognormal radius' mean cube over its
// median's.
double mean_cube() {
  const auto below = [](double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); };
  const double t = 3.0 * kBubbleSpread;
  return std::exp(0.5 * t * t) * (below(kMost - t) - below(kFewest - t)) +
         std::exp(t * kFewest) * below(kFewest) + std::exp(t * kMost) * (1.0 - below(kMost));
}

// A turbulent plume widens by about a tenth of its height: its radius.
double plume_m(double rise_m) {
  return 0.02 + 0.09 * rise_m;
}

// How far a bubble has risen age_s after it left, and how fast it rises then.
struct Rise {
  double m, m_s;
};
Rise rise_of(double radius_m, double age_s, double burst_m_s) {
  const double own_m_s = bubble_speed_m_s(radius_m) + kPlumeRise_m_s;
  const double ahead_m_s = std::max(burst_m_s - own_m_s, 0.0), left = std::exp(-age_s / kBurst_s);
  return {own_m_s * age_s + ahead_m_s * kBurst_s * (1.0 - left), own_m_s + ahead_m_s * left};
}

double pressure_pa(double y_m) {
  return kAir_pa + kDensity_kg_m3 * kFreeFall_m_s2 * std::max(-y_m, 0.0);
}

// Where a bubble left, and how far from the plume's axis it goes along x and z, in radii of the
// plume.
struct Course {
  Vec3 from_m;
  Vec2 off;
};

// A place within the unit circle.
Vec2 within_circle(const MixedKey& key, std::uint64_t index) {
  const double turn = 2.0 * kPi * random_uniform(key, index);
  return std::sqrt(random_uniform(key, index + 1)) * Vec2(std::cos(turn), std::sin(turn));
}

// The bubble that had this radius at the source, after its rise.
WorldParticle risen(const scene::BubbleSource& source, const Course& course, double radius_m,
                    double age_s, const Rise& rise, const Vec3& aside_m, const MixedKey& key,
                    std::uint64_t index) {
  WorldParticle bubble;
  const Vec2 off = course.off * plume_m(rise.m);
  // Ellipsoidal bubbles swing by about their own width, some five times a second; caps hardly do.
  const double swing = 2.0 * kPi * (5.0 * age_s + random_uniform(key, index));
  const double side = 1.5 * std::min(radius_m, 5e-3) * std::sin(swing);
  bubble.position_m = course.from_m + aside_m +
                      Vec3(off.x + side * course.off.y, rise.m, off.y - side * course.off.x);
  bubble.velocity_m_s = Vec3(0.0, rise.m_s, 0.0);
  // Boyle: the volume grows as the pressure falls.
  bubble.radius_m =
      radius_m * std::cbrt(pressure_pa(course.from_m.y) / pressure_pa(bubble.position_m.y));
  bubble.opacity = glm::smoothstep(source.height_m, 0.75 * source.height_m, rise.m) *
                   glm::smoothstep(0.0, 0.1, age_s);
  bubble.kind = shared::kParticleBubble;
  bubble.seed = static_cast<std::uint32_t>(random_bits(key, index + 1));
  return bubble;
}

// The bubbles that a wide one is broken into, at its age: their shares of its gas add up to all.
void add_parts(const scene::BubbleSource& source, const Course& course, double radius_m,
               double age_s, double broken_s, double burst_m_s, const MixedKey& key,
               std::uint64_t index, std::vector<WorldParticle>& out) {
  const auto parts =
      kFewestParts + static_cast<std::uint64_t>(double(kMostParts - kFewestParts + 1) *
                                                random_uniform(key, index));
  const Rise whole = rise_of(radius_m, broken_s, burst_m_s);
  const double parted_s = age_s - broken_s;
  const double part_m = kPartWidths * radius_m * (1.0 - std::exp(-parted_s / 0.4));
  double left = 1.0;
  for (std::uint64_t i = 0; i < parts; ++i) {
    const std::uint64_t own = index + 8 * (i + 1);
    const double share = i + 1 < parts ? left * (0.1 + 0.5 * random_uniform(key, own)) : left;
    left -= share;
    const double own_m = radius_m * std::cbrt(share);
    const double speed_m_s = bubble_speed_m_s(own_m) + kPlumeRise_m_s;
    const double turn = 2.0 * kPi * random_uniform(key, own + 1);
    const Vec3 aside(part_m * std::cos(turn), 0.5 * part_m * (random_uniform(key, own + 2) - 0.5),
                     part_m * std::sin(turn));
    out.push_back(risen(source, course, own_m, age_s, {whole.m + speed_m_s * parted_s, speed_m_s},
                        aside, key, own + 3));
  }
}

}  // namespace

double bubble_speed_m_s(double radius_m) {
  // Mendelson 1967, AIChE Journal 13, 250: like a wave as long as the bubble's girth; for diameters
  // over 1.3 mm. Smaller ones slow down in proportion.
  const double diameter_m = std::max(2.0 * radius_m, kSmall_m);
  const double speed = std::sqrt(2.0 * kTension_n_m / (kDensity_kg_m3 * diameter_m) +
                                 0.5 * kFreeFall_m_s2 * diameter_m);
  return speed * std::min(2.0 * radius_m / kSmall_m, 1.0);
}

void add_bubbles(const scene::MotionSource& motion, const scene::BubbleSource& source,
                 std::uint64_t number, std::uint64_t seed, double time_s,
                 std::vector<WorldParticle>& out, const SphereCulling* sight) {
  const bool leaks = source.breath_s <= 0.0;
  const double period_s = leaks ? 1.0 : source.breath_s;
  const double out_s = leaks ? period_s : kOutShare * period_s;
  double radius_m = source.median_radius_m;
  const double mean_m3 = 4.0 / 3.0 * kPi * radius_m * radius_m * radius_m * mean_cube();
  double count = source.flow_m3_s * period_s / mean_m3;
  if (count > kMostBubbles) {
    radius_m *= std::cbrt(count / kMostBubbles);
    count = kMostBubbles;
  }
  const RandomKey own{seed, kBubbleStream, number};
  const double first_s = period_s * random_uniform(own, 0);
  const double burst_m_s = leaks ? 0.0 : bubble_speed_m_s(kBurst_m) + kPlumeRise_m_s;
  // The slowest there can be: sqrt(a / d + b d) is least at d = sqrt(a / b), and less for the
  // smallest. Parts of a broken one are wider than that.
  const double smallest_m = radius_m * std::exp(kFewest * kBubbleSpread);
  const double slowest_m_s =
      std::sqrt(2.0 * std::sqrt(kTension_n_m / kDensity_kg_m3 * kFreeFall_m_s2)) *
          std::min(2.0 * smallest_m / kSmall_m, 1.0) +
      kPlumeRise_m_s;
  const double oldest_s = source.height_m / slowest_m_s + period_s;
  const auto gulps = std::max(1.0, std::round(kGulps_hz * out_s));
  const auto last = static_cast<std::int64_t>(std::floor((time_s - first_s) / period_s));
  const auto breaths = static_cast<std::int64_t>(std::ceil(oldest_s / period_s));
  // Where the source is as a gulp begins and ends, and how far off the axis the gulp goes.
  struct Gulp {
    Vec3 first_m, last_m;
    Vec2 off;
  };
  std::vector<std::optional<Gulp>> places(static_cast<std::size_t>(gulps));
  std::vector<WorldParticle> parts;
  const double share = leaks ? 1.0 : kGulpShare;
  for (std::int64_t breath = last - breaths; breath <= last; ++breath) {
    const MixedKey key(
        RandomKey{seed, kBubbleStream ^ mix64(number + 1), static_cast<std::uint64_t>(breath)});
    // A fraction of a bubble is one by chance.
    const auto n = static_cast<std::uint64_t>(std::floor(count + random_uniform(key, 0)));
    const double breath_s = first_s + period_s * static_cast<double>(breath);
    const auto place_at = [&](double gulp) {
      return motion.world_from_joint(static_cast<std::size_t>(source.object), source.joint,
                                     breath_s + out_s * gulp / gulps) *
             source.position_m;
    };
    // Once a bubble is left of it: a swimmer's joints at another time cost as much as ten bubbles.
    places.assign(places.size(), std::nullopt);
    const auto gulp_at = [&](std::size_t i) -> const Gulp& {
      if (!places[i])
        places[i] = Gulp{place_at(double(i)), place_at(double(i) + share),
                         within_circle(key, kOfGulps + 2 * i)};
      return *places[i];
    };
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::uint64_t index = 64 * (i + 1);
      // Most of a breath leaves early, in gulps; a leak trickles.
      double when = random_uniform(key, index);
      if (!leaks) when *= 0.5 + 0.5 * when;
      const double gulp = std::floor(when * gulps), within = when * gulps - gulp;
      const double born_s = breath_s + out_s * (gulp + share * within) / gulps;
      const double age_s = time_s - born_s;
      // Even the slowest is out of sight by then.
      if (age_s <= 0.0 || age_s * slowest_m_s > source.height_m) continue;
      const double own_m = radius_m * std::exp(kBubbleSpread * bounded_normal(key, index + 1));
      const Rise rise = rise_of(own_m, age_s, burst_m_s);
      const bool wide = own_m > kBreaks_m;
      const double broken_s =
          wide ? kBreakFirst_s + (kBreakLast_s - kBreakFirst_s) * random_uniform(key, index + 3)
               : age_s;
      const bool broken = wide && age_s > broken_s;
      // Parts rise more slowly than the whole, by not more than this.
      const double behind_m =
          broken ? (age_s - broken_s) * bubble_speed_m_s(own_m) + kPartWidths * own_m : 0.0;
      if (rise.m - behind_m > source.height_m) continue;
      const Gulp& from = gulp_at(static_cast<std::size_t>(gulp));
      Course course{glm::mix(from.first_m, from.last_m, within), Vec2(0.0)};
      // About where it is, with room for the plume's width, its swing and its growth.
      if (sight && !sight->may_see(course.from_m + Vec3(0.0, rise.m, 0.0) - sight->origin_m(),
                                   plume_m(rise.m) + behind_m + 10.0 * own_m + kSpotRoom_m))
        continue;
      const Vec2 alone = within_circle(key, index + 4);
      course.off = leaks ? alone : 0.55 * from.off + 0.45 * alone;
      parts.clear();
      if (broken)
        add_parts(source, course, own_m, age_s, broken_s, burst_m_s, key, index + 8, parts);
      else
        parts.push_back(risen(source, course, own_m, age_s, rise, Vec3(0.0), key, index + 6));
      for (const WorldParticle& bubble : parts)
        if (bubble.position_m.y < -bubble.radius_m &&
            bubble.position_m.y - course.from_m.y <= source.height_m)
          out.push_back(bubble);
    }
  }
}

void add_silt(const scene::MotionSource& motion, const scene::SiltSource& source,
              std::uint64_t number, std::uint64_t seed, double time_s,
              std::vector<WorldParticle>& out) {
  const auto object = static_cast<std::size_t>(source.object);
  const auto place_at = [&](double t_s) {
    return motion.world_from_joint(object, source.joint, t_s) * source.position_m;
  };
  const double life_s = 2.0 * source.hang_s;
  const auto last = static_cast<std::int64_t>(std::floor(time_s / kPuffEvery_s));
  for (std::int64_t puff = last; static_cast<double>(last - puff) * kPuffEvery_s < life_s; --puff) {
    const double born_s = kPuffEvery_s * static_cast<double>(puff);
    const double age_s = time_s - born_s;
    // Older puffs are so wide that every other one is enough, then every fourth: the rest fade out.
    const double left = puff % 2 != 0   ? glm::smoothstep(8.0, 4.0, age_s)
                        : puff % 4 != 0 ? glm::smoothstep(24.0, 16.0, age_s)
                                        : 1.0;
    if (left <= 0.0) continue;
    const Vec3 at = place_at(born_s);
    const double height_m = at.y + source.bed_depth_m;
    if (height_m >= source.reach_m) continue;
    const double near = 1.0 - std::max(height_m, 0.0) / source.reach_m;
    const double speed = glm::length(at - place_at(born_s - kPuffEvery_s)) / kPuffEvery_s;
    const double strength = near * near * (0.3 + 0.7 * std::min(speed / 0.3, 1.0));
    const RandomKey key{seed, kSiltStream ^ mix64(number), static_cast<std::uint64_t>(puff)};
    WorldParticle cloud;
    const double radius_m = std::sqrt(kPuff_m * kPuff_m + 4.0 * kPuffSpread_m2_s * age_s);
    const double turn = 2.0 * kPi * random_uniform(key, 0);
    const double out_m =
        0.25 * (1.0 - std::exp(-age_s / 1.5)) + 0.01 * age_s * random_uniform(key, 1);
    const double up_m = 0.5 * strength * (1.0 - std::exp(-age_s / 2.0)) * random_uniform(key, 2) +
                        0.6 * radius_m - 0.004 * age_s;
    cloud.position_m = Vec3(at.x + out_m * std::cos(turn),
                            std::max(-source.bed_depth_m + up_m, -source.bed_depth_m + 0.05),
                            at.z + out_m * std::sin(turn));
    cloud.radius_m = radius_m;
    // Its particles spread over a wider cloud, and settle.
    cloud.opacity = 0.75 * std::sqrt(strength) * std::pow(kPuff_m / radius_m, 0.7) *
                    std::exp(-age_s / source.hang_s) * glm::smoothstep(0.0, 0.5, age_s) * left;
    cloud.kind = shared::kParticleSilt;
    cloud.seed = static_cast<std::uint32_t>(random_bits(key, 3));
    if (cloud.opacity > 0.01) out.push_back(cloud);
  }
}

}  // namespace neritic::render
