// The draws of one view set: instances that some view can see, and for rigid meshes the clusters
// that some view can see. Plain data made on the CPU.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/render/cluster_culling.hpp"
#include "engine/render/frame_state.hpp"
#include "engine/render/least_drawn.hpp"
#include "engine/render/views.hpp"

namespace neritic::render {

struct Draw {
  const GpuPrimitive* primitive = nullptr;
  std::uint32_t first_instance = 0, instance_count = 0;
  std::uint32_t first_range = 0, range_count = 0;  // of DrawList::ranges
  std::uint32_t deformed = kNone;                  // first vertex in the deformed stream
  bool mirrored = false;                           // negative determinant: front faces turn round
  bool hides_back_faces = false;  // closed, and every eye is outside: see closed_surface.hpp
  double order_m = 0.0;           // see nearness(); of blended ones the centre's distance
};

struct DrawList {
  std::vector<shared::Instance> instances;
  std::vector<shared::NextInstance> next_instances;  // empty without motion
  // Where each instance is drawn; empty where each is drawn as it is.
  std::vector<shared::NextInstance> drawn_instances;
  std::vector<DrawnLarger> larger;
  std::vector<IndexRange> ranges;
  std::vector<Draw> opaque;   // front to back
  std::vector<Draw> blended;  // back to front, one instance a draw
  bool clipped = false;       // at the plane of ViewSet::within
  // Heights of what is drawn, from the set's origin; everything where not all is bounded. Nothing
  // drawn: lowest_m is above highest_m.
  double lowest_m = std::numeric_limits<double>::infinity(),
         highest_m = -std::numeric_limits<double>::infinity();
  std::uint64_t triangles = 0;      // drawn
  std::uint64_t all_triangles = 0;  // of the scene's rigid and deforming meshes, every appearance
};

struct DrawListOptions {
  bool clusters = true;  // false: every instance whole, for comparison; no bit of a picture differs
  // Draws only front faces of closed meshes if every eye is outside: for views that otherwise draw
  // both sides (sonars). Pixels at outlines differ where rounding puts a back before its front.
  bool hide_back_faces = false;
  // Objects of this class are left out; 0: none are.
  std::uint16_t without_class = 0;
  // Objects smaller than this are drawn larger. A geometry G-buffer's only.
  std::optional<LeastDrawn> least_drawn = {};
  // Flags by object: those with 0 are left out. Empty: none is.
  std::span<const std::uint8_t> objects = {};
  // Meshes may be coarser where that moves nothing by more than so many pixels (see
  // scene::MeshLevel), and what is smaller than half of it is left out; 0: all are whole.
  double mesh_error_px = 0.0;
  // With mesh_error_px: what is narrower than so many pixels is left out too.
  double least_px = 0.0;
  // How many vertices of each FrameState::deforms are drawn, raised to what this list draws.
  // nullptr: nobody asks.
  std::vector<std::uint32_t>* deform_need = nullptr;
};

// Up to this many visible instances of a mesh with clusters are examined one by one, and each that
// loses enough triangles to the picture's edges is a draw of its own. More of them stay one draw:
// most are then wholly inside or small, and looking costs more than it saves.
inline constexpr std::size_t kMostSplitInstances = 256;

DrawList build_draw_list(const scene::Scene& scene, const GpuScene& gpu_scene,
                         const FrameState& state, const ViewSet& views,
                         const DrawListOptions& options = {});

}  // namespace neritic::render
