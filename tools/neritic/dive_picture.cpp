#include "tools/neritic/dive_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "diver/gas_label.hpp"
#include "tools/common/picture.hpp"
#include "tools/neritic/dive_told.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

using nlohmann::json;

// The ground is sampled by rays on a square grid of this many cells a side.
constexpr int kGroundCells = 180;
constexpr double kRayTop_m = 100.0, kRayLength_m = 12000.0, kLeastSide_m = 10.0;

template <class Row>
using Rows = std::vector<Row>;

template <class Row, class Value>
json column(const Rows<Row>& rows, Value value) {
  json out = json::array();
  for (const Row& row : rows) {
    const auto v = value(row);
    if constexpr (std::is_floating_point_v<decltype(v)>)
      out.push_back(six_digits(v));  // what is not finite becomes null
    else
      out.push_back(v);
  }
  return out;
}

// Where it was, and how deep what is solid lies straight below; null: nothing is.
template <class Row>
void add_path(json& out, const PhysicsWorld& world, const Rows<Row>& rows) {
  out["time_s"] = column(rows, [](const Row& r) { return r.time_s; });
  out["x_m"] = column(rows, [](const Row& r) { return r.world_from_body.position_m.x; });
  out["z_m"] = column(rows, [](const Row& r) { return r.world_from_body.position_m.z; });
  out["depth_m"] = column(rows, [](const Row& r) { return -r.world_from_body.position_m.y; });
  out["speed_m_s"] = column(rows, [](const Row& r) { return glm::length(r.velocity.linear()); });
  out["ground_depth_m"] = column(rows, [&](const Row& r) {
    const Vec3& from = r.world_from_body.position_m;
    const auto hit = world.solid().cast(from, {0.0, -1.0, 0.0}, kRayLength_m);
    return hit ? hit->distance_m - from.y : std::numeric_limits<double>::quiet_NaN();
  });
}

json vehicle_data(const PhysicsWorld& world, const PhysicsVehicle& vehicle,
                  const Rows<DiveRow>& rows) {
  json out{{"name", vehicle.name}, {"thrust_n", json::array()}, {"waypoints", json::array()}};
  add_path(out, world, rows);
  // A vehicle without a mission drifts: it is to be nowhere.
  const auto wanted = [&](auto value) {
    return vehicle.mission ? column(rows, value) : json(nullptr);
  };
  out["wanted_x_m"] = wanted([](const DiveRow& r) { return r.wanted.position_m.x; });
  out["wanted_z_m"] = wanted([](const DiveRow& r) { return r.wanted.position_m.z; });
  out["wanted_depth_m"] = wanted([](const DiveRow& r) { return -r.wanted.position_m.y; });
  out["error_m"] = wanted([](const DiveRow& r) {
    return glm::distance(r.world_from_body.position_m, r.wanted.position_m);
  });
  for (std::size_t i = 0; i < vehicle.vehicle.thruster_count; ++i)
    out["thrust_n"].push_back(column(rows, [i](const DiveRow& r) { return r.force_n[i]; }));
  std::uint64_t arrived = 0;
  for (const DiveRow& row : rows) {
    if (row.arrived == arrived) continue;
    arrived = row.arrived;
    const Vec3& at = row.world_from_body.position_m;
    out["waypoints"].push_back({{"number", arrived},
                                {"at_s", six_digits(row.time_s)},
                                {"at_x_m", six_digits(at.x)},
                                {"at_z_m", six_digits(at.z)},
                                {"at_depth_m", six_digits(-at.y)}});
  }
  return out;
}

json limits_data(const PhysicsHuman& human) {
  const diver::AscentRateLimits& ascent = human.computer->settings().ascent;
  return {{"fast_m_min", ascent.fast_m_min},
          {"dangerous_m_min", ascent.dangerous_m_min},
          {"co2_mmhg", diver::kCo2Levels_mmhg},
          {"narcotic_m", diver::kNarcoticLevels_m},
          {"density_g_l", diver::kDensityLevels_kg_m3},
          {"oxygen_bar", diver::kOxygenLevels_bar}};
}

