// Any bytes as a diver's TOML file: an Error in one line, or a diver who swims and stays finite.
#include "diver/diver_file.hpp"
#include "engine/core/check.hpp"
#include "engine/sim/fields.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto file = diver::parse_diver(text, "fuzz.toml", "/nowhere", 1025.0);
  if (!file.ok()) {
    const std::string& message = file.error().message;
    NERITIC_CHECK(!message.empty() && message.find('\n') == message.npos, "{}", message);
    return 0;
  }
  const auto body = diver::make_body(file->parameters);
  NERITIC_CHECK(body.ok(), "read, but refused: {}", body.error().message);
  const auto computer = diver::DiveComputer::create(file->computer);
  NERITIC_CHECK(computer.ok(), "read, but refused: {}", computer.error().message);
  diver::HumanState state = diver::start_at(*body, {0.0, 0.0, 10.0}, {1.0, 0.0, 0.0, 0.0});
  diver::HumanInputs inputs;
  diver::SwimmerState swimmer;
  for (int i = 0; i < 12; ++i) {
    diver::swim(*body, file->swimmer, {{50.0, 5.0, 12.0}, 0.5}, state, swimmer, 0.05, inputs);
    state = diver::step(*body, state, inputs, 0.05);
  }
  state.life.computer = computer->step(computer->start(), {state.root.position_ned_m.z, 0}, 1.0);
  NERITIC_CHECK(sim::all_finite(state) && sim::all_finite(swimmer), "not finite");
  return 0;
}
