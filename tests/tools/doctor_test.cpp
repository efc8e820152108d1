// Conclusions of `neritic doctor`, on invented machines and on this one.
#include "tools/neritic/doctor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Machine complete_machine() {
  gpu::DeviceInfo device;
  device.name = "Good Card";
  device.kind = "discrete GPU";
  device.driver = "driver 1.2";
  device.api_version = VK_API_VERSION_1_3;
  device.usable = device.can_present = device.timestamps = true;
  Machine machine;
  machine.devices = {device};
  machine.chosen = 0;
  machine.validation_layer = true;
  machine.matplotlib = "3.6.3 of python3";
  machine.display = "X11 :0";
  machine.display_there = true;
  return machine;
}

bool works(const Machine& machine, const std::string& command) {
  for (const Verdict& verdict : verdicts(machine))
    if (verdict.command == command) return verdict.works;
  ADD_FAILURE() << "no verdict on " << command;
  return false;
}

std::string why(const Machine& machine, const std::string& command) {
  for (const Verdict& verdict : verdicts(machine))
    if (verdict.command == command) return verdict.why;
  return "";
}

TEST(DoctorVerdict, ACompleteMachineDoesAllButTheHeadset) {
  const Machine machine = complete_machine();
  for (const char* command :
       {"render", "sonar --method gpu", "sonar --method reference", "dive (window)",
        "curves of plan, physio, dive", "tests with validation"})
    EXPECT_TRUE(works(machine, command)) << command;
  EXPECT_FALSE(works(machine, "dive (headset)"));
}

TEST(DoctorVerdict, AHeadsetNeedsARuntimeThatAnswersAndIsThere) {
  Machine machine = complete_machine();
  machine.openxr_runtime = "/etc/xdg/openxr/1/active_runtime.json";
  machine.openxr_manifest_exists = true;
  machine.headset_trouble = "the OpenXR runtime does not start";
  EXPECT_EQ(why(machine, "dive (headset)"), "the OpenXR runtime does not start");
  machine.headset = xr::HeadsetInfo{
      .runtime = "Good Runtime 1.2.3",
      .system = "",
      .extensions = {{"XR_KHR_composition_layer_depth", "depth with each picture", false}},
      .others = {"XR_FB_passthrough"}};
  EXPECT_THAT(why(machine, "dive (headset)"), HasSubstr("Good Runtime 1.2.3 has no headset now"));
  EXPECT_FALSE(works(machine, "dive (headset)"));
  machine.headset->system = "Good Goggles";
  EXPECT_TRUE(works(machine, "dive (headset)"));
  EXPECT_THAT(doctor_text(machine), HasSubstr("absent  depth with each picture"));
  EXPECT_THAT(doctor_text(machine), HasSubstr("not used: XR_FB_passthrough"));
  EXPECT_THAT(doctor_json(machine), HasSubstr("Good Goggles"));
}

TEST(DoctorText, SaysWhatItGoesRound) {
  Machine machine = complete_machine();
  EXPECT_EQ(doctor_text(machine).find("works around"), std::string::npos);
  machine.devices[0].quirks.clips_into_wrong_view = true;
  EXPECT_THAT(doctor_text(machine),
              HasSubstr("works around faults of its driver: one view per rendering"));
  EXPECT_THAT(doctor_json(machine), HasSubstr("\"clips_into_wrong_view\": true"));
}

TEST(DoctorText, NamesMatplotlibOrHowToGetIt) {
  Machine machine = complete_machine();
  EXPECT_THAT(doctor_text(machine), HasSubstr("matplotlib          3.6.3 of python3"));
  machine.matplotlib.clear();
  EXPECT_FALSE(works(machine, "curves of plan, physio, dive"));
  EXPECT_THAT(doctor_text(machine), HasSubstr("absent: tools/setup plots installs it"));
  EXPECT_THAT(doctor_json(machine), HasSubstr("\"matplotlib\": null"));
}

TEST(DoctorVerdict, WithoutADeviceOnlyTheReferenceSonarAndCurvesWork) {
  Machine machine = complete_machine();
  machine.devices.clear();
  machine.chosen.reset();
  machine.trouble = Error{ErrorCode::kNoDevice, "no Vulkan device: install mesa-vulkan-drivers"};
  for (const Verdict& verdict : verdicts(machine))
    EXPECT_EQ(verdict.works, verdict.command == "sonar --method reference" ||
                                 verdict.command == "curves of plan, physio, dive")
        << verdict.command;
  EXPECT_THAT(doctor_text(machine), HasSubstr("mesa-vulkan-drivers"));
}

TEST(DoctorVerdict, ADeviceThatDoesNotAnswerIsNoDevice) {
  Machine machine = complete_machine();
  machine.trouble = Error{ErrorCode::kDeviceLost, "it hangs"};
  EXPECT_FALSE(works(machine, "render"));
}

TEST(DoctorVerdict, AWindowNeedsADisplayThatIsThereAndASwapchain) {
  Machine machine = complete_machine();
  machine.display_there = false;
  EXPECT_FALSE(works(machine, "dive (window)"));
  EXPECT_THAT(why(machine, "dive (window)"), HasSubstr(":0"));
  machine.display = "";
  EXPECT_FALSE(works(machine, "dive (window)"));
  EXPECT_THAT(why(machine, "dive (window)"), HasSubstr("DISPLAY"));
  machine = complete_machine();
  machine.devices[0].can_present = false;
  EXPECT_FALSE(works(machine, "dive (window)"));
  EXPECT_TRUE(works(machine, "render"));
}

