// The operator's console as it draws over a view: the keys as they are bound, notes of keys that do
// nothing here, and what was clicked.
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include "engine/xr/offscreen.hpp"
#include "testbed/view/bindings.hpp"
#include "testbed/view/console.hpp"
#include "testbed/view/dive_view.hpp"
#include "testbed/view/key_words.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/simulation/dives.hpp"
#include "tests/testbed/view/kept_display.hpp"

namespace neritic::testbed {
namespace {

// The default actions with the bindings of a file.
std::vector<xr::ActionDesc> bound_by(const std::string& bindings) {
  const test::ScratchFolder scratch;
  EXPECT_TRUE(write_text(scratch / "b.toml", "[actions]\n" + bindings).ok());
  return bound_actions(dive_actions(), scratch / "b.toml").value();
}

constexpr const char* kBindings =
    "help = [\"key J\"]\nnext_view = [\"key T\"]\npilot = [\"key O\"]\nquit = []\n"
    "save = [\"pad left\"]\nmove_up = [\"key U\", \"-key Z\"]\n";

TEST(KeyWords, AreThoseOfTheBindings) {
  const auto bound = bound_by(kBindings), usual = dive_actions();
  EXPECT_EQ(key_of(usual, "help"), "F1");
  EXPECT_EQ(key_of(bound, "help"), "J");
  EXPECT_EQ(key_of(bound, "save"), "pad left");
  EXPECT_EQ(key_of(bound, "quit"), "");
  EXPECT_EQ(first_keys(usual, true, true), "F1  keys   V  view   P  steer");
  EXPECT_EQ(first_keys(bound, true, true), "J  keys   T  view   O  steer");
  EXPECT_EQ(first_keys(bound_by("help = []\n"), true, false), "V  view");
  EXPECT_EQ(with_key(bound, "quit", "ends"), "ends");
  EXPECT_EQ(swim_words(usual),
            "you swim the diver: A D turn, also the mouse with its right button; W ahead, E Q up "
            "and down, I K the jacket; P lets go");
  EXPECT_EQ(swim_words(bound_by("move_up = [\"-key Z\", \"key U\"]\nlook_x = []\npilot = []\n"
                                "inflate = [\"key J\"]\ndeflate = []\n")),
            "you swim the diver: A D turn; W ahead, U Z up and down, J the jacket");
}

class ConsoleView : public test::GpuTest {
 protected:
  void SetUp() override {
    test::GpuTest::SetUp();
    if (IsSkipped()) return;
    scene::Scene scene = load_text(
                             "[[objects]]\nshape = \"sphere\"\nposition_m = [0, -5, 0]\n"
                             "[[cameras]]\nposition_m = [0, -5, 4]\n")
                             .value();
    session_ = Session::create(device(), std::move(scene)).value();
    overlay_ = xr::Overlay::create(device(), nullptr, 1).value();
    group_ = xr::one_view(1280, 720, radians(60.0));
  }
  void TearDown() override {
    console_.reset();
    overlay_.reset();
    session_.reset();
    test::GpuTest::TearDown();
  }
  // Without panels, so that nothing is drawn but what a test asks for.
  void make(std::vector<xr::ActionDesc> actions) {
    console_ = Console::create(*session_, *overlay_,
                               {.actions = std::move(actions), .memory = {.panels = false}})
                   .value();
  }
  // Whether the console draws anything over a frame.
  bool draws() {
    graph::FrameGraph graph;
    const ViewChoice choice(session_->scene(), 0);
    const DivePilot pilot = DivePilot::create(nullptr, false).value();
    const DiveTimes times(false);
    const auto panel = console_->declare(graph, {group_, choice, pilot, times});
    EXPECT_TRUE(panel.ok());
    return panel.ok() && panel->has_value();
  }
  // The text of the first window that the console draws.
  std::string window_text() {
    ImGuiContextHook hook;
    hook.Type = ImGuiContextHookType_NewFramePost;
    hook.UserData = &log_;
    hook.Callback = [](ImGuiContext*, ImGuiContextHook* of) {
      ImGui::LogToFile(-1, static_cast<std::string*>(of->UserData)->c_str());
    };
    const ImGuiID id = ImGui::AddContextHook(ImGui::GetCurrentContext(), &hook);
    draws();
    ImGui::RemoveContextHook(ImGui::GetCurrentContext(), id);
    return read_text(log_).value();
  }

