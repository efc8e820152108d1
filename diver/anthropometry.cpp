#include "diver/anthropometry.hpp"

#include <cmath>

#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

// De Leva (1996), "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomech.
// 29(9), 1223-1230, table 4: lengths of the mean subject, and shares of body mass and of the
// segment's length. Trunk from the neck's seventh vertebra (CERV) by sternum (XYPH) and navel
// (OMPH) to the middle of the hips (MIDH); head from its top (VERT); foot from heel to longest toe.
struct TableRow {
  double length_mm, mass_percent, centre_percent;
  double sagittal_percent, transverse_percent, longitudinal_percent;  // radii of gyration
};
struct Table {
  double height_m, mass_kg;
  TableRow head, thorax, abdomen, pelvis, upper_arm, forearm, hand, upper_leg, lower_leg, foot;
};

constexpr Table kMale{1.741,
                      73.0,
                      {242.9, 6.94, 50.02, 30.3, 31.5, 26.1},
                      {242.1, 15.96, 50.66, 50.5, 32.0, 46.5},
                      {215.5, 16.33, 45.02, 48.2, 38.3, 46.8},
                      {145.7, 11.17, 61.15, 61.5, 55.1, 58.7},
                      {281.7, 2.71, 57.72, 28.5, 26.9, 15.8},
                      {268.9, 1.62, 45.74, 27.6, 26.5, 12.1},
                      {86.2, 0.61, 79.0, 62.8, 51.3, 40.1},
                      {422.2, 14.16, 40.95, 32.9, 32.9, 14.9},
                      {434.0, 4.33, 44.59, 25.5, 24.9, 10.3},
                      {258.1, 1.37, 44.15, 25.7, 24.5, 12.4}};
constexpr Table kFemale{1.735,
                        61.9,
                        {243.7, 6.68, 48.41, 27.1, 29.5, 26.1},
                        {228.0, 15.45, 50.5, 46.6, 31.4, 44.9},
                        {205.3, 14.65, 45.12, 43.3, 35.4, 41.5},
                        {181.5, 12.47, 49.2, 43.3, 40.2, 44.4},
                        {275.1, 2.55, 57.54, 27.8, 26.0, 14.8},
                        {264.3, 1.38, 45.59, 26.1, 25.7, 9.4},
                        {78.0, 0.56, 74.74, 53.1, 45.4, 33.5},
                        {368.5, 14.78, 36.12, 36.9, 36.4, 16.2},
                        {432.3, 4.81, 44.16, 27.1, 26.7, 9.3},
                        {228.3, 1.29, 40.14, 29.9, 27.9, 13.9}};

// Dempster (1955), as in Winter, "Biomechanics and Motor Control of Human Movement", table 4.1.
struct Kind {
  TableRow Table::*row;
  double density_kg_m3;
};
Kind kind_of(Segment segment) {
  switch (segment) {
    case kPelvis:
      return {&Table::pelvis, 1010.0};
    case kAbdomen:
      return {&Table::abdomen, 1010.0};
    case kThorax:
      return {&Table::thorax, 920.0};
    case kHead:
      return {&Table::head, 1110.0};
    case kLeftUpperArm:
    case kRightUpperArm:
      return {&Table::upper_arm, 1070.0};
    case kLeftForearm:
    case kRightForearm:
      return {&Table::forearm, 1130.0};
    case kLeftHand:
    case kRightHand:
      return {&Table::hand, 1160.0};
    case kLeftUpperLeg:
    case kRightUpperLeg:
      return {&Table::upper_leg, 1050.0};
    case kLeftLowerLeg:
    case kRightLowerLeg:
      return {&Table::lower_leg, 1090.0};
    case kLeftFoot:
    case kRightFoot:
      return {&Table::foot, 1100.0};
  }
  return {};
}

// Limits for lean or heavy people whose limbs would be out of proportion.
constexpr double kMostWidthRatio = 2.2;

}  // namespace

double SegmentMeasures::radius_m() const {
  return std::sqrt(volume_m3 / (kPi * length_m));
}

Result<std::array<SegmentMeasures, kSegments>> measure_segments(const Build& build) {
  const Table& table = build.sex == Sex::kMale ? kMale : kFemale;
  if (!(build.height_m >= 1.2 && build.height_m <= 2.3))
    return refusal("height_m", fmt::format("{}", build.height_m), "1.2 to 2.3");
  if (!(build.mass_kg >= 30.0 && build.mass_kg <= 200.0))
    return refusal("mass_kg", fmt::format("{}", build.mass_kg), "30 to 200");
  const double width = build.mass_kg / build.height_m / (table.mass_kg / table.height_m);
  if (!(width <= kMostWidthRatio && width >= 1.0 / kMostWidthRatio))
    return refusal("mass_kg", fmt::format("{} at a height of {} m", build.mass_kg, build.height_m),
                   fmt::format("{:.0f} to {:.0f}", build.mass_kg / width / kMostWidthRatio,
                               build.mass_kg / width * kMostWidthRatio));
  std::array<SegmentMeasures, kSegments> out;
  for (std::size_t i = 0; i < kSegments; ++i) {
    const Kind kind = kind_of(static_cast<Segment>(i));
    const TableRow& row = table.*kind.row;
    SegmentMeasures& s = out[i];
    s.length_m = 1e-3 * row.length_mm * build.height_m / table.height_m;
    s.mass_kg = 1e-2 * row.mass_percent * build.mass_kg;
    s.centre_m = 1e-2 * row.centre_percent * s.length_m;
    const auto inertia = [&](double percent) {
      const double radius_m = 1e-2 * percent * s.length_m;
      return s.mass_kg * radius_m * radius_m;
    };
    s.sagittal_kg_m2 = inertia(row.sagittal_percent);
    s.transverse_kg_m2 = inertia(row.transverse_percent);
    s.longitudinal_kg_m2 = inertia(row.longitudinal_percent);
    s.volume_m3 = s.mass_kg / kind.density_kg_m3;
  }
  return out;
}

}  // namespace neritic::diver
