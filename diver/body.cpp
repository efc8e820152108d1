#include "diver/body.hpp"

#include <algorithm>
#include <cmath>

#include "diver/added_mass.hpp"
#include "diver/limits.hpp"
#include "diver/real_gas.hpp"

namespace neritic::diver {
namespace {

// Crossflow drag of a cylinder at 1e4 < Re < 2e5 and of a flat plate, and friction on wetted area
// (Hoerner, "Fluid-Dynamic Drag", 1965, ch. 3 and 2).
constexpr double kCylinderDrag = 1.1;
constexpr double kPlateDrag = 1.9;
constexpr double kFriction = 0.01;

// C_d A of a prone swimmer without gear is 0.0459 m^2 (Narita et al. 2017), of which friction on
// the skin is 0.018; the rest is laid on the head.
constexpr double kHeadDrag_m2 = 0.028;
// With suit, tank, jacket and fins it is 0.295 m^2 in trim (40 N at a knot); 0.013 of C_d more for
// each degree head up, +49 % at 15 degrees (Passmore and Rickers 2002, Sports Eng. 5, 65). Laid on
// the jacket and on the tank, half each; crossflow over strips alone gives a tenth of that growth.
constexpr double kWornDrag_m2 = 0.238;
constexpr double kWornIncidence = 2.15;

// Air in the thorax of Dempster's specimens, 2.2 l in a body of 75 kg: without it the density is
// 1.06 of water's, with the residual volume 1.04, with full lungs 0.98.
constexpr double kSpecimenAir_m3_kg = 2.2e-3 / 75.0;

// Neoprene: thinner than sold where it is stretched and at the joints, so that a suit of 5 mm lifts
// 3 kg at the surface; 0.65 of it is gas; the rest is rubber.
constexpr double kSuitShare = 0.6;
constexpr double kSuitGas = 0.65;
constexpr double kRubber_kg_m3 = 1250.0;
constexpr double kLead_kg_m3 = 11340.0;

// Neutral with an empty jacket here, level there (gear.hpp).
constexpr double kNeutralDepth_m = 5.0, kNeutralTank_pa = 50e5;
constexpr double kLevelDepth_m = 15.0, kLevelTank_pa = 120e5;
constexpr double kQuietBreath_m3 = 0.5e-3;
constexpr double kLeadAside_m = 0.17;

// How a segment lies in its axes and how wide it is over how deep, with the cross section's area
// as its volume and length give it.
struct Section {
  Mat3 segment_from_part;
  double width_over_depth;
};
Section section_of(Segment segment) {
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const Mat3 trunk(x, z, -y), limb(-x, z, y), foot(z, x, y);
  switch (segment) {
    case kPelvis:
    case kAbdomen:
      return {trunk, 1.4};
    case kThorax:
      return {trunk, 1.45};
    case kHead:
      return {trunk, 0.8};
    case kLeftHand:
    case kRightHand:
      return {limb, 1.0 / 3.0};
    case kLeftFoot:
    case kRightFoot:
      return {foot, 1.5};
    default:
      return {limb, 1.0};
  }
}

Mat3 diagonal_matrix(double x, double y, double z) {
  return Mat3(x, 0, 0, 0, y, 0, 0, 0, z);
}

double ellipse_perimeter(double a, double b) {  // within 3 %, to 1 : 3
  return 2.0 * kPi * std::sqrt(0.5 * (a * a + b * b));
}

// Water that moves with a part, in the part's axes, about its start.
SpatialMass added_mass_of(const Part& p) {
  const double l = p.length_m, l2 = l * l / 2.0, l3 = l * l * l / 3.0;
  SpatialMass m;
  m.a = diagonal_matrix(0.0, p.added_first_kg_m * l, p.added_second_kg_m * l);
  m.b[2][1] = p.added_first_kg_m * l2;    // first, by turning about second
  m.b[1][2] = -p.added_second_kg_m * l2;  // second, by turning about first
  m.c = diagonal_matrix(p.added_twist_kg_m * l, p.added_second_kg_m * l3, p.added_first_kg_m * l3);
  return m;
}

// Fills a Body step by step; one thread.
class BodyMaker {
 public:
  BodyMaker(const BodyParameters& parameters,
            const std::array<SegmentMeasures, kSegments>& measures)
      : in_(parameters), measures_(measures) {}

