// Segments against the tables as an independent script scaled them.
#include "diver/anthropometry.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "diver/added_mass.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

const std::map<std::string, Segment> kOf{{"pelvis", kPelvis},          {"abdomen", kAbdomen},
                                         {"thorax", kThorax},          {"head_neck", kHead},
                                         {"upper_arm", kLeftUpperArm}, {"forearm", kRightForearm},
                                         {"hand", kLeftHand},          {"thigh", kRightUpperLeg},
                                         {"shank", kLeftLowerLeg},     {"foot", kRightFoot}};

struct Row {
  std::string body, segment;
  Build build;
  std::vector<double> values;  // length, mass, centre, three inertias, volume, radius
};

std::vector<Row> rows() {
  std::ifstream file(test::source_dir() / "tests/diver/data/bodies.csv");
  std::vector<Row> out;
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("#") || line.starts_with("body,")) continue;
    std::istringstream cells(line);
    std::string cell;
    Row row;
    for (int i = 0; std::getline(cells, cell, ','); ++i) {
      if (i == 0)
        row.body = cell,
        row.build.sex = cell.find("female") == cell.npos ? Sex::kMale : Sex::kFemale;
      else if (i == 1)
        row.build.height_m = std::stod(cell);
      else if (i == 2)
        row.build.mass_kg = std::stod(cell);
      else if (i == 3)
        row.segment = cell;
      else
        row.values.push_back(std::stod(cell));
    }
    out.push_back(row);
  }
  return out;
}

TEST(Anthropometry, SegmentsAreThoseOfTheTables) {
  const auto all = rows();
  ASSERT_EQ(all.size(), 40u);
  for (const Row& row : all) {
    const auto segments = measure_segments(row.build).value();
    const SegmentMeasures& s = segments[kOf.at(row.segment)];
    const double got[] = {s.length_m,        s.mass_kg,          s.centre_m,
                          s.sagittal_kg_m2,  s.transverse_kg_m2, s.longitudinal_kg_m2,
                          1e3 * s.volume_m3, s.radius_m()};
    constexpr double kLastDigit[] = {1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6, 1e-3, 1e-4};
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_NEAR(got[i], row.values[i], 0.51 * kLastDigit[i])
          << row.body << " " << row.segment << " " << i;
  }
}

TEST(Anthropometry, BothSidesAreAlikeAndMassesAddUp) {
  for (const Build build :
       {Build{}, Build{Sex::kFemale, 1.67, 62.0}, Build{Sex::kMale, 1.95, 110.0}}) {
    const auto segments = measure_segments(build).value();
    double mass_kg = 0.0;
    for (std::size_t i = 0; i < kSegments; ++i) {
      mass_kg += segments[i].mass_kg;
      EXPECT_EQ(segments[i].mass_kg, segments[kMirror[i]].mass_kg);
    }
    EXPECT_NEAR(mass_kg, build.mass_kg, 2e-4 * build.mass_kg);  // the female table adds up to 99.99
  }
}

TEST(Anthropometry, BodiesOutOfAnyProportionAreRefused) {
  EXPECT_EQ(measure_segments({Sex::kMale, 0.3, 75}).error().message,
            "height_m: found 0.3; accepted: 1.2 to 2.3");
  EXPECT_FALSE(measure_segments({Sex::kMale, 1.78, -1.0}).ok());
  EXPECT_FALSE(measure_segments({Sex::kMale, 2.2, 31.0}).ok());
  EXPECT_FALSE(measure_segments({Sex::kMale, std::nan(""), 75}).ok());
}

// Lamb (1932), art. 114 and 115: a/b, along, across, turning.
TEST(AddedMass, OfSpheroidsIsThatOfTheClosedForm) {
  const double table[][4] = {
      {1.0001, 0.4999, 0.5, 0.0},  {1.5, 0.3037, 0.6221, 0.0951}, {2, 0.21, 0.7042, 0.2394},
      {3, 0.122, 0.8039, 0.4657},  {4, 0.0816, 0.8598, 0.6079},   {5, 0.0591, 0.8943, 0.6999},
      {6, 0.0452, 0.9171, 0.7623}, {8, 0.0293, 0.9447, 0.8394},   {10, 0.0207, 0.9602, 0.8835}};
  for (const auto& [ratio, along, across, turning] : table) {
    const SpheroidAddedMass k = spheroid_added_mass(ratio);
    EXPECT_NEAR(k.along, along, 1e-4) << ratio;
    EXPECT_NEAR(k.across, across, 1e-4) << ratio;
    EXPECT_NEAR(k.turning, turning, 1e-4) << ratio;
  }
}

TEST(AddedMass, OfAFinIsFourteenTimesTheFoot) {
  // A plate of 0.20 by 0.45 m on a foot of 1.03 kg.
  const double added_kg = 0.45 * section_added_mass(1025.0, 0.10);
  EXPECT_NEAR(added_kg, 14.49, 0.005);
  EXPECT_NEAR(section_added_mass(1025.0, 0.10), 32.2013, 1e-3);
}

}  // namespace
}  // namespace neritic::diver
