#include "engine/xr/desktop/overlay.hpp"

#include <backends/imgui_impl_glfw.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/core/check.hpp"
#include "engine/draw2d/font.hpp"
#include "shaders.hpp"
#include "shared/imgui.h"

namespace neritic::xr {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
constexpr float kHeightOfScale1_px = 1080.0f;
constexpr float kFontSize_px = 14.0f;  // the em, at a scale of 1

void set_style(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 4.0f;
  style.FrameRounding = 2.0f;
  style.WindowBorderSize = 1.0f;
  style.WindowPadding = ImVec2(10.0f, 8.0f);
  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.02f, 0.045f, 0.065f, 0.80f);
  style.Colors[ImGuiCol_Border] = ImVec4(0.45f, 0.65f, 0.72f, 0.25f);
  style.Colors[ImGuiCol_Text] = ImVec4(0.90f, 0.95f, 0.97f, 1.0f);
  style.Colors[ImGuiCol_TextDisabled] = ImVec4(0.62f, 0.74f, 0.79f, 1.0f);
  style.Colors[ImGuiCol_TitleBg] = ImVec4(0.03f, 0.09f, 0.12f, 0.90f);
  style.Colors[ImGuiCol_TitleBgActive] = ImVec4(0.04f, 0.17f, 0.22f, 0.95f);
  style.Colors[ImGuiCol_TitleBgCollapsed] = ImVec4(0.03f, 0.09f, 0.12f, 0.70f);
  style.Colors[ImGuiCol_PlotHistogram] = ImVec4(0.20f, 0.55f, 0.65f, 0.75f);
  style.Colors[ImGuiCol_FrameBg] = ImVec4(0.10f, 0.18f, 0.22f, 0.55f);
  style.ScaleAllSizes(scale);
}

// Side of the squares by which drawn_parts tells what is clear.
constexpr int kPartCell_px = 4;

// Rectangles of whole pixels that hold all triangles: cells of a net that some triangle's box
// touches, in rows, rows that are alike joined.
std::vector<PanelPart> drawn_parts(const ImDrawData& data) {
  const float width = data.DisplaySize.x, height = data.DisplaySize.y;
  const int columns = static_cast<int>(std::ceil(width / kPartCell_px));
  const int rows = static_cast<int>(std::ceil(height / kPartCell_px));
  std::vector<char> touched(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const auto cell = [&](int x, int y) -> char& {
    return touched[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(x)];
  };
  const auto place = [](float pixel, int cells) {
    return std::clamp(static_cast<int>(std::floor(pixel / kPartCell_px)), 0, cells - 1);
  };
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer)
      for (unsigned int i = 0; i + 2 < command.ElemCount; i += 3) {
        ImVec2 least(width, height), most(0.0f, 0.0f);
        for (unsigned int k = 0; k < 3; ++k) {
          const ImDrawIdx index = list.IdxBuffer[static_cast<int>(command.IdxOffset + i + k)];
          const ImVec2 at = list.VtxBuffer[static_cast<int>(command.VtxOffset + index)].pos;
          least = {std::min(least.x, at.x), std::min(least.y, at.y)};
          most = {std::max(most.x, at.x), std::max(most.y, at.y)};
        }
        least = {std::max(least.x, command.ClipRect.x), std::max(least.y, command.ClipRect.y)};
        most = {std::min(most.x, command.ClipRect.z), std::min(most.y, command.ClipRect.w)};
        if (!(least.x < most.x && least.y < most.y)) continue;
        for (int y = place(least.y, rows); y <= place(most.y, rows); ++y)
          for (int x = place(least.x, columns); x <= place(most.x, columns); ++x) cell(x, y) = 1;
      }
  }
  std::vector<PanelPart> parts;
  const auto x_of = [&](int x) { return std::min(float(x * kPartCell_px), width) / width; };
  const auto y_of = [&](int y) { return std::min(float(y * kPartCell_px), height) / height; };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      if (!cell(x, y)) continue;
      int end = x;
      while (end < columns && cell(end, y)) ++end;
      const auto alike = [&](int row) {
        for (int k = x; k < end; ++k)
          if (!cell(k, row)) return false;
        return (x == 0 || !cell(x - 1, row)) && (end == columns || !cell(end, row));
      };
      int below = y;
      for (; below < rows && alike(below); ++below)
        for (int k = x; k < end; ++k) cell(k, below) = 0;
      parts.push_back({x_of(x), y_of(y), x_of(end), y_of(below)});
      x = end - 1;
    }
  return parts;
}

