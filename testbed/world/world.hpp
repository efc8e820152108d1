// A scene for programs: opened with a seed, stepped when they say so, read by stream, commanded by
// name. In-process Python and the server are made on it. It configures the testbed's one loop
// (testbed/loop) and turns it frame by frame; a device is made when the first image is asked for.
//
// ROS conventions (engine/core/ros_frames.hpp): world east, north, up; bodies forward, left, up;
// quaternions x, y, z, w. Numbers have names (fields of StreamInfo). One thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/result.hpp"
#include "testbed/samples/inbox.hpp"
#include "testbed/world/arrivals.hpp"

namespace neritic::scene {
struct Scene;
}

namespace neritic::testbed {

struct WorldOptions {
  std::optional<std::uint64_t> seed;  // instead of the scene's
  // Ticks wait for the host's clock, and the scene's devices are heard; else they run at once.
  bool real_time = false;
  unsigned threads = 1;     // of a step; 0: by the scene's size; at most sim::kMostThreads
  std::string device;       // of images: part of its name; empty: the best
  bool validation = false;  // of Vulkan, for images
};

struct StreamField {
  std::string name;
  std::uint32_t count = 1;
};
// A stream of readings, of inputs or of images. Its id is its place in World::streams().
struct StreamInfo {
  std::string name;   // "rov/imu", "diver/joints", "eye/color"
  std::string owner;  // "rov"
  std::string kind;   // "imu"
  std::string frame;  // of its vectors or its picture
  enum class Sort { kReading, kInput, kImage } sort = Sort::kReading;
  std::vector<StreamField> fields;  // of readings and inputs
  double rate_hz = 0.0;             // of images
  std::string encoding;             // of images, as ROS's sensor_msgs/Image names it
};
struct AgentInfo {
  std::string name;
  std::string kind;  // "vehicle", "diver", "object"
  // For a vehicle.
  std::vector<std::pair<double, double>> thruster_n;  // least and most force of each
  bool takes_pwm = false;
  bool has_mission = false;
  std::uint64_t modem = 0;  // its number among the scene's modems, from 1 on; 0: it has none
};

struct Reading {
  static constexpr std::size_t kMostValues = 32;
  std::uint32_t stream = 0;
  std::uint32_t count = 0;  // of values; 0: there is none yet
  std::uint64_t sequence = 0;
  TimeNs stamp_ns = 0, arrival_ns = 0;  // simulated time
  std::array<double, kMostValues> values{};
};

// An image with its own pixels: rows from the top, channels interleaved. Move only where it lies.
struct WorldImage {
  std::uint32_t stream = 0;
  std::uint64_t sequence = 0;
  TimeNs stamp_ns = 0, arrival_ns = 0;
  std::uint32_t width = 0, height = 0, channels = 1;
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> pixels;
  // For its frame in the world: a camera's optical frame (right, down, forward), a sonar's head
  // (forward, left, up).
  std::array<double, 3> position{};
  std::array<double, 4> orientation{0.0, 0.0, 0.0, 1.0};
  std::array<double, 4> intrinsics{};  // fx, fy, cx, cy of a camera, in pixels
  // For a sonar: limits of the rows (m) and columns (rad, positive to the left), and of elevation.
  std::array<double, 2> range_m{}, azimuth{}, elevation{};

