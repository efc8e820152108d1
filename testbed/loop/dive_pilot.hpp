// Flies a vehicle by hand in the live program: keys to samples of a wrench, and a view that rides
// along. Rendering thread.
#pragma once

#include <string>

#include "testbed/loop/dive_input.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/record/source_watch.hpp"
#include "testbed/samples/source.hpp"

namespace neritic::testbed {

class DivePilot final : public SampleSource {
 public:
  // Without physics, without vehicles, or if not may_fly (a replay), nothing is flown. view: the
  // mount of the camera that is flown. kBadInput if the inbox has no room for the keyboard.
  static Result<DivePilot> create(LivePhysics* physics, const scene::Mount& view,
                                  bool may_fly = true);

  // Keys of this frame. True while a vehicle is flown: the camera is not then.
  bool take(const DiveInput& input);
  bool flying() const { return flying_; }
  // Sends what the keys of the newest frame ask for, once, and logs a line if the authority over
  // any group of inputs changed.
  Status poll(SampleInbox& inbox, double scene_time_s) override;
  // The riding view; precondition: flying().
  Pose world_from_view() const;
  // For the panels: a line a vehicle, then one a group of inputs whose source is silent or that
  // does not use the samples sent to it.
  std::vector<std::string> lines() const;

 private:
  DivePilot(LivePhysics* physics, const scene::Mount& view);
  void send(SampleInbox& inbox, PayloadKind kind, std::uint64_t& sequence, const Payload& payload);
  void hand_over(SampleInbox& inbox);

  LivePhysics* physics_;
  std::size_t vehicle_ = 0;  // the one that the view is on, else the first
  Pose vehicle_from_view_;
  bool flying_ = false, flew_ = false;  // now, and at the last poll
  bool sent_ = true;                    // the newest keys
  VehicleWrench wrench_;                // of the newest keys
  std::optional<SourceWatch> watch_;
  std::optional<SourceId> keyboard_;         // absent: nothing is flown
  std::uint64_t wrenches_ = 0, events_ = 0;  // samples sent
};

}  // namespace neritic::testbed
