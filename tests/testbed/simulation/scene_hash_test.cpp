// Each key of a scene that the physics reads changes the hash with which states are saved. Tables
// name the format's own lists of keys (engine/scene/scene_keys.hpp): a key that is neither changed
// here nor said to be only drawn fails.
#include "testbed/simulation/scene_hash.hpp"

#include <set>

#include "engine/core/npy.hpp"
#include "engine/scene/scene_keys.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

std::uint64_t hash_of_text(const std::string& text) {
  const auto scene = load_text(text);
  EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message) << "\n" << text;
  if (!scene.ok()) return 0;
  const auto world = PhysicsWorld::create(*scene);
  EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().message) << "\n" << text;
  return world.ok() ? (*world)->state_format().scene_hash : 0;
}

// The scene with two values of a key, of which one may be absent.
struct Change {
  std::string key, one, other;
};
struct KeyTable {
  std::string name;
  scene::KeyList keys;
  std::set<std::string> others;  // drawn, heard or told, not physics; or changed in another table
  std::function<std::string(const std::string&)> around;  // the scene around the table's keys
  std::vector<Change> changes;
};

std::string rov_with(const std::string& keys) {
  return rov_text("position_m = [0, -10, 0]\n" + keys, "rov");
}
// The scene of one vehicle and what is said around an inline table of it.
auto rov_table(const std::string& key, const std::string& others = {}) {
  return [=](const std::string& inside) {
    return std::string(kStillWater) + others + rov_with(key + " = { " + inside + " }\n");
  };
}
auto diver_table(const std::string& key, const std::string& others = {}) {
  return [=](const std::string& inside) {
    return std::string(kStillWater) + others +
           diver_text("position_m = [0, -10, 0]\n" + key + " = { " + inside + " }\n");
  };
}
std::string top_table(const std::string& head, const std::string& inside) {
  return "[physics]\n" + head + "\n" + inside + "\n" + rov_with("");
}

const std::string kRock =
    "[[objects]]\nname = \"rock\"\nshape = \"sphere\"\nradius_m = 0.3\nposition_m = [4, -9, 0]\n";
const std::string kPost =
    "[[objects]]\nname = \"post\"\nshape = \"sphere\"\nradius_m = 0.3\nposition_m = [6, -9, 0]\n";
const std::string kTool =
    "[[objects]]\nname = \"tool\"\nshape = \"sphere\"\nradius_m = 0.05\nposition_m = [0, -9, 2]\n"
    "thing = {}\n";

// Files that scenes of this test name.
struct TestFiles {
  test::ScratchFolder folder;
  TestFiles() {
    const auto text = [&](const char* name, const std::string& content) {
      EXPECT_TRUE(write_text(folder / name, content).ok());
    };
    for (const char* name : {"a.npy", "b.npy"}) {
      const std::vector<double> flow{0.1, 0.0, name[0] == 'a' ? 0.1 : 0.2};
      EXPECT_TRUE(write_npy(folder / name, flow, {1, 1, 1, 3}).ok());
      const std::vector<float> heights{0.0f, 0.5f, 0.2f, name[0] == 'a' ? 1.0f : 1.5f};
      EXPECT_TRUE(write_npy(folder / (std::string("bed_") + name), heights, {2, 2}).ok());
    }
    text("a_buttons.csv", "t_s,inflate\n0,0\n5,1\n");
    text("b_buttons.csv", "t_s,inflate\n0,0\n6,1\n");
    text("a_swim.csv", "t_s,upper_leg_l_y_deg\n0,0\n1,20\n");
    text("b_swim.csv", "t_s,upper_leg_l_y_deg\n0,0\n1,25\n");
    text("a_way.csv", "t_s,x,y,z\n0,0,-5,0\n9,9,-5,0\n");
    text("b_way.csv", "t_s,x,y,z\n0,0,-5,0\n9,9,-6,0\n");
    text("a_copies.csv", "1,0,0\n");
    text("b_copies.csv", "2,0,0\n");
    const std::string vehicle =
        read_text(vehicles_folder() + "/bluerov2_heavy_dynamics.toml").value();
    text("tied.toml", vehicle + "\n[tether]\nlength_m = 20\n");
    text("heavier.toml", "# another file\n" + vehicle);
    EXPECT_TRUE(write_text(folder / "t200_thrust.csv",
                           read_text(vehicles_folder() + "/t200_thrust.csv").value())
                    .ok());
    text("twin.toml", read_text(test::source_dir() / "assets/divers/recreational.toml").value() +
                          "[[tanks]]\noxygen = 0.5\n");
  }
  std::string operator()(const char* name) const { return "\"" + (folder / name).string() + "\""; }
};

