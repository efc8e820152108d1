// Any bytes as a vehicle's TOML file, and as a thrust table: an Error in one line, or a vehicle
// that moves, and a curve that comes back.
#include <cmath>

#include "engine/core/check.hpp"
#include "rov/step.hpp"
#include "rov/vehicle_file.hpp"
#include "tests/fuzz/replay.hpp"

namespace {

void expect_one_line(const neritic::Error& error) {
  NERITIC_CHECK(error.message.find('\n') == error.message.npos, "{}", error.message);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto file = rov::parse_vehicle(text, "fuzz.toml", "/nowhere", 1028.0);
  if (file.ok()) {
    const rov::Vehicle vehicle = rov::make_vehicle(file->parameters).value();
    rov::Inputs inputs;
    inputs.thruster_n.fill(5.0);
    rov::State state;
    for (int i = 0; i < 10; ++i) state = rov::step(vehicle, state, inputs, 0.1);
    NERITIC_CHECK(is_finite(state.position_ned_m) && rov::is_finite(state.velocity), "not finite");
  } else {
    expect_one_line(file.error());
  }
  const auto curve = rov::ThrustCurve::parse(text, "fuzz.csv");
  if (!curve.ok()) {
    expect_one_line(curve.error());
    return 0;
  }
  for (const double volts : {0.0, 12.0, 1e9})
    for (const double n : {-10.0, 0.0, 3.0})
      NERITIC_CHECK(std::isfinite(curve->realised_n(n, volts)), "{} N at {} V", n, volts);
  return 0;
}