  Body make() {
    body_.model = in_.model;
    body_.height_m = in_.build.height_m;
    body_.water_kg_m3 = in_.water_kg_m3;
    body_.surface_pa = in_.surface_pa;
    place_joints();
    for (std::size_t i = 0; i < kSegments; ++i) add_segment(static_cast<Segment>(i));
    add_feet();
    add_lungs();
    add_worn();
    body_.moves.fill(true);
    add_lead();
    add_axial_mass();
    if (in_.model == Model::kPlanar) freeze_arms();
    return body_;
  }

 private:
  double half_rho() const { return 0.5 * in_.water_kg_m3; }
  double scale() const { return in_.build.height_m / 1.78; }  // of places said for that height

  void place_joints() {
    const double h = in_.build.height_m;
    const auto put = [&](Segment segment, const Vec3& at_m) {
      body_.segments[segment].joint_m = at_m;
    };
    const auto length = [&](Segment segment) { return measures_[segment].length_m; };
    put(kAbdomen, {length(kPelvis), 0, 0});
    put(kThorax, {length(kAbdomen), 0, 0});
    put(kHead, {length(kThorax), 0, 0});
    const double shoulder_m = kShoulderAbove * h - length(kPelvis) - length(kAbdomen);
    for (const bool right : {false, true}) {
      const double side = right ? 1.0 : -1.0;
      put(right ? kRightUpperArm : kLeftUpperArm, {shoulder_m, side * kShoulderAside * h, 0});
      put(right ? kRightForearm : kLeftForearm, {-length(kLeftUpperArm), 0, 0});
      put(right ? kRightHand : kLeftHand, {-length(kLeftForearm), 0, 0});
      put(right ? kRightUpperLeg : kLeftUpperLeg, {0, side * kHipAside * h, 0});
      put(right ? kRightLowerLeg : kLeftLowerLeg, {-length(kLeftUpperLeg), 0, 0});
      put(right ? kRightFoot : kLeftFoot, {-length(kLeftLowerLeg), 0, 0});
    }
  }

  void add_mass(std::size_t segment, double mass_kg, const Vec3& centre_m, const Mat3& inertia) {
    SegmentBody& s = body_.segments[segment];
    const SpatialMass added = rigid_mass(mass_kg, centre_m, inertia);
    s.rigid += added;
    s.mass += added;
    if (mass_kg > 0.0)
      s.mass_centre_m = (s.mass_kg * s.mass_centre_m + mass_kg * centre_m) / (s.mass_kg + mass_kg);
    s.mass_kg += mass_kg;
  }

  void add_part(const Part& part) {
    body_.parts[body_.part_count++] = part;
    const SpatialMass turned = rotated(added_mass_of(part), part.segment_from_part);
    body_.segments[part.segment].mass += shifted(turned, part.start_m);
  }

  // Half widths along first and second axis.
  void set_section(Part& part, double half_first_m, double half_second_m) const {
    const double rho = in_.water_kg_m3;
    part.drag_first = half_rho() * kCylinderDrag * 2.0 * half_second_m;
    part.drag_second = half_rho() * kCylinderDrag * 2.0 * half_first_m;
    part.drag_along = half_rho() * kFriction * ellipse_perimeter(half_first_m, half_second_m);
    part.added_first_kg_m = section_added_mass(rho, half_second_m);
    part.added_second_kg_m = section_added_mass(rho, half_first_m);
    part.added_twist_kg_m = section_added_inertia(rho, half_first_m, half_second_m);
    part.radius_m = std::sqrt(half_first_m * half_second_m);
  }

