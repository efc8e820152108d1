// Dear ImGui on this engine: reads a window's input and draws what was asked for between begin and
// declare into a panel's image, by one pass of the frame graph. Images of the frame (a sonar's) are
// textures like any other. One at a time, since ImGui keeps one context. Rendering thread.
#pragma once

#include <imgui.h>

#include <memory>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/xr/desktop/window.hpp"
#include "engine/xr/display.hpp"

namespace neritic::xr {

class Overlay {
 public:
  // window: whose input it reads; nullptr: none. scale: the least of text and panels.
  static Result<std::unique_ptr<Overlay>> create(gpu::Device& device, Window* window, float scale);
  ~Overlay();

  // Scales text and panels for pictures of that height: twice as large on 2160 pixels as on 1080.
  // Waits for the GPU when the scale changes.
  Status fit(std::uint32_t height);
  // Starts a frame of that many pixels; ImGui calls may follow. The frame before, if it was not
  // declared, is dropped.
  void begin(std::uint32_t width, std::uint32_t height, double elapsed_s);
  // An image of this frame's graph for ImGui to draw with (sRGB-encoded values, a 2D array as all
  // of the graph's images). Valid until declare's pass has run.
  ImTextureID texture(graph::ImageHandle image, std::uint32_t layer = 0);
  // Ends ImGui's frame and declares the pass that draws it: RGBA8 of the size given to begin,
  // colour multiplied by alpha, clear where ImGui drew nothing.
  graph::ImageHandle declare(graph::FrameGraph& graph);
  // Rectangles that hold all that was drawn; after declare.
  const std::vector<PanelPart>& drawn() const { return drawn_; }

  // The input devices that ImGui's panels use now.
  InputClaims claims() const;
  float scale() const { return scale_; }

 private:
  struct Texture {
    graph::ImageHandle image;
    std::uint32_t layer = 0;
  };
  explicit Overlay(gpu::Device& device) : device_(device) {}
  Status create_font();
  Status create_pipelines();
  void drop_frame();
  void record(graph::PassContext& context, graph::ImageHandle target) const;
  void draw(graph::PassContext& context, const ImDrawData& data) const;
  VkImageView bind_texture(graph::PassContext& context, ImTextureID id, std::uint32_t& layer) const;

  gpu::Device& device_;
  ImGuiContext* context_ = nullptr;
  bool glfw_ = false;
  bool begun_ = false;  // a frame, not declared yet
  float least_scale_ = 1.0f, scale_ = 1.0f;
  std::uint32_t width_ = 1, height_ = 1;  // of this frame
  gpu::Image font_;
  gpu::Sampler sampler_;
  gpu::Pipeline pipeline_, plain_;  // plain: triangles of one colour
  std::vector<PanelPart> drawn_;
  std::vector<Texture> textures_;  // of this frame; ImTextureID is its place plus one, 0: the font
};

}  // namespace neritic::xr
