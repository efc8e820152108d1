// Files of cases: defaults of what is left out, and one line that says what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "rov/control_check.hpp"
#include "rov/trajectory_check.hpp"
#include "tests/rov/cases.hpp"

namespace neritic::rov {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

Json smallest() {
  return parse_json(R"({"scenarios": [{"id": "small",
    "params": {"m_kg": 10, "I_CO_kgm2": [[0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.3]]},
    "samples": [{"t": 1, "p_ned": [0, 0, 0]}]}]})")
      .value();
}

std::string fault(const Json& json) {
  const auto read = read_trajectories(json_text(json), "cases.json");
  return read.ok() ? "" : read.error().message;
}
std::string control_fault(const Json& json) {
  const auto read = read_control_cases(json_text(json), "cases.json");
  return read.ok() ? "" : read.error().message;
}

TEST(RovCaseFile, WhatIsLeftOutHasItsDefault) {
  const auto read = read_trajectories(json_text(smallest()), "cases.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const TrajectoryCase& one = read->front();
  EXPECT_DOUBLE_EQ(one.vehicle.weight_n, 98.2);
  EXPECT_DOUBLE_EQ(one.vehicle.buoyancy_n, 98.2);
  EXPECT_EQ(one.vehicle.thruster_count, 8u);
  EXPECT_EQ(one.vehicle.mass, one.vehicle.rigid_mass);
  EXPECT_TRUE(check_trajectory(one).ok());  // at rest where it was put
}

TEST(RovCaseFile, Lag1NeedsItsTimeConstant) {
  Json json = smallest();
  Json& one = json["scenarios"][0];
  one["thruster_mode"] = "lag1";
  one["doc"] = "a lag with T = 0.15 s";  // for people: nothing is read out of it
  EXPECT_THAT(fault(json), HasSubstr("case 'small': scenarios[0].thruster_time_constant_s: not "
                                     "found, but needed"));
  one["thruster_time_constant_s"] = 0.25;
  const auto read = read_trajectories(json_text(json), "cases.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->front().vehicle.lag.time_s, 0.25);
  one["thruster_time_constant_s"] = -1.0;
  EXPECT_THAT(fault(json), HasSubstr("found -1.0; accepted: a number in [1e-06, 1000000]"));
  for (const char* other : {"T", "lag1_T_s", "T_thruster", "tau_s"}) {
    Json named = json;
    named["scenarios"][0].erase("thruster_time_constant_s");
    named["scenarios"][0][other] = 0.25;
    EXPECT_THAT(fault(named),
                HasSubstr(fmt::format("scenarios[0].{}: not known; the nearest is", other)));
  }
}

TEST(RovCaseFile, TextsUnderOtherNamesAreNotes) {
  Json json = smallest();
  Json& one = json["scenarios"][0];
  one["closed_form"] = parse_json("{\"u_ss\": 3}").value();
  one["quat_norm_error"] = 0.0;
  one["params"]["name"] = "small";
  one["params"]["note"] = "a note";
  json["integrator"] = "of some program";
  EXPECT_EQ(fault(json), "");
  one["thruster_mod"] = "lag1";  // but not where the name is a slip
  EXPECT_THAT(fault(json), HasSubstr("thruster_mod: not known; the nearest is thruster_mode"));
}

// A file that claims to know nothing does not hold for anything.
TEST(RovCaseFile, WhatAFileClaimsOfItsErrorsIsBounded) {
  Json json = smallest();
  Json& one = json["scenarios"][0];
  one["samples"][0]["p_ned"] = {0.0, 0.001, 0.0};  // it stays at 0
  const auto result_of = [](const Json& of) {
    return check_trajectory(read_trajectories(json_text(of), "cases.json").value().front());
  };
  EXPECT_FALSE(result_of(json).ok());
  EXPECT_EQ(result_of(json).note, "");
  one["reference_error_estimate"] = 0.5;
  EXPECT_FALSE(result_of(json).ok());
  EXPECT_EQ(result_of(json).note, "reference_error_estimate 0.5 counts as 1e-05");
  one["reference_error_estimate"] = 0.0;
  one["samples"][0]["p_ned"] = {0.0, 0.01, 0.0};
  one["fixed_step_end_error"] = parse_json("{\"rk4_240Hz\": [1e6, 1e6]}").value();
  EXPECT_FALSE(result_of(json).ok());
  EXPECT_EQ(result_of(json).note, "fixed_step_end_error 1e+06 counts as 0.001");
}

TEST(RovCaseFile, ASineHasSixAmplitudesFrequenciesAndPhases) {
  Json json = smallest();
  json["scenarios"][0]["tau_sin"] =
      parse_json(R"({"A": [3, 0, 0, 0, 0, 1], "omega": [2, 1, 1, 1, 1, 4],
                     "phase": [0.5, 0, 0, 0, 0, -1]})")
          .value();
  const auto read = read_trajectories(json_text(json), "cases.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const Vec6 tau = read->front().sine->at(0.7);
  EXPECT_NEAR(tau[0], 3.0 * std::sin(1.9), 1e-12);
  EXPECT_NEAR(tau[5], std::sin(1.8), 1e-12);
  EXPECT_EQ(tau[1] + tau[2] + tau[3] + tau[4], 0.0);
  json["scenarios"][0]["tau_sin"] = nullptr;
  EXPECT_FALSE(read_trajectories(json_text(json), "cases.json")->front().sine.has_value());
}

TEST(RovCaseFile, InputsThatAreNoForcesAreTurnedIntoThem) {
  Json json = smallest();
  Json& one = json["scenarios"][0];
  one["thruster_mode"] = "vb_poly";
  one["input_segments"] = parse_json("[{\"t0\": 0, \"t1\": 1}]").value();
  one["input_normalised_V"] = parse_json("[[0.5, -0.5, 0, 0, 0, 0, 0, 1]]").value();
  auto read = read_trajectories(json_text(json), "cases.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_DOUBLE_EQ(read->front().segments[0].thruster_n[0], 16.5939453125);
  EXPECT_DOUBLE_EQ(read->front().segments[0].thruster_n[1], -16.5939453125);
  one["thruster_mode"] = "t200_16V";
  one.erase("input_normalised_V");
  one["input_pwm_us"] = parse_json("[[1500, 1900, 1100, 1898, 1500, 1500, 1500, 1500]]").value();
  EXPECT_THAT(fault(json), HasSubstr("input_pwm_us: t200_thrust.csv: found no such file"));
  const test::ScratchFolder folder;
  std::filesystem::copy_file(test::source_dir() / "tests/rov/data/t200_measured.csv",
                             folder / "t200_thrust.csv");
  read = read_trajectories(json_text(json), "cases.json", folder.path());
  ASSERT_TRUE(read.ok()) << read.error().message;
  const auto& forces = read->front().segments[0].thruster_n;
  EXPECT_EQ(forces[0], 0.0);
  EXPECT_NEAR(forces[1], 51.4362, 1e-9);
  EXPECT_NEAR(forces[2], -39.9079, 1e-9);
  EXPECT_NEAR(forces[3], 0.5 * (51.4362 + 51.1990), 1e-9);
}

struct Fault {
  const char* pointer;  // where in the document
  const char* value;    // JSON
  const char* said;
};

TEST(RovCaseFile, FaultsAreSaidInOneLine) {
  const Fault faults[] = {
      {"/format", "\"rov_vectors/9\"",
       "cases.json: format: found \"rov_vectors/9\"; accepted: \"rov_vec"},
      {"/scenarios", "{}", "cases.json: scenarios: found an object; accepted: a list"},
      {"/scenarios", "[]", "cases.json: scenarios: found none; accepted: at least one case"},
      {"/scenarios/0", "7", "scenarios[0]: found 7; accepted: an object"},
      {"/scenarios/0/params/m_kg", "-1",
       "case 'small': scenarios[0].params.m_kg: found -1; accepted: a num"},
      {"/scenarios/0/params/m_kg", "\"heavy\"",
       "params.m_kg: found \"heavy\"; accepted: a number in"},
      {"/scenarios/0/params/I_CO_kgm2", "[0.2, 0.2, 0.3]",
       "I_CO_kgm2[0]: found 0.2; accepted: a list of 3"},
      {"/scenarios/0/params/I_CO_kgm2", "[[0, 0, 0], [0, 0, 0], [0, 0, 0]]",
       "params: inertia_kg_m2: found a mass matrix that is not"},
      {"/scenarios/0/params/D_Q_diag", "[1, 2]",
       "D_Q_diag: found [1,2]; accepted: a list of 6 numbers"},
      {"/scenarios/0/params/D_Q_diag", "[-1, 0, 0, 0, 0, 0]", "quadratic_damping: found -1"},
      {"/scenarios/0/samples/0/p_ned", "[1, null, 3]",
       "samples[0].p_ned: found null as entry 1; accepted: a list of 3 numbers"},
      {"/scenarios/0/samples/0", "{\"t\": 1}",
       "samples[0]: found nothing to compare; accepted: p_ned"},
      {"/scenarios/0/thruster_mode", "\"warp\"",
       "found \"warp\"; accepted: none, force, lag1, vb3, vb_po"},
      {"/scenarios/0/initial", "{\"q_wxyz\": [0, 0, 0, 0]}",
       "q_wxyz: found [0,0,0,0]; accepted: a unit qu"},
      {"/scenarios/0/tau_sin", "{\"A\": [1, 1, 1, 1, 1, 1]}", "tau_sin.omega: not found, but"},
      {"/scenarios/0/tau_sin", "{\"amp\": [1, 1, 1, 1, 1, 1]}", "tau_sin.amp: not known; the nea"},
      {"/scenarios/0/tau_sin", "{\"A\": 1}", "tau_sin.A: found 1; accepted: a list of 6 numbers"},
      {"/scenarios/0/tau_sin", "[]", "tau_sin: found []; accepted: an object"},
      {"/scenarios/0/fixed_step_end_error", "{\"rk4\": [0, 0]}",
       "rk4: found another name; accepted: rk4_"},
      {"/scenarios/0/samples/0/p", "[0, 0, 0]", "samples[0].p: not known; the nearest is"},
      {"/remark", "3", "cases.json: remark: not known; the nearest is "},
      {"/scenarios/0/input_segments", "[{\"t0\": 1, \"t1\": 1}]",
       "[0].t1: found 1; accepted: a time after"},
      {"/scenarios/0/params/D_Q", "[1, 0, 0, 0, 0, 0]",
       "params.D_Q: not known; the nearest is D_L"},
      {"/scenarios/0/params/W_n", "98",
       "case 'small': scenarios[0].params.W_n: not known; the neare"},
      {"/scenarios/0/initial", "{\"nu\": [1, 0, 0, 0, 0, 0]}",
       "scenarios[0].initial.nu: not known"},
      {"/scenarios/0/input_segments", "[{\"t0\": 0, \"t1\": 1, \"tau\": [1, 0, 0, 0, 0, 0]}]",
       "input_segments[0].tau: not known; the nearest is "},
      {"/scenarios/0/reference_error_estimate", "2",
       "reference_error_estimate: found 2; accepted: a number"},
      {"/scenarios/0/input_segments",
       "[{\"t0\": 0, \"t1\": 1, \"tau_body\": [0, 2e9, 0, 0, 0, 0]}]",
       "tau_body: found [0,2000000000.0,0,0,0,0]; accepted: numbers in [-1e+09, 1e+09]"},
      {"/scenarios/0/current_ned_mps", "[0, 101, 0]",
       "found [0,101,0]; accepted: numbers in [-100, 100]"},
      {"/thrusters", "{\"direction_frd\": [[0, 0, 1]]}",
       "thrusters.position_frd_m: not found, but"},
      {"/thrusters", "{\"position_frd_m\": 5, \"direction_frd\": [[0, 0, 1]]}",
       "thrusters.position_frd_m: found 5"},
      {"/thrusters", "{\"position_frd_m\": [[0, 0, 0]], \"direction_frd\": []}",
       "thrusters.direction_frd: found []; accepted: 1 rows of 3 numbers"},
      {"/thrusters", "{\"position_frd_m\": [[0, 0, 0]], \"direction_frd\": [[0, 0, 0]]}",
       "thrusters[0].direction: found (0, 0, 0); accepted: a unit vector"}};
  for (const Fault& f : faults) {
    Json json = smallest();
    json[Json::json_pointer(f.pointer)] = parse_json(f.value).value();
    EXPECT_THAT(fault(json), HasSubstr(f.said)) << f.pointer;
    EXPECT_THAT(fault(json), ::testing::StartsWith("cases.json: ")) << f.pointer;
    EXPECT_EQ(fault(json).find('\n'), std::string::npos) << f.pointer;
  }
  Json json = smallest();
  json["scenarios"][0].erase("samples");
  EXPECT_THAT(fault(json), HasSubstr("scenarios[0].samples: not found, but needed"));
}

TEST(RovCaseFile, FaultsOfControlAreSaidInOneLine) {
  const Json whole = parse_json(data_text("control.json")).value();
  EXPECT_EQ(control_fault(whole), "");
  const Fault faults[] = {
      {"/pid_sequence/KD", "[1]",
       "case 'pid_sequence': pid_sequence.KD: found [1]; accepted: a list of 2"},
      {"/pid_sequence/dt", "0", "pid_sequence.dt: found 0"},
      {"/pid_sequence/steps/3/e", "[1]", "pid_sequence.steps[3].e: found [1]"},
      {"/allocation/B_6x8", "[[1]]", "allocation.B_6x8: found [[1]]; accepted: 6 rows of 8 number"},
      {"/allocation/B_6x7", "[[1]]", "allocation.B_6x7: not known; the nearest is B_6x8"},
      {"/allocation/fmin", "[-1]", "allocation.fmin: found [-1]; accepted: a number in"},
      {"/pid_sequence", "[]", "pid_sequence: found []; accepted: an object"},
      {"/allocation/fmax", "-1",
       "allocation.fmax: found -1; accepted: a number in [0, 1000000000]"},
      {"/allocation/cases/2/tau", "[1]", "case 'allocation/2': allocation.cases[2].tau: found [1]"},
      {"/closed_loop/map", "\"tau=M*u\"",
       "closed_loop.map: found \"tau=M*u\"; accepted: \"tau=M_RB*u ("},
      {"/closed_loop/plant", "null", "closed_loop.plant: not found, but needed"},
      {"/closed_loop/plant", "\"Fossen + limits +51/-39 N\"",
       "+51/-39 N\"; accepted: \"Fossen + thruster lag T s"},
      {"/closed_loop/plant", "\"Fossen + lag 0.1 s\"",
       "lag 0.1 s\"; accepted: \"Fossen + thruster lag T s"},
      {"/closed_loop/plant", "\"lag 0 s, limits +51/-39 N\"",
       "+51/-39 N\"; accepted: \"Fossen + thruster lag T s"},
      {"/closed_loop/gains/KP", "[1]",
       "closed_loop.gains.KP: found [1]; accepted: a list of six numbers"},
      {"/closed_loop/results", "{\"mars/surge_2m\": {\"t90\": 1}}",
       "accepted: one that begins with neu"},
      {"/closed_loop/results", "{\"sea/dance\": {\"t90\": 1}}", "case 'sea/dance'"},
      {"/closed_loop/results", "{\"sea/surge_0m\": {\"t90\": 1}}", "case 'sea/surge_0m'"}};
  for (const Fault& f : faults) {
    Json json = whole;
    json[Json::json_pointer(f.pointer)] = parse_json(f.value).value();
    EXPECT_THAT(control_fault(json), HasSubstr(f.said)) << f.pointer;
  }
}

}  // namespace
}  // namespace neritic::rov