// Indices in a row that one pipeline draws.
struct Run {
  unsigned int first = 0, count = 0;
  bool plain = false;
};

// Less area than this is not worth a draw command of its own.
constexpr float kLeastPlain_px2 = 3000.0f;

// A command's triangles in their order: those of one colour apart from textured ones, where they
// cover enough.
std::vector<Run> runs_of(const ImDrawList& list, const ImDrawCmd& command, const ImVec2& white) {
  std::vector<Run> runs;
  float area_px2 = 0.0f;  // of the last run
  const auto end_run = [&] {
    if (runs.empty() || !runs.back().plain || area_px2 >= kLeastPlain_px2) return;
    runs.back().plain = false;
    if (runs.size() < 2 || runs[runs.size() - 2].plain) return;
    runs[runs.size() - 2].count += runs.back().count;
    runs.pop_back();
  };
  for (unsigned int i = 0; i + 2 < command.ElemCount; i += 3) {
    const ImDrawVert* corners[3];
    bool plain = true;
    for (unsigned int k = 0; k < 3; ++k) {
      const ImDrawIdx index = list.IdxBuffer[static_cast<int>(command.IdxOffset + i + k)];
      corners[k] = &list.VtxBuffer[static_cast<int>(command.VtxOffset + index)];
      plain &= corners[k]->uv.x == white.x && corners[k]->uv.y == white.y;
    }
    if (runs.empty() || runs.back().plain != plain) {
      end_run();
      area_px2 = 0.0f;
      if (runs.empty() || runs.back().plain != plain) runs.push_back({i, 0, plain});
    }
    runs.back().count += 3;
    const ImVec2 &a = corners[0]->pos, &b = corners[1]->pos, &c = corners[2]->pos;
    area_px2 += 0.5f * std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
  }
  end_run();
  return runs;
}

}  // namespace

Result<std::unique_ptr<Overlay>> Overlay::create(gpu::Device& device, Window* window, float scale) {
  NERITIC_CHECK(ImGui::GetCurrentContext() == nullptr, "one overlay at a time");
  IMGUI_CHECKVERSION();
  std::unique_ptr<Overlay> overlay(new Overlay(device));
  overlay->context_ = ImGui::CreateContext();
  overlay->least_scale_ = overlay->scale_ = std::max(1.0f, std::round(scale));
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no files of its own
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.BackendRendererName = "neritic";
  set_style(overlay->scale_);
  if (window) overlay->glfw_ = ImGui_ImplGlfw_InitForVulkan(window->handle(), true);
  NERITIC_TRY_STATUS(overlay->create_font());
  NERITIC_TRY_STATUS(overlay->create_pipelines());
  return overlay;
}

Status Overlay::fit(std::uint32_t height) {
  const float wanted = std::round(static_cast<float>(height) / kHeightOfScale1_px);
  const float scale = std::max(least_scale_, wanted);
  if (scale == scale_) return {};
  drop_frame();         // it locks the font
  device_.wait_idle();  // frames in flight read the font
  scale_ = scale;
  ImGui::GetStyle() = ImGuiStyle();
  set_style(scale);
  ImGui::GetIO().Fonts->Clear();
  return create_font();
}

Overlay::~Overlay() {
  if (glfw_) ImGui_ImplGlfw_Shutdown();
  if (context_) ImGui::DestroyContext(context_);
}

