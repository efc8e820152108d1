// Rows that are taller than a range bin: what they share out over the bins that they span, and what
// is hidden between them, against closed forms.
#include <algorithm>

#include "sonar/label_energy.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarFootprint = test::GpuTest;

constexpr double kHeight_m = 2.5;  // over the floor
constexpr std::uint32_t kBeams = 16, kBins = 1024;

scene::Scene floor_below(std::uint32_t rows, double range_max_m = 16.0) {
  scene::Sonar sonar = sonar_of(4.0, range_max_m, kBins);
  sonar.azimuth_rad = radians(10.0);
  sonar.bins_azimuth = kBeams;
  sonar.bins_elevation = rows;
  sonar.gbuffer_scale = 2.0;
  // Down to 26 degrees, up to 6 below the horizon: ranges 5.7 to 23.9 m.
  sonar.mount.pose.rotation = glm::angleAxis(radians(-16.0), Vec3(1, 0, 0));
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_plane(80.0, 80.0), {0.0, -kHeight_m, 0.0}));
  scene.sonars = {sonar};
  return scene;
}

// The plain cosine's mean over 20 degrees of elevation that the floor gives between two ranges, in
// the plane straight ahead: the integral of sin(g) dg, sin g = H / r.
double floor_between(double near_m, double far_m) {
  const auto below = [](double r) { return std::sqrt(1.0 - kHeight_m * kHeight_m / (r * r)); };
  return (below(far_m) - below(near_m)) / radians(20.0);
}

TEST_F(SonarFootprint, AFloorAtGrazingIsNoComb) {
  const SonarFrame frame = ping(device(), floor_below(48));
  const auto row_of = [&](double range_m) {
    return static_cast<std::uint32_t>((range_m - 4.0) / frame.grid.range_step_m());
  };
  const std::uint32_t middle = kBeams / 2;
  double worst = 0.0;
  std::uint32_t silent = 0;
  for (std::uint32_t row = row_of(6.0); row < kBins; ++row) {
    const double heard = frame.image.intensity[std::size_t{row} * kBeams + middle];
    const double r = frame.grid.range_m(row), half = frame.grid.range_step_m() / 2.0;
    silent += heard == 0.0;
    worst = std::max(worst, std::abs(heard / floor_between(r - half, r + half) - 1.0));
  }
  EXPECT_EQ(silent, 0u);
  EXPECT_LT(worst, 0.1);
}

// The same rows with bins that none of them spans: shared or not, the sum is the same.
TEST_F(SonarFootprint, SharingKeepsEnergy) {
  scene::Scene scene = floor_below(48, 40.0);
  const double shared = total(ping(device(), scene));
  scene.sonars[0].bins_range = 16;
  const SonarFrame whole = ping(device(), scene);
  ASSERT_GT(shared, 0.0);
  EXPECT_NEAR(shared / total(whole), 1.0, 1e-6);
  // With terms, and as speckle's power is on average.
  scene.sonars[0].bins_range = kBins;
  scene.sonars[0].terms.labels.energy = true;
  EXPECT_NEAR(total(ping(device(), scene)) / shared, 1.0, 1e-5);
}

TEST_F(SonarFootprint, AFloorCastsNoShadow) {
  for (const std::uint32_t rows : {24u, 48u, 512u}) {
    scene::Scene scene = floor_below(rows);
    scene.sonars[0].terms.labels.energy = true;
    const SonarFrame frame = ping(device(), scene);
    ASSERT_TRUE(frame.label_energy);
    const auto& classes = frame.label_energy->classes;
    EXPECT_EQ(std::count(classes.begin(), classes.end(), sonar::kShadow), 0) << rows;
  }
}

