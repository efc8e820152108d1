// Samples that leave a simulation, against the table that `dive --headless --log` writes of the
// same run, and against the rates of the vehicle's file.
#include "testbed/simulation/output_samples.hpp"

#include <map>
#include <sstream>

#include "testbed/record/dive_record.hpp"
#include "tests/testbed/csv_text.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

std::string survey_and_diver() {
  return std::string(kStillWater) +
         "[[objects]]\nname = \"sand\"\nclass = \"seabed\"\nshape = \"plane\"\nsize_m = [40, 40]\n"
         "position_m = [0, -14, 0]\n" +
         rov_text(
             "position_m = [3, -10, 0]\n"
             "mission = { waypoints = [ { position_m = [6, -9, -3] } ] }\n",
             "rov", "bluerov2_heavy_survey_dynamics.toml") +
         diver_text(std::string("position_m = [0, -12, 0]\n") + kProne);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

// Cells of a log by participant, time as it stands there, and column.
class Table {
 public:
  explicit Table(const std::string& csv) {
    std::istringstream in(csv);
    std::string line;
    std::getline(in, line);
    names_ = cells_of(line);
    while (std::getline(in, line)) {
      auto cells = cells_of(line);
      rows_[cells[1] + " " + cells[0]] = cells;
    }
  }
  std::string at(const std::string& who, double time_s, const std::string& column) const {
    const auto row = rows_.find(fmt::format("{} {:.9g}", who, time_s));
    const auto name = std::ranges::find(names_, column);
    if (row == rows_.end() || name == names_.end()) return "no such cell";
    return row->second[static_cast<std::size_t>(name - names_.begin())];
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::vector<std::string>> rows_;
};

std::string cell(double number) {
  return fmt::format("{:.9g}", number);
}
std::string heard_cell(bool heard, double number) {
  return heard ? cell(number) : std::string();
}
std::string ended_cell(double minutes) {
  return minutes < 0.0 ? std::string() : cell(minutes);
}

using Cells = std::map<std::string, std::string>;

// The log's columns that tell the same as the payload.
Cells columns_of(const Payload& payload) {
  if (const auto* imu = std::get_if<rov::ImuReading>(&payload))
    return {{"gyro_yaw_deg_s", cell(degrees(imu->angular_rad_s.z))},
            {"accelerometer_x_m_s2", cell(imu->specific_force_m_s2.x)}};
  if (const auto* dvl = std::get_if<rov::DvlReading>(&payload))
    return {{"dvl_surge_m_s", heard_cell(dvl->locked(), dvl->velocity_m_s.x)},
            {"dvl_altitude_m", heard_cell(dvl->heard != 0, dvl->altitude_m)}};
  if (const auto* pressure = std::get_if<rov::PressureReading>(&payload))
    return {{"pressure_pa", cell(pressure->pressure_pa)},
            {"pressure_depth_m", cell(pressure->depth_m)}};
  if (const auto* compass = std::get_if<CompassReading>(&payload))
    return {{"compass_deg", cell(degrees(compass->heading_rad))}};
  if (const auto* altimeter = std::get_if<rov::AltimeterReading>(&payload))
    return {{"altimeter_m", heard_cell(altimeter->heard != 0, altimeter->distance_m)}};
  if (const auto* usbl = std::get_if<rov::UsblReading>(&payload))
    return {{"usbl_y_m", heard_cell(usbl->heard != 0, -usbl->position_ned_m.z)}};
  if (const auto* motion = std::get_if<DiverMotion>(&payload))
    return {{"x_m", cell(motion->world_from_body.position_m.x)},
            {"qw", cell(motion->world_from_body.rotation.w)},
            {"surge_m_s", cell(motion->velocity_m_s.x)},
            {"yaw_deg_s", cell(degrees(motion->angular_rad_s.z))},
            {"gaze_x", cell(motion->gaze.x)},
            {"heart_bpm", cell(motion->heart_bpm)},
            {"ventilation_l_min", cell(motion->ventilation_l_min)},
            {"tank_bar", cell(1e-5 * motion->tank_pa)},
            {"jacket_l", cell(1e3 * motion->jacket_m3)},
            {"lungs_l", cell(1e3 * motion->lungs_m3)},
            {"tank", cell(static_cast<double>(motion->tank))},
            {"buttons", cell(static_cast<double>(motion->buttons))}};
  if (const auto* human = std::get_if<HumanReading>(&payload))
    return {{"heart_bpm", cell(human->heart_bpm)}, {"tank_bar", cell(1e-5 * human->gas_pa)}};
  const auto& computer = std::get<ComputerReading>(payload);
  return {{"ceiling_m", cell(computer.ceiling_m)},
          {"stop_m", cell(computer.stop_m)},
          {"no_stop_min", ended_cell(computer.no_stop_min)},
          {"to_surface_min", ended_cell(computer.to_surface_min)},
          {"po2_bar", cell(computer.po2_bar)},
          {"ascent_m_min", cell(computer.ascent_m_min)},
          {"cns_percent", cell(computer.cns_percent)},
          {"ascent_alarm", cell(static_cast<double>(computer.alarm))}};
}

constexpr double kSeconds = 3.0;

TEST(OutputSamples, EachStreamHasItsRateAndTheValuesOfTheLogWithoutGaps) {
  const TestDive dive = dive_of(survey_and_diver());
  const PhysicsWorld& world = *dive.world;
  OutputSamples outputs(world, OutputSamples::all(world));
  DiveRecorder recorder(world, {.rows = true, .row_rate_hz = 1.0 / world.step_s()});
  struct Out {
    double step_s;  // time of the step at which it left
    Sample sample;
  };
  std::vector<Out> out;
  const auto take = [&] {
    const auto& newest = dive.simulation->newest();
    recorder.add(newest);
    for (const Sample& sample : outputs.of(newest)) out.push_back({newest.time_s, sample});
  };
  take();
  while (dive.time_s() < kSeconds - 1e-9) {
    dive.simulation->advance(1);
    take();
  }
  const Table table(csv_of(world, recorder.rows()));

  std::map<std::string, std::uint64_t> counts;
  for (const Out& o : out) {
    const Stream& stream = world.streams()[o.sample.header.stream];
    const std::string who = stream.name.substr(0, stream.name.find('/'));
    EXPECT_EQ(o.sample.header.source, kSimulation);
    EXPECT_EQ(o.sample.header.sequence, counts[stream.name]++) << stream.name;
    EXPECT_EQ(o.sample.kind(), stream.kind);
    const double age_s = o.step_s - 1e-9 * static_cast<double>(o.sample.header.captured_ns);
    EXPECT_GE(age_s, -1e-8) << stream.name;
    EXPECT_LT(age_s, world.step_s() + 1e-8) << stream.name;
    for (const auto& [column, expected] : columns_of(o.sample.payload))
      ASSERT_EQ(table.at(who, o.step_s, column), expected)
          << stream.name << " " << column << " at " << o.step_s;
  }
  const rov::SensorSet& sensors = world.vehicles()[0].file.sensors;
  const auto at = [](double hz) { return static_cast<std::uint64_t>(kSeconds * hz) + 1; };
  const std::map<std::string, std::uint64_t> expected{
      {"rov/imu", at(sensors.imu->rate_hz)},
      {"rov/dvl", at(sensors.dvl->rate_hz)},
      {"rov/pressure", at(sensors.pressure->rate_hz)},
      {"rov/compass", at(sensors.compass->rate_hz)},
      {"rov/altimeter", at(sensors.altimeter->rate_hz)},
      {"rov/usbl", at(sensors.usbl->rate_hz)},
      {"diver/motion", at(kDiverMotion_hz)},
      {"diver/human", at(kHuman_hz)},
      {"diver/computer", at(1.0 / diver::kComputerSample_s)}};
  EXPECT_EQ(counts, expected);
}

// Every kind of sensor, all faster than steps of 60 Hz, above a bed.
constexpr double kImu_hz = 1000, kDvl_hz = 90, kPressure_hz = 130, kCompass_hz = 333,
                 kAltimeter_hz = 64, kUsbl_hz = 75;
std::string fast_sensors(const test::ScratchFolder& folder, double physics_hz) {
  const std::string table = read_text(vehicles_folder() + "/t200_thrust.csv").value();
  EXPECT_TRUE(write_text(folder / "t200_thrust.csv", table).ok());
  EXPECT_TRUE(
      write_text(
          folder / "fast.toml",
          read_text(vehicles_folder() + "/bluerov2_heavy_dynamics.toml").value() +
              fmt::format("\n[imu]\nrate_hz = {}\n[dvl]\nrate_hz = {}\n[pressure]\nrate_hz = "
                          "{}\n[compass]\nrate_hz = {}\n[altimeter]\nrate_hz = {}\n"
                          "[usbl]\nrate_hz = {}\n",
                          kImu_hz, kDvl_hz, kPressure_hz, kCompass_hz, kAltimeter_hz, kUsbl_hz))
          .ok());
  return fmt::format("seed = 4\n[physics]\nrate_hz = {}\n", physics_hz) +
         "[[objects]]\nname = \"sand\"\nclass = \"seabed\"\nshape = \"plane\"\nsize_m = [40, 40]\n"
         "position_m = [0, -14, 0]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\n"
         "size_m = [0.57, 0.26, 0.46]\ndynamics = \"" +
         (folder / "fast.toml").string() +
         "\"\nposition_m = [3, -10, 0]\nnavigation = \"truth\"\n"
         "mission = { waypoints = [ { position_m = [6, -9, -3] } ] }\n";
}

using Readings = std::map<std::string, std::vector<Sample>>;
const std::map<std::string, double> kFastRates{{"rov/imu", kImu_hz},
                                               {"rov/dvl", kDvl_hz},
                                               {"rov/pressure", kPressure_hz},
                                               {"rov/compass", kCompass_hz},
                                               {"rov/altimeter", kAltimeter_hz},
                                               {"rov/usbl", kUsbl_hz}};

void take(Readings& readings, const PhysicsWorld& world, std::span<const Sample> samples) {
  for (const Sample& sample : samples)
    readings[world.streams()[sample.header.stream].name].push_back(sample);
}

// Each reading against that of steps of 1 kHz, in which no sensor reads twice.
TEST(OutputSamples, SensorsFasterThanTheStepsLoseNoReading) {
  const test::ScratchFolder folder;
  const auto flown = [&](double physics_hz) {
    const TestDive dive = dive_of(fast_sensors(folder, physics_hz));
    OutputSamples outputs(*dive.world, OutputSamples::all(*dive.world));
    Readings out;
    take(out, *dive.world, outputs.of(dive.simulation->newest()));
    const Sample* memory = outputs.of(dive.simulation->newest()).data();
    while (dive.time_s() < 2.0 - 1e-9) {
      dive.simulation->advance(1);
      const auto samples = outputs.of(dive.simulation->newest());
      EXPECT_EQ(samples.data(), memory);  // the same memory at each step
      take(out, *dive.world, samples);
    }
    return out;
  };
  Readings slow = flown(60.0), fast = flown(1000.0);
  for (const auto& [name, hz] : kFastRates) {
    const std::vector<Sample>&a = slow[name], &b = fast[name];
    ASSERT_EQ(a.size(), static_cast<std::size_t>(2.0 * hz) + 1) << name;
    ASSERT_EQ(b.size(), a.size()) << name;
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a[i].header.sequence, i) << name;
      ASSERT_NEAR(static_cast<double>(a[i].header.captured_ns), 1e9 * static_cast<double>(i) / hz,
                  2.0)
          << name;
      ASSERT_LE(a[i].header.captured_ns, a[i].header.arrived_ns + 1) << name;
      ASSERT_LT(a[i].header.arrived_ns - a[i].header.captured_ns, 16'666'670) << name;
      if (const auto* imu = std::get_if<rov::ImuReading>(&a[i].payload)) {
        const auto& other = std::get<rov::ImuReading>(b[i].payload);
        ASSERT_LT(glm::distance(imu->angular_rad_s, other.angular_rad_s), 1e-3);
      } else if (const auto* pressure = std::get_if<rov::PressureReading>(&a[i].payload)) {
        ASSERT_NEAR(pressure->depth_m, std::get<rov::PressureReading>(b[i].payload).depth_m, 1e-3);
      } else if (const auto* compass = std::get_if<CompassReading>(&a[i].payload)) {
        ASSERT_NEAR(compass->heading_rad, std::get<CompassReading>(b[i].payload).heading_rad, 1e-3);
      }
    }
  }
}