  void add_segment(Segment segment) {
    const SegmentMeasures& m = measures_[segment];
    const Section section = section_of(segment);
    Part part;
    part.segment = segment;
    part.strips = in_.strips_a_segment;
    part.segment_from_part = section.segment_from_part;
    part.length_m = m.length_m;
    if (segment == kLeftFoot || segment == kRightFoot)
      part.start_m = -in_.build.height_m * Vec3(kAnkleAboveFoot, 0.0, kAnkleFromHeel);
    part.volume_m3 = m.volume_m3;
    if (segment == kThorax) part.volume_m3 -= kSpecimenAir_m3_kg * in_.build.mass_kg;

    // Lengths of the trunk are measured from its upper end, where its axis ends.
    const double at_m = segment <= kHead ? m.length_m - m.centre_m : m.centre_m;
    const Vec3 along = section.segment_from_part[0];
    // Along the part, from front to back, from side to side, in the part's axes.
    const Mat3 own = diagonal_matrix(m.longitudinal_kg_m2, m.sagittal_kg_m2, m.transverse_kg_m2);
    const Mat3 inertia =
        section.segment_from_part * own * glm::transpose(section.segment_from_part);
    add_mass(segment, m.mass_kg, part.start_m + at_m * along, inertia);

    const double k = std::sqrt(section.width_over_depth);
    double half_first_m = m.radius_m() / k, half_second_m = m.radius_m() * k;
    if (in_.gear.suit) {
      const double thick_m = kSuitShare * in_.gear.suit->thickness_m;
      half_first_m += thick_m, half_second_m += thick_m;
      const double volume_m3 =
          thick_m * m.length_m * ellipse_perimeter(half_first_m, half_second_m);
      part.suit_gas_m3 = kSuitGas * volume_m3;
      part.volume_m3 += (1.0 - kSuitGas) * volume_m3;
      add_mass(segment, (1.0 - kSuitGas) * volume_m3 * kRubber_kg_m3,
               part.start_m + 0.5 * m.length_m * along, Mat3(0.0));
    }
    set_section(part, half_first_m, half_second_m);
    add_part(part);
  }

  void add_feet() {
    for (const bool right : {false, true}) {
      const std::size_t foot = right ? kRightFoot : kLeftFoot;
      std::size_t last = foot;  // parts are in the order of segments
      double half_m = std::sqrt(body_.parts[foot].added_first_kg_m / (kPi * in_.water_kg_m3));
      if (in_.gear.fins) {
        const Fins& fins = *in_.gear.fins;
        const Part& sole = body_.parts[foot];
        Part blade;
        blade.segment = foot;
        blade.strips = in_.strips_a_segment;
        blade.flat = true;
        blade.start_m = sole.start_m + sole.length_m * sole.segment_from_part[0];
        const double s = std::sin(fins.angle_rad), c = std::cos(fins.angle_rad);
        blade.segment_from_part = Mat3(Vec3(-s, 0, c), Vec3(c, 0, s), Vec3(0, 1, 0));
        blade.length_m = fins.length_m;
        blade.volume_m3 = fins.volume_m3;
        half_m = 0.5 * fins.width_m;
        set_section(blade, 0.0, half_m);
        blade.drag_first *= kPlateDrag / kCylinderDrag;
        blade.radius_m = 0.02;
        const Vec3 middle = blade.start_m + 0.3 * fins.length_m * blade.segment_from_part[0];
        const double l2 = fins.length_m * fins.length_m / 12.0,
                     w2 = fins.width_m * fins.width_m / 12.0;
        add_mass(foot, fins.mass_kg, middle,
                 fins.mass_kg * blade.segment_from_part * diagonal_matrix(w2, l2 + w2, l2) *
                     glm::transpose(blade.segment_from_part));
        last = body_.part_count;
        add_part(blade);
      }
      body_.edges[right ? 1 : 0] = {last, section_added_mass(in_.water_kg_m3, half_m)};
    }
  }

  void add_lungs() {
    const double size = in_.build.mass_kg / 75.0;
    body_.lungs = {1.3e-3 * size, 2.5e-3 * size, 6.0e-3 * size};
    body_.fitness = in_.fitness;
    if (body_.fitness.most_oxygen_l_min == 0.0)
      body_.fitness.most_oxygen_l_min = usual_most_oxygen_l_min(in_.build.mass_kg);
    body_.lungs_at_m = {0.48 * measures_[kThorax].length_m, 0.0, 0.0};
  }