TEST_F(SonarFootprint, ABoxCastsItsClosedFormShadow) {
  constexpr double kNear_m = 8.0, kTall_m = 0.6, kDeep_m = 0.4;  // along the floor, from its face
  for (const std::uint32_t rows : {96u, 512u}) {
    scene::Scene scene = floor_below(rows);
    scene::Object box = object_of(scene, scene::make_box(Vec3(6.0, kTall_m, kDeep_m)),
                                  {0.0, kTall_m / 2.0 - kHeight_m, -kNear_m - kDeep_m / 2.0});
    scene.objects.push_back(box);
    scene.sonars[0].terms.labels.energy = true;
    const SonarFrame frame = ping(device(), scene);
    ASSERT_TRUE(frame.label_energy);
    // From the top's far edge to where the ray past it meets the floor.
    const double far_m = kNear_m + kDeep_m, over_m = kHeight_m - kTall_m;
    const double from_m = std::hypot(far_m, over_m);
    const double to_m = from_m * kHeight_m / over_m;
    double first_m = 1e9, last_m = 0.0, hidden_m = 0.0;
    for (std::uint32_t row = 0; row < kBins; ++row)
      if (frame.label_energy->classes[std::size_t{row} * kBeams + kBeams / 2] == sonar::kShadow) {
        first_m = std::min(first_m, frame.grid.range_m(row));
        last_m = std::max(last_m, frame.grid.range_m(row));
        hidden_m += frame.grid.range_step_m();
      }
    // A row at the edges belongs to what its middle sees: half a row's span of either surface.
    const double row_rad = radians(20.0) / rows;
    const double top_m = from_m * from_m / over_m * row_rad,
                 floor_m = to_m * to_m / kHeight_m * row_rad;
    const double bin_m = 2.0 * frame.grid.range_step_m();
    EXPECT_NEAR(first_m, from_m, top_m + bin_m) << rows;
    EXPECT_NEAR(last_m, to_m, floor_m + bin_m) << rows;
    EXPECT_NEAR(hidden_m, last_m - first_m, bin_m) << rows;  // in one piece
  }
}

TEST_F(SonarFootprint, ASphereOnAxisHidesTheWaterBehindItUpToTheWall) {
  scene::Sonar sonar = sonar_of(2.0, 8.0, 300);
  sonar.gbuffer_scale = 2.0;
  sonar.terms.labels.energy = true;
  scene::Scene scene = wall(7.0, sonar);
  scene.objects.push_back(object_of(scene, scene::make_sphere(0.4, 128), {0.0, 0.0, -4.0}));
  const SonarFrame frame = ping(device(), scene);
  ASSERT_TRUE(frame.label_energy);
  const double limb_m = std::sqrt(4.0 * 4.0 - 0.4 * 0.4);
  const auto at = [&](double range_m, std::uint32_t column) {
    const auto row = static_cast<std::size_t>((range_m - 2.0) / frame.grid.range_step_m());
    return frame.label_energy->classes[row * 128 + column];
  };
  for (const double r : {limb_m + 0.3, 5.0, 6.0, 6.9}) EXPECT_EQ(at(r, 64), sonar::kShadow) << r;
  EXPECT_EQ(at(3.3, 64), sonar::kWater);
  EXPECT_NE(at(3.62, 64), sonar::kWater);
  for (const double r : {3.3, 5.0, 6.0, 6.9}) EXPECT_EQ(at(r, 4), sonar::kWater) << r;  // beside it
}

