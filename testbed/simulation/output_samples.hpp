// The samples that leave a simulation: readings of vehicle sensors, states and dive computers of
// divers, collisions. Each step's snapshot gives those that are due at it, each at its own rate.
// Only the streams that are asked for cost anything. The thread that has the snapshots, one at a
// time.
//
//   OutputSamples outputs(world, {world.streams().find("rov/imu").value()});
//   for (const Sample& sample : outputs.of(simulation.newest())) ...   // after each step
#pragma once

#include <vector>

#include "testbed/simulation/collisions.hpp"

namespace neritic::testbed {

// A diver's state leaves at this rate, or at that of the steps where it is lower. The dive computer
// has its own (diver::kComputerSample_s), vehicle sensors that of their files. A collision leaves
// with each step in which the body touches something.
inline constexpr double kDiverMotion_hz = 60.0;
inline constexpr double kBattery_hz = 1.0;
inline constexpr double kHuman_hz = 10.0;

class OutputSamples {
 public:
  // Every stream of the world that leaves the simulation.
  static std::vector<StreamId> all(const PhysicsWorld& world);

  // Borrows the world. Precondition: wanted is of all(world).
  OutputSamples(const PhysicsWorld& world, const std::vector<StreamId>& wanted);

  // Each step in turn, the start (or a restored state) first. A sensor that is faster than the
  // steps has all of its readings, in their order. Valid until the next call; allocates nothing.
  // The source is the simulation. The sequence number counts the readings of the run from 0,
  // whenever one begins to ask: it follows from the state alone, so that every consumer reads the
  // same samples. A step that was left out shows as a gap. Captured: the reading's own time;
  // arrived: when the step was due; both on the clock that drives the steps.
  std::span<const Sample> of(const sim::Snapshot<PhysicsState>& snapshot);

 private:
  struct Output {
    StreamId stream = 0;
    std::uint64_t count = 0;  // readings made up to the last snapshot
  };
  // A stream's readings up to a snapshot, and the time of the newest.
  struct Made {
    std::uint64_t count = 0;
    double time_s = 0.0;
  };
  Made made(const Stream& stream, const sim::Snapshot<PhysicsState>& snapshot) const;
  static Made made(PayloadKind kind, const rov::SensorReadings& readings);
  template <class MakePayload>
  void add(Output& output, const Made& now, const sim::Snapshot<PhysicsState>& snapshot,
           const MakePayload& payload);
  std::optional<std::size_t> ranging_of(const Stream& stream) const;
  void add_reports(Output& output, const Stream& stream,
                   const sim::Snapshot<PhysicsState>& snapshot);
  Made every(double period_s, std::uint64_t step) const;
  Payload payload(const Stream& stream, const sim::Snapshot<PhysicsState>& snapshot);

  const PhysicsWorld& world_;
  CollisionFinder collisions_;
  std::vector<Output> outputs_;
  std::vector<Sample> samples_;
  bool begun_ = false;
};

}  // namespace neritic::testbed
