#include "testbed/sensors/sonar_check.hpp"

#include "engine/core/refusal.hpp"
#include "sonar/gather.hpp"
#include "sonar/head.hpp"

namespace neritic::testbed {

Error of_sonar(const scene::Scene& scene, const scene::Sonar& sonar, Error error) {
  const std::string name = fmt::format("sonar {}: ", sonar.name);
  if (!error.message.starts_with(name)) error.message = name + error.message;
  if (!scene.path.empty()) error.message = scene.path + ": " + error.message;
  return error;
}

Status check_sonar(const scene::Scene& scene, const scene::Sonar& sonar) {
  const auto heads = sonar::plan_heads(sonar);
  if (!heads.ok()) return of_sonar(scene, sonar, heads.error());
  if (sonar.gather == sonar::name_of(sonar::Gather::kPublished) && heads->front().echo)
    return of_sonar(scene, sonar,
                    refusal("gather", "published, the plain cosine",
                            "plane or nearest beside terms and for kinds of one beam"));
  return {};
}

}  // namespace neritic::testbed