// In open water there is no wall to tell by: behind the sphere is shadow to the end of the range
// where most of a beam's rays ended on it, water where most pass it by. Both from the angle that
// the sphere fills.
TEST_F(SonarFootprint, ASphereInOpenWaterHidesWhatMostOfABeamWouldHear) {
  constexpr double kRadius_m = 0.4, kRange_m = 4.0;
  scene::Sonar sonar = sonar_of(2.0, 8.0, 300);
  sonar.gbuffer_scale = 2.0;
  sonar.terms.labels.energy = true;
  scene::Scene scene;
  scene.objects.push_back(
      object_of(scene, scene::make_sphere(kRadius_m, 128), {0.0, 0.0, -kRange_m}));
  scene.sonars = {sonar};
  const SonarFrame frame = ping(device(), scene);
  ASSERT_TRUE(frame.label_energy);
  const auto row_of = [&](double range_m) {
    return static_cast<std::uint32_t>((range_m - 2.0) / frame.grid.range_step_m());
  };
  int shadows = 0, waters = 0;
  for (std::uint32_t column = 0; column < 128; ++column) {
    const double cosine = std::sqrt(1.0 - std::pow(kRadius_m / kRange_m, 2)) /
                          std::cos(frame.grid.azimuth_rad(column));
    const double filled_rad = cosine < 1.0 ? 2.0 * std::acos(cosine) : 0.0;
    const double part = filled_rad / radians(20.0);
    if (std::abs(part - 0.5) < 0.02) continue;  // a row or two
    // The limb's plane is carried by up to a pixel and half a cell: it ends later than the sphere.
    for (const std::uint32_t row : {row_of(5.1), row_of(6.0), 299u}) {
      const std::size_t at = std::size_t{row} * 128 + column;
      EXPECT_EQ(frame.label_energy->classes[at], part > 0.5 ? sonar::kShadow : sonar::kWater)
          << column << ", row " << row;
      EXPECT_NEAR(frame.label_energy->fraction[at], part > 0.5 ? part : 0.0, 0.02);
    }
    ++(part > 0.5 ? shadows : waters);
  }
  EXPECT_GT(shadows, 20);
  EXPECT_GT(waters, 60);
}

// A pile from the floor to above the sonar: no ray goes over it to the floor behind.
TEST_F(SonarFootprint, APileThatReachesAboveTheSonarHidesTheFloorBehindItToTheEnd) {
  constexpr double kNear_m = 8.0, kAbove_m = 0.5;
  scene::Scene scene = floor_below(512);
  const double tall_m = kHeight_m + kAbove_m;  // seen to 3.6 degrees above the horizon
  scene.objects.push_back(object_of(scene, scene::make_box(Vec3(0.7, tall_m, 0.4)),
                                    {0.0, tall_m / 2.0 - kHeight_m, -kNear_m - 0.2}));
  for (const double pitch_rad : {radians(-8.0), radians(-2.0)}) {  // up to 2 and to 8 degrees
    scene.sonars[0].mount.pose.rotation = glm::angleAxis(pitch_rad, Vec3(1, 0, 0));
    scene.sonars[0].terms.labels.energy = true;
    const SonarFrame frame = ping(device(), scene);
    ASSERT_TRUE(frame.label_energy);
    for (std::uint32_t column = 0; column < kBeams; ++column) {
      const bool behind = std::abs(std::tan(frame.grid.azimuth_rad(column))) * kNear_m < 0.3;
      // Some rows of the column at its edge meet it.
      const bool beside =
          std::abs(std::tan(frame.grid.azimuth_rad(column))) * (kNear_m + 0.4) > 0.45;
      for (std::uint32_t row = 0; row < kBins && (behind || beside); ++row) {
        const std::uint16_t found = frame.label_energy->classes[std::size_t{row} * kBeams + column];
        // The pile's farthest ray goes down to its foot, or up over its edge.
        if (frame.grid.range_m(row) > std::hypot(kNear_m + 0.4, kHeight_m) + 0.1) {
          EXPECT_EQ(found == sonar::kShadow, behind) << column << ", " << frame.grid.range_m(row);
        }
        if (beside) {
          EXPECT_NE(found, sonar::kShadow) << column << ", " << frame.grid.range_m(row);
        }
      }
    }
  }
}

