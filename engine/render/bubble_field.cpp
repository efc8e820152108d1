#include "engine/render/bubble_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "engine/core/random.hpp"

namespace neritic::render {
namespace {

constexpr std::uint64_t kBubbleStream = 0x627562;
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
Rise rise_of(double own_m_s, double age_s, double burst_m_s) {
  const double ahead_m_s = burst_m_s - own_m_s;
  if (ahead_m_s <= 0.0) return {own_m_s * age_s, own_m_s};
  const double left = std::exp(-age_s / kBurst_s);
  return {own_m_s * age_s + ahead_m_s * kBurst_s * (1.0 - left), own_m_s + ahead_m_s * left};
}

double pressure_pa(double y_m) {
  return kAir_pa + kDensity_kg_m3 * kFreeFall_m_s2 * std::max(-y_m, 0.0);
}

// A place within the unit circle.
Vec2 within_circle(const MixedKey& key, std::uint64_t index) {
  const double turn = 2.0 * kPi * random_uniform(key, index);
  return std::sqrt(random_uniform(key, index + 1)) * Vec2(std::cos(turn), std::sin(turn));
}

}  // namespace

// The facts of a source that hold for all its breaths.
struct BubbleField::Plan {
  bool leaks;
  double period_s, out_s, first_s, count, radius_m, burst_m_s, gulps, oldest_s;

  Plan(const scene::BubbleSource& source, std::uint64_t number, std::uint64_t seed) {
    leaks = source.breath_s <= 0.0;
    period_s = leaks ? 1.0 : source.breath_s;
    out_s = leaks ? period_s : kOutShare * period_s;
    radius_m = source.median_radius_m;
    const double mean_m3 = 4.0 / 3.0 * kPi * radius_m * radius_m * radius_m * mean_cube();
    count = source.flow_m3_s * period_s / mean_m3;
    if (count > kMostBubbles) {
      radius_m *= std::cbrt(count / kMostBubbles);
      count = kMostBubbles;
    }
    first_s = period_s * random_uniform(RandomKey{seed, kBubbleStream, number}, 0);
    burst_m_s = leaks ? 0.0 : bubble_speed_m_s(kBurst_m) + kPlumeRise_m_s;
    // The slowest there can be: sqrt(a / d + b d) is least at d = sqrt(a / b), and less for the
    // smallest. Parts of a broken one are wider than that.
    const double smallest_m = radius_m * std::exp(kFewest * kBubbleSpread);
    const double slowest_m_s =
        std::sqrt(2.0 * std::sqrt(kTension_n_m / kDensity_kg_m3 * kFreeFall_m_s2)) *
            std::min(2.0 * smallest_m / kSmall_m, 1.0) +
        kPlumeRise_m_s;
    oldest_s = source.height_m / slowest_m_s + period_s;
    gulps = std::max(1.0, std::round(kGulps_hz * out_s));
  }
  // The share of a gulp's time in which gas leaves.
  double share() const { return leaks ? 1.0 : kGulpShare; }
};

double bubble_speed_m_s(double radius_m) {
  // Mendelson 1967, AIChE Journal 13, 250: like a wave as long as the bubble's girth; for diameters
  // over 1.3 mm. Smaller ones slow down in proportion.
  const double diameter_m = std::max(2.0 * radius_m, kSmall_m);
  const double speed = std::sqrt(2.0 * kTension_n_m / (kDensity_kg_m3 * diameter_m) +
                                 0.5 * kFreeFall_m_s2 * diameter_m);
  return speed * std::min(2.0 * radius_m / kSmall_m, 1.0);
}

// The bubbles that a wide one breaks into: their shares of its gas add up to all.
void BubbleField::add_parts(Breath& breath, Bubble& bubble, const MixedKey& key,
                            std::uint64_t index) {
  const auto parts =
      kFewestParts + static_cast<std::uint64_t>(double(kMostParts - kFewestParts + 1) *
                                                random_uniform(key, index));
  bubble.first_part = breath.parts.size();
  bubble.parts = static_cast<std::size_t>(parts);
  double left = 1.0;
  for (std::uint64_t i = 0; i < parts; ++i) {
    const std::uint64_t own = index + 8 * (i + 1);
    const double share = i + 1 < parts ? left * (0.1 + 0.5 * random_uniform(key, own)) : left;
    left -= share;
    const double radius_m = bubble.part.radius_m * std::cbrt(share);
    const double turn = 2.0 * kPi * random_uniform(key, own + 1);
    breath.parts.push_back(
        {radius_m, bubble_speed_m_s(radius_m) + kPlumeRise_m_s,
         Vec3(std::cos(turn), 0.5 * (random_uniform(key, own + 2) - 0.5), std::sin(turn)),
         random_uniform(key, own + 3), static_cast<std::uint32_t>(random_bits(key, own + 4))});
  }
}

BubbleField::Breath BubbleField::breath_of(const scene::BubbleSource& source, const Plan& plan,
                                           std::uint64_t number, std::uint64_t seed,
                                           std::int64_t which) {
  const MixedKey key(
      RandomKey{seed, kBubbleStream ^ mix64(number + 1), static_cast<std::uint64_t>(which)});
  Breath breath;
  breath.begins_s = plan.first_s + plan.period_s * static_cast<double>(which);
  // A fraction of a bubble is one by chance.
  const auto n = static_cast<std::uint64_t>(std::floor(plan.count + random_uniform(key, 0)));
  breath.bubbles.reserve(n);
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::uint64_t index = 64 * (i + 1);
    Bubble bubble;
    // Most of a breath leaves early, in gulps; a leak trickles.
    double when = random_uniform(key, index);
    if (!plan.leaks) when *= 0.5 + 0.5 * when;
    const double gulp = std::floor(when * plan.gulps);
    bubble.gulp = static_cast<std::size_t>(gulp);
    bubble.within = when * plan.gulps - gulp;
    bubble.born_s =
        breath.begins_s + plan.out_s * (gulp + plan.share() * bubble.within) / plan.gulps;
    const double radius_m =
        plan.radius_m * std::exp(kBubbleSpread * bounded_normal(key, index + 1));
    const double speed_m_s = bubble_speed_m_s(radius_m) + kPlumeRise_m_s;
    bubble.part = {radius_m, speed_m_s, Vec3(0.0), random_uniform(key, index + 6),
                   static_cast<std::uint32_t>(random_bits(key, index + 7))};
    const Vec2 alone = within_circle(key, index + 4);
    bubble.off =
        plan.leaks ? alone : 0.55 * within_circle(key, kOfGulps + 2 * bubble.gulp) + 0.45 * alone;
    bubble.gone_s = source.height_m / speed_m_s;
    if (radius_m > kBreaks_m) {
      bubble.broken_s =
          kBreakFirst_s + (kBreakLast_s - kBreakFirst_s) * random_uniform(key, index + 3);
      bubble.broken_at_m = rise_of(speed_m_s, bubble.broken_s, plan.burst_m_s).m;
      add_parts(breath, bubble, key, index + 8);
      // Until the slowest of its parts has risen so far, from the lowest place that it may have.
      double slowest_m_s = speed_m_s;
      for (std::size_t k = 0; k < bubble.parts; ++k)
        slowest_m_s = std::min(slowest_m_s, breath.parts[bubble.first_part + k].speed_m_s);
      bubble.gone_s = std::max(
          bubble.gone_s,
          bubble.broken_s +
              (source.height_m + kPartWidths * radius_m - bubble.broken_at_m) / slowest_m_s);
    }
    breath.bubbles.push_back(bubble);
  }
  add_gulps(breath, plan);
  return breath;
}