Status Overlay::create_font() {
  ImGuiIO& io = ImGui::GetIO();
  // Latin, general punctuation, super- and subscripts, Greek, arrows and mathematical signs. ImGui
  // draws any other code point as U+FFFD.
  static constexpr ImWchar kRanges[] = {0x20,   0xFF,   0x370,  0x3FF,  0x2010,
                                        0x2027, 0x2070, 0x209F, 0x2190, 0x21FF,
                                        0x2200, 0x226F, 0xFFFD, 0xFFFD, 0};
  const std::span<const std::byte> file = draw2d::font_file(draw2d::Face::kRegular);
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  // ImGui takes a pointer to bytes that it may change, but reads them only.
  void* bytes = const_cast<std::byte*>(file.data());
  const ImFont* font = io.Fonts->AddFontFromMemoryTTF(
      bytes, static_cast<int>(file.size()), std::round(kFontSize_px * scale_), &config, kRanges);
  NERITIC_CHECK(font != nullptr, "ImGui does not read the font");
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  NERITIC_TRY(font_, gpu::Image::create(device_, {.name = "overlay font",
                                                  .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                  .width = static_cast<std::uint32_t>(width),
                                                  .height = static_cast<std::uint32_t>(height),
                                                  .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                           VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                                  .array_view = true}));
  const std::span texels(pixels, std::size_t{font_.desc().width} * font_.desc().height * 4);
  io.Fonts->SetTexID(nullptr);
  return gpu::upload_image(device_, font_, std::as_bytes(texels));
}