std::vector<KeyTable> water_tables(const TestFiles& file) {
  const auto water = [](const std::string& inside) { return top_table("[water]", inside); };
  return {
      {"physics",
       scene::kPhysicsKeys,
       {},
       [](const std::string& inside) { return top_table("", inside); },
       {{"rate_hz", "", "rate_hz = 120"},
        {"integrator", "", "integrator = \"rk4\""},
        {"max_error_m", "", "max_error_m = 0.01"},
        {"water_kg_m3", "", "water_kg_m3 = 1020"},
        {"altitude_m", "", "altitude_m = 500"}}},
      {"current",
       scene::kCurrentKeys,
       {"file", "origin_m", "spacing_m", "start_s", "interval_s"},
       [](const std::string& inside) { return top_table("[current]", inside); },
       {{"kind", "kind = \"power_law\"\nvelocity_m_s = [0.1, 0, 0]",
         "kind = \"linear\"\nvelocity_m_s = [0.1, 0, 0]"},
        {"velocity_m_s", "kind = \"uniform\"\nvelocity_m_s = [0.1, 0, 0]",
         "kind = \"uniform\"\nvelocity_m_s = [0.1, 0, 0.1]"},
        {"deep_velocity_m_s", "kind = \"linear\"\nvelocity_m_s = [0.1, 0, 0]",
         "kind = \"linear\"\nvelocity_m_s = [0.1, 0, 0]\ndeep_velocity_m_s = [0, 0, 0.1]"},
        {"depth_m", "kind = \"linear\"\nvelocity_m_s = [0.1, 0, 0]",
         "kind = \"linear\"\nvelocity_m_s = [0.1, 0, 0]\ndepth_m = 40"},
        {"exponent", "kind = \"power_law\"\nvelocity_m_s = [0.1, 0, 0]",
         "kind = \"power_law\"\nvelocity_m_s = [0.1, 0, 0]\nexponent = 0.2"}}},
      {"grid current",
       scene::kCurrentKeys,
       {"kind", "velocity_m_s", "deep_velocity_m_s", "depth_m", "exponent"},
       [&](const std::string& inside) {
         return top_table("[current]", "kind = \"grid\"\n" + inside);
       },
       {{"file", "file = " + file("a.npy") + "\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 1]",
         "file = " + file("b.npy") + "\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 1]"},
        {"origin_m", "file = " + file("a.npy") + "\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 1]",
         "file = " + file("a.npy") + "\norigin_m = [1, 0, 0]\nspacing_m = [1, 1, 1]"},
        {"spacing_m", "file = " + file("a.npy") + "\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 1]",
         "file = " + file("a.npy") + "\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 2]"},
        {"start_s", "file = " + file("a.npy") + "\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 1]",
         "file = " + file("a.npy") + "\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 1]\nstart_s = 1"},
        {"interval_s", "file = " + file("a.npy") + "\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 1]",
         "file = " + file("a.npy") +
             "\norigin_m = [0, 0, 0]\nspacing_m = [1, 1, 1]\ninterval_s = 2"}}},
      {"water",
       scene::kWaterKeys,
       {"type", "scattering", "surface", "forward_scatter", "snow", "murk", "bubbles", "silt"},
       water,
       {{"temperature_c", "", "temperature_c = 4"},
        {"salinity_psu", "temperature_c = 4", "temperature_c = 4\nsalinity_psu = 30"},
        {"layers", "temperature_c = 12",
         "temperature_c = 12\nlayers = [ { depth_m = 5, temperature_c = 8 } ]"},
        {"waves", "surface = true\nwaves = {}", "surface = true\nwaves = { moves = true }"}}},
      {"layers",
       scene::kLayerKeys,
       {"slope", "wavelength_m"},
       [&](const std::string& inside) {
         return top_table("[water]", "temperature_c = 12\nlayers = [ { " + inside + " } ]");
       },
       {{"depth_m", "depth_m = 5, temperature_c = 8", "depth_m = 6, temperature_c = 8"},
        {"thickness_m", "depth_m = 5, temperature_c = 8",
         "depth_m = 5, temperature_c = 8, thickness_m = 1"},
        {"temperature_c", "depth_m = 5, temperature_c = 8", "depth_m = 5, temperature_c = 7"},
        {"salinity_psu", "depth_m = 5, temperature_c = 8",
         "depth_m = 5, temperature_c = 8, salinity_psu = 36"}}},
      {"waves",
       scene::kWavesKeys,
       {},
       [&](const std::string& inside) {
         return top_table("[water]", "surface = true\nwaves = { " + inside + " }");
       },
       {{"wind_m_s", "moves = true", "moves = true, wind_m_s = 6"},
        {"fetch_km", "moves = true", "moves = true, fetch_km = 11"},
        {"direction_deg", "moves = true", "moves = true, direction_deg = 10"},
        {"components", "moves = true", "moves = true, components = 8"},
        {"seed", "moves = true", "moves = true, seed = 4"},
        {"moves", "moves = false", "moves = true"}}},
      {"acoustics",
       scene::kAcousticsKeys,
       {},
       [](const std::string& inside) {
         return "[physics]\n[acoustics]\n" + inside + "\n" + rov_with("modem = {}\n");
       },
       {{"temperature_c", "", "temperature_c = 4"},
        {"salinity_psu", "", "salinity_psu = 30"},
        {"ph", "", "ph = 7"},
        {"profile", "", "profile = [[0, 1500], [40, 1480]]"},
        {"path", "", "path = \"constant\""},
        {"spreading", "", "spreading = 1.5"},
        {"wind_m_s", "", "wind_m_s = 9"},
        {"shipping", "", "shipping = 0.1"}}},
  };
}

