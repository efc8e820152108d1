#include "engine/scene/sonar_settings.hpp"

#include <tuple>

#include "engine/scene/scene.hpp"

namespace neritic::scene {

const char* name_of(SonarKind kind) {
  switch (kind) {
    case SonarKind::kImaging:
      return "imaging";
    case SonarKind::kProfiling:
      return "profiling";
    case SonarKind::kEchoSounder:
      return "echosounder";
    case SonarKind::kSideScan:
      return "sidescan";
    case SonarKind::kMechanical:
      return "mechanical";
  }
  return "";
}

bool same_settings(const Sonar& a, const Sonar& b) {
  const auto settings = [](const Sonar& s) {
    return std::tie(s.kind, s.range_min_m, s.range_max_m, s.azimuth_rad, s.elevation_rad,
                    s.bins_range, s.bins_azimuth, s.bins_elevation, s.gbuffer_scale, s.gather,
                    s.near_m, s.semi_angle_rad, s.depression_rad, s.step_rad, s.quality,
                    s.max_error, s.quality_chosen, s.least_target_m, s.terms);
  };
  return settings(a) == settings(b);
}

}  // namespace neritic::scene
