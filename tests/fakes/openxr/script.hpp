// The fake headset's properties and acts, read from lines of text (README.md lists them). Lines can
// be added while a program runs. Times are seconds of simulated time; angles in the text are
// degrees.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/fakes/openxr/poses.hpp"

namespace neritic::fakes {

// Something that happens when the frame of this number (from 0, of each session) is waited for.
struct TimedLine {
  std::uint64_t frame = 0;
  std::string line;
};

struct Controller {
  PoseTrack grip;
  std::string profile;  // "" while it is switched off
};

// Calls of a function that fail although the client is correct.
struct ScriptedFailure {
  int times = 0, after = 0;  // after so many that do not fail
  XrResult result = XR_ERROR_RUNTIME_FAILURE;
};

struct Script {
  // The system.
  bool available = true;      // xrCreateInstance answers
  int system_refusals = 0;    // how often xrGetSystem says that no headset is plugged in
  int instance_refusals = 0;  // how often xrCreateInstance says that the runtime is away
  int views = 2;              // 1, 2 or 4
  std::uint32_t width = 160, height = 160, focus_width = 160, focus_height = 160;
  std::uint32_t max_size = 4096;
  std::array<double, 4> fov_left{-52, 42, 45, -49};  // degrees; the right eye's is mirrored
  double focus_deg = 14;                             // half the angle of a focus view
  double eye_distance_m = 0.064, cant_deg = 0;       // cant: each eye turned outwards
  std::vector<std::int64_t> formats{
      VK_FORMAT_R8G8B8A8_SRGB,  VK_FORMAT_B8G8R8A8_SRGB,
      VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT,
      VK_FORMAT_D32_SFLOAT,     VK_FORMAT_D16_UNORM};  // VkFormat, best first
  std::uint32_t swapchain_length = 3, max_layers = 16, max_array = 4;
  std::set<std::string> without;  // extensions that are not offered
  // Those of Vulkan that XR_KHR_vulkan_enable wants.
  std::set<std::string> vulkan_instance{"VK_KHR_external_memory_capabilities"};
  std::set<std::string> vulkan_device{"VK_KHR_dedicated_allocation",
                                      "VK_KHR_get_memory_requirements2"};
  bool stage = true;
  std::string name = "Neritic fake headset";
  std::vector<float> refresh_rates{72, 90, 120};
  // Time.
  double period_s = 1.0 / 90.0, lead_periods = 2;
  double gaze_period_s = 0.005;
  std::map<std::uint64_t, int> late;  // frame: by how many periods
  bool real_time = false;             // xrWaitFrame sleeps, on the monotonic clock
  // The person.
  PoseTrack head;
  std::array<PoseTrack, 2> hands;          // the wrist of each; empty: not tracked
  std::array<StepTrack<double>, 2> curls;  // 0 flat, 1 a fist
  bool hands_seen = true;
  PoseTrack gaze;  // of the eyes in the head; empty: not tracked
  std::array<Controller, 2> controllers;
  std::string gamepad;                                             // profile, "" without one
  std::map<std::string, StepTrack<std::array<double, 2>>> inputs;  // by path
  StepTrack<bool> tracked;                                         // the head's pose
  StepTrack<bool> oriented, positioned;                            // whether it is known at all
  Pose local{{0, 1.6, 0}, {1, 0, 0, 0}};  // of LOCAL's origin on the stage's floor
  // Pictures.
  std::string out;                     // folder of the composed pictures, "" for none
  std::set<std::uint64_t> out_frames;  // empty: all
  std::array<double, 3> background{0, 0, 0};
  bool main_visible = true;  // of the program under an overlay
  int image_timeouts = 0;    // how often xrWaitSwapchainImage runs out of its time
  std::string report;        // file that gets a line for each fault
  std::deque<TimedLine> timed;
  std::map<std::string, ScriptedFailure> failures;  // by function
};

// Applies the lines of text. The first line that is not understood, with its number; else nothing.
std::optional<std::string> read_script(const std::string& text, Script& script);

}  // namespace neritic::fakes