  void add_worn() {
    body_.blunt[0] = {
        kHead, {0.5 * measures_[kHead].length_m, 0, 0}, half_rho() * kHeadDrag_m2, 0.0};
    double drag_m2 = 0.0;
    for (const Tank& tank : in_.gear.tanks) add_tank(tank);
    if (!in_.gear.tanks.empty()) drag_m2 += 0.5 * kWornDrag_m2;
    if (in_.gear.jacket) {
      drag_m2 += 0.5 * kWornDrag_m2;
      add_jacket(*in_.gear.jacket);
    } else {
      body_.jacket.capacity_m3 = 0.0;
    }
    body_.blunt[1] = {kThorax, scale() * Vec3(0.0, 0.0, -0.08),
                      half_rho() * in_.gear.drag_area_m2.value_or(drag_m2), kWornIncidence};
  }

  void add_tank(const Tank& tank) {
    const std::size_t i = body_.tank_count++;
    // The back of the trunk, or beside the waist; one alone before the ribs, where it tilts its
    // diver least.
    const std::size_t on_back = tanks_on_back(in_.gear);
    Vec3 at = Vec3(-0.05, 0.0, -0.148 - tank.radius_m);
    if (i >= on_back) {
      const std::size_t beside = i - on_back;
      at = {-0.15, beside == 1 ? 0.24 : -0.24 - 0.1 * (beside == 2), 0.0};
      if (in_.gear.tanks.size() == on_back + 1) at = {-0.15, -0.15, 0.13};
    } else if (on_back == 2) {
      at.y = (i == 0 ? 1.0 : -1.0) * (tank.radius_m + 0.005);
    }
    at *= scale();
    body_.tanks[i] = {at, tank.water_volume_m3, tank.mix, tank.pressure_pa};
    const double l2 = tank.length_m * tank.length_m / 12.0, r2 = tank.radius_m * tank.radius_m;
    add_mass(kThorax, tank.empty_mass_kg, at,
             tank.empty_mass_kg * diagonal_matrix(r2, 0.5 * r2 + l2, 0.5 * r2 + l2));
    Part part;
    part.segment = kThorax;
    part.strips = in_.strips_a_segment;
    part.segment_from_part = section_of(kThorax).segment_from_part;
    part.start_m = at - Vec3(0.5 * tank.length_m, 0, 0);
    part.length_m = tank.length_m;
    part.volume_m3 = tank.outer_volume_m3;
    set_section(part, tank.radius_m, tank.radius_m);
    // In the lee of the trunk, or the trunk in its lee.
    part.drag_first = part.added_first_kg_m = 0.0;
    add_part(part);
  }

  void add_jacket(const Jacket& said) {
    Jacket& jacket = body_.jacket;
    jacket = said;
    for (Vec3* at : {&jacket.centre_m, &jacket.hose_root_m, &jacket.dump_m, &jacket.relief_at_m})
      *at *= scale();
    const Vec3& e = said.half_axes_m;
    jacket.half_axes_m *= std::cbrt(said.capacity_m3 / (4.0 / 3.0 * kPi * e.x * e.y * e.z));
    add_mass(kThorax, jacket.mass_kg, jacket.centre_m, Mat3(0.0));
    Part cloth;  // whose drag is the blunt one
    cloth.segment = kThorax;
    cloth.segment_from_part = section_of(kThorax).segment_from_part;
    cloth.length_m = 2.0 * jacket.half_axes_m.x;
    cloth.start_m = jacket.centre_m - Vec3(jacket.half_axes_m.x, 0, 0);
    cloth.volume_m3 = jacket.volume_m3;
    cloth.radius_m = jacket.half_axes_m.z;
    add_part(cloth);
  }