TEST(DoctorVerdict, TestsNeedTheValidationLayerAndItsPackageIsNamed) {
  Machine machine = complete_machine();
  machine.validation_layer = false;
  EXPECT_FALSE(works(machine, "tests with validation"));
  EXPECT_THAT(why(machine, "tests with validation"), HasSubstr("vulkan-validationlayers"));
}

TEST(DoctorText, SaysWhatAnUnusableDeviceLacks) {
  Machine machine = complete_machine();
  gpu::DeviceInfo old = machine.devices[0];
  old.name = "Old Card";
  old.index = 1;
  old.usable = false;
  old.missing = "synchronization2";
  machine.devices.push_back(old);
  EXPECT_THAT(doctor_text(machine), HasSubstr("lacks synchronization2"));
  EXPECT_THAT(doctor_text(machine), HasSubstr("Good Card   <- would be used"));
}

TEST(DoctorJson, HoldsTheSameForProgramsEvenWithBytesThatAreNoText) {
  Machine machine = complete_machine();
  machine.openxr_runtime = "/tmp/\xff\xfe";
  const auto json = parse_json(doctor_json(machine)).value();
  EXPECT_EQ(json["devices"][0]["name"], "Good Card");
  EXPECT_EQ(json["chosen"], 0);
  EXPECT_TRUE(json["trouble"].is_null());
  EXPECT_EQ(json["works"]["render"]["works"], true);
  EXPECT_EQ(json["works"]["dive (headset)"]["works"], false);
}

// Sets a variable for a test's time.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(FindOpenxrRuntime, AsksTheVariableThenTheUserThenTheSystem) {
  const test::ScratchFolder scratch;
  const fs::path user = scratch / "user", system = scratch / "system";
  const Variable named("XR_RUNTIME_JSON", ""), config("XDG_CONFIG_HOME", user.string()),
      dirs("XDG_CONFIG_DIRS", (scratch / "empty").string() + ":" + system.string());
  const auto manifest = [](const fs::path& folder) {
    return folder / "openxr" / "1" / "active_runtime.json";
  };
  const auto install = [&](const fs::path& folder) {
    fs::create_directories(manifest(folder).parent_path());
    ASSERT_TRUE(write_text(manifest(folder), "{}").ok());
  };
  install(system);
  EXPECT_EQ(find_openxr_runtime(), manifest(system));
  install(user);
  EXPECT_EQ(find_openxr_runtime(), manifest(user));
  const Variable override_both("XR_RUNTIME_JSON", "/not/there.json");
  EXPECT_EQ(find_openxr_runtime(), fs::path("/not/there.json"));
}

TEST(TroubleOfManifest, IsSaidOfEachFileThatNamesNoRuntime) {
  const test::ScratchFolder scratch;
  const auto trouble = [&](const char* text) {
    const fs::path manifest = scratch / "runtime.json";
    EXPECT_TRUE(write_text(manifest, text).ok());
    return trouble_of_manifest(manifest);
  };
  const auto library = [](const std::string& path) {
    return R"({"file_format_version": "1.0.0", "runtime": {"library_path": ")" + path + "\"}}";
  };
  ASSERT_TRUE(write_text(scratch / "here.so", "").ok());
  EXPECT_EQ(trouble("{garbage"), "is no JSON");
  EXPECT_THAT(trouble("[]"), HasSubstr("is no manifest"));
  EXPECT_THAT(trouble("{}"), HasSubstr("is no manifest"));
  EXPECT_THAT(trouble(R"({"file_format_version": "1.0.0", "runtime": {"library_path": 3}})"),
              HasSubstr("is no manifest"));
  EXPECT_THAT(trouble(library("./gone.so").c_str()), HasSubstr("gone.so is not there"));
  EXPECT_EQ(trouble(library("./here.so").c_str()), "");
  EXPECT_EQ(trouble(library((scratch / "here.so").string()).c_str()), "");
  EXPECT_EQ(trouble(library("libopenxr_monado.so").c_str()), "");  // the system finds it
}

// A file that is there, but is no runtime, is no OpenXR runtime.
TEST(DoctorText, ARuntimeThatDoesNotAnswerIsNotToldAsOne) {
  Machine machine = complete_machine();
  machine.openxr_runtime = "/etc/xdg/openxr/1/active_runtime.json";
  machine.openxr_manifest_exists = true;
  machine.headset_trouble = "the OpenXR runtime does not start";
  EXPECT_THAT(doctor_text(machine), HasSubstr("active_runtime.json (does not answer)"));
  EXPECT_THAT(doctor_json(machine), HasSubstr("the OpenXR runtime does not start"));
  machine.openxr_manifest_trouble = "is no JSON";
  EXPECT_THAT(doctor_text(machine), HasSubstr("active_runtime.json (is no JSON)"));
  EXPECT_EQ(why(machine, "dive (headset)"), "/etc/xdg/openxr/1/active_runtime.json: is no JSON");
}

TEST(ExamineMachine, FindsAtLeastAProcessorAndMemory) {
  const Machine machine = examine_machine("");
  EXPECT_GT(machine.cpu_threads, 0u);
  EXPECT_GT(machine.memory_bytes, 0u);
  EXPECT_LE(machine.memory_available_bytes, machine.memory_bytes);
  EXPECT_NE(machine.trouble.has_value(), machine.chosen.has_value() && machine.device_start_ms > 0);
}

TEST(ExamineMachine, AnUnknownDeviceIsATroubleThatListsTheDevices) {
  const Machine machine = examine_machine("no such card");
  ASSERT_TRUE(machine.trouble.has_value());
  for (const gpu::DeviceInfo& device : machine.devices)
    EXPECT_THAT(machine.trouble->message, HasSubstr(device.name));
}

}  // namespace
}  // namespace neritic::tools
