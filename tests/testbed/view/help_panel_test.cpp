// The list of keys: every action with a help is on it, and each page fits the window.
#include "testbed/view/help_panel.hpp"

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "testbed/view/dive_input.hpp"

namespace neritic::testbed {
namespace {

class HelpPanel : public testing::Test {
 protected:
  void SetUp() override {
    context_ = ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().Fonts->AddFontDefault();
    ImGui::GetIO().Fonts->Build();
  }
  void TearDown() override { ImGui::DestroyContext(context_); }
  // Twice: a window that fits its content knows its size in the second frame.
  std::size_t draw(float width, float height, std::size_t page) {
    std::size_t pages = 0;
    for (int frame = 0; frame < 2; ++frame) {
      ImGui::GetIO().DisplaySize = ImVec2(width, height);
      ImGui::GetIO().DeltaTime = 0.02f;
      ImGui::NewFrame();
      pages = draw_help(dive_actions(), page, 1.0f);
      ImGui::Render();
    }
    return pages;
  }
  ImGuiContext* context_ = nullptr;
};

TEST_F(HelpPanel, EveryPageFitsTheWindow) {
  for (const auto& [width, height] :
       {std::pair(640.0f, 480.0f), {800, 600}, {1280, 720}, {1920, 1080}, {3840, 2160}}) {
    const std::size_t pages = draw(width, height, 0);
    EXPECT_LE(pages, width < 1280 ? 2u : 1u) << width;
    for (std::size_t page = 0; page < pages; ++page) {
      draw(width, height, page);
      const ImGuiWindow* window = ImGui::FindWindowByName("###keys");
      ASSERT_NE(window, nullptr);
      EXPECT_GE(window->Pos.x, 0.0f);
      EXPECT_GE(window->Pos.y, 0.0f);
      EXPECT_LE(window->Pos.x + window->Size.x, width);
      EXPECT_LE(window->Pos.y + window->Size.y, height);
      EXPECT_LE(window->ContentSize.y, window->InnerRect.GetHeight() + 1.0f) << width;
    }
  }
}

// Also where the window is narrower than a line of the list.
TEST_F(HelpPanel, NoTextIsCutInASmallWindow) {
  for (const auto& [width, height] : {std::pair(401.0f, 303.0f), {300, 200}, {160, 400}}) {
    const std::size_t pages = draw(width, height, 0);
    EXPECT_GT(pages, 1u);
    for (std::size_t page = 0; page < pages; ++page) {
      draw(width, height, page);
      const ImGuiWindow* window = ImGui::FindWindowByName("###keys");
      ASSERT_NE(window, nullptr);
      EXPECT_LE(window->Pos.x + window->Size.x, width);
      EXPECT_LE(window->Pos.y + window->Size.y, height);
      EXPECT_LE(window->ContentSize.x, window->InnerRect.GetWidth() + 1.0f) << width;
      EXPECT_LE(window->ContentSize.y, window->InnerRect.GetHeight() + 1.0f) << width;
    }
  }
}

// A key that does two things would do both.
TEST(DiveActions, NoKeyIsOfTwoActionsButThoseThatShareAStick) {
  std::map<std::string, std::string> owner;
  for (const xr::ActionDesc& action : dive_actions())
    for (std::string binding : action.bindings) {
      if (binding.starts_with("-")) binding.erase(0, 1);
      if (!binding.starts_with("key ")) continue;
      EXPECT_TRUE(owner.emplace(binding, action.name).second)
          << binding << ": " << owner[binding] << " and " << action.name;
    }
}

}  // namespace
}  // namespace neritic::testbed
