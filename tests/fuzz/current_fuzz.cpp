// Any bytes as the grid of a current: an Error in one line, or finite velocities everywhere.
#include "engine/core/check.hpp"
#include "engine/sim/current.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto grid = sim::parse_grid_current(fuzz::as_bytes(data, size), "fuzz.npy", {});
  if (!grid.ok()) {
    const std::string& message = grid.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.npy: ") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  for (const Vec3& p : {Vec3(0.0), Vec3(0.4, 0.6, 0.9), Vec3(-1e9, 1e300, 2.5)}) {
    const sim::CurrentSample at = sim::sample(*grid, p, p.x);
    NERITIC_CHECK(glm::length(at.velocity_m_s) <= 2.0 * sim::kMaxCurrent_m_s, "{} m/s",
                  glm::length(at.velocity_m_s));
    NERITIC_CHECK(is_finite(at.rate_m_s2) && is_finite(at.gradient_per_s[0]), "at {}", p.x);
  }
  return 0;
}
