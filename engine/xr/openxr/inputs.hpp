// Inside engine/xr/openxr only: what the wearer does. Controls of controllers and gamepad, hands,
// gaze; those that the runtime does not have stay empty. Rendering thread.
#pragma once

#include <array>
#include <memory>

#include "engine/xr/display.hpp"
#include "engine/xr/openxr/session.hpp"

namespace neritic::xr::openxr {

class Inputs {
 public:
  // Before the session's first frame. All outlive it.
  static Result<std::unique_ptr<Inputs>> create(Runtime& runtime, const Session& session);
  ~Inputs();
  Inputs(const Inputs&) = delete;
  Inputs& operator=(const Inputs&) = delete;

  // Reads the controllers; state gets values, and presses since the last call. Nothing without
  // the wearer's focus.
  Status sync(DeviceState& state);
  // Hands and gaze, in the stage. hands: at that time. The gaze is the newest sample's, at its own.
  void track(XrTime at, Tracked& tracked) const;

 private:
  Inputs(Runtime& runtime, const Session& session) : runtime_(runtime), session_(session) {}
  struct ControlAction {
    XrAction action = XR_NULL_HANDLE;
    std::size_t control = 0;
    double sign = 1.0;
    bool held = true;  // or not known: a press counts only after it was seen released
  };
  Status create_actions();
  Status create_poses();
  Status suggest();
  Status attach();
  Result<XrAction> action(const std::string& name, XrActionType type);
  Result<XrSpace> space_of(XrAction action);
  XrPath path(const std::string& text) const;
  void make_trackers();
  std::optional<Pose> tracked_hand(std::size_t side, XrTime at) const;
  std::optional<Pose> held_controller(std::size_t side, XrTime at) const;
  void read_gaze(XrTime at, Tracked& tracked) const;
  Runtime& runtime_;
  const Session& session_;
  XrActionSet set_ = XR_NULL_HANDLE;
  std::vector<ControlAction> controls_;
  std::array<XrAction, 2> grips_{};
  std::array<XrSpace, 2> grip_spaces_{};
  XrAction gaze_ = XR_NULL_HANDLE;
  XrSpace gaze_space_ = XR_NULL_HANDLE;
  std::array<XrHandTrackerEXT, 2> trackers_{};
};

}  // namespace neritic::xr::openxr
