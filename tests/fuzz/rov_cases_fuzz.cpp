// Any bytes as a file of trajectories, or of control: an Error in one line, or cases that run.
#include "engine/core/check.hpp"
#include "rov/control_cases.hpp"
#include "rov/trajectory_check.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

void expect_one_line(const neritic::Error& error) {
  NERITIC_CHECK(
      error.message.starts_with("fuzz.json") && error.message.find('\n') == error.message.npos,
      "{}", error.message);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto trajectories = rov::read_trajectories(text, "fuzz.json");
  if (!trajectories.ok()) expect_one_line(trajectories.error());
  if (trajectories.ok())
    for (rov::TrajectoryCase one : *trajectories) {
      // The first samples alone: long runs are no promise of the reader.
      while (one.samples.size() > 1 && one.samples.back().t_s > 0.5) one.samples.pop_back();
      if (one.samples.back().t_s > 0.5) continue;
      for (const rov::State& state : rov::run_trajectory(one, {rov::Integrator::kGuarded, 50.0}))
        NERITIC_CHECK(is_finite(state.position_ned_m) && rov::is_finite(state.velocity),
                      "not finite in {}", one.id);
    }
  const auto control = rov::read_control_cases(text, "fuzz.json");
  if (!control.ok()) expect_one_line(control.error());
  if (control.ok())
    for (const rov::LoopCase& loop : control->loops)
      NERITIC_CHECK(loop.duration_s <= 1e4 && loop.gains.period_s > 0.0, "{} s", loop.duration_s);
  return 0;
}
