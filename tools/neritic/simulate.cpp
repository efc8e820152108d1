// `neritic simulate`: sends the bytes of a lab's devices, as a person who swims by himself would
// make them or from recordings.
#include "tools/neritic/simulate.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/address.hpp"
#include "engine/core/files.hpp"
#include "engine/core/refusal.hpp"
#include "testbed/loop/loop.hpp"
#include "tools/neritic/load_scene.hpp"
#include "tools/neritic/physio_report.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

// The same dive under the autopilot: nobody listens to the devices here.
scene::Scene alone(scene::Scene scene) {
  scene.sources.clear();
  for (scene::Object& object : scene.objects)
    if (object.human) object.human->inputs.clear();
  return scene;
}

Status send_devices(const SimulateFlags& flags, const scene::Scene& scene,
                    const Interrupt& interrupt) {
  SimulatedSignals signals;
  NERITIC_TRY_STATUS(read_signals(flags, signals));
  NERITIC_TRY(LabOptions options, lab_options(flags, signals));
  options.names = flags.what;
  NERITIC_TRY(auto world, PhysicsWorld::create(alone(scene)));
  const auto physics = LivePhysics::create(std::move(world), {.pace = LivePhysics::Pace::kPicture});
  const auto seen = [&](std::size_t diver) -> const HumanPhysics& {
    return physics->newest().state.humans()[diver];
  };
  NERITIC_TRY(const auto lab,
              SimulatedLab::create(scene, physics->world(), nullptr, seen, options));
  if (!flags.quiet) {
    for (const std::string& way : lab->ways()) fmt::print("{}\n", way);
    fmt::print("{}\n", flags.seconds ? fmt::format("for {:g} s", *flags.seconds) : "until Ctrl-C");
    std::fflush(stdout);
  }
  const double step_s = physics->world().step_s();
  Loop loop({.clock = Clock::real(0.0, step_s),
             .physics = physics.get(),
             .sources = {lab.get()},
             .stop = {.frames = flags.seconds
                                    ? static_cast<std::uint64_t>(std::ceil(*flags.seconds / step_s))
                                    : 0,
                      .interrupted = [&] { return interrupt.requested(); }}});
  NERITIC_TRY_STATUS(loop.run());
  if (!flags.quiet)
    fmt::print("{} packets in {:.1f} s, {} of them lost on purpose{}\n", lab->sent(), loop.wall_s(),
               lab->lost(),
               lab->not_taken() > 0
                   ? fmt::format(", {} not taken: nobody listens", lab->not_taken())
                   : "");
  return {};
}

Status check_shares(const SimulateFlags& flags) {
  for (const auto& [flag, percent] : {std::pair("--loss", flags.loss),
                                      {"--repeat", flags.repeat},
                                      {"--cut", flags.cut},
                                      {"--corrupt", flags.corrupt},
                                      {"--garbage", flags.garbage}})
    if (!(percent >= 0.0 && percent <= 100.0))
      return refusal(flag, fmt::format("{:g}", percent), "0 to 100 percent");
  for (const auto& [flag, ms] :
       {std::pair("--delay-ms", flags.delay_ms), {"--jitter-ms", flags.jitter_ms}})
    if (!(ms >= 0.0 && ms <= 60'000.0))
      return refusal(flag, fmt::format("{:g}", ms), "0 to 60000 milliseconds");
  if (flags.seconds && !(*flags.seconds > 0.0 && *flags.seconds <= 1e6))
    return refusal("--seconds", fmt::format("{:g}", *flags.seconds), "above 0, up to 1000000");
  if (!(flags.suit_hz >= 1.0 && flags.suit_hz <= 1000.0))
    return refusal("--suit-hz", fmt::format("{:g}", flags.suit_hz), "1 to 1000");
  return {};
}

Status read_signal(const char* what, const std::string& file,
                   std::optional<diver::Recording>& signal) {
  if (file.empty()) return {};
  PhysioFlags flags;
  flags.what = what;
  flags.file = file;
  NERITIC_TRY(signal, load_recording(flags));
  return {};
}

}  // namespace

Status read_signals(const SimulateFlags& flags, SimulatedSignals& signals) {
  if (!flags.limbs.empty()) {
    NERITIC_TRY(const std::string text, read_text(flags.limbs));
    NERITIC_TRY(signals.limbs, diver::read_limb_recording(text, flags.limbs));
  }
  if (!flags.buttons.empty()) {
    NERITIC_TRY(const std::string text, read_text(flags.buttons));
    NERITIC_TRY(signals.buttons, diver::read_button_recording(text, flags.buttons));
  }
  NERITIC_TRY_STATUS(read_signal("ecg", flags.ecg, signals.ecg));
  return read_signal("breath", flags.sound, signals.sound);
}

Result<LabOptions> lab_options(const SimulateFlags& flags, const SimulatedSignals& signals) {
  NERITIC_TRY_STATUS(check_shares(flags));
  LabOptions options;
  options.faults = {.delay_s = 1e-3 * flags.delay_ms,
                    .jitter_s = 1e-3 * flags.jitter_ms,
                    .loss = 0.01 * flags.loss,
                    .repeat = 0.01 * flags.repeat,
                    .cut = 0.01 * flags.cut,
                    .corrupt = 0.01 * flags.corrupt,
                    .garbage = 0.01 * flags.garbage,
                    .seed = flags.seed};
  if (!flags.to.empty()) {
    const auto to = parse_address(fmt::format("udp://{}:1", flags.to));
    if (!to.ok())
      return refusal("--to", fmt::format("'{}'", flags.to), "an IPv4 address, as 192.168.1.20");
    options.to_ipv4 = to->ipv4;
  }
  if (signals.limbs) options.limbs = &*signals.limbs;
  if (signals.buttons) options.buttons = &*signals.buttons;
  if (signals.ecg) options.ecg = &*signals.ecg;
  if (signals.sound) options.sound = &*signals.sound;
  options.suit_hz = flags.suit_hz;
  options.gloves = !flags.no_gloves;
  return options;
}

Status run_simulate(const SimulateFlags& flags) {
  const Interrupt interrupt;
  NERITIC_TRY(scene::Scene scene, load_scene_or_model(flags.scene, ""));
  if (!PhysicsWorld::needed(scene))
    return refusal(flags.scene, "a scene in which nothing moves by physics",
                   "a scene with [physics] and a diver");
  const auto asks = [&](const char* what) {
    return std::ranges::find(flags.what, what) != flags.what.end();
  };
  const bool whole = asks("lab") || asks("flood") || asks("latency");
  if (whole && flags.what.size() > 1)
    return refusal("simulate", fmt::format("{}", fmt::join(flags.what, " ")),
                   "lab, flood or latency alone, or devices");
  if (asks("lab")) return simulate_lab(flags, scene, interrupt);
  if (!flags.files.record.empty() || !flags.files.log.empty())
    return refusal(flags.files.record.empty() ? "--log" : "--record",
                   fmt::format("simulate {}", fmt::join(flags.what, " ")),
                   "with simulate lab; the dive that listens records (neritic dive --record)");
  if (asks("flood")) return simulate_flood(flags, scene, interrupt);
  if (asks("latency")) return simulate_latency(flags, std::move(scene), interrupt);
  return send_devices(flags, scene, interrupt);
}

}  // namespace neritic::tools
