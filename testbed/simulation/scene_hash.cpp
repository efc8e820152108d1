#include "testbed/simulation/scene_hash.hpp"

#include <map>
#include <set>

#include "engine/core/files.hpp"
#include "engine/core/hash.hpp"
#include "testbed/simulation/model_hash.hpp"

namespace neritic::testbed {
namespace {

// Adds values member by member: padding has no meaning. A list begins
// with their count, so that the end of one list is never read as the start of what follows.
class SceneHash {
 public:
  explicit SceneHash(std::span<const std::uint64_t> vehicle_files)
      : vehicle_files_(vehicle_files) {}

  Status add(const scene::Scene& scene) {
    number(scene.seed);
    const scene::Physics& physics = *scene.physics;
    text(physics.integrator);
    numbers(physics.rate_hz, physics.max_error_m, physics.water_kg_m3, physics.altitude_m);
    if (scene.water && scene.water->column) add(*scene.water->column);
    if (scene.water && scene.water->waves && scene.water->waves_move) add(*scene.water->waves);
    number(scene.current.has_value());
    if (scene.current) NERITIC_TRY_STATUS(add(*scene.current));
    number(scene.objects.size());
    for (const scene::Object& object : scene.objects) NERITIC_TRY_STATUS(add(scene, object));
    add_carriers(scene);
    if (!scene.modems.empty()) add(scene.acoustics.value_or(scene::Acoustics{}));
    for (const scene::Modem& modem : scene.modems) add(modem);
    return {};
  }
  std::uint64_t value() const { return hash_.value(); }

 private:
  void number(std::uint64_t value) { hash_.add(value); }
  template <class... Numbers>
  void numbers(Numbers... values) {
    (hash_.add(static_cast<double>(values)), ...);
  }
  // Absent differs from any value: what stands for it is chosen elsewhere.
  void number_if(const std::optional<double>& value) {
    number(value.has_value());
    if (value) numbers(*value);
  }
  void text(const std::string& value) {
    hash_.add_span(std::span<const char>(value.data(), value.size()));
  }
  void vec(const Vec3& v) { numbers(v.x, v.y, v.z); }
  void quat(const Quat& q) { numbers(q.w, q.x, q.y, q.z); }
  void matrix(const Mat4& m) {
    for (int i = 0; i < 4; ++i) numbers(m[i].x, m[i].y, m[i].z, m[i].w);
  }
  Status file(const std::filesystem::path& path) {
    number(path.empty());
    if (path.empty()) return {};
    auto& known = files_[path.string()];
    if (!known) {
      NERITIC_TRY(const auto bytes, read_file(path));
      Hash64 hash;
      hash.add_span(std::span<const std::byte>(bytes));
      known = hash.value();
    }
    number(*known);
    return {};
  }

  Status add(const scene::Current& c) {
    number(static_cast<std::uint64_t>(c.kind));
    vec(c.velocity_m_s), vec(c.deep_velocity_m_s), vec(c.origin_m), vec(c.spacing_m);
    numbers(c.depth_m, c.exponent, c.start_s, c.interval_s);
    return file(c.file);
  }

  void add(const SeaState& sea) {
    text("waves");
    numbers(sea.wind_m_s, sea.fetch_m, sea.direction_rad);
    number(sea.components), number(sea.seed);
  }
  void add(const WaterColumn& column) {
    text("water column");
    numbers(column.temperature_c, column.salinity_psu);
    number(column.count);
    for (const WaterLayer& layer : column.layers())
      numbers(layer.depth_m, layer.thickness_m, layer.temperature_c, layer.salinity_psu);
  }
  void add(const scene::Acoustics& water) {
    text("acoustics");
    numbers(water.temperature_c, water.salinity_psu, water.ph, water.spreading, water.wind_m_s,
            water.shipping);
    number(static_cast<std::uint64_t>(water.path));
    number(water.profile.size());
    for (const scene::SonarRow& row : water.profile) numbers(row.x, row.y);
  }
  void add(const scene::Modem& modem) {
    text("modem");
    number(static_cast<std::uint64_t>(modem.object));
    vec(modem.position_m);
    numbers(modem.source_level_db, modem.frequency_hz, modem.bandwidth_hz, modem.bit_rate_hz,
            modem.preamble_s, modem.coding_gain_db, modem.detection_db, modem.self_noise_db,
            modem.turnaround_s);
    number(modem.fading);
    number(modem.usbl.has_value());
    if (!modem.usbl) return;
    text(modem.usbl->target);
    numbers(modem.usbl->interval_s, modem.usbl->range_noise_m, modem.usbl->direction_noise_rad);
    number_if(modem.usbl->sound_m_s);
    numbers(modem.usbl->offset_s);
    number_if(modem.usbl->wait_s);
  }

