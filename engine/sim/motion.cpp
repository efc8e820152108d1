// A step of a body among things: contacts at its start, then the way, cut where something new is
// met.
#include "engine/sim/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/sim/contact_memory.hpp"
#include "engine/sim/snapshot.hpp"

namespace neritic::sim {
namespace {

constexpr int kMostPieces = 64;
// A step is cut so often where something is hit; what hits more often within one step does so
// where the pieces end.
constexpr int kMostHits = 8;
// Two poses say a turn of less than half a circle.
constexpr double kMostTurn_rad = 1.0;
// Things farther away than this are in no contact.
constexpr double kMostMargin_m = 0.05;
// Longer ways are swept: contacts hold to first order in the way, so that a turn takes corners a
// little into what they touch.
constexpr double kShortWay_m = 0.005;
constexpr double kLeastMargin_m = 1e-3;
// How deep a sweep lets a part go: contacts then push it out.
constexpr double kSweepDepth_m = 0.002;
// Deeper than contacts ever let it come: it was put there, and is on its way out.
constexpr double kDeep_m = 0.05;

// No point of the body moves farther than this.
double way_length(const BodyShape& shape, const Pose& from, const Pose& to) {
  const double half_cosine = std::min(std::abs(glm::dot(from.rotation, to.rotation)), 1.0);
  const double turn_rad = 2.0 * std::acos(half_cosine);
  return glm::length(to.position_m - from.position_m) + turn_rad * shape.reach_m();
}

// Velocities as the world sees them: they stay while the body turns under them.
struct WorldTwist {
  Vec3 linear{0.0}, angular{0.0};
};
WorldTwist in_world(const Twist& body, const Quat& world_from_body) {
  return {world_from_body * body.linear, world_from_body * body.angular};
}
Twist in_body(const WorldTwist& world, const Quat& world_from_body) {
  const Quat body_from_world = glm::conjugate(world_from_body);
  return {body_from_world * world.linear, body_from_world * world.angular};
}

Pose moved_by(const Pose& pose, const WorldTwist& velocity, double duration_s) {
  return moved(pose, in_body(velocity, pose.rotation), duration_s);
}

void in_body_axes(std::span<const Contact> contacts, const Vec3& origin_m,
                  const Quat& world_from_body, std::vector<BodyContact>& out) {
  const Mat3 body_from_world = glm::mat3_cast(glm::conjugate(world_from_body));
  out.clear();
  for (const Contact& contact : contacts)
    out.push_back({body_from_world * (contact.point_m - origin_m), body_from_world * contact.normal,
                   contact.gap_m, contact.surface.friction, contact.surface.restitution});
}

// M v from M^-1 by Cholesky's factors; M is symmetric positive definite.
std::array<double, 6> momentum_of(const InverseMass& inverse_mass, const Twist& velocity) {
  std::array<double, 36> l{};
  std::array<double, 6> x{velocity.linear.x,  velocity.linear.y,  velocity.linear.z,
                          velocity.angular.x, velocity.angular.y, velocity.angular.z};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = inverse_mass[6 * i + j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[6 * i + k] * l[6 * j + k];
      l[6 * i + j] = i == j ? std::sqrt(sum) : sum / l[6 * j + j];
    }
    for (std::size_t k = 0; k < i; ++k) x[i] -= l[6 * i + k] * x[k];
    x[i] /= l[6 * i + i];
  }
  for (std::size_t i = 6; i-- > 0;) {
    for (std::size_t k = i + 1; k < 6; ++k) x[i] -= l[6 * k + i] * x[k];
    x[i] /= l[6 * i + i];
  }
  return x;
}
double twice_energy(const InverseMass& inverse_mass, const Twist& velocity) {
  const auto p = momentum_of(inverse_mass, velocity);
  return glm::dot(Vec3(p[0], p[1], p[2]), velocity.linear) +
         glm::dot(Vec3(p[3], p[4], p[5]), velocity.angular);
}

// The velocity in the axes that the body has turned to. Its mass may be larger in that direction:
// the turn, which no force made, adds no energy.
Twist turned(const WorldTwist& velocity, const Quat& solved_in, const Quat& now,
             const InverseMass& inverse_mass) {
  const Twist before = in_body(velocity, solved_in), after = in_body(velocity, now);
  const double had = twice_energy(inverse_mass, before), has = twice_energy(inverse_mass, after);
  if (!(has > had)) return after;
  const double scale = std::sqrt(had / has);
  return {after.linear * scale, after.angular * scale};
}

// One step of one body.
class Mover {
 public:
  Mover(const StaticWorld& world, const BodyShape& shape, const InverseMass& inverse_mass,
        const Pose& before, const BodyMotion& free, double dt_s, ContactMemory& memory,
        MotionReport& told, const Twist* started)
      : world_(world),
        shape_(shape),
        inverse_mass_(inverse_mass),
        free_(free),
        memory_(memory),
        told_(told),
        started_(started ? std::optional(in_world(*started, before.rotation)) : std::nullopt),
        now_(before),
        target_(free.world_from_body),
        solved_in_(free.world_from_body.rotation),
        velocity_(in_world(free.velocity, solved_in_)),
        left_s_(dt_s),
        way_s_(dt_s) {}

