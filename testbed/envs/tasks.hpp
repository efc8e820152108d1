// The tasks of vectorised environments: where the goal is and how it moves, what a step is worth,
// and what ends an episode. North, east, down. Pure functions over plain values; any thread.
#pragma once

#include <optional>
#include <string_view>

#include "engine/core/result.hpp"
#include "testbed/envs/env_vehicle.hpp"

namespace neritic::testbed {

enum class Task {
  kHover,   // station keeping: stay at a place and a heading
  kTrack,   // follow a point on a smooth closed path in three dimensions
  kDock,    // come into a dock, along its axis, slowly
  kFollow,  // keep beside a diver who swims about, and face them
  kShark,   // keep between a diver and a shark, which turns away from a vehicle that is near
};
Result<Task> task_of(std::string_view name);
std::string_view name_of(Task task);

// Where the vehicle is to be, and what else of the task it may know.
struct Goal {
  Vec3 position_ned_m{0.0};
  Vec3 velocity_ned_m_s{0.0};
  double heading_rad = 0.0;
  // A point of the task: a second ahead on the path, the mouth of the dock, the diver, the shark.
  Vec3 point_ned_m{0.0};
};

// All that changes of a task in an episode.
struct TaskState {
  Goal goal;
  // For a path: amplitudes, rates and phases of its three axes around the middle.
  Vec3 middle_ned_m{0.0}, amplitude_m{0.0}, rate_rad_s{0.0}, phase_rad{0.0};
  // For the diver and of the shark.
  Vec3 diver_ned_m{0.0}, shark_ned_m{0.0};
  double diver_heading_rad = 0.0, diver_turn_rad_s = 0.0, diver_speed_m_s = 0.0;
  double shark_heading_rad = 0.0, shark_away_s = 0.0, shark_speed_m_s = 0.0;
};

struct Worth {
  double reward = 0.0;
  bool ends = false;  // success or failure: the episode's end is a state of the task, not of time
};

// The start of an episode: the task's state, and where the vehicle begins.
struct Start {
  TaskState state;
  Vec3 position_ned_m{0.0};
  double heading_rad = 0.0;
};
Start start_of(Task task, const Dice& dice);
// After time_s of the episode, one step later.
void advance(Task task, const Dice& dice, double time_s, double step_s, const Vec3& vehicle_ned_m,
             TaskState& state);
// In a task that is done once: the worth of where the vehicle is, of which a step's reward is the
// gain, so that staying beside the goal earns nothing. 0 in the others, whose steps are rewarded by
// where the vehicle is.
double potential_of(Task task, const TaskState& state, const rov::WaterMotion& motion);
// The worth of a step that ended in this motion. effort: mean square of the actions, 0 to 1;
// before: the potential before the step.
Worth worth_of(Task task, const TaskState& state, const rov::WaterMotion& motion,
               const rov::Vec6& velocity, double effort, double before);

}  // namespace neritic::testbed
