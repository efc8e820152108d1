// `neritic hud`: a diver's instruments over any other OpenXR program, as an overlay session of its
// own: from a recorded dive that runs again at its own pace, or from one that runs elsewhere.
#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/xr/openxr/headset.hpp"
#include "testbed/sensors/validation.hpp"
#include "testbed/server/remote_instruments.hpp"
#include "testbed/view/dive_hud.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/dive_physics.hpp"
#include "tools/neritic/dive_served.hpp"
#include "tools/neritic/hud_flags.hpp"
#include "tools/neritic/interrupt.hpp"
#include "tools/neritic/recorded_scene.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr std::uint32_t kOverlayFrames = 2;

// In the order of creation: each uses those before it.
struct OverlaySession {
  std::unique_ptr<gpu::Device> device;
  std::unique_ptr<xr::Headset> headset;
  std::unique_ptr<gpu::Frames> frames;
  std::unique_ptr<graph::Executor> executor;
};

Status start_overlay(const HudFlags& flags, OverlaySession& overlay) {
  // Not OpenXR's validation: the layer (1.0.20) refuses an overlay's chain of two.
  NERITIC_TRY(overlay.headset, xr::Headset::connect({.overlay = true}));
  gpu::DeviceOptions options;
  options.validation = flags.validation;
  overlay.headset->require(options);
  NERITIC_TRY(overlay.device, gpu::Device::create(options));
  NERITIC_TRY_STATUS(overlay.headset->attach(*overlay.device));
  NERITIC_TRY(overlay.frames, gpu::Frames::create(*overlay.device, kOverlayFrames));
  overlay.executor = std::make_unique<graph::Executor>(*overlay.frames);
  return {};
}

// One frame of the instruments, without a picture under them.
Status show_frame(OverlaySession& overlay, const xr::DisplayFrame& frame, DiveHud& hud) {
  static const xr::ViewGroup kNoView = xr::ViewGroup{1, 1, {xr::View{}}};
  if (frame.verdict != xr::FrameVerdict::kDraw) return overlay.headset->end_frame(false);
  graph::FrameGraph graph;
  std::vector<xr::Layer> layers;
  const Pose head = frame.world_from_head.value_or(Pose{});
  const auto draw = [&]() -> Status {
    HudView seen{kNoView, true, {}, head, frame.tracked.hands[0], true};
    seen.seen_s = 1e-9 * static_cast<double>(frame.display_at_ns.value_or(now_ns()));
    NERITIC_TRY_STATUS(hud.declare(graph, seen, layers));
    NERITIC_TRY([[maybe_unused]] const auto picture, overlay.headset->declare(graph, head, layers));
    NERITIC_TRY(gpu::Commands* const commands, overlay.frames->begin());
    NERITIC_TRY([[maybe_unused]] const auto plan, overlay.executor->run(graph, *commands));
    NERITIC_TRY([[maybe_unused]] const auto value, overlay.frames->submit());
    return {};
  };
  const Status drawn = draw();
  NERITIC_TRY_STATUS(overlay.headset->end_frame(drawn.ok()));
  return drawn;
}

// Until go_on says no, the runtime quits it, or this number of frames was seen (0: all).
Status show_frames(OverlaySession& overlay, DiveHud& hud, std::uint64_t frames,
                   const std::function<Result<bool>()>& go_on) {
  for (std::uint64_t shown = 0; frames == 0 || shown < frames;) {
    NERITIC_TRY(const bool on, go_on());
    if (!on) break;
    NERITIC_TRY(const xr::DisplayFrame frame, overlay.headset->begin_frame({}));
    if (frame.verdict == xr::FrameVerdict::kQuit) break;
    shown += frame.verdict == xr::FrameVerdict::kDraw ? 1 : 0;
    NERITIC_TRY_STATUS(show_frame(overlay, frame, hud));
  }
  return {};
}