  std::span<const std::byte> bytes() const;
};

// The true motion of an agent, apart from what is measured of it.
struct Truth {
  std::array<double, 3> position{};                             // of its origin, world
  std::array<double, 4> orientation{0.0, 0.0, 0.0, 1.0};        // world from body
  std::array<double, 3> linear_velocity{}, angular_velocity{};  // over ground, body axes
  std::array<double, 3> current{};                              // of the water there, world axes
  std::uint64_t touched_steps = 0;  // in which it touched something, so far
  std::vector<double> thruster_n;   // of a vehicle: the commands that act
  // For a diver, and an object with limbs that samples move: 15 rotations, as the command joints.
  std::vector<double> joints;
};

// A diver's instruments as numbers with names (testbed/instruments), and the health of the streams
// that feed the diver: name, note, "good", "waiting" or "lost".
struct Instruments {
  double time_s = 0.0;
  std::vector<std::pair<std::string, double>> numbers;
  std::vector<std::array<std::string, 3>> streams;
  std::string message, message_from;  // the newest words that the diver's modem received
};

// A source of samples (a device of the scene, a program, a client of the server) and what became
// of its samples.
struct SourceInfo {
  // The link of a device that the scene opens, as an operator's panel has it.
  struct Link {
    std::string device, where;  // "mxtp", "udp://127.0.0.1:9763"
    double rate_hz = 0.0;       // packets of late
    std::uint64_t lost = 0;     // packets that never came, by their own counter
    // Where its packets have a clock: host minus device, s; by which that is slow, 1e-6 (0 in the
    // first half minute); mean of the way's time beyond the shortest, ms.
    std::optional<double> clock_offset_s, clock_drift_ppm, jitter_ms;
    std::string trouble;  // of the connection, or why nothing is used; empty: none
  };
  std::string name;
  SourceCounts counts;
  // "waiting": never heard; "lost": it fell silent, so that a group of inputs is without it, or its
  // link is for a second; "good". Empty: no group listens to it, and it is no device.
  std::string health;
  std::optional<Link> link;
};
// The counts with their names for programs: "accepted", "dropped", ...
std::vector<std::pair<std::string_view, std::uint64_t>> named_counts(const SourceCounts& counts);

class Devices;
class ImageConsumer;
class LivePhysics;

class World {
 public:
  // Errors in one line: the scene's file, or nothing in it moves by physics.
  static Result<std::unique_ptr<World>> open(const std::filesystem::path& scene,
                                             const WorldOptions& options = {});
  // A world of a physics that another loop turns; it and the scene outlive this world: readings,
  // commands and truths of it, no tick(), no restore(), no recording. Its images are computed by
  // that loop, among whose consumers images() must be. path: of the scene. devices: of the scene,
  // which outlive this world; null: there are none.
  static Result<std::unique_ptr<World>> attach(LivePhysics& physics, const scene::Scene& scene,
                                               const std::string& path,
                                               const Devices* devices = nullptr);
  // Ends the recording.
  ~World();

  const std::string& title() const;
  // In lock-step the scene's devices, which send by the clock on the wall, are not listened to.
  bool leaves_devices() const;
  const std::string& path() const;
  std::uint64_t seed() const;
  double step_s() const;
  std::uint64_t step() const;
  double time_s() const;
  TimeNs time_ns() const;
  std::uint64_t hash() const;  // of the state
  const std::vector<AgentInfo>& agents() const;
  const std::vector<StreamInfo>& streams() const;
  // Names of the scene's objects: a reading's number n (gaze_object, held) is that of place n - 1.
  std::vector<std::string> objects() const;
  // kBadInput with the nearest name.
  Result<std::uint32_t> stream(const std::string& name) const;
  Result<std::size_t> agent(const std::string& name) const;

  // So many steps, in lock-step with the caller. An Error of a device, a source or a recording: the
  // steps until then were taken.
  Status tick(std::uint64_t steps = 1) { return tick(steps, {}); }
  // stop is asked after each step; true ends the tick there.
  Status tick(std::uint64_t steps, const std::function<bool()>& stop);

  // The newest reading of each stream that has arrived, by stream; count 0 where there is none.
  std::span<const Reading> newest() const;
  // Every reading of a stream is kept for take_arrived(), at most kMostKept; then the oldest is
  // dropped, and counted.
  static constexpr std::size_t kMostKept = 1 << 16;
  Status keep(std::uint32_t stream, bool on);
  std::vector<Reading> take_arrived();
  std::size_t arrived() const;  // that wait for take_arrived()
  std::uint64_t dropped() const;
  // On arrival only: what was measured stays. kBadInput for negative times or shares, and for a
  // stream of inputs.
  Status set_link(std::uint32_t stream, const LinkOptions& link);