  void add(const scene::Mount& mount) {
    numbers(mount.object);
    if (mount.joint >= 0) text("joint"), numbers(mount.joint);
    vec(mount.pose.position_m), quat(mount.pose.rotation);
    if (mount.afloat) {
      text("afloat");
      add(mount.afloat->sea);
      numbers(mount.afloat->length_breadth_m.x, mount.afloat->length_breadth_m.y);
    }
    number(mount.track.has_value());
    if (!mount.track) return;
    number(mount.track->places.size());
    for (const auto& place : mount.track->places) numbers(place.time_s), vec(place.position_m);
    numbers(mount.track->repeat_from_s, mount.track->repeat_s);
    number(mount.track->attitudes.size());
    for (const auto& at : mount.track->attitudes) numbers(at.time_s), quat(at.rotation);
  }

  void add(const scene::Model& model, const Vec3& scale) {
    auto& known = models_[{&model, {scale.x, scale.y, scale.z}}];
    if (!known) known = shape_hash(model, scale);
    number(*known);
  }

  // The objects that carry others on a joint.
  void add_carriers(const scene::Scene& scene) {
    std::set<int> carriers;
    for (const scene::Object& object : scene.objects)
      if (object.mount.joint >= 0) carriers.insert(object.mount.object);
    for (const int index : carriers) {
      const scene::Object& carrier = scene.objects.at(static_cast<std::size_t>(index));
      text("carries on a joint"), numbers(index);
      number(joints_hash(*scene.models.at(static_cast<std::size_t>(carrier.model)), carrier.clip));
      numbers(carrier.clip_offset_s, carrier.clip_rate);
      vec(carrier.scale);
    }
  }

  Status add(const scene::Scene& scene, const scene::Object& object) {
    text(object.name);
    add(object.mount);
    number(object.dynamics.has_value());
    number(object.human.has_value());
    number(static_cast<std::uint64_t>(object.collision));
    const bool touched = object.collision != scene::Collision::kNone || object.dynamics;
    if (object.model >= 0 && (touched || object.human)) {
      add(*scene.models[static_cast<std::size_t>(object.model)], object.scale);
      number(object.copies.size());
      for (const Mat4& copy : object.copies) matrix(copy);
    }
    if (!object.inputs.empty()) text("inputs"), add(object.inputs);
    if (object.thing) add(*object.thing);
    if (object.dynamics) add(*object.dynamics);
    if (object.human) NERITIC_TRY_STATUS(add(*object.human));
    return {};
  }

  void add(const scene::Dynamics& dynamics) {
    number(vehicle_files_[vehicle_++]);
    number(dynamics.failed_thrusters);
    number(static_cast<std::uint64_t>(dynamics.navigation));
    add(dynamics.inputs);
    number(dynamics.tether_anchor_m.has_value());
    if (dynamics.tether_anchor_m) vec(*dynamics.tether_anchor_m);
    if (dynamics.tether) add(*dynamics.tether);
    if (dynamics.gripper) text("gripper"), add(*dynamics.gripper);
    if (dynamics.near_added_mass) text("near_added_mass");
    if (dynamics.wash) text("wash"), numbers(dynamics.wash->diameter_m, dynamics.wash->reach_m);
    number(dynamics.mission.has_value());
    if (dynamics.mission) add(*dynamics.mission);
  }

