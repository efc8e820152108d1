// The terms of a sonar as facts, for the .json beside its images: only those that were named.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "engine/scene/sonar_settings.hpp"

namespace neritic::sonar {

nlohmann::json terms_json(const scene::SonarTerms& terms);

}  // namespace neritic::sonar
