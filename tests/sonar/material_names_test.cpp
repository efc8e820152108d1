// The names that a scene accepts as materials are those whose impedance is known.
#include <gtest/gtest.h>

#include <set>

#include "engine/scene/scene_materials.hpp"
#include "sonar/acoustics_materials.hpp"

namespace neritic {
namespace {

TEST(SonarMaterials, AreTheOnesThatScenesMayName) {
  std::set<std::string_view> known;
  for (const sonar::Material& material : sonar::materials()) known.insert(material.name);
  const std::set<std::string_view> named(scene::kMaterialNames.begin(),
                                         scene::kMaterialNames.end());
  EXPECT_EQ(named, known);
  EXPECT_EQ(named.size(), scene::kMaterialNames.size());
}

}  // namespace
}  // namespace neritic
