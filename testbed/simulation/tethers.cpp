#include "testbed/simulation/tethers.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "engine/sim/grip.hpp"
#include "rov/frames.hpp"

namespace neritic::testbed {
namespace {

// The cable keeps so far off what is solid, at least: thinner, a fast one could pass a sheet.
constexpr double kLeastContactRadius_m = 0.01;
// Depth is undone at no more than this in a step.
constexpr double kMostEscape_m = 0.005;
// Farther, nothing is met in a step, unless it moves faster than this in one.
constexpr double kMargin_m = 0.02, kMostMargin_m = 0.5;

// Length over that without pull, at most, at the start: a line that is longer would throw its
// vehicle.
constexpr double kMostStrain = 1.01;

// The mass of a body at a place of it, against a push there: the inverse of
// [1, -[r]x] M^-1 [1, -[r]x]^T, world axes.
Mat3 mass_at(const sim::InverseMass& inverse_mass, const Quat& world_from_body, const Vec3& at_m) {
  Mat3 yields(0.0);
  for (int k = 0; k < 3; ++k) {
    Vec3 push(0.0);
    push[k] = 1.0;
    const sim::Twist given = sim::given_by(inverse_mass, at_m, push);
    yields[k] = given.linear + glm::cross(given.angular, at_m);
  }
  const Mat3 turn = glm::mat3_cast(world_from_body);
  return turn * glm::inverse(yields) * glm::transpose(turn);
}

// Axes of north, east, down from those of the world.
Mat3 in_ned(const Mat3& m) {
  Mat3 axes(0.0);
  for (int k = 0; k < 3; ++k) {
    Vec3 unit(0.0);
    unit[k] = 1.0;
    axes[k] = rov::ned_from_world(unit);
  }
  return axes * m * glm::transpose(axes);
}

rov::Cable cable_of(const scene::Tether& t, double water_kg_m3) {
  rov::Cable cable;
  cable.segments = t.segments;
  cable.diameter_m = t.diameter_m;
  cable.net_weight_n_m = t.net_weight_n_m;
  cable.stiffness_n = t.stiffness_n;
  cable.damping_n_s = t.damping_n_s;
  cable.normal_drag = t.normal_drag;
  cable.tangential_drag = t.tangential_drag;
  cable.water_kg_m3 = water_kg_m3;
  return cable;
}

double contact_radius_m(const PhysicsTether& tether) {
  return std::max(0.5 * tether.cable.diameter_m, kLeastContactRadius_m);
}

// Appends to out the solid things that a segment is near.
void find_contacts(const PhysicsTether& tether, std::uint32_t segment, const Vec3& from_m,
                   const Vec3& to_m, double margin_m, const sim::StaticWorld& solid,
                   sim::ContactMemory& memory, std::vector<rov::CableContact>& out) {
  const Vec3 middle_m = 0.5 * (from_m + to_m);
  sim::BodyShape shape;
  shape.add_capsule(from_m - middle_m, to_m - middle_m, contact_radius_m(tether));
  const Vec3 along = to_m - from_m;
  const double square = glm::dot(along, along);
  for (const sim::Contact& contact : solid.contacts(shape, Pose{middle_m}, margin_m, memory)) {
    const double share =
        square > 0.0 ? std::clamp(glm::dot(contact.point_m - from_m, along) / square, 0.0, 1.0)
                     : 0.5;
    out.push_back({segment, share, rov::ned_from_world(contact.normal),
                   std::max(contact.gap_m, -kMostEscape_m), tether.settings.friction});
  }
}

}  // namespace

Result<Tethers> Tethers::create(const scene::Scene& scene, const Movers& movers) {
  Tethers out;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const auto& dynamics = scene.objects[i].dynamics;
    if (!dynamics || !dynamics->tether) continue;
    const scene::Tether& settings = *dynamics->tether;
    PhysicsTether tether{
        .name = scene.objects[i].name,
        .vehicle = static_cast<std::size_t>(movers.vehicle_of_object[i]),
        .object = settings.object,
        .cable = cable_of(settings, scene.physics->water_kg_m3),
        .settings = settings,
        .first_node = out.nodes_,
        .top = Place(scene, {.object = static_cast<int>(settings.object)}, movers)};
    if (const Status checked = check_cable(tether.cable); !checked.ok())
      return bad_input("{}: {}: {}", scene.path, scene.objects[i].name, checked.error().message);
    out.nodes_ += settings.segments - 1;
    out.all_.push_back(std::move(tether));
  }
  return out;
}

