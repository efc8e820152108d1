// Contacts of two bodies, and their solver.
#include "engine/sim/body_pair.hpp"

#include <algorithm>
#include <cmath>

#include "engine/sim/convex_query.hpp"
#include "engine/sim/pair_solver.hpp"
#include "engine/sim/plane_axes.hpp"
#include "engine/sim/static_things.hpp"

namespace neritic::sim {
namespace {

constexpr int kPairRounds = 60;
constexpr double kPairTolerance_m_s = 1e-12;
// Depth beyond it is undone at this rate, up to this speed, as in the contact solver.
constexpr double kPairSlop_m = 1e-6, kPairPushRate_hz = 50.0, kPairPush_m_s = 2.0;

// Bodies whose ways come no nearer than this do not touch.
constexpr double kPairMargin_m = 1e-3;

PairRow row_of(const PairBody& a, const PairBody& b, const Vec3& b_from_a_m, const Vec3& point_m,
               const Vec3& direction) {
  const Quat a_from_world = glm::conjugate(a.free.world_from_body.rotation),
             b_from_world = glm::conjugate(b.free.world_from_body.rotation);
  return {
      SolverRow(a_from_world * point_m, a_from_world * direction, a.inverse_mass),
      SolverRow(b_from_world * (point_m - b_from_a_m), b_from_world * -direction, b.inverse_mass)};
}

// No point of the body moves farther in the step.
double way_m(const PairBody& body) {
  const Pose &from = body.before, &to = body.free.world_from_body;
  const double half_cosine = std::min(std::abs(glm::dot(from.rotation, to.rotation)), 1.0);
  return glm::length(to.position_m - from.position_m) +
         2.0 * std::acos(half_cosine) * body.shape.reach_m();
}

// The nearest points of each pair of parts that could touch within the step.
void find_near_points(const PairBody& a, const PairBody& b, const Vec3& b_from_a_m,
                      std::vector<PairPoint>& out) {
  out.clear();
  const double margin_m = way_m(a) + way_m(b) + kPairMargin_m;
  if (glm::length(b_from_a_m) > a.shape.reach_m() + b.shape.reach_m() + margin_m) return;
  const Mat3 turn_a = glm::mat3_cast(a.before.rotation), turn_b = glm::mat3_cast(b.before.rotation);
  PartPoints storage_a, storage_b;
  for (const ConvexPart& part_a : a.shape.parts()) {
    const PlacedPart pa = place_part(part_a, turn_a, Vec3(0.0), storage_a);
    for (const ConvexPart& part_b : b.shape.parts()) {
      const PlacedPart pb = place_part(part_b, turn_b, b_from_a_m, storage_b);
      if (glm::distance(pa.centre_m, pb.centre_m) > pa.reach_m + pb.reach_m + margin_m) continue;
      const auto found = convex_distance(pa.core_m, pb.core_m);
      if (!found) continue;
      const double gap_m = found->distance_m - pa.radius_m - pb.radius_m;
      if (gap_m > margin_m) continue;
      const Vec3 on_b = found->point_b + found->direction * pb.radius_m;
      out.push_back({on_b + found->direction * (0.5 * gap_m), found->direction, gap_m});
    }
  }
}

// The pose after the step at this velocity, which is in the axes of the free step's end.
Pose pose_after(const PairBody& body, const Six& velocity, const Six& push, double dt_s) {
  Six both = velocity;
  add_scaled(both, push, 1.0);
  const Quat before_from_free =
      glm::conjugate(body.before.rotation) * body.free.world_from_body.rotation;
  const Twist twist = twist_of(both);
  return moved(body.before, {before_from_free * twist.linear, before_from_free * twist.angular},
               dt_s);
}

}  // namespace

void PairSolver::clear() {
  normals.clear();
  sides.clear();
  others.clear();
  targets_m_s.clear();
}

bool PairSolver::solve(double friction, Six& va, Six& vb) {
  for (int round = 0; round < kPairRounds; ++round) {
    double change_m_s = 0.0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      PairRow& n = normals[i];
      const double wanted = n.impulse - (n.speed(va, vb) - targets_m_s[i]) / n.mobility();
      const double change = std::max(wanted, 0.0) - n.impulse;
      n.push(change, va, vb);
      change_m_s = std::max(change_m_s, std::abs(change) * n.mobility());
      if (friction > 0.0) rub(i, friction, va, vb);
    }
    if (change_m_s < kPairTolerance_m_s) break;
  }
  return std::ranges::any_of(normals, [](const PairRow& n) { return n.impulse > 0.0; });
}

void PairSolver::rub(std::size_t i, double friction, Six& va, Six& vb) {
  PairRow &x = sides[i], &y = others[i];
  const double mobility = x.mobility() + y.mobility();
  Vec2 impulse(x.impulse - x.speed(va, vb) / mobility, y.impulse - y.speed(va, vb) / mobility);
  const double most = friction * normals[i].impulse, size = glm::length(impulse);
  if (size > most) impulse *= most / size;
  x.push(impulse.x - x.impulse, va, vb);
  y.push(impulse.y - y.impulse, va, vb);
}

double pair_reach_m(const PairBody& body) {
  return body.shape.reach_m() + way_m(body) + 0.5 * kPairMargin_m;
}

bool part_bodies(PairBody& a, PairBody& b, double friction, double dt_s, PairMemory& memory) {
  const Vec3 b_from_a_m = b.before.position_m - a.before.position_m;
  find_near_points(a, b, b_from_a_m, memory.points);
  if (memory.points.empty()) return false;
  PairSolver &meeting = memory.meeting, &leaving = memory.leaving;
  meeting.clear();
  leaving.clear();
  for (const PairPoint& p : memory.points) {
    const PlaneAxes across = plane_axes(p.normal);
    meeting.normals.push_back(row_of(a, b, b_from_a_m, p.point_m, p.normal));
    meeting.sides.push_back(row_of(a, b, b_from_a_m, p.point_m, across.x));
    meeting.others.push_back(row_of(a, b, b_from_a_m, p.point_m, across.y));
    meeting.targets_m_s.push_back(-std::max(p.gap_m, 0.0) / dt_s);
    if (p.gap_m > -kPairSlop_m) continue;
    leaving.normals.push_back(meeting.normals.back());
    leaving.targets_m_s.push_back(
        std::min((-p.gap_m - kPairSlop_m) * std::min(kPairPushRate_hz, 1.0 / dt_s), kPairPush_m_s));
  }
  Six va = six_of(a.free.velocity), vb = six_of(b.free.velocity), push_a{}, push_b{};
  const bool met = meeting.solve(friction, va, vb), left = leaving.solve(0.0, push_a, push_b);
  if (!met && !left) return false;
  // Velocities keep their components while the axes turn a little farther or less than alone: no
  // energy comes of that.
  a.free = {pose_after(a, va, push_a, dt_s), twist_of(va)};
  b.free = {pose_after(b, vb, push_b, dt_s), twist_of(vb)};
  return true;
}

}  // namespace neritic::sim