void BubbleField::add_gulps(Breath& breath, const Plan& plan) {
  std::ranges::stable_sort(breath.bubbles, {}, &Bubble::gulp);
  breath.gulps.resize(static_cast<std::size_t>(plan.gulps));
  for (std::size_t i = 0; i < breath.bubbles.size(); ++i) {
    const Bubble& bubble = breath.bubbles[i];
    Gulp& gulp = breath.gulps[bubble.gulp];
    if (gulp.count++ == 0) gulp.first = i;
    const auto add = [&](const Part& part) {
      gulp.slowest_m_s = std::min(gulp.slowest_m_s, part.speed_m_s);
      gulp.fastest_m_s = std::max(gulp.fastest_m_s, part.speed_m_s);
      gulp.widest_m = std::max(gulp.widest_m, part.radius_m);
    };
    add(bubble.part);
    std::ranges::for_each(std::span(breath.parts).subspan(bubble.first_part, bubble.parts), add);
  }
}

void BubbleField::append(const scene::MotionSource& motion, const scene::BubbleSource& source,
                         std::uint64_t number, std::uint64_t seed, double time_s,
                         std::vector<WorldParticle>& out, const SphereCulling* sight) {
  const Plan plan(source, number, seed);
  const auto last = static_cast<std::int64_t>(std::floor((time_s - plan.first_s) / plan.period_s));
  const auto first = last - static_cast<std::int64_t>(std::ceil(plan.oldest_s / plan.period_s));
  const Settings settings{seed, source.breath_s, source.flow_m3_s, source.median_radius_m,
                          source.height_m};
  Kept& kept = kept_[number];
  if (!(kept.settings == settings)) kept = {settings, {}};
  // Two views may be of times that lie a breath apart.
  std::erase_if(kept.breaths,
                [&](const auto& b) { return b.first < first - 1 || b.first > last + 1; });
  for (std::int64_t which = first; which <= last; ++which) {
    auto found = kept.breaths.find(which);
    if (found == kept.breaths.end())
      found = kept.breaths.emplace(which, breath_of(source, plan, number, seed, which)).first;
    add_breath(motion, source, plan, found->second, time_s, out, sight);
  }
}

