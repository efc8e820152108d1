// A headset through any OpenXR runtime, as a display. The runtime chooses the Vulkan device and
// makes it, so the order is connect, require, gpu::Device::create, attach. A session or runtime
// that is lost makes frames hidden until it is back: the program goes on. Rendering thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/xr/display.hpp"

namespace neritic::xr {

// The offer of an OpenXR runtime, and which of it this program uses.
struct HeadsetInfo {
  std::string runtime, system;  // names, the runtime's with its version
  struct Extension {
    std::string name;
    std::string adds;  // in words
    bool offered = false;
  };
  std::vector<Extension> extensions;  // all that this program knows
  std::vector<std::string> others;    // offered, and not used here
};

struct HeadsetOptions {
  // A space that stays where it is in the room (a lab's, with its origin on the floor). Else one
  // whose origin is where the head was when the wearer last recentred.
  bool room = false;
  double refresh_hz = 0.0;  // asked for where the runtime lets programs choose; 0: its own choice
  std::vector<ActionDesc> actions;
  // Over another program's picture, which goes on (XR_EXTX_overlay): panels alone, no views.
  // kUnsupported where the runtime cannot do that.
  bool overlay = false;
  // OpenXR's validation layer (Debian package openxr-layer-corevalidation). kUnsupported where it
  // is not installed.
  bool validation = false;
};

class Headset : public Display {
 public:
  // Connects to the runtime. kBadInput for an action's binding; kNoDevice where there is no loader,
  // no runtime or no headset, in one line; kUnsupported where the runtime has no Vulkan.
  static Result<std::unique_ptr<Headset>> connect(const HeadsetOptions& options);
  // Lets the runtime make the device. `this` must outlive the options.
  virtual void require(gpu::DeviceOptions& options) = 0;
  // Starts on that device, which must outlive the headset. Precondition: once, before any frame.
  virtual Status attach(gpu::Device& device) = 0;
  virtual const HeadsetInfo& info() const = 0;
  // Messages of the validation layer so far.
  virtual const std::vector<std::string>& validation_messages() const = 0;
};

// Asks the active runtime what it has, for a report; without a headset `system` is empty. kNoDevice
// as connect.
Result<HeadsetInfo> examine_headset();

}  // namespace neritic::xr