json human_data(const PhysicsWorld& world, const PhysicsHuman& human, const HumanFigures& figures,
                const Rows<HumanRow>& rows) {
  json out{{"name", human.name},
           {"limits", limits_data(human)},
           {"dangers", dangers_json(human, figures)},
           {"gas_switches", changes_json(human, figures)},
           {"tanks", json::array()},
           {"tank_bar", json::array()}};
  add_path(out, world, rows);
  for (std::size_t i = 0; i < human.body.tank_count; ++i) {
    out["tanks"].push_back(diver::name_of(human.body.tanks[i].mix));
    out["tank_bar"].push_back(column(rows, [i](const HumanRow& r) { return 1e-5 * r.tank_pa[i]; }));
  }
  const auto add = [&](const char* name, auto value) { out[name] = column(rows, value); };
  using R = const HumanRow&;
  add("tank", [](R r) { return r.tank; });
  add("remaining_min", [](R r) { return r.gas.remaining_s / 60.0; });
  add("ventilation_l_min", [](R r) { return r.gas.ventilation_l_min; });
  add("oxygen_l_min", [](R r) { return r.oxygen_l_min; });
  add("reserve_percent", [](R r) { return 100.0 * r.reserve_share; });
  add("breaths_min", [](R r) { return r.vitals.breath_bpm; });
  add("heart_bpm", [](R r) { return r.vitals.heart_bpm; });
  add("lungs_l", [](R r) { return 1e3 * r.lungs_m3; });
  add("jacket_l", [](R r) { return 1e3 * r.gas.jacket_m3; });
  add("net_weight_n", [](R r) { return r.net_weight_n; });
  add("kick_hz", [](R r) { return r.kick_hz; });
  add("limb_power_w", [](R r) { return r.limb_power_w; });
  add("ceiling_m", [](R r) { return r.ascent.view.ceiling_m; });
  add("stop_m", [](R r) { return r.ascent.view.stop_m; });
  add("no_stop_min", [](R r) { return r.ascent.view.no_stop_min; });
  add("to_surface_min", [](R r) { return r.ascent.view.to_surface_min; });
  add("ascent_m_min", [](R r) { return r.ascent.view.ascent_m_min; });
  add("ascent_alarm", [](R r) { return static_cast<int>(r.ascent.view.alarm); });
  add("ceiling_violated", [](R r) { return r.ascent.view.ceiling_violated ? 1 : 0; });
  add("out_of_gas", [](R r) { return r.out_of_gas_s > 0.0 ? 1 : 0; });
  add("oxygen_high", [](R r) { return (danger_bits(r) & 16u) != 0 ? 1 : 0; });
  add("risk_high", [](R r) { return (danger_bits(r) & 8u) != 0 ? 1 : 0; });
  add("co2_proxy_mmhg", [](R r) { return r.vitals.risk.co2_mmhg; });
  add("narcosis_proxy_m", [](R r) { return r.vitals.risk.narcotic_depth_m; });
  add("gas_density_g_l", [](R r) { return r.ascent.view.density_g_l; });
  add("po2_bar", [](R r) { return r.vitals.risk.oxygen_bar; });
  return out;
}

// Heights of what is solid on a square around all paths, seen from above; null where nothing is.
json ground_data(const PhysicsWorld& world, const std::vector<Vec3>& places) {
  constexpr double kMargin = 1.3;  // of the paths' larger extent
  if (places.empty()) return nullptr;
  Vec3 low = places[0], high = places[0];
  for (const Vec3& p : places) low = glm::min(low, p), high = glm::max(high, p);
  const Vec3 middle = 0.5 * (low + high);
  const double side_m = std::max(kMargin * std::max(high.x - low.x, high.z - low.z), kLeastSide_m);
  const double cell_m = side_m / kGroundCells;
  json heights = json::array();
  bool any = false;
  for (int row = 0; row < kGroundCells; ++row) {
    json line = json::array();
    for (int i = 0; i < kGroundCells; ++i) {
      const Vec3 from{middle.x - 0.5 * side_m + (i + 0.5) * cell_m, kRayTop_m,
                      middle.z - 0.5 * side_m + (row + 0.5) * cell_m};
      const auto hit = world.solid().cast(from, {0.0, -1.0, 0.0}, kRayLength_m);
      any |= hit.has_value();
      line.push_back(hit ? json(six_digits(hit->distance_m - kRayTop_m)) : json(nullptr));
    }
    heights.push_back(std::move(line));
  }
  return {{"west_m", six_digits(middle.x - 0.5 * side_m)},
          {"north_m", six_digits(-(middle.z - 0.5 * side_m))},
          {"side_m", six_digits(side_m)},
          {"depths_m", any ? std::move(heights) : json(nullptr)}};
}

}  // namespace

json dive_picture_data(const std::string& title, const PhysicsWorld& world, const PlotRows& rows,
                       const std::vector<HumanFigures>& figures) {
  json vehicles = json::array(), humans = json::array();
  std::vector<Vec3> places;
  const auto add_places = [&](const auto& of_one) {
    for (const auto& row : of_one) places.push_back(row.world_from_body.position_m);
  };
  for (std::size_t i = 0; i < world.vehicles().size(); ++i) {
    const Rows<DiveRow> of_one = rows.vehicle(i);
    add_places(of_one);
    vehicles.push_back(vehicle_data(world, world.vehicles()[i], of_one));
  }
  for (std::size_t i = 0; i < world.humans().size(); ++i) {
    const Rows<HumanRow> of_one = rows.human(i);
    add_places(of_one);
    humans.push_back(human_data(world, world.humans()[i], figures[i], of_one));
  }
  return {{"picture", "dive"},
          {"title", title},
          {"risk_note", diver::kRiskNote},
          {"ground", ground_data(world, places)},
          {"vehicles", std::move(vehicles)},
          {"humans", std::move(humans)}};
}

}  // namespace neritic::tools