Status Tethers::check_lengths(const PhysicsState& start) const {
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const TetherState& tether = start.tethers()[i];
    const double away_m = glm::distance(tether.top_ned_m, tether.end_ned_m);
    if (away_m > kMostStrain * tether.length_m)
      return refusal(
          fmt::format("{}: tether.length_m", all_[i].name), fmt::format("{:g}", tether.length_m),
          fmt::format("{:.4g} metres or more, from its top to the vehicle at the start", away_m));
  }
  return {};
}

std::span<const rov::CableNode> Tethers::nodes(const PhysicsState& state, std::size_t index) const {
  return state.tether_nodes().subspan(all_[index].first_node, all_[index].cable.segments - 1);
}

void Tethers::start(const sim::StaticWorld& solid, PhysicsState& state) const {
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const PhysicsTether& tether = all_[i];
    const rov::State& body = state.vehicles()[tether.vehicle].body;
    TetherState& out = state.tethers()[i];
    out.length_m = tether.settings.length_m;
    out.top_ned_m = rov::ned_from_world(tether.top.at(state, 0.0).position_m);
    out.end_ned_m = rov::ned_from_world(rov::world_pose(body.position_ned_m, body.attitude) *
                                        tether.settings.attachment_m);
    const auto nodes = state.tether_nodes().subspan(tether.first_node, tether.cable.segments - 1);
    rov::hang_cable(tether.cable, out.length_m, out.top_ned_m, out.end_ned_m, nodes);
    // Where it would hang in something solid it lies on it: on what is below the straight line.
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double share = static_cast<double>(k + 1) / tether.cable.segments;
      Vec3 over = rov::world_from_ned(nodes[k].position_ned_m);
      const double hangs_m = over.y;
      over.y = rov::world_from_ned(glm::mix(out.top_ned_m, out.end_ned_m, share)).y;
      if (over.y <= hangs_m) continue;
      const auto hit = solid.cast(over, Vec3(0.0, -1.0, 0.0), over.y - hangs_m);
      if (!hit) continue;
      over.y += contact_radius_m(tether) - hit->distance_m;
      nodes[k].position_ned_m = rov::ned_from_world(over);
    }
  }
}

bool Tethers::step(std::size_t index, const sim::StaticWorld& solid, const PhysicsState& before,
                   const sim::StepTime& time, TetheredBody body, TetherScratch& scratch,
                   sim::ContactMemory& memory, PhysicsState& after) const {
  const PhysicsTether& tether = all_[index];
  const double dt_s = time.step_s;
  if (!(dt_s > 0.0)) return false;
  const TetherState& was = before.tethers()[index];
  TetherState& out = after.tethers()[index];
  const auto nodes = after.tether_nodes().subspan(tether.first_node, tether.cable.segments - 1);
  if (const auto& winch = tether.settings.winch)
    out.length_m = std::clamp(
        was.length_m + dt_s * rov::winch_rate_m_s(was.top_n, winch->hold_n, winch->speed_m_s),
        winch->least_m, winch->most_m);
  const Vec3& at_m = tether.settings.attachment_m;
  const Quat& turned = body.free.world_from_body.rotation;
  rov::CableEnds ends;
  ends.top_before_ned_m = was.top_ned_m;
  // A carrier of the top that moves by physics is still where it was before the step.
  ends.top_after_ned_m =
      rov::ned_from_world(tether.top.at(before, time.time_s() + dt_s).position_m);
  ends.end_free_ned_m = rov::ned_from_world(body.free.world_from_body * at_m);
  const Vec3 free_m_s = sim::point_velocity(body.free, at_m);
  ends.end_free_velocity_m_s = rov::ned_from_world(free_m_s);
  ends.end_before_velocity_m_s =
      rov::ned_from_world(body.velocity_before_m_s +
                          glm::cross(body.turning_before_rad_s, body.before.rotation * at_m));
  ends.end_mass_kg = in_ned(mass_at(body.inverse_mass, turned, at_m));
  scratch.contacts.clear();
  if (solid.counts().things > 0) {
    Vec3 from_m = rov::world_from_ned(was.top_ned_m);
    const Vec3 end_m = body.before * at_m;
    double fastest_m_s =
        std::max(glm::length(free_m_s), glm::distance(ends.top_after_ned_m, was.top_ned_m) / dt_s);
    for (const rov::CableNode& node : nodes)
      fastest_m_s = std::max(fastest_m_s, glm::length(node.velocity_ned_m_s));
    const double margin_m = std::min(kMargin_m + 2.0 * dt_s * fastest_m_s, kMostMargin_m);
    for (std::uint32_t s = 0; s < tether.cable.segments; ++s) {
      const Vec3 to_m =
          s + 1 < tether.cable.segments ? rov::world_from_ned(nodes[s].position_ned_m) : end_m;
      find_contacts(tether, s, from_m, to_m, margin_m, solid, memory, scratch.contacts);
      from_m = to_m;
    }
  }
  const rov::CablePull pull = rov::step_cable(tether.cable, out.length_m, ends, scratch.currents,
                                              scratch.contacts, dt_s, nodes, scratch.work);
  if (!pull.converged) ++out.unconverged;
  out.top_ned_m = ends.top_after_ned_m;
  out.pull_ned_n = pull.impulse_n_s / dt_s;
  out.end_n = pull.end_n;
  out.top_n = pull.top_n;
  out.most_n = pull.most_n;
  out.touching = pull.touching;
  // The body's velocity changes by the impulse, and its place as if that were its mean.
  const Vec3 push = glm::conjugate(turned) * rov::world_from_ned(pull.impulse_n_s);
  const sim::Twist change = sim::given_by(body.inverse_mass, at_m, push);
  body.free.world_from_body = sim::moved(body.free.world_from_body, change, dt_s);
  body.free.velocity.linear += change.linear;
  body.free.velocity.angular += change.angular;
  out.end_ned_m = rov::ned_from_world(body.free.world_from_body * at_m);
  return true;
}

