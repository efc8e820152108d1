// The run's files by key: its state saved and gone back to, its recording begun and ended. Each
// call gives a note for the operator. Rendering thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/xr/actions.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/record/recording_switch.hpp"

namespace neritic::testbed {

struct RunKeeperOptions {
  std::string name;        // of files: NAME.state, NAME_DATE.mcap
  RecordingOptions scene;  // of recordings by key
  std::string recording;   // a file that records the whole run; empty: none
  // Why the run cannot go back; empty: it can.
  std::string no_way_back;
  std::vector<xr::ActionDesc> actions = {};  // as they are bound, for notes that name a key
};

class RunKeeper {
 public:
  RunKeeper(LivePhysics& physics, RunKeeperOptions options)
      : physics_(physics),
        options_(std::move(options)),
        start_s_(physics.shown_snapshot().time_s),
        switch_(physics.world()) {}

  // Writes NAME.state to the current folder.
  std::string save();
  // Reads it, of this run or an earlier one. went: whether the run goes on from there.
  std::string go_back(bool& went);
  // Begins a recording with a name by the time of day, or ends it.
  std::string toggle_recording();
  // A note about a recording that failed by itself, once; empty: none.
  std::string trouble();

  // The recording in progress and its start; nothing while there is none.
  struct Recording {
    std::string file;
    double seconds = 0.0;
  };
  std::optional<Recording> recording() const;
  // To be given each step.
  StepSink& sink() { return switch_; }

 private:
  std::filesystem::path state_file() const { return options_.name + ".state"; }
  std::string end_recording();

  LivePhysics& physics_;
  RunKeeperOptions options_;
  double start_s_;
  RecordingSwitch switch_;
};

}  // namespace neritic::testbed