  // Images of that stream from the next tick on, at the multiples of the period of rate_hz or of
  // the sensor's own rate (0), counted from time 0, and at most one a step. The first one makes the
  // device. keep: as above; else only the newest one waits.
  // kBadInput: no stream of images, or more than the sensor's rate.
  Status want_image(std::uint32_t stream, double rate_hz = 0.0, bool keep = false);
  Status check_image(std::uint32_t stream, double rate_hz) const;  // whether it would be refused
  Status drop_image(std::uint32_t stream);
  // Those that arrived since the last call, in their order, with their pixels: nothing is copied.
  std::vector<std::unique_ptr<WorldImage>> take_images();
  // The consumer by which an attached world asks its loop for images; null if the world has a loop
  // of its own.
  ImageConsumer* images();

  // A command for an agent takes the authority over its group and holds until the next one,
  // release() or, if hold_s > 0, until so long nothing came. Vehicles:
  //   goto        x y z yaw [vx vy vz]: be there, level
  //   velocity    vx vy vz yaw_rate: over ground, forward, left, up of its heading; cut to what the
  //               thrusters reach in that direction
  //   wrench      fx fy fz tx ty tz: N, N m, body axes; depth and heading are held where it is 0
  //   thrusters   a force each, N    pwm    a pulse width each, us    faults    1 each that fails
  // Divers: buttons  inflate deflate dump; joints  15 quaternions; head  position, orientation,
  // placed; hands, gaze, breath, heart, gas: the fields of the stream of that name.
  // Objects: pose  x y z qx qy qz qw [vx vy vz wx wy wz].
  // Divers with regulators: regulator  supply (0 by itself, 1 own tanks, 2 the donor's) and flow
  // (0 by the scene, 1 blows off, 2 holds). Grippers and hands: grip  0 by itself, 1 open, 2 close.
  // Both take no authority and hold until the next one.
  // Modems: send  the number of the modem that it is for (0: all), then 1 to 64 bytes; it takes no
  // authority, and what comes of it is read from AGENT/modem.
  // source: who commands, by name. kBadInput: what was found, what is accepted.
  Status command(const std::string& agent, const std::string& kind, std::span<const double> values,
                 double hold_s = 0.0, const std::string& source = kClient);
  // Gives all groups of the agent back to what the scene chose for them.
  Status release(const std::string& agent, const std::string& source = kClient);
  // A sample as a device of that name sends it, into a stream of inputs; it acts if the scene (or a
  // command) gives that source the authority. stamp_s: when it was measured; absent: now.
  Status inject(const std::string& stream, std::span<const double> values,
                const std::string& source, std::optional<double> stamp_s = {});
  static constexpr const char* kClient = "client";

  // All sources that were opened, in the order in which they were; not the simulation itself.
  std::vector<SourceInfo> sources() const;

  Result<Truth> truth(const std::string& agent) const;
  // kBadInput for an agent that is no diver.
  Result<Instruments> instruments(const std::string& agent) const;
  // An attached world: samples that left its physics, in their order, with simulated times. missed:
  // how many before them did not come; they count as dropped.
  void receive(std::span<const Sample> outputs, std::uint64_t missed = 0);

  // The whole state as bytes, and back at once; images and readings on their way are dropped. A
  // command that acted when it was saved goes on acting, until release() or another command.
  std::vector<std::byte> save() const;
  Status restore(std::span<const std::byte> bytes);

  // From now on until stop_recording(): PATH.mcap, which `neritic dive --replay` runs again
  // (testbed/record/RECORDING.md), with PATH.csv. If the disk fails, the run goes on, and
  // stop_recording() says so.
  Status record(const std::filesystem::path& path);
  Status stop_recording();
  bool recording() const;

 private:
  World();
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace neritic::testbed
