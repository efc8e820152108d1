// Where something that moves on a given course is, in its parent's frame (the world's, or its
// carrier's): a survey line, a lawn-mower pattern, a recorded trajectory. Positions run straight
// between places at constant speed, attitudes turn the shortest way at a constant rate; before the
// first and after the last key both stand still. Plain values, pure functions; any thread.
#pragma once

#include <vector>

#include "engine/core/math.hpp"

namespace neritic::scene {

struct Track {
  struct Place {
    double time_s = 0.0;
    Vec3 position_m{0.0};
  };
  struct Attitude {
    double time_s = 0.0;
    Quat rotation{1.0, 0.0, 0.0, 0.0};
  };
  // Each at least one, times not falling; of two at the same time the later counts from then on.
  std::vector<Place> places;
  std::vector<Attitude> attitudes;
  // From repeat_from_s on it goes round, once in repeat_s; 0: it does not.
  double repeat_from_s = 0.0, repeat_s = 0.0;
};

// A course through points at one speed.
struct Waypoints {
  std::vector<Vec3> points_m;  // two or more, neighbours apart
  double speed_m_s = 1.0;      // > 0
  double start_s = 0.0;
  bool repeat = false;  // from the last back to the first, and again
};

// How a body turns on its course.
struct TrackHeading {
  // True: yaw follows the course, level, and rotation comes on top of it. False: rotation alone.
  bool along = true;
  Quat rotation{1.0, 0.0, 0.0, 0.0};
  // Along: a corner is turned while this length of the course passes, half of it before the corner,
  // never more than the nearer half of a leg. 0: at once.
  double turn_m = 1.0;
};

// Those of a course that repeats end with its first leg, so that its turns are whole.
std::vector<Track::Place> places_of(const Waypoints& waypoints);
// Makes a track over the places of a course that repeats go round.
void close(Track& track);
// Along a course that is vertical or stands, the heading before it stays (at the start: that of the
// first leg with one, or none).
Track track_of(std::vector<Track::Place> places, const TrackHeading& heading);

// Legs over the rectangle, spacing_m apart from z0 (or x0) on, the last within spacing_m of the far
// edge; there and back in turns, beginning at (x0, z0). along_x: legs run along x. y = -depth_m.
struct LawnMower {
  double x0_m = 0, z0_m = 0, x1_m = 0, z1_m = 0;  // x0 < x1, z0 < z1
  double depth_m = 0.0, spacing_m = 1.0;          // spacing > 0
  bool along_x = true;
};
std::size_t leg_count(const LawnMower& mower);
std::vector<Vec3> waypoints_of(const LawnMower& mower);

Pose pose_at(const Track& track, double time_s);
// m/s and, about the parent's axes, rad/s; at a key those from then on. 0 outside the track.
Vec3 velocity_at(const Track& track, double time_s);
Vec3 angular_velocity_at(const Track& track, double time_s);

}  // namespace neritic::scene