std::vector<KeyTable> vehicle_tables() {
  const std::string point = "waypoints = [ { position_m = [0, -9, -4] } ]";
  const auto waypoint = [](const std::string& inside) {
    return std::string(kStillWater) + kRock +
           rov_with("mission = { waypoints = [ { position_m = [0, -9, -4], " + inside + " } ] }\n");
  };
  return {
      {"mission",
       scene::kMissionKeys,
       {},
       rov_table("mission", kRock + kPost),
       {{"waypoints", point, "waypoints = [ { position_m = [0, -9, -5] } ]"},
        {"hold", "hold = \"station\"", point},
        {"orbit", "orbit = { radius_m = 2, object = \"rock\" }",
         "orbit = { radius_m = 2, object = \"post\" }"},
        {"follow", "follow = { object = \"rock\" }", "follow = { object = \"post\" }"},
        {"stand_between", "stand_between = { a = \"rock\", b = \"post\" }",
         "stand_between = { a = \"post\", b = \"rock\" }"},
        {"acceptance_m", point, point + ", acceptance_m = 0.2"},
        {"speed_m_s", point, point + ", speed_m_s = 0.2"},
        {"speed_over", point + ", speed_m_s = 0.2",
         point + ", speed_m_s = 0.2, speed_over = \"water\""},
        {"repeat", point, point + ", repeat = true"},
        {"heading_deg", point, point + ", heading_deg = 0"},
        {"look_at", point, point + ", look_at = \"rock\""},
        {"look_at_m", point + ", look_at_m = [1, -9, 0]", point + ", look_at_m = [2, -9, 0]"},
        {"tilt", point + ", look_at = \"rock\"", point + ", look_at = \"rock\", tilt = true"}}},
      {"waypoints",
       scene::kMissionWaypointKeys,
       {"position_m"},  // above
       waypoint,
       {{"heading_deg", "hold_s = 1", "hold_s = 1, heading_deg = 0"},
        {"look_at", "hold_s = 1", "hold_s = 1, look_at = \"rock\""},
        {"look_at_m", "look_at_m = [1, -9, 0]", "look_at_m = [2, -9, 0]"},
        {"tilt", "look_at = \"rock\"", "look_at = \"rock\", tilt = true"},
        {"hold_s", "hold_s = 1", "hold_s = 2"}}},
      {"orbit",
       scene::kOrbitKeys,
       {},
       [](const std::string& inside) {
         return std::string(kStillWater) + kRock + kPost +
                rov_with("mission = { orbit = { " + inside + " } }\n");
       },
       {{"object", "radius_m = 1, object = \"rock\"", "radius_m = 1, object = \"post\""},
        {"point_m", "radius_m = 1, point_m = [4, -9, 0]", "radius_m = 1, point_m = [5, -9, 0]"},
        {"radius_m", "radius_m = 1, object = \"rock\"", "radius_m = 2, object = \"rock\""},
        {"speed_m_s", "radius_m = 1, object = \"rock\"",
         "radius_m = 1, object = \"rock\", speed_m_s = -0.3"},
        {"speed_over", "radius_m = 1, object = \"rock\"",
         "radius_m = 1, object = \"rock\", speed_over = \"water\""}}},
      {"follow",
       scene::kFollowKeys,
       {"object"},  // above
       [](const std::string& inside) {
         return std::string(kStillWater) + kRock +
                rov_with("mission = { follow = { object = \"rock\"" + inside + " } }\n");
       },
       {{"offset_m", "", ", offset_m = [0, 0, 1]"}}},
      {"stand_between",
       scene::kStandBetweenKeys,
       {"a", "b"},  // above
       [](const std::string& inside) {
         return std::string(kStillWater) + kRock + kPost +
                rov_with("mission = { stand_between = { a = \"rock\", b = \"post\"" + inside +
                         " } }\n");
       },
       {{"distance_m", "", ", distance_m = 0.5"}}},
      {"tether",
       scene::kTetherKeys,
       {"color"},
       rov_table("tether", kRock),
       {{"from_m", "from_m = [0, 0, 0]", "from_m = [1, 0, 0]"},
        {"from", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], from = \"rock\""},
        {"attachment_m", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], attachment_m = [0, 0.1, 0]"},
        {"length_m", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], length_m = 40"},
        {"segments", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], segments = 8"},
        {"diameter_m", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], diameter_m = 0.01"},
        {"net_weight_n_m", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], net_weight_n_m = 0.1"},
        {"stiffness_n", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], stiffness_n = 3e4"},
        {"damping_n_s", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], damping_n_s = 100"},
        {"normal_drag", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], normal_drag = 1"},
        {"tangential_drag", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], tangential_drag = 0.02"},
        {"friction", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], friction = 0.5"},
        {"winch", "from_m = [0, 0, 0]", "from_m = [0, 0, 0], winch = {}"}}},
      {"winch",
       scene::kWinchKeys,
       {},
       [](const std::string& inside) {
         return std::string(kStillWater) +
                rov_with("tether = { from_m = [0, 0, 0], winch = { " + inside + " } }\n");
       },
       {{"hold_n", "", "hold_n = 30"},
        {"speed_m_s", "", "speed_m_s = 0.4"},
        {"least_m", "", "least_m = 2"},
        {"most_m", "", "most_m = 90"}}},
      {"wash",
       scene::kWashKeys,
       {},
       rov_table("wash"),
       {{"diameter_m", "", "diameter_m = 0.1"}, {"reach_m", "", "reach_m = 5"}}},
      {"gripper",
       scene::kGripperKeys,
       {},
       rov_table("gripper", kTool),
       {{"position_m", "position_m = [0, 0, -0.4]", "position_m = [0, 0, -0.5]"},
        {"reach_m", "position_m = [0, 0, -0.4]", "position_m = [0, 0, -0.4], reach_m = 0.2"},
        {"strength_n", "position_m = [0, 0, -0.4]", "position_m = [0, 0, -0.4], strength_n = 50"},
        {"most_m_s", "position_m = [0, 0, -0.4]", "position_m = [0, 0, -0.4], most_m_s = 0.3"}}},
      {"vehicle's inputs",
       scene::kVehicleInputKeys,
       {},
       rov_table("inputs"),
       {{"wrench", "", "wrench = \"pad\""},
        {"setpoint", "", "setpoint = \"pad\""},
        {"fault", "", "fault = \"pad\""}}},
      {"choice",
       scene::kInputChoiceKeys,
       {},
       [](const std::string& inside) {
         return std::string(kStillWater) + rov_with("inputs = { wrench = { " + inside + " } }\n");
       },
       {{"from", "from = \"pad\"", "from = \"stick\""},
        {"hold_s", "from = \"pad\"", "from = \"pad\", hold_s = 0"},
        {"then", "from = \"pad\"", "from = \"pad\", then = \"nobody\""}}},
      {"modem",
       scene::kModemKeys,
       {},
       rov_table("modem", kPost + "inputs = { pose = \"autopilot\" }\nmodem = {}\n"),
       {{"position_m", "", "position_m = [0, 0.1, 0]"},
        {"source_level_db", "", "source_level_db = 160"},
        {"frequency_hz", "", "frequency_hz = 20000"},
        {"bandwidth_hz", "", "bandwidth_hz = 7000"},
        {"bit_rate_hz", "", "bit_rate_hz = 400"},
        {"preamble_s", "", "preamble_s = 0.06"},
        {"coding_gain_db", "", "coding_gain_db = 2"},
        {"detection_db", "", "detection_db = 2"},
        {"self_noise_db", "", "self_noise_db = 60"},
        {"fading", "", "fading = false"},
        {"turnaround_s", "", "turnaround_s = 0.6"},
        {"usbl", "", "usbl = { target = \"post\" }"}}},
      {"usbl",
       scene::kModemUsblKeys,
       {},
       [](const std::string& inside) {
         const std::string beacon = "inputs = { pose = \"autopilot\" }\nmodem = {}\n";
         return std::string(kStillWater) + kPost + beacon + kRock + beacon +
                rov_with("modem = { usbl = { " + inside + " } }\n");
       },
       {{"target", "target = \"post\"", "target = \"rock\""},
        {"interval_s", "target = \"post\"", "target = \"post\", interval_s = 3"},
        {"offset_s", "target = \"post\"", "target = \"post\", offset_s = 0.5"},
        {"wait_s", "target = \"post\"", "target = \"post\", wait_s = 4"},
        {"range_noise_m", "target = \"post\"", "target = \"post\", range_noise_m = 0.1"},
        {"direction_noise_deg", "target = \"post\"", "target = \"post\", direction_noise_deg = 1"},
        {"sound_m_s", "target = \"post\"", "target = \"post\", sound_m_s = 1490"}}},
  };
}

