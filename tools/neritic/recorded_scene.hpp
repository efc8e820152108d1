// A recording that is run again: which scene it is of, and the scene that is shown of it, which may
// have other sensors, other water, another place: --replay of `dive` and `render`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/record/recording_file.hpp"
#include "testbed/record/run_record.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {

// The scene of a recording; path: of the file that stands for it, empty: its own, as it was when it
// was recorded. kBadInput for a recording without a scene.
Result<scene::Scene> recorded_scene(const testbed::SampleLog& log, const std::string& file,
                                    const std::string& path, const std::string& size,
                                    scene::SceneOptions options = {});

// Changes to what is shown of a recording: other files' cameras, sonars, lights and things over its
// scene, or another scene, in which the participants of the same names move as they were recorded.
struct ShownChanges {
  std::string scene;               // empty: its own
  std::vector<std::string> added;  // files that are merged over it
  std::string water;               // a Jerlov type; empty: as it is
  bool any() const { return !scene.empty() || !added.empty() || !water.empty(); }
};
// The scene that is shown, its objects numbered as those of the scene whose physics runs, which is
// the recorded one (or path's). kBadInput where a participant has another model.
Result<scene::Scene> shown_scene(const testbed::SampleLog& log, const std::string& file,
                                 const std::string& path, const std::string& size,
                                 const ShownChanges& changes, const scene::Scene& physics,
                                 const scene::SceneOptions& options = {});

// Changes the Jerlov type of a scene's water. kBadInput for an unknown one, and without water.
Status set_water(scene::Scene& scene, const std::string& type, const std::string& path);

// A recording that is run again: it steers, and each state is compared with it. It stays where it
// is: the check borrows from the source.
struct Replay {
  testbed::RecordedSource source;
  testbed::RecordingCheck check;
  std::string file;

  // kBadInput for a recording of another scene.
  static Result<std::unique_ptr<Replay>> of(testbed::SampleLog log, const std::string& file,
                                            const testbed::PhysicsWorld& world);
  std::uint64_t steps() const { return source.log().steps(); }
  double seconds() const { return static_cast<double>(steps()) * source.log().step_s; }
  // On standard output: how many steps were as recorded.
  void tell() const;
};
// kBadInput for a file without steps. Warns where it was cut off.
Result<testbed::SampleLog> read_recording(const std::string& file);
// The state that a recording of mid-run begins with, for this world; nothing: its start.
Result<std::optional<testbed::SavedState>> start_of(const testbed::SampleLog& log,
                                                    const std::string& file,
                                                    const testbed::PhysicsWorld& world);
// The facts that a new recording says of its run. on_clock: it runs at a real clock's pace.
Result<testbed::RecordingOptions> recording_options(const std::string& scene, bool on_clock);

}  // namespace neritic::tools