Result<std::unique_ptr<RemoteInstruments>> connect(const HudFlags& flags) {
  RemoteInstrumentsOptions options{.remote = {.name = "hud"}, .diver = flags.diver};
  NERITIC_TRY(options.remote.socket.address, tcp_address("--connect", flags.connect));
  if (!flags.key.empty()) {
    NERITIC_TRY(options.remote.socket.keys, net::read_secret(flags.key));
    const auto beside = flags.key.parent_path() / "server.public";
    NERITIC_TRY(options.remote.socket.server_z85,
                net::read_public(flags.server_key.empty() ? beside : flags.server_key));
  } else if (!flags.server_key.empty()) {
    return refusal("--server-key", "no --key beside it", "with --key NAME.secret");
  }
  return RemoteInstruments::connect(options);
}

Status show_remote(const HudFlags& flags, const Interrupt& interrupt) {
  if (!flags.scene.empty())
    return refusal("--connect", "a scene beside it", "the address alone: the dive has its own");
  DiveHudOptions options;
  NERITIC_TRY(options.layouts, hud_layouts(flags.layouts.empty() ? "mask" : flags.layouts));
  if (flags.units == "imperial") options.units = hud::Units::kImperial;
  NERITIC_TRY(auto feed, connect(flags));
  OverlaySession overlay;
  NERITIC_TRY_STATUS(start_overlay(flags, overlay));
  fmt::print("{} of {}, from {}\n", feed->diver(), feed->title(), flags.connect);
  std::fflush(stdout);
  DiveHud hud(*overlay.device, *overlay.frames, std::move(feed), options);
  const Status status = show_frames(overlay, hud, flags.frames,
                                    [&]() -> Result<bool> { return !interrupt.requested(); });
  overlay.device->wait_idle();
  NERITIC_TRY_STATUS(status);
  return check_validation(*overlay.device);
}

}  // namespace

Status run_hud(const HudFlags& flags) {
  const Interrupt interrupt;
  if (!flags.connect.empty()) return show_remote(flags, interrupt);
  if (!flags.key.empty() || !flags.server_key.empty())
    return refusal(flags.key.empty() ? "--server-key" : "--key", "no --connect beside it",
                   "with --connect");
  NERITIC_TRY(SampleLog recorded, read_recording(flags.replay));
  NERITIC_TRY(const scene::Scene scene, recorded_scene(recorded, flags.replay, flags.scene, ""));
  if (!PhysicsWorld::needed(scene))
    return refusal(scene.path, "a scene in which nothing moves by physics",
                   "a scene with a diver that has physics");
  DiveFlags dive;
  dive.scene = scene.path, dive.hud = flags.layouts, dive.units = flags.units;
  dive.diver = flags.diver, dive.replay = flags.replay;
  NERITIC_TRY(const auto physics,
              make_dive_physics(dive, scene, &recorded, LivePhysics::Pace::kPicture));
  NERITIC_TRY(const auto options, hud_options(dive, physics.get(), "mask"));
  if (!options)
    return refusal(scene.path, "a scene without divers who swim",
                   "a scene with a diver that has physics");
  NERITIC_TRY(const auto replay, Replay::of(std::move(recorded), flags.replay, physics->world()));
  OverlaySession overlay;
  NERITIC_TRY_STATUS(start_overlay(flags, overlay));
  DiveHud hud(*overlay.device, *overlay.frames, *physics, *options);
  physics->listen({&replay->source});
  physics->start();
  const TimeNs start_ns = now_ns();
  const double start_s = physics->newest().time_s;
  const Status status = show_frames(overlay, hud, flags.frames, [&]() -> Result<bool> {
    const double time_s = 1e-9 * static_cast<double>(now_ns() - start_ns);
    if (interrupt.requested() || time_s > replay->seconds()) return false;
    physics->follow(0, start_s + time_s);
    NERITIC_TRY_STATUS(physics->listening());
    return true;
  });
  overlay.device->wait_idle();
  NERITIC_TRY_STATUS(status);
  return check_validation(*overlay.device);
}

}  // namespace neritic::tools