  void add(const scene::Tether& t) {
    text("tether");
    number(t.object);
    vec(t.attachment_m);
    number(t.segments);
    numbers(t.length_m, t.diameter_m, t.net_weight_n_m, t.stiffness_n, t.damping_n_s, t.normal_drag,
            t.tangential_drag, t.friction);
    number(t.winch.has_value());
    if (t.winch) numbers(t.winch->hold_n, t.winch->speed_m_s, t.winch->least_m, t.winch->most_m);
  }

  void add(const std::vector<scene::InputChoice>& inputs) {
    number(inputs.size());
    for (const scene::InputChoice& choice : inputs) {
      text(choice.group), text(choice.from), text(choice.then);
      number_if(choice.hold_s);
    }
  }
  void add(const scene::Aim& aim) { numbers(aim.object), vec(aim.point_m); }
  void add(const scene::Facing& facing) {
    number_if(facing.heading_rad);
    number(facing.look_at.has_value());
    if (facing.look_at) add(*facing.look_at);
    number(facing.tilt);
  }
  void add(const scene::Mission& m) {
    number(static_cast<std::uint64_t>(m.kind));
    add(m.facing);
    number(m.waypoints.size());
    for (const scene::MissionWaypoint& waypoint : m.waypoints) {
      vec(waypoint.position_m), numbers(waypoint.hold_s);
      add(waypoint.facing);
    }
    numbers(m.acceptance_m, m.speed_m_s, m.radius_m, m.distance_m);
    number(static_cast<std::uint64_t>(m.speed_over));
    number(m.repeat);
    vec(m.offset_m);
    add(m.target), add(m.between_a), add(m.between_b);
  }

  void add(const scene::Thing& thing) {
    text("thing");
    numbers(thing.mass_kg, thing.volume_m3, thing.drag_area_m2);
    number(thing.racked);
  }
  void add(const scene::Grip& grip) {
    vec(grip.position_m);
    numbers(grip.reach_m, grip.strength_n, grip.most_m_s);
  }
  void add(const scene::Condition& condition) {
    text("condition");
    number(condition.effects.size());
    for (const std::string& effect : condition.effects) text(effect);
    number(condition.acts);
    numbers(condition.fat_share);
    number_if(condition.water_c), number_if(condition.oxygen_tolerance);
  }
  void add(const scene::Regulator& regulator) {
    text("regulator"), text(regulator.donor);
    numbers(regulator.donor_tank, regulator.hose_m, regulator.reaction_s);
    number(regulator.free_flows.size());
    for (const scene::FreeFlow& flow : regulator.free_flows)
      numbers(flow.at_s, flow.until_s, flow.tank, flow.area_m2);
  }

  Status add(const scene::Human& human) {
    NERITIC_TRY_STATUS(file(human.file));
    NERITIC_TRY_STATUS(file(human.jacket_buttons));
    add(human.inputs);
    if (human.condition) add(*human.condition);
    if (human.regulator) add(*human.regulator);
    if (human.hands) text("hands"), add(*human.hands);
    number(human.swim.has_value());
    if (!human.swim) return {};
    number(human.swim->waypoints_m.size());
    for (const Vec3& point : human.swim->waypoints_m) vec(point);
    numbers(human.swim->speed_m_s, human.swim->acceptance_m);
    number(static_cast<std::uint64_t>(human.swim->speed_over));
    number(human.swim->repeat);
    return file(human.swim->motion);
  }

  Hash64 hash_;
  std::span<const std::uint64_t> vehicle_files_;  // of each vehicle in turn
  std::size_t vehicle_ = 0;
  // Files that many objects share count once.
  std::map<std::string, std::optional<std::uint64_t>> files_;
  std::map<std::pair<const scene::Model*, std::array<double, 3>>, std::optional<std::uint64_t>>
      models_;
};

}  // namespace

Result<std::uint64_t> scene_hash(const scene::Scene& scene,
                                 std::span<const std::uint64_t> vehicle_files) {
  SceneHash hash(vehicle_files);
  NERITIC_TRY_STATUS(hash.add(scene));
  return hash.value();
}

}  // namespace neritic::testbed
