#include "engine/scene/flock_motion.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.hpp"
#include "engine/core/random.hpp"

namespace neritic::scene {
namespace {

// Fish that are placed on one core: fewer take less time than a thread's start.
constexpr std::size_t kLeastFish = 1000;
// Velocities are differences over this time.
constexpr double kStep_s = 0.04;
// A fish's pitch, at most: schools keep level.
constexpr double kSteepest = 0.6;  // rise over run

// A fish's own way about its place in the school: the share of the school's speed at which it
// strays, and its turns a second. Few stray far: the share rises with a draw's cube.
constexpr double kLeastStray = 0.22, kMostStray = 0.7;
constexpr double kSlowestStray_hz = 0.08, kFastestStray_hz = 0.2;
constexpr double kStrayUp = 0.6;       // of its height, to its breadth
constexpr double kMostBank_rad = 0.2;  // roll

// The streams of a fish's own numbers: of its place, then of its way about it.
enum Draw : std::uint64_t { kRing, kAngle, kHeight, kPhase, kSize, kDraws };
enum StrayDraw : std::uint64_t { kShare, kPace, kAcross, kUp, kAlong, kStrayDraws };

// A swell that runs through the whole school: neighbours do nearly the same, and none keeps its
// place for good. Wave vectors in 1 / radius; incommensurate, so that nothing repeats.
struct Swell {
  Vec3 direction, wave;
  double turns_s, phase;
};
constexpr int kSwells = 4;

struct School {
  const Flock& flock;
  MixedKey key, stray_key;
  Swell swells[kSwells];
};

School school_of(const Flock& flock) {
  School school{
      flock, MixedKey({flock.seed, 0x666c6f636b, 0}), MixedKey({flock.seed, 0x7374726179, 0}), {}};
  for (std::uint64_t i = 0; i < kSwells; ++i) {
    const auto draw = [&](std::uint64_t n) {
      return random_uniform({flock.seed, 0x7377656c6c, 0}, 8 * i + n) * 2.0 - 1.0;
    };
    school.swells[i] = {Vec3(draw(0), 0.5 * draw(1), draw(2)),
                        Vec3(draw(3), draw(4), draw(5)) * 2.2, 0.35 + 0.2 * draw(6), kPi * draw(7)};
  }
  return school;
}

// One fish's own numbers, the same at all times.
struct Fish {
  double ring, angle_rad, height, phase_rad, size;  // of its place in the school
  double stray_m_s, pace_rad_s, across_rad, up_rad, along_rad;
};

Fish fish_of(const School& school, std::uint64_t index) {
  const Flock& flock = school.flock;
  const auto draw = [&](Draw what) {
    return random_uniform(school.key, index * kDraws + static_cast<std::uint64_t>(what));
  };
  const auto stray = [&](StrayDraw what) {
    return random_uniform(school.stray_key, index * kStrayDraws + static_cast<std::uint64_t>(what));
  };
  Fish fish;
  // A disc that thins out to its rim; a mill is hollow in its middle.
  fish.ring = std::sqrt(std::lerp(flock.mill ? 0.12 : 0.0, 1.0, draw(kRing)));
  fish.angle_rad = 2.0 * kPi * draw(kAngle);
  fish.height = (2.0 * draw(kHeight) - 1.0) * std::sqrt(1.0 - 0.8 * fish.ring * fish.ring);
  fish.phase_rad = 0.5 * draw(kPhase);
  fish.size = flock.scale * std::lerp(0.75, 1.25, draw(kSize));
  fish.stray_m_s =
      flock.speed_m_s * std::lerp(kLeastStray, kMostStray, std::pow(stray(kShare), 3.0));
  fish.pace_rad_s = 2.0 * kPi * std::lerp(kSlowestStray_hz, kFastestStray_hz, stray(kPace));
  fish.across_rad = 2.0 * kPi * stray(kAcross);
  fish.up_rad = 2.0 * kPi * stray(kUp);
  fish.along_rad = 2.0 * kPi * stray(kAlong);
  return fish;
}

// Relative to the school's middle, before the fish strays and dodges.
Vec3 in_school(const School& school, const Fish& fish, double time_s) {
  const Flock& flock = school.flock;
  double angle = fish.angle_rad;
  if (flock.mill)  // every fish at the same speed, so inner ones get round sooner
    angle += flock.speed_m_s * time_s / (fish.ring * 0.5 * (flock.radius_m.x + flock.radius_m.z));
  Vec3 at(fish.ring * std::cos(angle), fish.height, fish.ring * std::sin(angle));
  Vec3 drift(0.0);
  for (const Swell& swell : school.swells)
    drift += swell.direction *
             std::sin(glm::dot(swell.wave, at) + 2.0 * kPi * swell.turns_s * 0.3 * time_s +
                      swell.phase + fish.phase_rad);
  at += 0.11 * drift;
  return at * flock.radius_m;
}

// From its place in the school.
Vec3 stray(const Fish& fish, double time_s) {
  const double turned_rad = fish.pace_rad_s * time_s;
  return fish.stray_m_s / fish.pace_rad_s *
         Vec3(std::sin(turned_rad + fish.across_rad),
              kStrayUp * std::sin(1.17 * turned_rad + fish.up_rad),
              std::sin(0.83 * turned_rad + fish.along_rad));
}

// Pushed out of the way: at distance r of what it avoids it swims at r + a exp(-r / a), which rises
// with r everywhere and is at least a.
Vec3 dodged(const Vec3& at, std::span<const Vec3> avoid, double avoid_m) {
  Vec3 out = at;
  for (const Vec3& from : avoid) {
    const Vec3 away = out - from;
    const double r = glm::length(away);
    if (r > 12.0 * avoid_m) continue;
    const double push = avoid_m * std::exp(-r / avoid_m);
    out += r > 1e-9 ? away * (push / r) : Vec3(0.0, push, 0.0);
  }
  return out;
}

struct Instant {
  Vec3 middle;
  std::vector<Vec3> avoid;
};

Instant instant_of(const MotionSource& source, std::size_t object, double time_s) {
  Instant out{source.world_from_object(object, time_s).position_m, {}};
  for (const std::size_t other : source.scene().objects[object].flock->avoid)
    out.avoid.push_back(source.world_from_object(other, time_s).position_m);
  return out;
}

// In the world. Fish do not stray beside what they avoid, where they turn and hurry most.
Vec3 place_of(const School& school, const Instant& instant, const Fish& fish, double time_s) {
  const double avoid_m = school.flock.avoid_m;
  const Vec3 at = instant.middle + in_school(school, fish, time_s);
  double calm = 1.0;
  for (const Vec3& from : instant.avoid) {
    const double r = glm::distance(at, from) / (2.0 * avoid_m);
    calm *= 1.0 - std::exp(-r * r);
  }
  return dodged(at + calm * stray(fish, time_s), instant.avoid, avoid_m);
}

// World_from_copy of a fish.
Mat4 copy_of(const School& school, const Instant& now, const Instant& soon, std::uint64_t index,
             double time_s) {
  const Fish fish = fish_of(school, index);
  const Vec3 at = place_of(school, now, fish, time_s);
  const Vec3 then = place_of(school, soon, fish, time_s + kStep_s);
  Vec3 way = then - at;
  const double run = std::hypot(way.x, way.z);
  way.y = std::clamp(way.y, -kSteepest * run, kSteepest * run);
  const double length = glm::length(way);
  const Vec3 back = length > 1e-12 ? way / -length : Vec3(0, 0, 1);
  const Vec3 level = glm::normalize(glm::cross(Vec3(0, 1, 0), back));
  const double bank_rad =
      kMostBank_rad * std::sin(0.7 * fish.pace_rad_s * time_s + fish.across_rad);
  const Vec3 right = std::cos(bank_rad) * level + std::sin(bank_rad) * glm::cross(back, level);
  const Vec3 up = glm::cross(back, right);
  return Mat4(Vec4(right * fish.size, 0.0), Vec4(up * fish.size, 0.0), Vec4(back * fish.size, 0.0),
              Vec4(at, 1.0));
}

}  // namespace

std::vector<Mat4> flock_copies(const MotionSource& source, std::size_t object, double time_s) {
  const Flock& flock = *source.scene().objects[object].flock;
  const School school = school_of(flock);
  const Instant now = instant_of(source, object, time_s);
  const Instant soon = instant_of(source, object, time_s + kStep_s);
  const Mat4 object_from_world = glm::inverse(to_matrix(source.world_from_object(object, time_s)));
  std::vector<Mat4> out(flock.count);
  in_ranges(flock.count, ranges_of(flock.count, kLeastFish),
            [&](std::size_t, std::size_t begin, std::size_t end) {
              for (std::size_t i = begin; i < end; ++i)
                out[i] = object_from_world * copy_of(school, now, soon, i, time_s);
            });
  return out;
}

}  // namespace neritic::scene