  // A segment's origin with all joints straight, in the body's axes.
  Vec3 origin_of(std::size_t segment) const {
    Vec3 at(0.0);
    for (; segment != kPelvis; segment = kParent[segment]) at += body_.segments[segment].joint_m;
    return at;
  }

  // Mass over displaced water with the lungs half full, and its moments along the body and to
  // starboard.
  struct Balance {
    double excess_kg = 0.0, moment_kg_m = 0.0, aside_kg_m = 0.0;
    void add(double kg, double at_m, double aside_m) {
      excess_kg += kg, moment_kg_m += kg * at_m, aside_kg_m += kg * aside_m;
    }
  };
  // tank_pa: none, as at the start.
  Balance balance_at(double depth_m, std::optional<double> tank_pa) const {
    Balance out;
    for (std::size_t i = 0; i < kSegments; ++i) {
      const Vec3 centre = origin_of(i) + body_.segments[i].mass_centre_m;
      out.add(body_.segments[i].mass_kg, centre.x, centre.y);
    }
    const double rho = in_.water_kg_m3;
    const double gas_share = kSurfacePressure_pa / pressure_at(body_, depth_m);
    for (std::size_t i = 0; i < body_.part_count; ++i) {
      const Part& p = body_.parts[i];
      const Vec3 middle =
          origin_of(p.segment) + p.start_m + 0.5 * p.length_m * p.segment_from_part[0];
      out.add(-rho * (p.volume_m3 + gas_share * p.suit_gas_m3), middle.x, middle.y);
    }
    const double thorax_m = origin_of(kThorax).x;
    out.add(-rho * (body_.lungs.rest_m3 + 0.5 * kQuietBreath_m3), thorax_m + body_.lungs_at_m.x,
            0.0);
    for (std::size_t i = 0; i < body_.tank_count; ++i) {
      const TankPlace& tank = body_.tanks[i];
      const double pa = tank_pa.value_or(tank.start_pa);
      out.add(moles_in(tank.mix, tank.water_volume_m3, pa) * molar_mass(tank.mix),
              thorax_m + tank.position_m.x, tank.position_m.y);
    }
    return out;
  }

  void add_lead() {
    const double sinks = 1.0 - in_.water_kg_m3 / kLead_kg_m3;
    // Without a jacket nothing lifts what the gas of full tanks weighs.
    const Balance neutral = in_.gear.jacket ? balance_at(kNeutralDepth_m, kNeutralTank_pa)
                                            : balance_at(in_.start_depth_m, std::nullopt);
    body_.lead_kg = in_.gear.lead_kg.value_or(std::max(0.0, -neutral.excess_kg / sinks));
    if (body_.lead_kg <= 0.0) return;
    const double thorax_m = origin_of(kThorax).x;
    const double belt_m = 0.4 * measures_[kPelvis].length_m, shoulders_m = 0.18 * scale();
    // Where the lead balances the rest, with what the jacket then has to lift.
    Balance level = balance_at(kLevelDepth_m, kLevelTank_pa);
    const double lift_kg = std::max(0.0, level.excess_kg + sinks * body_.lead_kg);
    if (in_.gear.jacket) level.add(-lift_kg, thorax_m + body_.jacket.centre_m.x, 0.0);
    const double level_m = -level.moment_kg_m / (body_.lead_kg * sinks);
    const double share = in_.gear.lead_at_shoulders.value_or(
        std::clamp((level_m - belt_m) / (thorax_m + shoulders_m - belt_m), 0.0, 1.0));
    // Against a tank that hangs at one side, to the other, as far as a belt and pockets go.
    const double aside_m = std::clamp(-level.aside_kg_m / body_.lead_kg, -kLeadAside_m * scale(),
                                      kLeadAside_m * scale());
    put_lead(kPelvis, (1.0 - share) * body_.lead_kg, {belt_m, aside_m, 0.10});
    put_lead(kThorax, share * body_.lead_kg, {shoulders_m, aside_m, 0.0});
  }

  void put_lead(Segment segment, double kg, const Vec3& at_m) {
    add_mass(segment, kg, at_m, Mat3(0.0));
    // Spread over the segment's own part: a tenth of a litre.
    body_.parts[segment].volume_m3 += kg / kLead_kg_m3;
  }

