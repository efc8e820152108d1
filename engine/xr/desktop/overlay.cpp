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

bool meet(const PanelPart& a, const PanelPart& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

PanelPart around(const PanelPart& a, const PanelPart& b) {
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right),
          std::max(a.bottom, b.bottom)};
}

// Adds a part to disjoint ones; those that meet become one.
void add_part(std::vector<PanelPart>& parts, PanelPart part) {
  for (auto met = parts.begin(); met != parts.end();) {
    if (meet(*met, part)) {
      part = around(*met, part);
      parts.erase(met);
      met = parts.begin();
    } else {
      ++met;
    }
  }
  parts.push_back(part);
}

// In whole pixels: the vertices of each command, within what it is clipped to.
std::vector<PanelPart> drawn_parts(const ImDrawData& data) {
  const float width = data.DisplaySize.x, height = data.DisplaySize.y;
  std::vector<PanelPart> parts;
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      ImVec2 least(width, height), most(0.0f, 0.0f);
      for (unsigned int i = 0; i < command.ElemCount; ++i) {
        const ImDrawIdx index = list.IdxBuffer[static_cast<int>(command.IdxOffset + i)];
        const ImVec2 at = list.VtxBuffer[static_cast<int>(command.VtxOffset + index)].pos;
        least = {std::min(least.x, at.x), std::min(least.y, at.y)};
        most = {std::max(most.x, at.x), std::max(most.y, at.y)};
      }
      const float left = std::floor(std::max({least.x, command.ClipRect.x, 0.0f}));
      const float top = std::floor(std::max({least.y, command.ClipRect.y, 0.0f}));
      const float right = std::ceil(std::min({most.x, command.ClipRect.z, width}));
      const float bottom = std::ceil(std::min({most.y, command.ClipRect.w, height}));
      if (left < right && top < bottom)
        add_part(parts, {left / width, top / height, right / width, bottom / height});
    }
  }
  return parts;
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
  NERITIC_TRY_STATUS(overlay->create_pipeline());
  return overlay;
}

Status Overlay::fit(std::uint32_t height) {
  const float wanted = std::round(static_cast<float>(height) / kHeightOfScale1_px);
  const float scale = std::max(least_scale_, wanted);
  if (scale == scale_) return {};
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

Status Overlay::create_pipeline() {
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
  return {};
}

void Overlay::begin(std::uint32_t width, std::uint32_t height, double elapsed_s) {
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
}

ImTextureID Overlay::texture(graph::ImageHandle image, std::uint32_t layer) {
  textures_.push_back({image, layer});
  return reinterpret_cast<ImTextureID>(textures_.size());
}

graph::ImageHandle Overlay::declare(graph::FrameGraph& graph) {
  ImGui::Render();
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
  commands.bind_pipeline(pipeline_);
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
      commands.bind(pipeline_,
                    {gpu::bound_texture(shared::kImguiTexture, view, sampler_.handle())});
      commands.push(pipeline_, push);
      vkCmdDrawIndexed(cmd, command.ElemCount, 1, command.IdxOffset,
                       static_cast<std::int32_t>(command.VtxOffset), 0);
    }
  }
}

InputClaims Overlay::claims() const {
  const ImGuiIO& io = ImGui::GetIO();
  return {.keys = io.WantTextInput, .mouse = io.WantCaptureMouse};
}

}  // namespace neritic::xr
