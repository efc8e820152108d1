// Flies a vehicle by hand in the live program: keys to samples of a wrench. Rendering thread.
#pragma once

#include <string>

#include "hud/numbers.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/record/source_watch.hpp"
#include "testbed/samples/source.hpp"
#include "testbed/view/dive_input.hpp"
#include "testbed/view/host_hold.hpp"

namespace neritic::testbed {

class DivePilot final : public SampleSource {
 public:
  // Without physics, without vehicles, or if not may_fly (a replay), nothing is flown. kBadInput if
  // the inbox has no room for the keyboard.
  static Result<DivePilot> create(LivePhysics* physics, bool may_fly = true);

  // Keys of this frame. object: that carries the view, -1 none; if it is a vehicle, that one is
  // taken over, else the one before, at first the first. True while a vehicle is flown: the eye is
  // not then. speed: seconds of the scene in one of the host.
  bool take(const DiveInput& input, int object, double speed = 1.0);
  // The run went back to a saved state, where another may have had the authority.
  void went_back() { flew_ = had_authority(); }
  bool flying() const { return flying_; }
  // Sends what the keys of the newest frame ask for, once, and logs a line if the authority over
  // any group of inputs changed.
  Status poll(SampleInbox& inbox, double scene_time_s) override;
  // The object of the scene that is flown or would be; -1: none.
  int object() const;
  // For the panels: what an object that moves by physics does, or what its diver breathes; empty
  // for any other.
  std::string doing(std::size_t object, hud::Units units = hud::Units::kMetric) const;
  // A line each group of inputs whose source is silent or that does not use the samples sent to it.
  std::vector<std::string> troubles() const;

 private:
  explicit DivePilot(LivePhysics* physics);
  void send(SampleInbox& inbox, PayloadKind kind, std::uint64_t& sequence, const Payload& payload);
  void hand_over(SampleInbox& inbox);
  bool had_authority() const;
  bool heard() const;

  LivePhysics* physics_;
  std::size_t vehicle_ = 0;
  bool flying_ = false, flew_ = false;  // now, and at the last poll
  bool sent_ = true;                    // the newest keys
  VehicleWrench wrench_;                // of the newest keys
  HostHold hold_;                       // of those
  bool told_ = false;                   // the vehicle knows that hold
  std::optional<SourceWatch> watch_;
  std::optional<SourceId> keyboard_;         // absent: nothing is flown
  std::uint64_t wrenches_ = 0, events_ = 0;  // samples sent
};

}  // namespace neritic::testbed