  // Along the body, as of a spheroid of its length and volume; shared by the trunk.
  void add_axial_mass() {
    const double volume_m3 = solid_volume(body_, kNeutralDepth_m);
    const double half_length_m = 0.5 * in_.build.height_m;
    const double half_width_m = std::sqrt(volume_m3 / (4.0 / 3.0 * kPi * half_length_m));
    const double added_kg =
        spheroid_added_mass(half_length_m / half_width_m).along * in_.water_kg_m3 * volume_m3;
    double trunk_m3 = 0.0;
    for (std::size_t i = 0; i <= kHead; ++i) trunk_m3 += body_.parts[i].volume_m3;
    for (std::size_t i = 0; i <= kHead; ++i) {
      const Part& p = body_.parts[i];
      SpatialMass m;
      m.a = diagonal_matrix(added_kg * p.volume_m3 / trunk_m3, 0.0, 0.0);
      body_.segments[i].mass += shifted(m, p.start_m + 0.5 * p.length_m * p.segment_from_part[0]);
    }
  }

  // Head and arms become part of the thorax, as they hang when straight.
  void freeze_arms() {
    for (std::size_t i = kRightHand; i >= kHead; --i) {
      const std::size_t parent = kParent[i];
      const Vec3 at = body_.segments[i].joint_m;
      SegmentBody& from = body_.segments[i];
      SegmentBody& to = body_.segments[parent];
      to.rigid += shifted(from.rigid, at);
      to.mass += shifted(from.mass, at);
      const double kg = to.mass_kg + from.mass_kg;
      to.mass_centre_m =
          (to.mass_kg * to.mass_centre_m + from.mass_kg * (at + from.mass_centre_m)) / kg;
      to.mass_kg = kg;
      from.rigid = from.mass = {}, from.mass_kg = 0.0;
      for (std::size_t k = 0; k < body_.part_count; ++k)
        if (body_.parts[k].segment == i)
          body_.parts[k].segment = parent, body_.parts[k].start_m += at;
      for (BluntDrag& blunt : body_.blunt)
        if (blunt.segment == i) blunt.segment = parent, blunt.position_m += at;
      body_.moves[i] = false;
    }
  }

  const BodyParameters& in_;
  const std::array<SegmentMeasures, kSegments>& measures_;
  Body body_;
};

}  // namespace

Result<Body> make_body(const BodyParameters& parameters) {
  NERITIC_TRY(const auto measures, measure_segments(parameters.build));
  NERITIC_TRY_STATUS(
      check_limits({{"water density", parameters.water_kg_m3, 0.0, 1300.0},
                    {"strips a segment", static_cast<double>(parameters.strips_a_segment), 1, 64},
                    {"depth of the start", parameters.start_depth_m, 0.0, 1e9}}));
  NERITIC_TRY_STATUS(check_limits({{"pressure at the surface", parameters.surface_pa, 2e4, 5e5}}));
  NERITIC_TRY_STATUS(check_fitness(parameters.fitness));
  NERITIC_TRY_STATUS(check_gear(parameters.gear));
  return BodyMaker(parameters, measures).make();
}

double pressure_at(const Body& body, double depth_m) {
  const double above_kg_m2 = body.layers ? body.layers->mass_above_kg_m2(depth_m)
                                         : body.water_kg_m3 * std::max(depth_m, 0.0);
  return body.surface_pa + kGravity_m_s2 * above_kg_m2;
}

double dry_mass(const Body& body) {
  double kg = 0.0;
  for (const SegmentBody& s : body.segments) kg += s.mass_kg;
  return kg;
}

double solid_volume(const Body& body, double depth_m) {
  const double gas_share = kSurfacePressure_pa / pressure_at(body, depth_m);
  double m3 = 0.0;
  for (std::size_t i = 0; i < body.part_count; ++i)
    m3 += body.parts[i].volume_m3 + gas_share * body.parts[i].suit_gas_m3;
  return m3;
}

}  // namespace neritic::diver
