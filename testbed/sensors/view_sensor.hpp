// A camera's or a view set's part of a frame's graph, and its images at the host. Private to
// testbed/sensors; rendering thread.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "engine/render/bubble_field.hpp"
#include "engine/render/caustic_waves.hpp"
#include "engine/render/particles.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/snow_field.hpp"
#include "testbed/sensors/frame_request.hpp"
#include "testbed/sensors/frame_result.hpp"
#include "testbed/sensors/readback.hpp"
#include "testbed/sensors/sensor_frame.hpp"
#include "testbed/sensors/skylight.hpp"
#include "testbed/sensors/sun_maps.hpp"

namespace neritic::testbed {

struct FrameParts;

// Light that all cameras of a frame share, declared with the first that needs it.
struct FrameLight {
  bool lamps_known = false;
  std::vector<render::ShadowMap> lamps;  // those with shadows
  graph::ImageHandle lamp_maps;
  // By texels a side; their levels are those of all views that use them.
  struct Net {
    shared::CausticsParams params{};
    graph::ImageHandle image;
  };
  std::map<std::uint32_t, Net> caustics;
  // render::still_hash of the frame.
  std::uint64_t still_of(const FrameParts& frame);

 private:
  std::optional<std::uint64_t> still_;
};

// Shared by all sensors of a frame while it is declared.
struct FrameParts {
  graph::FrameGraph& graph;
  gpu::Device& device;
  render::Renderer& renderer;
  const scene::Scene& scene;
  const render::GpuScene& gpu_scene;
  const scene::MotionSource& motion;
  const render::FrameState& state;
  const render::DeformedGeometry& deformed;
  ReadbackPool& readback;
  std::uint64_t seed = 0;  // of noise and speckle
  FrameLight& light;
  SunMaps& sun_maps;
  Skylight& skylight;
  // Flags by object: what may move, and its opposite.
  std::span<const std::uint8_t> moving, still;
  std::uint32_t frame = 0;  // the request's: noise follows from it
  // Vertices of each FrameState::deforms that some view draws (DrawListOptions).
  std::vector<std::uint32_t>& deform_need;
  render::SnowField& snow;
  render::BubbleField& bubbles;
  const SeaWaves& waves;  // of the surface; still where the scene names none
  render::FramePictures& pictures;
};

// A view set in one frame: data that the passes borrow, and the buffers that the host reads.
struct ViewsWork {
  render::ViewSet views;
  Capture capture;
  double mesh_error_px = 0.0;  // of its meshes, in its own pixels and in texels of its shadows
  std::string owner;           // unlike a view's name no two sets of a frame share it
  render::DrawList draws;
  // Where capture asks for arrays and shading has fewer pixels: the shading's own.
  render::ViewSet shaded_views;
  render::DrawList shaded_draws;
  std::vector<render::ViewSet> cascades;  // of the sun; empty where it throws no shadows
  std::vector<render::ShadowMap> still_maps, moving_maps;  // of them, drawn in this frame
  render::ViewParticles particles;                         // of the scene's water
  Readback depth, normal, label, color, motion, linear;    // empty where they were not asked for
  std::optional<CameraPicture> camera;
  Vec3f white{1.0f};                            // gains of the white balance
  std::vector<std::vector<InstanceBox>> boxes;  // a view
  bool at_host() const { return depth || normal || label || color || motion || linear; }
};

// Adds the passes of a view set. label: of errors, "camera NAME".
Result<SensorFrame::Views> declare_views(const FrameParts& frame, const std::string& label,
                                         const ViewsRequest& request, ViewsWork& work);
// The parts of a geometry or shape G-buffer that a capture needs.
render::GBufferParts parts_of(const Capture& capture);
// Declares the read-backs of a G-buffer's geometry, as work.capture asks.
Status bring_geometry(const FrameParts& frame, const std::string& prefix, const render::GBuffer& g,
                      ViewsWork& work);
// The images that were asked for, a view each, after the frame is done.
std::vector<ViewImages> decode_views(const ViewsWork& work);

}  // namespace neritic::testbed
