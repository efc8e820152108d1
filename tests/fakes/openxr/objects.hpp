// The objects behind OpenXR handles. A handle is a number that is never used twice, so that a
// destroyed one is told from an unknown one. All guarded by the runtime's lock.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "tests/fakes/openxr/poses.hpp"
#include "tests/fakes/openxr/vulkan.hpp"

namespace neritic::fakes {

struct Object {
  Object(XrObjectType type, Object* parent) : type(type), parent(parent) {}
  virtual ~Object() = default;
  const XrObjectType type;
  Object* const parent;
  std::uint64_t handle = 0;
};

struct Instance : Object {
  using Handle = XrInstance;
  static constexpr XrObjectType kObject = XR_OBJECT_TYPE_INSTANCE;
  Instance() : Object(kObject, nullptr) {}
  std::set<std::string> extensions;
  std::vector<std::string> paths;  // XrPath is the index + 1
  std::deque<XrEventDataBuffer> events;
  bool lost = false;
  bool has_system = false;
  bool asked_requirements = false, asked_requirements2 = false;  // by version of vulkan_enable
  VulkanObjects vulkan;
  std::map<std::string, std::map<std::uint64_t, std::vector<std::string>>> suggested;  // by profile
};

// One action's value under one subaction path, as the last xrSyncActions read it.
struct ActionValue {
  bool active = false, changed = false;
  double x = 0, y = 0;
  XrTime changed_at = 0;
};
struct ActionState {
  std::map<std::string, ActionValue> by_top;  // "" for all
};

struct Frame {
  std::uint64_t number = 0;
  XrTime display_time = 0;
};

struct Session : Object {
  using Handle = XrSession;
  static constexpr XrObjectType kObject = XR_OBJECT_TYPE_SESSION;
  explicit Session(Instance* parent) : Object(kObject, parent), instance(*parent) {}
  Instance& instance;
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;  // as last told by an event that was queued
  std::unique_ptr<Gpu> gpu;
  bool running = false, lost = false, exit_requested = false;
  bool overlay = false;
  bool foveated = false;        // the views were last located about the gaze
  std::uint32_t placement = 0;  // of an overlay's layers, from the lowest
  int wake_after_polls = -1;    // READY again after that many empty polls; below 0: never
  XrViewConfigurationType views = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  std::uint64_t next_frame = 0;
  bool has_waited = false, has_begun = false;
  Frame waited, begun;
  double period_s = 0;
  float refresh_rate = 0;
  bool attached = false;  // action sets
  std::vector<std::uint64_t> action_sets;
  std::map<std::string, std::string> profile_told;  // by top-level path, as the last event said
  std::map<std::uint64_t, ActionState> action_states;
};

struct Space : Object {
  using Handle = XrSpace;
  static constexpr XrObjectType kObject = XR_OBJECT_TYPE_SPACE;
  explicit Space(Session* parent) : Object(kObject, parent), session(*parent) {}
  Session& session;
  XrReferenceSpaceType reference = XR_REFERENCE_SPACE_TYPE_MAX_ENUM;  // of a reference space
  std::uint64_t action = 0;                                           // of an action space
  std::string top_path;                                               // "" for any
  Pose offset;
};

enum class ImageUse { kFree, kAcquired, kWaited };

struct Swapchain : Object {
  using Handle = XrSwapchain;
  static constexpr XrObjectType kObject = XR_OBJECT_TYPE_SWAPCHAIN;
  explicit Swapchain(Session* parent) : Object(kObject, parent), session(*parent) {}
  ~Swapchain() override;
  Session& session;
  XrSwapchainCreateInfo info{};
  std::vector<SwapchainImage> images;
  std::vector<ImageUse> uses;
  std::deque<std::uint32_t> acquired;  // oldest first
  std::uint32_t next = 0;
  int released = -1;  // the image of the last release
  bool ever_acquired = false;
};

struct ActionSet : Object {
  using Handle = XrActionSet;
  static constexpr XrObjectType kObject = XR_OBJECT_TYPE_ACTION_SET;
  explicit ActionSet(Instance* parent) : Object(kObject, parent), instance(*parent) {}
  Instance& instance;
  std::string name, localized;
  std::uint32_t priority = 0;
  bool attached = false;
};

struct Action : Object {
  using Handle = XrAction;
  static constexpr XrObjectType kObject = XR_OBJECT_TYPE_ACTION;
  explicit Action(ActionSet* parent) : Object(kObject, parent), set(*parent) {}
  ActionSet& set;
  std::string name, localized;
  XrActionType kind = XR_ACTION_TYPE_BOOLEAN_INPUT;
  std::vector<std::string> subactions;
};

struct HandTracker : Object {
  using Handle = XrHandTrackerEXT;
  static constexpr XrObjectType kObject = XR_OBJECT_TYPE_HAND_TRACKER_EXT;
  explicit HandTracker(Session* parent) : Object(kObject, parent), session(*parent) {}
  Session& session;
  std::size_t side = 0;
};

}  // namespace neritic::fakes