TetherReading tether_reading(const TetherState& state) {
  return {.pull_n = rov::world_from_ned(state.pull_ned_n),
          .tension_n = state.end_n,
          .top_n = state.top_n,
          .most_n = state.most_n,
          .length_m = state.length_m,
          .straight_m = glm::distance(state.top_ned_m, state.end_ned_m),
          .touching = state.touching};
}

scene::NodeKey drawn_tether(std::span<const rov::CableNode> nodes, const TetherState& state,
                            double time_s) {
  const std::size_t segments = nodes.size() + 1;
  const auto place = [&](std::ptrdiff_t i) -> Vec3 {
    if (i <= 0) return Vec3(0.0);
    const Vec3& at = static_cast<std::size_t>(i) < segments
                         ? nodes[static_cast<std::size_t>(i) - 1].position_ned_m
                         : state.end_ned_m;
    return rov::world_from_ned(at - state.top_ned_m);
  };
  scene::NodeKey key{time_s, {}, {}, {}};
  // Between two nodes a cubic through them, whose slope at each is its neighbours' (Catmull, Rom).
  for (std::size_t s = 0; s < segments; ++s)
    for (std::uint32_t k = 0; k < scene::kTetherJoints; ++k) {
      const auto i = static_cast<std::ptrdiff_t>(s);
      const double t = static_cast<double>(k) / scene::kTetherJoints;
      const Vec3 a = place(i - 1), b = place(i), c = place(i + 1), d = place(i + 2);
      key.places_m.push_back(0.5 *
                             (2.0 * b + t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) +
                                                            t * (3.0 * (b - c) + d - a)))));
    }
  key.places_m.push_back(place(static_cast<std::ptrdiff_t>(segments)));
  // Rings across the line, without twist from one to the next; a joint's line runs down its y.
  Quat turn(1.0, 0.0, 0.0, 0.0);
  Vec3 along(0.0, -1.0, 0.0);
  for (std::size_t j = 0; j < key.places_m.size(); ++j) {
    const Vec3 way =
        key.places_m[std::min(j + 1, key.places_m.size() - 1)] - key.places_m[j == 0 ? 0 : j - 1];
    if (const double length_m = glm::length(way); length_m > 1e-9) {
      const Vec3 next = way / length_m;
      // glm's quaternion of two directions: the shortest turn from one to the other.
      turn = glm::normalize(Quat(along, next) * turn);
      along = next;
    }
    key.rotations.push_back(turn);
  }
  key.scales.assign(key.places_m.size(), Vec3(1.0));
  return key;
}

}  // namespace neritic::testbed