  BodyMotion run() {
    const double allowed_m = std::min(kSweepDepth_m, 0.25 * shape_.thinnest_m());
    for (told_.pieces = 1;; ++told_.pieces) {
      const double margin_m =
          std::clamp(1.01 * way_length(shape_, now_, target_), kLeastMargin_m, kMostMargin_m);
      meet(margin_m);
      const double safe_m = std::min({kShortWay_m, 0.25 * shape_.thinnest_m(), margin_m});
      const double share = way_length(shape_, now_, target_) > safe_m
                               ? std::min(cut_, world_.sweep(shape_, now_, target_, allowed_m,
                                                             memory_.passable, memory_))
                               : cut_;
      if (share >= 1.0 && way_s_ >= left_s_) break;
      now_ = share < 1.0 ? blend_pose(now_, target_, share) : target_;
      left_s_ -= way_s_ * share;
      way_s_ = left_s_;
      if (told_.touched) aim(velocity_, left_s_);
      if (told_.pieces < kMostPieces) continue;
      // Wedged between more than can be told apart: it stays, and its energy goes.
      told_.lost_s = left_s_;
      return {now_, {}};
    }
    if (!told_.touched) return free_;
    return {target_, turned(velocity_, solved_in_, target_.rotation, inverse_mass_)};
  }

 private:
  // Contacts here, and what they make of the velocity and the way.
  void meet(double margin_m) {
    const auto contacts = world_.contacts(shape_, now_, margin_m, memory_);
    told_.contacts = static_cast<int>(contacts.size());
    memory_.passable.clear();
    cut_ = 1.0;
    for (const Contact& contact : contacts) {
      if (told_.pieces == 1) {
        told_.deepest_m = std::max(told_.deepest_m, -contact.gap_m);
        told_.lies = told_.lies || contact.gap_m < kLies_m;
      }
      if (contact.inside || contact.gap_m < -kDeep_m) memory_.passable.push_back(contact.thing);
    }
    // In the axes at the end of the way, which the free velocity is in.
    const Quat& axes = target_.rotation;
    in_body_axes(contacts, now_.position_m, axes, memory_.body_contacts);
    const std::span<const BodyContact> body_contacts = memory_.body_contacts;
    const Twist free = in_body(velocity_, axes);
    // As far as the first hit, which then is one impulse at its own place and time.
    const bool precise = memory_.solver.precise;
    const double until_s =
        hits_ < kMostHits ? time_to_hit(body_contacts, free, left_s_, precise) : left_s_;
    const bool hit = until_s < left_s_;
    hits_ += hit ? 1 : 0;
    const auto solution =
        solve_contacts(body_contacts, inverse_mass_, free, until_s, memory_.solver);
    if (!solution.acted()) {
      if (hit) cut_ = until_s / left_s_;
      return;
    }
    told_.touched = true;
    const bool hard = meets_hard(body_contacts, free, until_s, precise);
    told_.hits += hard || closes(contacts, solution) ? 1 : 0;
    told_.converged = told_.converged && solution.converged;
    for (std::size_t i = 0; i < contacts.size(); ++i)
      told_.impulse_n_s += contacts[i].normal * solution.impulses[i].normal_n_s +
                           axes * solution.impulses[i].friction_n_s;
    velocity_ = in_world(solution.velocity, axes);
    const WorldTwist push = in_world(solution.push, axes);
    solved_in_ = axes;
    aim({velocity_.linear + push.linear, velocity_.angular + push.angular}, until_s);
  }

