#include "engine/render/water_optics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic::render {
namespace {

TEST(WaterOptics, TenMetresFadeAsThePublishedTableSays) {
  // exp(-10 K_d) at 600 and 450 nm: type I 0.0954, 0.8270; III 0.0523, 0.2592; 5C 0.0183, 0.0037.
  const struct {
    const char* type;
    double red, blue;
  } rows[] = {{"I", .0954, .8270}, {"III", .0523, .2592}, {"5C", .0183, .0037}};
  for (const auto& row : rows) {
    const Vec3 k = jerlov_optics(row.type)->diffuse_attenuation_m;
    EXPECT_NEAR(std::exp(-10.0 * k.x), row.red, 5e-5) << row.type;
    EXPECT_NEAR(std::exp(-10.0 * k.z), row.blue, 5e-5) << row.type;
  }
}

TEST(WaterOptics, EveryTypeOfTheReferenceTableHasItsKd) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto csv = read_text(shared / "reference" / "jerlov_kd.csv");
  ASSERT_TRUE(csv.ok());
  std::istringstream lines(*csv);
  int checked = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#") || line.starts_with("type") || line.starts_with("AP84")) continue;
    std::istringstream cells(line);
    std::string type, cell;
    std::getline(cells, type, ',');
    std::vector<double> k;  // 400 to 700 nm in steps of 25
    while (std::getline(cells, cell, ',')) k.push_back(std::stod(cell));
    const auto optics = jerlov_optics(type);
    ASSERT_TRUE(optics.ok()) << type;
    EXPECT_NEAR(optics->diffuse_attenuation_m.x, k[8], 1e-9) << type;
    EXPECT_NEAR(optics->diffuse_attenuation_m.y, k[6], 1e-9) << type;
    EXPECT_NEAR(optics->diffuse_attenuation_m.z, k[2], 1e-9) << type;
    ++checked;
  }
  EXPECT_EQ(checked, 10);
}

// Not in I and IA: there absorption is nearly all, and the path of daylight is longer than its
// depth.
TEST(WaterOptics, SightFadesFasterThanDaylightWhereWaterScatters) {
  for (const char* type : {"IB", "II", "III", "1C", "3C", "5C", "7C", "9C"}) {
    const auto optics = jerlov_optics(type);
    ASSERT_TRUE(optics.ok());
    const Vec3 c = optics->beam_attenuation_m();
    for (int i = 0; i < 3; ++i) {
      EXPECT_GT(c[i], optics->diffuse_attenuation_m[i]) << type << " " << i;
    }
  }
}

TEST(WaterOptics, ClosureGivesBackKdAndSeaWaterAbsorbsNoLessThanPure) {
  // K_d = 1.04 (a + b_b) / mu_d with b_b = 0.5 b_water + 0.0183 b_particles (Morel 1974: pure water
  // scatters as much back as on), where absorption is not held at pure water's
  // (Pope and Fry 1997: 0.2224, 0.0565, 0.00922 at 600, 550, 450 nm).
  const Vec3 pure(.2224, .0565, .00922);
  int closed = 0;
  for (const char* type : {"I", "IA", "IB", "II", "III", "1C", "3C", "5C", "7C", "9C"}) {
    const auto o = jerlov_optics(type);
    const Vec3 back = .5 * o->water_scattering_m + .0183 * o->particle_scattering_m;
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(o->absorption_m[i], pure[i]) << type << " " << i;
      if (o->absorption_m[i] == pure[i]) continue;
      EXPECT_NEAR(1.04 * (o->absorption_m[i] + back[i]) / .86, o->diffuse_attenuation_m[i], 1e-9)
          << type;
      ++closed;
    }
  }
  EXPECT_GE(closed, 20);
}

TEST(WaterOptics, UnknownTypeNamesTheTen) {
  const auto optics = jerlov_optics("4C");
  ASSERT_FALSE(optics.ok());
  EXPECT_NE(optics.error().message.find("4C"), std::string::npos);
  EXPECT_NE(optics.error().message.find("9C"), std::string::npos);
}

}  // namespace
}  // namespace neritic::render