  // Whether the view's console draws anything over its next frame.
  bool shows_panels(DiveView& view, KeptDisplay& display) {
    graph::FrameGraph graph;
    EXPECT_TRUE(view.begin_frame().ok());
    view.take_input();
    FrameRequest request{.capture = kColorOnGpu};
    view.add_views(request);
    const auto declared = session_->declare(graph, request);
    EXPECT_TRUE(declared.ok() && view.declare(graph, **declared, 0.0, false).ok());
    EXPECT_TRUE(view.end_frame(std::nullopt).ok());
    return display.panel("panels") != nullptr;
  }

  std::unique_ptr<Session> session_;
  std::unique_ptr<xr::Overlay> overlay_;
  std::unique_ptr<Console> console_;
  xr::ViewGroup group_;
  test::ScratchFolder scratch_;
  std::string log_ = (scratch_ / "log").string();
};

TEST_F(ConsoleView, TheListOfKeysIsOfThoseThatAreBound) {
  make(bound_by(kBindings));
  console_->take({.toggle_help = true});
  const std::string text = window_text();
  // The columns of one line have different numbers of words between them.
  const auto listed = [&](const std::string& keys, const std::string& help) {
    const std::size_t at = text.find(help);
    return at != std::string::npos && at > keys.size() &&
           text.substr(0, at).find_last_not_of(" \n") != std::string::npos &&
           text.substr(0, text.substr(0, at).find_last_not_of(" \n") + 1).ends_with(keys);
  };
  EXPECT_TRUE(listed("J", "this list")) << text;
  EXPECT_TRUE(listed("T", "next view")) << text;
  EXPECT_TRUE(listed("O", "fly a vehicle")) << text;
  EXPECT_TRUE(listed("pad left", "save the run's state")) << text;
  EXPECT_TRUE(listed("W / S", "ahead, astern")) << text;
  EXPECT_TRUE(listed("Z / U", "down, up")) << text;
  EXPECT_EQ(text.find("end the dive"), std::string::npos) << text;
  EXPECT_EQ(text.find("F1 "), std::string::npos) << text;
}

// In a scene of one ball: no physics, no sonar, no diver.
TEST_F(ConsoleView, KeysOfWhatIsNotThereSayWhyAndLeaveTheSettingsAsTheyWere) {
  for (const DiveInput& input : std::initializer_list<DiveInput>{
           {.toggle_graphs = true}, {.next_sonar = true}, {.next_range = true}, {.gain_step = 1}}) {
    make(dive_actions());
    const ViewMemory before = console_->memory();
    EXPECT_FALSE(draws());
    console_->take(input);
    EXPECT_TRUE(draws()) << "a note";
    EXPECT_EQ(console_->memory(), before);
  }
  make(dive_actions());
  console_->take({.toggle_map = true});
  EXPECT_FALSE(draws());
  EXPECT_TRUE(console_->memory().map);
}

TEST_F(ConsoleView, AViewNotesTheKeysForWhichNobodyIsThere) {
  for (const char* action : {"hud", "inflate", "pilot", "save"}) {
    KeptDisplay display(false);
    NERITIC_ASSERT_OK(const auto view, DiveView::create(*session_, display, overlay_.get(), nullptr,
                                                        {.no_keys_for_files = "no file",
                                                         .nobody_to_steer = "nobody",
                                                         .no_instruments = "no instruments",
                                                         .memory = {.panels = false}}));
    EXPECT_FALSE(shows_panels(*view, display)) << action;
    display.press(action);
    EXPECT_TRUE(shows_panels(*view, display)) << action;
  }
}

TEST_F(ConsoleView, WhatWasClickedIsNotMarkedOverTheListOfKeys) {
  make(dive_actions());
  const auto marks = [&] {
    EXPECT_TRUE(draws());
    return ImGui::GetForegroundDrawList()->VtxBuffer.Size > 0;
  };
  console_->mark({Vec2(0.5), "ball"});
  EXPECT_TRUE(marks());
  console_->take({.toggle_help = true});
  EXPECT_FALSE(marks());
  console_->take({.toggle_help = true});
  EXPECT_TRUE(marks());
}

}  // namespace
}  // namespace neritic::testbed