// Also in a run that goes on from a state in the middle, and for one who begins to ask there.
TEST(OutputSamples, AllReadingsOfAStepAreInASavedState) {
  const test::ScratchFolder folder;
  const TestDive dive = dive_of(fast_sensors(folder, 60.0)),
                 on = dive_of(fast_sensors(folder, 60.0));
  dive.simulation->advance(31);
  const StateFormat format = dive.world->state_format();
  restore_state(
      *on.simulation,
      parse_state(format, encode_state(format, saved_state(*dive.simulation, format)), "state")
          .value());
  OutputSamples first(*dive.world, OutputSamples::all(*dive.world)),
      later(*on.world, OutputSamples::all(*on.world));
  for (int i = 0; i < 30; ++i) {
    const auto a = first.of(dive.simulation->newest()), b = later.of(on.simulation->newest());
    ASSERT_EQ(a.size(), b.size()) << i;
    EXPECT_GT(a.size(), 16u + 5u + 2u) << i;
    for (std::size_t k = 0; k < a.size(); ++k)
      ASSERT_TRUE(sim::same_bits(a[k].header, b[k].header)) << i;
    ASSERT_EQ(dive.simulation->newest().hash, on.simulation->newest().hash) << i;
    dive.simulation->advance(1), on.simulation->advance(1);
  }
}

