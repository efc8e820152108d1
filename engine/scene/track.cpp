#include "engine/scene/track.hpp"

#include <algorithm>
#include <optional>

#include "engine/core/check.hpp"

namespace neritic::scene {
namespace {

// Legs whose horizontal part is shorter than this have no heading: a body that descends.
constexpr double kLeastHorizontal_m = 1e-9;

// The key before time_s and how far it is to the next; nothing outside the keys.
struct Between {
  std::size_t before;
  double share, duration_s;
};
template <class Key>
std::optional<Between> between(const std::vector<Key>& keys, double time_s) {
  const auto above = std::upper_bound(keys.begin(), keys.end(), time_s,
                                      [](double t, const Key& key) { return t < key.time_s; });
  if (above == keys.begin() || above == keys.end()) return std::nullopt;
  const Key& before = *(above - 1);
  const double duration_s = above->time_s - before.time_s;  // > 0: above is later than time_s
  return Between{static_cast<std::size_t>(above - keys.begin()) - 1,
                 (time_s - before.time_s) / duration_s, duration_s};
}

// The time of the course's first round.
double in_round(const Track& track, double time_s) {
  const double passed_s = time_s - track.repeat_from_s;
  if (!(track.repeat_s > 0.0) || passed_s < 0.0) return time_s;
  return track.repeat_from_s + std::fmod(passed_s, track.repeat_s);
}

template <class Key>
const Key& outside(const std::vector<Key>& keys, double time_s) {
  return time_s < keys.front().time_s ? keys.front() : keys.back();
}

// Yaw of each leg, positive to port, 0 towards -z; unset where a leg has none and none came before.
std::vector<double> yaws_of(const std::vector<Track::Place>& places) {
  std::vector<double> yaws;
  std::optional<double> last;
  std::size_t unknown = 0;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const Vec3 way = places[i + 1].position_m - places[i].position_m;
    if (std::hypot(way.x, way.z) > kLeastHorizontal_m) last = std::atan2(-way.x, -way.z);
    if (!last) ++unknown;
    yaws.push_back(last.value_or(0.0));
  }
  if (unknown < yaws.size())
    std::fill_n(yaws.begin(), static_cast<std::ptrdiff_t>(unknown), yaws[unknown]);
  return yaws;
}

// Seconds of a leg that half a turn takes at one of its ends.
double half_turn_s(const Track::Place& from, const Track::Place& to, double turn_m) {
  const double length_m = glm::distance(from.position_m, to.position_m);
  if (!(length_m > 0.0)) return 0.0;
  return (to.time_s - from.time_s) * std::min(0.5, 0.5 * turn_m / length_m);
}

std::vector<Track::Attitude> attitudes_along(const std::vector<Track::Place>& places,
                                             const TrackHeading& heading) {
  const std::vector<double> yaws = yaws_of(places);
  const auto attitude = [&](double time_s, double yaw) {
    return Track::Attitude{time_s, from_yaw_pitch_roll(yaw, 0.0, 0.0) * heading.rotation};
  };
  std::vector<Track::Attitude> out{
      attitude(places.front().time_s, yaws.empty() ? 0.0 : yaws.front())};
  for (std::size_t i = 0; i + 1 < yaws.size(); ++i) {
    if (yaws[i] == yaws[i + 1]) continue;
    const Track::Place& corner = places[i + 1];
    out.push_back(
        attitude(corner.time_s - half_turn_s(places[i], corner, heading.turn_m), yaws[i]));
    out.push_back(
        attitude(corner.time_s + half_turn_s(corner, places[i + 2], heading.turn_m), yaws[i + 1]));
  }
  return out;
}

}  // namespace

std::vector<Track::Place> places_of(const Waypoints& waypoints) {
  std::vector<Vec3> points_m = waypoints.points_m;
  if (waypoints.repeat) points_m.insert(points_m.end(), {points_m[0], points_m[1]});
  std::vector<Track::Place> places;
  double length_m = 0.0;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    if (i > 0) length_m += glm::distance(points_m[i - 1], points_m[i]);
    places.push_back({waypoints.start_s + length_m / waypoints.speed_m_s, points_m[i]});
  }
  return places;
}

void close(Track& track) {
  const auto& places = track.places;
  NERITIC_CHECK(places.size() >= 4, "a course of {} places that repeats", places.size());
  // In the middle of the first leg no turn is under way.
  track.repeat_from_s = 0.5 * (places[0].time_s + places[1].time_s);
  track.repeat_s = places[places.size() - 2].time_s - places[0].time_s;
}

Track track_of(std::vector<Track::Place> places, const TrackHeading& heading) {
  NERITIC_CHECK(!places.empty(), "a track without places");
  Track track;
  track.attitudes = heading.along
                        ? attitudes_along(places, heading)
                        : std::vector{Track::Attitude{places.front().time_s, heading.rotation}};
  track.places = std::move(places);
  return track;
}

std::size_t leg_count(const LawnMower& mower) {
  const double across = mower.along_x ? mower.z1_m - mower.z0_m : mower.x1_m - mower.x0_m;
  return static_cast<std::size_t>(std::floor(across / mower.spacing_m * (1.0 + 1e-12))) + 1;
}

std::vector<Vec3> waypoints_of(const LawnMower& mower) {
  std::vector<Vec3> points;
  const std::size_t legs = leg_count(mower);
  const double y = -mower.depth_m;
  for (std::size_t leg = 0; leg < legs; ++leg) {
    const double step = static_cast<double>(leg) * mower.spacing_m;
    Vec3 a(mower.x0_m, y, mower.z0_m + step), b(mower.x1_m, y, mower.z0_m + step);
    if (!mower.along_x) {
      a = {mower.x0_m + step, y, mower.z0_m};
      b = {mower.x0_m + step, y, mower.z1_m};
    }
    if (leg % 2 == 1) std::swap(a, b);
    points.push_back(a);
    points.push_back(b);
  }
  return points;
}

Pose pose_at(const Track& track, double time_s) {
  NERITIC_CHECK(!track.places.empty() && !track.attitudes.empty(), "a track without keys");
  time_s = in_round(track, time_s);
  Pose pose;
  if (const auto at = between(track.places, time_s)) {
    const Vec3& a = track.places[at->before].position_m;
    pose.position_m = a + (track.places[at->before + 1].position_m - a) * at->share;
  } else {
    pose.position_m = outside(track.places, time_s).position_m;
  }
  if (const auto at = between(track.attitudes, time_s)) {
    pose.rotation = glm::normalize(glm::slerp(track.attitudes[at->before].rotation,
                                              track.attitudes[at->before + 1].rotation, at->share));
  } else {
    pose.rotation = outside(track.attitudes, time_s).rotation;
  }
  return pose;
}

Vec3 velocity_at(const Track& track, double time_s) {
  const auto at = between(track.places, in_round(track, time_s));
  if (!at) return Vec3(0.0);
  return (track.places[at->before + 1].position_m - track.places[at->before].position_m) /
         at->duration_s;
}

Vec3 angular_velocity_at(const Track& track, double time_s) {
  const auto at = between(track.attitudes, in_round(track, time_s));
  if (!at) return Vec3(0.0);
  Quat turn = track.attitudes[at->before + 1].rotation *
              glm::conjugate(track.attitudes[at->before].rotation);
  if (turn.w < 0.0) turn = -turn;  // the shortest way, as slerp goes
  const Vec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  if (!(sine > 0.0)) return Vec3(0.0);
  return axis * (2.0 * std::atan2(sine, turn.w) / sine / at->duration_s);
}

}  // namespace neritic::scene