std::vector<KeyTable> diver_tables(const TestFiles& file) {
  const std::string layers = "[water]\ntemperature_c = 4\n";
  return {
      {"swim",
       scene::kSwimKeys,
       {},
       diver_table("swim"),
       {{"waypoints_m", "waypoints_m = [[0, -10, -6]]", "waypoints_m = [[0, -10, -7]]"},
        {"speed_m_s", "waypoints_m = [[0, -10, -6]]",
         "waypoints_m = [[0, -10, -6]], speed_m_s = 0.3"},
        {"speed_over", "waypoints_m = [[0, -10, -6]]",
         "waypoints_m = [[0, -10, -6]], speed_over = \"ground\""},
        {"acceptance_m", "waypoints_m = [[0, -10, -6]]",
         "waypoints_m = [[0, -10, -6]], acceptance_m = 2"},
        {"repeat", "waypoints_m = [[0, -10, -6]]", "waypoints_m = [[0, -10, -6]], repeat = true"},
        {"motion", "motion = " + file("a_swim.csv"), "motion = " + file("b_swim.csv")}}},
      {"condition",
       scene::kConditionKeys,
       {},
       diver_table("condition", layers),
       {{"effects", "", "effects = [\"cold\"]"},
        {"acts", "", "acts = false"},
        {"water_c", "", "water_c = 12"},
        {"fat_share", "", "fat_share = 0.2"},
        {"oxygen_tolerance", "", "oxygen_tolerance = 0"}}},
      {"regulator",
       scene::kRegulatorKeys,
       {},
       [&](const std::string& inside) {
         return diver_table("regulator")(inside) + "[[objects]]\nname = \"buddy\"\nmodel = \"" +
                (test::source_dir() / "assets/models/diver.glb").string() +
                "\"\nhuman = " + file("twin.toml") + "\nposition_m = [3, -10, 0]\n";
       },
       {{"donor", "", "donor = \"buddy\""},
        {"donor_tank", "donor = \"buddy\"", "donor = \"buddy\", donor_tank = 1"},
        {"hose_m", "donor = \"buddy\"", "donor = \"buddy\", hose_m = 2"},
        {"reaction_s", "donor = \"buddy\"", "donor = \"buddy\", reaction_s = 1"},
        {"free_flow", "", "free_flow = [ {} ]"}}},
      {"free_flow",
       scene::kFreeFlowKeys,
       {},
       [&](const std::string& inside) {
         return std::string(kStillWater) +
                diver_text("position_m = [0, -10, 0]\nregulator = { free_flow = [ { " + inside +
                               " } ] }\n",
                           (file.folder / "twin.toml").string());
       },
       {{"at_s", "", "at_s = 3"},
        {"until_s", "", "until_s = 9"},
        {"tank", "", "tank = 1"},
        {"area_mm2", "", "area_mm2 = 5"}}},
      {"hands",
       scene::kHandsKeys,
       {},
       diver_table("hands", kTool),
       {{"reach_m", "", "reach_m = 0.2"},
        {"strength_n", "", "strength_n = 200"},
        {"most_m_s", "", "most_m_s = 0.3"}}},
      {"diver's inputs",
       scene::kDiverInputKeys,
       {},
       diver_table("inputs"),
       {{"body", "", "body = \"suit\""},
        {"hands", "", "hands = \"suit\""},
        {"head", "", "head = \"suit\""},
        {"gaze", "", "gaze = \"suit\""},
        {"buttons", "", "buttons = \"suit\""},
        {"breath", "", "breath = \"suit\""},
        {"heart", "", "heart = \"suit\""},
        {"gas", "", "gas = \"suit\""}}},
      {"thing",
       scene::kThingKeys,
       {},
       [](const std::string& inside) {
         return std::string(kStillWater) + rov_with("") + kPost + "thing = { " + inside + " }\n";
       },
       {{"mass_kg", "", "mass_kg = 2"},
        {"volume_l", "", "volume_l = 1"},
        {"drag_area_m2", "", "drag_area_m2 = 0.02"},
        {"racked", "", "racked = true"}}},
  };
}