TEST(OutputSamples, AConsumerThatBeginsLateReadsTheSameSamples) {
  const TestDive dive = dive_of(survey_and_diver());
  const auto all = OutputSamples::all(*dive.world);
  const StreamId imu = dive.world->streams().find("rov/imu").value();
  OutputSamples first(*dive.world, all);
  first.of(dive.simulation->newest());
  for (int i = 0; i < 101; ++i) {
    dive.simulation->advance(1);
    first.of(dive.simulation->newest());
  }
  OutputSamples late(*dive.world, all), one(*dive.world, {imu}), none(*dive.world, {});
  const Sample* memory = nullptr;
  for (int i = 0; i < 300; ++i) {
    dive.simulation->advance(1);
    const auto a = first.of(dive.simulation->newest()), b = late.of(dive.simulation->newest());
    ASSERT_EQ(a.size(), b.size()) << i;
    if (!memory) memory = a.data();
    EXPECT_EQ(a.data(), memory);  // the same memory at each step
    std::vector<Sample> imu_only;
    for (std::size_t k = 0; k < a.size(); ++k) {
      ASSERT_TRUE(sim::same_bits(a[k].header, b[k].header)) << i;
      if (a[k].header.stream == imu) imu_only.push_back(a[k]);
    }
    const auto c = one.of(dive.simulation->newest());
    ASSERT_EQ(c.size(), imu_only.size());
    if (!c.empty()) {
      EXPECT_TRUE(sim::same_bits(c[0].header, imu_only[0].header));
      EXPECT_TRUE(sim::same_bits(std::get<rov::ImuReading>(c[0].payload),
                                 std::get<rov::ImuReading>(imu_only[0].payload)));
    }
    EXPECT_TRUE(none.of(dive.simulation->newest()).empty());
  }
}

}  // namespace
}  // namespace neritic::testbed
