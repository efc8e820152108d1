// Inside engine/xr/openxr only: a session of a runtime, from its creation to its end, by the states
// that the runtime's events name; and the space in which it tracks. Rendering thread.
#pragma once

#include <memory>
#include <optional>

#include "engine/xr/openxr/runtime.hpp"

namespace neritic::xr::openxr {

class Session {
 public:
  // runtime must outlive it.
  static Result<std::unique_ptr<Session>> create(Runtime& runtime, const gpu::Device& device,
                                                 const HeadsetOptions& options);
  // The GPU must be done with everything of its children.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Handles the runtime's events: begins the session when it is ready, ends it when it stops.
  // configuration: of the views, which begin needs.
  Status poll(XrViewConfigurationType configuration);
  XrSession handle() const { return handle_; }
  // Between begin and end: frames are waited for.
  bool running() const { return running_; }
  // The wearer or the runtime wants the program to end.
  bool exits() const { return exits_; }
  XrSpace stage() const { return stage_; }
  XrSpace head() const { return head_; }
  // Whether the space is the room's, as was asked for.
  bool in_room() const { return in_room_; }
  // Whether the lenses' masks changed since the last call.
  bool take_mask_change() { return std::exchange(mask_changed_, false); }

 private:
  explicit Session(Runtime& runtime) : runtime_(runtime) {}
  Status create_spaces(bool room);
  Result<XrSpace> reference_space(XrReferenceSpaceType type);
  Status on_state(XrSessionState state, XrViewConfigurationType configuration);
  void on_recentred(const XrEventDataReferenceSpaceChangePending& event) const;
  Status set_refresh_rate(double wanted_hz);
  Runtime& runtime_;
  XrSession handle_ = XR_NULL_HANDLE;
  XrSpace stage_ = XR_NULL_HANDLE, head_ = XR_NULL_HANDLE;
  bool running_ = false, exits_ = false, in_room_ = false, mask_changed_ = false;
};

}  // namespace neritic::xr::openxr