std::vector<KeyTable> object_tables(const TestFiles& file) {
  // Solid things.
  const auto solid = [](const std::string& inside) {
    return std::string(kStillWater) + rov_with("") + "[[objects]]\nname = \"it\"\n" + inside + "\n";
  };
  const std::string box = "shape = \"box\"\ncollision = true\nposition_m = [5, -9, 0]\n";
  const std::string bed = "terrain = " + file("bed_a.npy") +
                          "\ncell_m = 2\ncollision = true\nposition_m = [5, -30, 0]\n";
  const std::string models = (test::source_dir() / "assets/models").string();
  const auto model = [&](const char* name) { return "model = \"" + models + "/" + name + "\"\n"; };
  // The carrier of what a mission follows, by a joint of its spine.
  const auto shark = [&](const std::string& keys) {
    return model("shark.glb") + keys + "\nposition_m = [0, -8, -3]\n" +
           "[[objects]]\nname = \"tip\"\non = \"it\"\njoint = \"spine_5\"\nshape = \"sphere\"\n" +
           rov_text("position_m = [0, -8, 9]\nmission = { follow = { object = \"tip\" } }\n",
                    "hunter");
  };
  const std::string on_rock = "on = \"rock\"\nshape = \"box\"\n";
  const std::string afloat = "[[objects]]\nname = \"buoy\"\nshape = \"box\"\n";
  const auto vehicle = [&](const std::string& keys) {
    return "shape = \"box\"\nsize_m = [0.5, 0.3, 0.5]\nposition_m = [9, -9, 0]\n" + keys;
  };
  const std::string dynamics =
      "dynamics = \"" + vehicles_folder() + "/bluerov2_heavy_dynamics.toml\"\n";
  const auto diver = [&](const std::string& keys) {
    return model("diver.glb") + "position_m = [9, -9, 0]\n" + keys;
  };
  const std::string human =
      "human = \"" + (test::source_dir() / "assets/divers/recreational.toml").string() + "\"\n";
  const std::string waves = "[water]\nsurface = true\nwaves = {}\n";
  return {
      {"object",
       scene::kObjectKeys,
       // Those of tables of their own are above and below; include is what it includes.
       {"include", "class", "reflectivity", "material", "backscatter_db", "texture_m", "color",
        "color_texture", "normal_texture", "detail_texture", "detail_m", "roughness", "metallic",
        "double_sided", "cameras", "sonars", "lamps", "flock", "afloat"},
       [=](const std::string& inside) {
         return std::string(kStillWater) + kRock + rov_with("") + "[[objects]]\nname = \"it\"\n" +
                inside + "\n";
       },
       {{"name", box + kPost, box + kPost + "[[objects]]\nshape = \"box\"\n"},
        {"track", "track = { waypoints_m = [[0, 0, 0], [1, 0, 0]], speed_m_s = 1 }",
         "track = { waypoints_m = [[0, 0, 0], [1, 0, 1]], speed_m_s = 1 }"},
        {"model", model("submarine.glb") + "collision = true",
         model("boat.glb") + "collision = true"},
        {"node", model("relics.glb") + "collision = true\nnode = \"anchor\"",
         model("relics.glb") + "collision = true\nnode = \"tyre\""},
        {"shape", "shape = \"sphere\"\ncollision = true\nposition_m = [5, -9, 0]", box},
        {"terrain", bed,
         "terrain = " + file("bed_b.npy") +
             "\ncell_m = 2\ncollision = true\nposition_m = [5, -30, 0]\n"},
        {"radius_m", "shape = \"sphere\"\ncollision = true\nposition_m = [5, -9, 0]",
         "shape = \"sphere\"\ncollision = true\nposition_m = [5, -9, 0]\nradius_m = 0.6"},
        {"size_m", box, box + "size_m = [1, 1, 2]"},
        {"height_m", "shape = \"cylinder\"\ncollision = true\nposition_m = [5, -9, 0]",
         "shape = \"cylinder\"\ncollision = true\nposition_m = [5, -9, 0]\nheight_m = 2"},
        {"segments", "shape = \"cylinder\"\ncollision = true\nposition_m = [5, -9, 0]",
         "shape = \"cylinder\"\ncollision = true\nposition_m = [5, -9, 0]\nsegments = 12"},
        {"inside_out", box, box + "inside_out = true"},
        {"cell_m", bed,
         "terrain = " + file("bed_a.npy") +
             "\ncell_m = 3\ncollision = true\nposition_m = [5, -30, 0]\n"},
        {"height_scale", bed, bed + "height_scale = 2"},
        {"height_offset_m", bed, bed + "height_offset_m = 1"},
        {"position_m", box, "shape = \"box\"\ncollision = true\nposition_m = [5, -9, 1]"},
        {"yaw_deg", box, box + "yaw_deg = 10"},
        {"pitch_deg", box, box + "pitch_deg = 10"},
        {"roll_deg", box, box + "roll_deg = 10"},
        {"rotation_xyzw", box, box + "rotation_xyzw = [0, 1, 0, 0]"},
        {"look_at_m", box, box + "look_at_m = [9, -9, 1]"},
        {"look_at", box, box + "look_at = \"rock\""},
        {"on", "shape = \"box\"", on_rock},
        {"joint", shark(""),
         model("shark.glb") +
             "\nposition_m = [0, -8, -3]\n[[objects]]\nname = \"tip\"\non = \"it\"\nshape = "
             "\"sphere\"\n" +
             rov_text("position_m = [0, -8, 9]\nmission = { follow = { object = \"tip\" } }\n",
                      "hunter")},
        {"scale", shark(""), shark("scale = 2")},
        {"clip", shark(""), shark("clip = \"swim\"")},
        {"clip_offset_s", shark("clip = \"swim\""), shark("clip = \"swim\"\nclip_offset_s = 0.5")},
        {"clip_rate", shark("clip = \"swim\""), shark("clip = \"swim\"\nclip_rate = 6")},
        {"copies", box + "copies = [[1, 0, 0]]", box + "copies = [[2, 0, 0]]"},
        {"copies_file", box + "copies_file = " + file("a_copies.csv"),
         box + "copies_file = " + file("b_copies.csv")},
        {"scatter",
         "shape = \"box\"\ncollision = true\nscatter = { count = 2, area_m = [20, 20, 30, 30] }",
         "shape = \"box\"\ncollision = true\nscatter = { count = 2, seed = 9, area_m = [20, 20, "
         "30, 30] }"},
        {"collision", box, "shape = \"box\"\ncollision = \"hull\"\nposition_m = [5, -9, 0]\n"},
        {"dynamics", vehicle(dynamics), vehicle("dynamics = " + file("heavier.toml"))},
        {"mission", vehicle(dynamics), vehicle(dynamics + "mission = { hold = \"station\" }")},
        {"failed_thrusters", vehicle(dynamics), vehicle(dynamics + "failed_thrusters = [1]")},
        {"tether_anchor_m",
         vehicle("dynamics = " + file("tied.toml") + "\ntether_anchor_m = [0, 0, 0]"),
         vehicle("dynamics = " + file("tied.toml") + "\ntether_anchor_m = [1, 0, 0]")},
        {"tether", vehicle(dynamics), vehicle(dynamics + "tether = { from_m = [0, 0, 0] }")},
        {"navigation",
         vehicle("dynamics = \"" + vehicles_folder() + "/bluerov2_heavy_survey_dynamics.toml\"\n"),
         vehicle("dynamics = \"" + vehicles_folder() +
                 "/bluerov2_heavy_survey_dynamics.toml\"\nnavigation = \"truth\"")},
        {"human", diver(human), diver("human = " + file("twin.toml"))},
        {"swim", diver(human), diver(human + "swim = { waypoints_m = [[0, -9, -9]] }")},
        {"jacket_buttons", diver(human + "jacket_buttons = " + file("a_buttons.csv")),
         diver(human + "jacket_buttons = " + file("b_buttons.csv"))},
        {"condition", diver(human), diver(human + "condition = {}")},
        {"thing", "shape = \"box\"", "shape = \"box\"\nthing = {}"},
        {"gripper", vehicle(dynamics) + kTool,
         vehicle(dynamics + "gripper = { position_m = [0, 0, -1] }\n") + kTool},
        {"wash", vehicle(dynamics), vehicle(dynamics + "wash = {}")},
        {"near_added_mass", vehicle(dynamics), vehicle(dynamics + "near_added_mass = true")},
        {"hands", diver(human) + kTool, diver(human + "hands = {}\n") + kTool},
        {"regulator", diver(human), diver(human + "regulator = {}")},
        {"inputs", "shape = \"box\"", "shape = \"box\"\ninputs = { pose = \"tracker\" }"},
        {"modem", vehicle(dynamics), vehicle(dynamics + "modem = {}")}}},
      {"afloat",
       scene::kAfloatKeys,
       {},
       [=](const std::string& inside) {
         return "[physics]\n" + waves + rov_with("") + afloat + "afloat = { " + inside + " }\n";
       },
       {{"length_m", "length_m = 2, breadth_m = 1", "length_m = 3, breadth_m = 1"},
        {"breadth_m", "length_m = 2, breadth_m = 1", "length_m = 2, breadth_m = 0.5"}}},
      {"object's inputs",
       scene::kObjectInputKeys,
       {},
       solid,
       {{"pose", "shape = \"box\"\ninputs = { pose = \"tracker\" }",
         "shape = \"box\"\ninputs = { pose = \"autopilot\" }"}}},
      {"track",
       scene::kTrackKeys,
       {"recording", "participant", "lawn_mower"},  // places as of a file; below
       [=](const std::string& inside) {
         return solid("shape = \"box\"\ntrack = { " + inside + " }");
       },
       {{"waypoints_m", "waypoints_m = [[0, 0, 0], [4, 0, 0]], speed_m_s = 1",
         "waypoints_m = [[0, 0, 0], [4, 0, 1]], speed_m_s = 1"},
        {"file", "file = " + file("a_way.csv"), "file = " + file("b_way.csv")},
        {"speed_m_s", "waypoints_m = [[0, 0, 0], [4, 0, 0]], speed_m_s = 1",
         "waypoints_m = [[0, 0, 0], [4, 0, 0]], speed_m_s = 2"},
        {"start_s", "waypoints_m = [[0, 0, 0], [4, 0, 0]], speed_m_s = 1",
         "waypoints_m = [[0, 0, 0], [4, 0, 0]], speed_m_s = 1, start_s = 1"},
        {"heading", "waypoints_m = [[0, 0, 0], [4, 0, 0]], speed_m_s = 1",
         "waypoints_m = [[0, 0, 0], [4, 0, 0]], speed_m_s = 1, heading = \"fixed\""},
        {"turn_m", "waypoints_m = [[0, 0, 0], [4, 0, 0], [4, 0, 4]], speed_m_s = 1",
         "waypoints_m = [[0, 0, 0], [4, 0, 0], [4, 0, 4]], speed_m_s = 1, turn_m = 2"},
        {"repeat", "waypoints_m = [[0, 0, 0], [4, 0, 0]], speed_m_s = 1",
         "waypoints_m = [[0, 0, 0], [4, 0, 0]], speed_m_s = 1, repeat = true"}}},
      {"lawn_mower",
       scene::kLawnMowerKeys,
       {},
       [=](const std::string& inside) {
         return solid("shape = \"box\"\ntrack = { speed_m_s = 1, lawn_mower = { " + inside +
                      " } }");
       },
       {{"area_m", "area_m = [0, 0, 9, 9], depth_m = 3, spacing_m = 3",
         "area_m = [0, 0, 9, 8], depth_m = 3, spacing_m = 3"},
        {"depth_m", "area_m = [0, 0, 9, 9], depth_m = 3, spacing_m = 3",
         "area_m = [0, 0, 9, 9], depth_m = 4, spacing_m = 3"},
        {"spacing_m", "area_m = [0, 0, 9, 9], depth_m = 3, spacing_m = 3",
         "area_m = [0, 0, 9, 9], depth_m = 3, spacing_m = 2"},
        {"legs", "area_m = [0, 0, 9, 9], depth_m = 3, spacing_m = 3, legs = \"x\"",
         "area_m = [0, 0, 9, 9], depth_m = 3, spacing_m = 3, legs = \"z\""}}},
  };
}

