#include "testbed/view/run_keeper.hpp"

#include <ctime>

#include "testbed/view/key_words.hpp"

namespace neritic::testbed {
namespace {

namespace fs = std::filesystem;

// "NAME_20260131_235959" by local time, with a number behind if that is taken.
fs::path free_name(const std::string& name) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y%m%d_%H%M%S", &local);
  const std::string first = fmt::format("{}_{}", name, stamp);
  std::string base = first;
  std::error_code error;
  for (int i = 2; fs::exists(base + ".mcap", error) || fs::exists(base + ".mcap.part", error); ++i)
    base = fmt::format("{}_{}", first, i);
  return base;
}

}  // namespace

std::string RunKeeper::save() {
  std::optional<SavedState> saved;
  const StateFormat format = physics_.world().state_format();
  physics_.between_steps(
      [&](PhysicsSimulation& simulation) { saved = saved_state(simulation, format); });
  const Status written = write_state(state_file(), format, *saved);
  if (!written.ok()) return written.error().message;
  const std::string back = key_of(options_.actions, "go_back");
  return fmt::format("saved {:.1f} s to {}{}", static_cast<double>(saved->step) * format.step_s,
                     state_file().string(),
                     back.empty() ? "" : fmt::format("   {} goes back to it", back));
}

std::string RunKeeper::go_back(bool& went) {
  went = false;
  const auto refused = [&](const std::string& why) {
    return with_key(options_.actions, "go_back", why);
  };
  const auto also = [&](const char* action, const char* does) {
    const std::string key = key_of(options_.actions, action);
    return key.empty() ? std::string() : fmt::format("; {} {}", key, does);
  };
  if (!options_.no_way_back.empty()) return refused(options_.no_way_back);
  if (switch_.on()) return refused("the recording cannot go back" + also("record", "ends it"));
  std::error_code error;
  if (!fs::exists(state_file(), error))
    return refused("no " + state_file().string() + also("save", "saves it"));
  const auto saved = read_state(state_file(), physics_.world().state_format());
  if (!saved.ok()) return saved.error().message;
  const Status status = physics_.go_to(*saved);
  if (!status.ok()) return fmt::format("{}: {}", state_file().string(), status.error().message);
  went = true;
  return fmt::format("back to {:.1f} s of {}", physics_.shown_snapshot().time_s,
                     state_file().string());
}

std::string RunKeeper::toggle_recording() {
  if (switch_.on()) return end_recording();
  physics_.between_steps([&](PhysicsSimulation& simulation) {
    switch_.begin(simulation, free_name(options_.name), options_.scene);
  });
  return "records " + switch_.file().string();
}

std::string RunKeeper::end_recording() {
  std::unique_ptr<StepSink> files;
  physics_.between_steps([&](PhysicsSimulation&) { files = switch_.end(); });
  const Status written = files->finish();
  if (!written.ok()) return written.error().message;
  const std::string file = switch_.file().string();
  return fmt::format("wrote {}: --replay {}", file, file);
}

std::string RunKeeper::trouble() {
  return switch_.on() && switch_.failed() ? end_recording() : "";
}

std::optional<RunKeeper::Recording> RunKeeper::recording() const {
  const double now_s = physics_.shown_snapshot().time_s;
  if (switch_.on()) return Recording{switch_.file().string(), now_s - switch_.begun_s()};
  if (!options_.recording.empty()) return Recording{options_.recording, now_s - start_s_};
  return {};
}

}  // namespace neritic::testbed