// A bubble, or a part of one, at its age; from_m: where it left; rise: since then.
void BubbleField::place(const scene::BubbleSource& source, const Vec3& from_m, const Vec2& off,
                        const Part& part, const Vec3& aside_m, double age_s, double rise_m,
                        double rise_m_s, std::vector<WorldParticle>& out) {
  const Vec2 beside = off * plume_m(rise_m);
  // Ellipsoidal bubbles swing by about their own width, some five times a second; caps hardly do.
  const double swing = 2.0 * kPi * (5.0 * age_s + part.phase);
  const double side = 1.5 * std::min(part.radius_m, 5e-3) * std::sin(swing);
  WorldParticle bubble;
  bubble.position_m =
      from_m + aside_m + Vec3(beside.x + side * off.y, rise_m, beside.y - side * off.x);
  bubble.velocity_m_s = Vec3(0.0, rise_m_s, 0.0);
  // Boyle: the volume grows as the pressure falls.
  bubble.radius_m =
      part.radius_m * std::cbrt(pressure_pa(from_m.y) / pressure_pa(bubble.position_m.y));
  if (bubble.position_m.y >= -bubble.radius_m || bubble.position_m.y - from_m.y > source.height_m)
    return;
  bubble.opacity = glm::smoothstep(source.height_m, 0.75 * source.height_m, rise_m) *
                   glm::smoothstep(0.0, 0.1, age_s);
  bubble.kind = shared::kParticleBubble;
  bubble.seed = part.look;
  out.push_back(bubble);
}

void BubbleField::add_breath(const scene::MotionSource& motion, const scene::BubbleSource& source,
                             const Plan& plan, const Breath& breath, double time_s,
                             std::vector<WorldParticle>& out, const SphereCulling* sight) {
  for (std::size_t g = 0; g < breath.gulps.size(); ++g) {
    const Gulp& gulp = breath.gulps[g];
    const auto left_at = [&](double since) {
      return breath.begins_s + plan.out_s * (static_cast<double>(g) + since) / plan.gulps;
    };
    const double first_s = left_at(0.0), last_s = left_at(plan.share());
    if (gulp.count == 0 || time_s <= first_s) continue;
    const double lowest_m = gulp.slowest_m_s * std::max(time_s - last_s, 0.0);
    if (lowest_m > source.height_m + kPartWidths * gulp.widest_m) continue;
    const auto source_at = [&](double left_s) {
      return motion
          .place_of(static_cast<std::size_t>(source.object), source.joint, source.position_m,
                    left_s)
          .position_m;
    };
    const Vec3 first_m = source_at(first_s), last_m = source_at(last_s);
    if (sight) {
      // About the upright line along which they are, with room for the plume's width, their swing
      // and growth.
      const double highest_m = std::max(
          lowest_m,
          std::min(rise_of(gulp.fastest_m_s, time_s - first_s, plan.burst_m_s).m, source.height_m));
      const Vec3 from_m = 0.5 * (first_m + last_m) - sight->origin_m();
      if (!sight->may_see_between(from_m + Vec3(0.0, lowest_m, 0.0),
                                  from_m + Vec3(0.0, highest_m, 0.0),
                                  0.5 * glm::distance(first_m, last_m) + plume_m(highest_m) +
                                      10.0 * gulp.widest_m + kSpotRoom_m))
        continue;
    }
    for (const Bubble& bubble : std::span(breath.bubbles).subspan(gulp.first, gulp.count))
      add_bubble(source, plan, breath, bubble, glm::mix(first_m, last_m, bubble.within), time_s,
                 out, sight);
  }
}

// A bubble that left there, or its parts.
void BubbleField::add_bubble(const scene::BubbleSource& source, const Plan& plan,
                             const Breath& breath, const Bubble& bubble, const Vec3& from_m,
                             double time_s, std::vector<WorldParticle>& out,
                             const SphereCulling* sight) {
  const double age_s = time_s - bubble.born_s;
  if (age_s <= 0.0 || age_s > bubble.gone_s) return;
  const double parted_s = age_s - bubble.broken_s;
  const bool broken = parted_s > 0.0;
  const Rise rise = rise_of(bubble.part.speed_m_s, age_s, plan.burst_m_s);
  // Parts rise more slowly than the whole, by not more than this.
  const double behind_m = broken ? parted_s * (bubble.part.speed_m_s - kPlumeRise_m_s) +
                                       kPartWidths * bubble.part.radius_m
                                 : 0.0;
  if (rise.m - behind_m > source.height_m) return;
  // About where it is, with room for the plume's width, its swing and its growth.
  if (sight &&
      !sight->may_see(from_m + Vec3(0.0, rise.m, 0.0) - sight->origin_m(),
                      plume_m(rise.m) + behind_m + 10.0 * bubble.part.radius_m + kSpotRoom_m))
    return;
  if (!broken)
    return place(source, from_m, bubble.off, bubble.part, Vec3(0.0), age_s, rise.m, rise.m_s, out);
  const double part_m = kPartWidths * bubble.part.radius_m * (1.0 - std::exp(-parted_s / 0.4));
  for (const Part& part : std::span(breath.parts).subspan(bubble.first_part, bubble.parts))
    place(source, from_m, bubble.off, part, part_m * part.way, age_s,
          bubble.broken_at_m + part.speed_m_s * parted_s, part.speed_m_s, out);
}

}  // namespace neritic::render