void expect_all(const std::vector<KeyTable>& tables) {
  for (const KeyTable& table : tables) {
    std::set<std::string> changed;
    for (const Change& change : table.changes) {
      changed.insert(change.key);
      EXPECT_NE(hash_of_text(table.around(change.one)), hash_of_text(table.around(change.other)))
          << table.name << ": " << change.key;
    }
    for (const scene::Key key : table.keys)
      EXPECT_TRUE(changed.contains(std::string(key)) || table.others.contains(std::string(key)))
          << table.name << ": " << key << " is neither changed nor only drawn";
  }
}

TEST(SceneHash, EachKeyOfTheWaterChangesIt) {
  const TestFiles files;
  expect_all(water_tables(files));
}
TEST(SceneHash, EachKeyOfAVehicleChangesIt) {
  expect_all(vehicle_tables());
}
TEST(SceneHash, EachKeyOfADiverChangesIt) {
  const TestFiles files;
  expect_all(diver_tables(files));
}
TEST(SceneHash, EachKeyOfAnObjectChangesIt) {
  const TestFiles files;
  expect_all(object_tables(files));
}

// Scenes as whole: their own keys.
TEST(SceneHash, EachTableOfASceneIsInAnotherTestOrOnlyDrawn) {
  EXPECT_NE(hash_of_text("seed = 1\n" + std::string(kStillWater) + rov_with("")),
            hash_of_text("seed = 2\n" + std::string(kStillWater) + rov_with("")));
  const std::set<std::string> elsewhere{"seed",    "water",    "physics",  "current",
                                        "objects", "vehicles", "acoustics"};
  const std::set<std::string> drawn{"title",   "include", "classes", "sun", "ambient",
                                    "cameras", "sonars",  "lamps",   "lab", "sources"};
  for (const scene::Key key : scene::kSceneKeys)
    EXPECT_TRUE(elsewhere.contains(std::string(key)) || drawn.contains(std::string(key))) << key;
}

}  // namespace
}  // namespace neritic::testbed