Status Overlay::create_pipelines() {
  NERITIC_TRY(sampler_, gpu::Sampler::create(device_, {.name = "overlay",
                                                       .u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                                       .v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                                       .mipmapped = false}));
  gpu::GraphicsPipelineDesc desc;
  desc.name = "overlay";
  desc.vertex_code = shaders::kImguiVert;
  desc.fragment_code = shaders::kImguiFrag;
  desc.layout.bindings = {{shared::kImguiTexture, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
  desc.layout.push_constant_bytes = sizeof(shared::ImguiPush);
  desc.streams = {{sizeof(ImDrawVert),
                   {{shared::kImguiPosition, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
                    {shared::kImguiUv, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
                    {shared::kImguiColor, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)}}}};
  desc.color_formats = {kFormat};
  desc.blend = gpu::Blend::kAlphaOver;
  NERITIC_TRY(pipeline_, gpu::Pipeline::create(device_, desc));
  desc.name = "overlay, plain";
  desc.constants = {{shared::kSpecImguiPlain, true}};
  NERITIC_TRY(plain_, gpu::Pipeline::create(device_, desc));
  return {};
}

void Overlay::begin(std::uint32_t width, std::uint32_t height, double elapsed_s) {
  drop_frame();
  textures_.clear();
  width_ = width;
  height_ = height;
  ImGuiIO& io = ImGui::GetIO();
  if (glfw_) ImGui_ImplGlfw_NewFrame();
  // The window's idea of its size may be newer than the frame's.
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DisplayFramebufferScale = ImVec2(1.0f, 1.0f);
  io.DeltaTime = std::max(1e-4f, static_cast<float>(elapsed_s));
  ImGui::NewFrame();
  begun_ = true;
}

void Overlay::drop_frame() {
  if (std::exchange(begun_, false)) ImGui::EndFrame();
}

ImTextureID Overlay::texture(graph::ImageHandle image, std::uint32_t layer) {
  textures_.push_back({image, layer});
  return reinterpret_cast<ImTextureID>(textures_.size());
}

graph::ImageHandle Overlay::declare(graph::FrameGraph& graph) {
  ImGui::Render();
  begun_ = false;
  drawn_ = drawn_parts(*ImGui::GetDrawData());
  struct Data {
    graph::ImageHandle target;
  };
  return graph
      .add_pass<Data>(
          "overlay",
          [&](graph::PassBuilder& builder, Data& data) {
            for (const Texture& texture : textures_)
              builder.read(texture.image, graph::Access::kSampledFragment);
            const graph::ImageHandle target =
                builder.create_image("overlay", {kFormat, width_, height_, 1});
            data.target = builder.write(target, graph::Access::kColorAttachment);
          },
          [this](const Data& data, graph::PassContext& context) { record(context, data.target); })
      .target;
}

void Overlay::record(graph::PassContext& context, graph::ImageHandle target) const {
  const gpu::Image& image = context.image(target);
  VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  color.imageView = image.view();
  color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.clearValue.color = {{0.0f, 0.0f, 0.0f, 0.0f}};
  const VkExtent2D extent{image.desc().width, image.desc().height};
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea.extent = extent;
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &color;
  const VkCommandBuffer cmd = context.cmd();
  vkCmdBeginRendering(cmd, &rendering);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(extent.width), static_cast<float>(extent.height), 0.0f, 1.0f};
  vkCmdSetViewport(cmd, 0, 1, &viewport);
  vkCmdSetCullMode(cmd, VK_CULL_MODE_NONE);
  vkCmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
  const ImDrawData* data = ImGui::GetDrawData();
  if (data && data->TotalVtxCount > 0) draw(context, *data);
  vkCmdEndRendering(cmd);
}

VkImageView Overlay::bind_texture(graph::PassContext& context, ImTextureID id,
                                  std::uint32_t& layer) const {
  const auto place = reinterpret_cast<std::uintptr_t>(id);
  layer = 0;
  if (place == 0) return font_.view();
  NERITIC_CHECK(place <= textures_.size(), "texture {} of {}", place, textures_.size());
  layer = textures_[place - 1].layer;
  return context.image(textures_[place - 1].image).view();
}

void Overlay::draw(graph::PassContext& context, const ImDrawData& data) const {
  gpu::Commands& commands = context.commands;
  const VkCommandBuffer cmd = context.cmd();
  const float width = data.DisplaySize.x, height = data.DisplaySize.y;
  const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    if (list.VtxBuffer.empty() || list.IdxBuffer.empty()) continue;
    const gpu::UploadSlice vertices = commands.upload(
        list.VtxBuffer.Data, list.VtxBuffer.size() * VkDeviceSize{sizeof(ImDrawVert)});
    const gpu::UploadSlice indices = commands.upload(
        list.IdxBuffer.Data, list.IdxBuffer.size() * VkDeviceSize{sizeof(ImDrawIdx)});
    vkCmdBindVertexBuffers(cmd, 0, 1, &vertices.buffer, &vertices.offset);
    vkCmdBindIndexBuffer(cmd, indices.buffer, indices.offset,
                         sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const auto left = static_cast<std::int32_t>(std::clamp(command.ClipRect.x, 0.0f, width));
      const auto top = static_cast<std::int32_t>(std::clamp(command.ClipRect.y, 0.0f, height));
      const auto right = static_cast<std::int32_t>(std::clamp(command.ClipRect.z, 0.0f, width));
      const auto bottom = static_cast<std::int32_t>(std::clamp(command.ClipRect.w, 0.0f, height));
      if (right <= left || bottom <= top || command.ElemCount == 0) continue;
      const VkRect2D scissor{
          {left, top},
          {static_cast<std::uint32_t>(right - left), static_cast<std::uint32_t>(bottom - top)}};
      vkCmdSetScissor(cmd, 0, 1, &scissor);
      shared::ImguiPush push{};
      push.clip_from_pixel = {2.0f / width, 2.0f / height};
      const VkImageView view = bind_texture(context, command.GetTexID(), push.layer);
      const std::vector<Run> runs = command.GetTexID() == nullptr
                                        ? runs_of(list, command, white)
                                        : std::vector<Run>{{0, command.ElemCount, false}};
      for (const Run& run : runs) {
        const gpu::Pipeline& pipeline = run.plain ? plain_ : pipeline_;
        commands.bind_pipeline(pipeline);
        commands.bind(pipeline,
                      {gpu::bound_texture(shared::kImguiTexture, view, sampler_.handle())});
        commands.push(pipeline, push);
        vkCmdDrawIndexed(cmd, run.count, 1, command.IdxOffset + run.first,
                         static_cast<std::int32_t>(command.VtxOffset), 0);
      }
    }
  }
}

InputClaims Overlay::claims() const {
  const ImGuiIO& io = ImGui::GetIO();
  return {.keys = io.WantTextInput, .mouse = io.WantCaptureMouse};
}

}  // namespace neritic::xr
