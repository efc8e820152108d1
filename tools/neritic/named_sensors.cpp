#include "tools/neritic/named_sensors.hpp"

#include <algorithm>

#include "engine/core/refusal.hpp"

namespace neritic::tools {

Result<NamedSensors> named_sensors(const std::vector<std::string>& names,
                                   const scene::Scene& scene) {
  NamedSensors sensors;
  std::vector<std::string> known;
  const auto add = [&](const auto& all, std::vector<std::size_t>& wanted) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      known.push_back(all[i].name);
      if (names.empty() || std::ranges::count(names, known.back()) > 0) wanted.push_back(i);
    }
  };
  add(scene.cameras, sensors.cameras);
  add(scene.sonars, sensors.sonars);
  for (const std::string& name : names)
    if (std::ranges::count(known, name) == 0)
      return refusal("--sensor", fmt::format("'{}'", name),
                     known.empty() ? "none, since the scene has no sensors"
                                   : fmt::format("{}", fmt::join(known, ", ")));
  return sensors;
}

}  // namespace neritic::tools