  // Whether one that acts is met, rather than lain on, in the step's first piece.
  bool closes(std::span<const Contact> contacts, const ContactSolution& solution) const {
    if (!started_ || told_.pieces > 1) return false;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Vec3 arm_m = contacts[i].point_m - now_.position_m;
      const Vec3 speed_m_s = started_->linear + glm::cross(started_->angular, arm_m);
      if (solution.impulses[i].normal_n_s > 0.0 &&
          glm::dot(contacts[i].normal, speed_m_s) < -kSoft_m_s)
        return true;
    }
    return false;
  }

  // Sets out for where this velocity leads in so long, or on the first part of the way.
  void aim(const WorldTwist& velocity, double duration_s) {
    const double turn_rad_s = glm::length(velocity.angular);
    way_s_ = std::min(duration_s, kMostTurn_rad / turn_rad_s);
    if (!memory_.passable.empty()) {
      // Things that it penetrates deeply are not swept against: no farther than that nothing thick
      // is passed.
      const double speed_m_s = glm::length(velocity.linear) + turn_rad_s * shape_.reach_m();
      way_s_ = std::min(way_s_, 0.25 * shape_.thinnest_m() / speed_m_s);
    }
    target_ = moved_by(now_, velocity, way_s_);
  }

  const StaticWorld& world_;
  const BodyShape& shape_;
  const InverseMass& inverse_mass_;
  const BodyMotion& free_;
  ContactMemory& memory_;
  MotionReport& told_;
  const std::optional<WorldTwist> started_;
  Pose now_, target_;
  Quat solved_in_;  // axes in which the velocity was last solved
  WorldTwist velocity_;
  double left_s_, way_s_;  // to the end; to the target
  double cut_ = 1.0;       // share of the way to the target until something is hit
  int hits_ = 0;           // so often the step was cut there
};

}  // namespace

Pose moved(const Pose& world_from_body, const Twist& velocity, double duration_s) {
  const Quat& q = world_from_body.rotation;
  const Vec3 turn_rad = velocity.angular * duration_s;
  const double angle_rad = glm::length(turn_rad);
  Pose out{world_from_body.position_m + q * (velocity.linear * duration_s), q};
  if (angle_rad > 0.0)
    out.rotation = glm::normalize(q * glm::angleAxis(angle_rad, turn_rad / angle_rad));
  return out;
}

BodyMotion move_body(const StaticWorld& world, const BodyShape& shape,
                     const InverseMass& inverse_mass, const Pose& before, const BodyMotion& free,
                     double dt_s, ContactMemory& memory, MotionReport* report,
                     const Twist* started) {
  MotionReport unread;
  MotionReport& told = report ? *report : unread;
  told = {};
  return Mover(world, shape, inverse_mass, before, free, dt_s, memory, told, started).run();
}

BodyMotion move_body(const StaticWorld& world, const BodyShape& shape,
                     const InverseMass& inverse_mass, const Pose& before, const BodyMotion& free,
                     double dt_s, MotionReport* report) {
  ContactMemory memory;
  return move_body(world, shape, inverse_mass, before, free, dt_s, memory, report);
}

}  // namespace neritic::sim
