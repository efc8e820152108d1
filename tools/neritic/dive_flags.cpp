#include "tools/neritic/dive_flags.hpp"

#include <cmath>

#include "engine/core/refusal.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "tools/neritic/dive_runs.hpp"
#include "tools/neritic/dive_told.hpp"
#include "tools/neritic/hud_flags.hpp"
#include "tools/neritic/step_files.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

bool draws(const DiveFlags& flags) {
  return flags.frames > 0 || flags.fast || flags.panels || flags.validation ||
         !flags.screenshot.empty() || !flags.size.empty() || !flags.sensors.empty() ||
         !flags.view.empty() || !flags.shown.empty() || !flags.water.empty() ||
         !flags.added.empty() || !flags.record_images.empty() || !flags.device.empty() ||
         !flags.hud.empty() || !flags.quality.empty() || !flags.timeline.empty();
}

// The first flag that needs physics; empty: none.
std::string physics_flag(const DiveFlags& flags) {
  if (const std::string flag = first_step_flag(flags.files); !flag.empty()) return flag;
  if (!flags.play.empty()) return "--play";
  if (!flags.replay.empty()) return "--replay";
  if (!flags.restore.empty()) return "--restore";
  if (!flags.markers.empty()) return "--markers";
  if (flags.realtime) return "--realtime";
  if (flags.json) return "--json";
  if (flags.runs) return "--runs";
  return "";
}

// The first flag that a replay cannot have; empty: none.
std::string flag_beside_replay(const DiveFlags& flags) {
  if (!flags.files.record.empty()) return "--record";
  if (!flags.files.save.empty()) return "--save";
  if (flags.seconds) return "--seconds";
  if (!flags.play.empty()) return "--play";
  if (!flags.restore.empty()) return "--restore";
  if (!flags.markers.empty()) return "--markers";
  if (flags.seed) return "--seed";
  if (flags.realtime) return "--realtime";
  return "";
}

// Flags that a run without a window or a headset would not look at.
Status check_flags_of_displays(const DiveFlags& flags) {
  if (flags.operator_window && (flags.headless || flags.display == "window"))
    return refusal("--operator",
                   flags.headless ? "--headless beside it" : "--display window beside it",
                   "a dive in a headset (a dive in a window has the panels in that)");
  if (!flags.headless) return {};
  if (flags.refresh_hz > 0.0 || !flags.bindings.empty())
    return refusal(flags.refresh_hz > 0.0 ? "--refresh" : "--bindings", "--headless beside it",
                   "a dive in a headset");
  if (flags.hud.empty() && !flags.panels && (!flags.diver.empty() || flags.units != "metric"))
    return refusal(flags.diver.empty() ? "--units" : "--diver", "--headless without --hud",
                   "with --hud, or a window or headset");
  return {};
}

Status check_replay_flags(const DiveFlags& flags) {
  const char* const alone = !flags.shown.empty()   ? "--scene"
                            : !flags.added.empty() ? "--add"
                            : !flags.water.empty() ? "--water"
                                                   : "";
  if (flags.replay.empty() && *alone != '\0')
    return refusal(alone, "no --replay beside it", "with a recording whose motion is shown");
  const std::string beside = flags.replay.empty() ? "" : flag_beside_replay(flags);
  if (beside.empty()) return {};
  return refusal("--replay", beside + " beside it",
                 "no --seconds, --record, --save, --play, --restore, --markers, --seed, "
                 "--realtime; it runs as "
                 "long as the recording, from where that begins");
}

}  // namespace

bool asks_for_physics_alone(const DiveFlags& flags, const scene::Scene& scene) {
  return flags.headless && PhysicsWorld::needed(scene) && !draws(flags);
}

Status check_physics_flags(const DiveFlags& flags, const scene::Scene& scene) {
  const std::string flag = physics_flag(flags);
  if (flag.empty()) return {};
  if (!PhysicsWorld::needed(scene)) return flag_without_physics(flag, flags.scene);
  const char* alone = flags.realtime       ? "--realtime"
                      : flags.runs         ? "--runs"
                      : flags.play.empty() ? ""
                                           : "--play";
  if (*alone != '\0' && (!flags.headless || draws(flags)))
    return refusal(alone, "a run with pictures", "with --headless and without flags of pictures");
  if (!flags.restore.empty() && !flags.play.empty())
    return refusal("--play", "--restore beside it", "a run from time 0, where a recording begins");
  if (flags.runs && (!first_step_flag(flags.files).empty() || flags.realtime ||
                     !flags.replay.empty() || !flags.restore.empty() || !flags.play.empty()))
    return refusal("--runs", "a flag of one run beside it",
                   "no --log, --log-rate, --plot, --record, --save, --replay, --restore, --play, "
                   "--realtime; one run leaves such files (--seed N)");
  return {};
}

Status check_dive_flags(const DiveFlags& flags) {
  if (flags.seconds && !(std::isfinite(*flags.seconds) && *flags.seconds > 0.0))
    return refusal("--seconds", fmt::format("{}", *flags.seconds), "a number above 0");
  if (flags.fast && !flags.headless)
    return refusal("--fast", "a run in a window", "with --headless (a window follows its screen)");
  if (flags.display != "auto" && flags.headless)
    return refusal("--display", "--headless beside it", "one of the two");
  if (flags.swim || !flags.task.empty()) {
    const char* const flag = flags.swim ? "--swim" : "--task";
    const char* const beside = flags.headless                        ? "--headless"
                               : flags.display == "openxr"           ? "--display openxr"
                               : flags.swim && !flags.replay.empty() ? "--replay"
                                                                     : "";
    if (*beside != '\0')
      return refusal(flag, fmt::format("{} beside it", beside), "a dive in a window");
  }
  if (flags.panels && !flags.headless)
    return refusal("--panels", "a run in a window", "with --headless (a window has them; F2)");
  if (!flags.hud.empty() && flags.hud != "none")
    if (const auto layouts = hud_layouts(flags.hud); !layouts.ok()) return layouts.error();
  NERITIC_TRY_STATUS(check_flags_of_displays(flags));
  return check_replay_flags(flags);
}

Status check_serve_flags(const DiveFlags& flags, const scene::Scene& scene, bool pictures) {
  if (flags.serve.empty())
    return flags.keys.empty() ? Status()
                              : refusal("--keys", "no --serve beside it", "with --serve");
  if (!flags.replay.empty()) return refusal("--serve", "--replay beside it", "one of the two");
  if (!PhysicsWorld::needed(scene))
    return refusal("--serve", "a scene in which nothing moves by physics",
                   "a scene with [physics] and a vehicle, a diver or an object with inputs");
  if (!pictures) return refusal("--serve", "a dive without pictures", "neritic serve SCENE");
  return {};
}

}  // namespace neritic::tools