// At a round flank the plane of a pixel goes on where the surface bends away: an upright pole, seen
// by a sonar that looks down, has no echoes before its front.
TEST_F(SonarFootprint, APoleHasNoHorns) {
  constexpr double kDistance_m = 10.0, kPole_m = 0.15;
  scene::Sonar sonar = sonar_of(5.0, 15.0, 1000);
  sonar.azimuth_rad = radians(70.0);
  sonar.bins_azimuth = 256;
  sonar.bins_elevation = 256;
  scene::Scene scene;
  scene.objects.push_back(
      object_of(scene, scene::make_cylinder(kPole_m, 8.0, 128), {0.31, 0.0, -kDistance_m}));
  scene.sonars = {sonar};
  scene.sonars[0].mount.pose.rotation = glm::angleAxis(radians(-12.0), Vec3(1, 0, 0));
  const SonarFrame frame = ping(device(), scene);
  const double front_m = std::hypot(kDistance_m, 0.31) - kPole_m;
  double before = 0.0;
  for (std::size_t i = 0; i < frame.image.intensity.size(); ++i) {
    const auto row = static_cast<std::uint32_t>(i / frame.grid.bins.azimuth);
    if (frame.grid.range_m(row) < front_m - 0.05) before += frame.image.intensity[i];
  }
  EXPECT_LT(before / total(frame), 1e-5);
}

// A ball of 25 cm at 3 m anywhere in the wedge is heard from its front, 2.75 m, to where it ends
// from sight, 2.99 m, and a pixel's step beyond: its top and bottom are no floors that go on. It
// fills 4.8 degrees to either side: four that lie apart share no column of a picture.
TEST_F(SonarFootprint, ABallHasNoEchoesBeforeItAndFewBehind) {
  scene::Sonar sonar;
  sonar.range_min_m = 1.0;
  sonar.range_max_m = 5.0;
  sonar.azimuth_rad = radians(90.0);
  sonar.elevation_rad = radians(28.0);
  sonar.bins_range = sonar.bins_azimuth = sonar.bins_elevation = 500;
  constexpr double kBearings_deg[] = {0.0, 10.0, 30.0, 40.0}, kHalfWay_deg = 5.0;
  const auto ball = std::make_shared<scene::Model>(scene::make_sphere(0.25, 512));
  for (const double up_deg : {0.0, 8.0}) {
    scene::Scene scene;
    scene.models = {ball};
    for (const double bearing_deg : kBearings_deg) {
      const double b = radians(bearing_deg), e = radians(up_deg);
      scene::Object object;
      object.name = fmt::format("{}", bearing_deg);
      object.model = 0;
      object.mount.pose.position_m =
          3.0 * Vec3(std::sin(b) * std::cos(e), std::sin(e), -std::cos(b) * std::cos(e));
      object.class_id = 12;
      object.instance = static_cast<std::uint16_t>(scene.objects.size() + 1);
      scene.objects.push_back(object);
    }
    scene.sonars = {sonar};
    const SonarFrame frame = ping(device(), scene);
    for (const double bearing_deg : kBearings_deg) {
      SCOPED_TRACE(fmt::format("{} {}", bearing_deg, up_deg));
      int first = 500, last = 0;
      for (std::uint32_t column = 0; column < 500; ++column) {
        if (std::abs(degrees(frame.grid.azimuth_rad(column)) - bearing_deg) > kHalfWay_deg)
          continue;
        for (int row = 0; row < 500; ++row) {
          if (frame.image.intensity[static_cast<std::size_t>(row) * 500 + column] == 0.0f) continue;
          first = std::min(first, row);
          last = std::max(last, row);
        }
      }
      EXPECT_NEAR(first, 218, 1);
      EXPECT_GE(last, 247);
      EXPECT_LE(last, 262);
    }
  }
}

// Half a metre above a floor it is met at half a degree: rings of single bins, if its rows were not
// shared out where the plane of a pixel could be a limb's, too.
TEST_F(SonarFootprint, AFloorAtHalfADegreeIsHeardInEveryBin) {
  scene::Sonar sonar = sonar_of(1.0, 50.0, 500);
  sonar.azimuth_rad = radians(90.0);
  sonar.elevation_rad = radians(28.0);
  sonar.bins_azimuth = 20;
  sonar.bins_elevation = 500;
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_plane(1000.0, 1000.0), {0.0, -0.5, 0.0}));
  scene.sonars = {sonar};
  const SonarFrame frame = ping(device(), scene);
  for (std::uint32_t row = 12; row < 500; ++row)
    EXPECT_GT(frame.image.intensity[row * 20 + 10], 0.0f) << row;
}

}  // namespace
}  // namespace neritic::testbed
