// The sonar on the GPU: one compute pass that gathers per beam from a G-buffer and sums into range
// bins with integers, so that the same input gives the same bits in any order. Declared into a
// frame graph each frame; made once. Rendering thread.
//
// Two shaders: the plain cosine (one 32-bit sum a bin), and, where GatherOptions::echo is there,
// the gather with terms (two integers a bin: a 64-bit power, or a complex amplitude).
//
// Precision: a plain intensity is rounded to 1 / fixed_scale() (2^-20 for up to 4096 elevation
// bins, so that their sum cannot overflow 32 bits), which moves a cell of the image by at most half
// of that. With terms a power is rounded to 2^-28, an amplitude to 1 / fixed_scale() (2^-19 for 512
// elevation bins).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/intrinsics.hpp"
#include "engine/graph/frame_graph.hpp"
#include "shared/sonar.h"
#include "shared/sonar_echo.h"
#include "sonar/beam_grid.hpp"
#include "sonar/reference.hpp"

namespace neritic::sonar {

enum class Gather {
  kNearest,    // the range of the pixel that the beam hits
  kPlane,      // the beam meets the plane through that pixel's point and normal
  kPublished,  // every pixel of the cell, the last of a range bin wins: Algorithm 1 turned round
};
const char* name_of(Gather gather);
// "nearest", "plane", "published"; kBadInput names the others.
Result<Gather> gather_of(const std::string& name);

// How the images that a gather reads are stored. All sectors have one size and one pinhole.
struct GBufferLayout {
  std::uint32_t width = 1, height = 1;
  Intrinsics intrinsics;
  // One image of four floats: unit normal x, y, z and planar metres. Else two: reversed-Z depth,
  // near_m / planar metres, and octahedral R16G16_SNORM normals. One fetch is cheaper than two.
  bool packed = false;
  double near_m = 0.02;
  bool normals_face_sensor = true;
  // Not 0: the images' sides lean so (render::ViewDesc::lean), and beams look all over their
  // columns' width. Plane and nearest only.
  double lean = 0.0;
};

// The terms of a gather beyond the plain cosine; each costs only where it is named.
struct EchoOptions {
  bool coherent = false;               // sum the world's scatterers as complex amplitudes (speckle)
  bool corrected = false;              // a table of range factors will be given
  bool bent = false;                   // and, after it, one of where rays leave; takes weights
  bool moving = false;                 // ranges change by motion within the ping or Doppler
  bool records = false;                // keep what each beam returned
  bool ghost = false;                  // the view is from the sonar's mirror image
  std::vector<float> weights;          // [n_elevation][n_azimuth], 0 to 1; empty: all 1
  std::vector<float> gamma_quantiles;  // of a texture of mean 1; empty: none
};

// How a device's threads share the work. The bits are the same.
struct GatherThreads {
  // A workgroup a column whose threads add by atomics (graphics hardware), or a thread a column
  // (processors). Absent: what suits the device.
  std::optional<bool> atomics;
  // A thread a column sums into texel buffers if the device's are large enough: processors are
  // faster at it.
  bool texels = true;
};

struct GatherOptions {
  Gather gather = Gather::kPlane;
  bool labels = true;        // keep the class of each cell's strongest return
  bool reflectivity = true;  // a table by instance label will be given
  // Some instances may be drawn larger than they are: where Inputs::strengths has less than 0.
  bool larger = false;
  GatherThreads threads;
  std::optional<EchoOptions> echo;
};

// One dispatch gathers these rows of cells, and (published) these rows of pixels of them.
struct GatherPart {
  std::uint32_t first_row = 0, end_row = 0, first_v = 0, end_v = 0;
};

class SonarGather {
 public:
  // kUnsupported where the device's limits do not allow it.
  static Result<SonarGather> create(gpu::Device& device, const BeamGrid& grid,
                                    std::vector<Sector> sectors, const GBufferLayout& layout,
                                    const GatherOptions& options);

  struct Inputs {
    graph::ImageHandle depth, normals;  // packed: no depth
    graph::ImageHandle labels;          // R16G16_UINT class, instance; may be absent
    graph::BufferHandle reflectivity;   // floats by instance label; may be absent
    std::uint32_t reflectivities = 0;
    // Instead of that table, until the run. An instance that is drawn larger than it is has a
    // negative value, whose size is the strength a sample.
    std::span<const float> strengths = {};
    // The water's surface over the eye, m along the y of the normals' axes: what lies above it does
    // not echo.
    double surface_m = 1e30;
    // Where those instances are, until the run; by ascending labels.
    std::span<const shared::SonarDrawnLarger> larger = {};
    // Ghosts: what the sonar itself sees, of the same sizes; CHECKed to be there.
    graph::ImageHandle direct_depth, direct_labels;
    // Sonar axes from the axes that the normals are in (world axes of a scene's G-buffer).
    Mat3 sonar_from_gbuffer{1.0};
    // Where to write; absent: transient buffers of the frame. An imported host-readable buffer
    // saves a copy on devices that share memory with the host (DeviceInfo::shared_memory);
    // elsewhere every sum would cross the bus.
    graph::BufferHandle sums_target, keys_target, records_target;
    // Sums, keys and nothing else of an earlier gather of this frame: this one adds to them.
    graph::BufferHandle sums_so_far, keys_so_far;
    shared::SonarEcho echo{};  // with terms: of this ping; sum_scale is filled in
    std::span<const float> correction =
        {};  // [correction_height][correction_width], until the run; of bent rays twice
    std::string prefix = "";  // of the names of passes and transients: which sonar's they are
  };
  struct Outputs {
    graph::BufferHandle sums;     // uint32 [n_range][n_azimuth], with terms two each
    graph::BufferHandle keys;     // uint32 [n_range][n_azimuth]; absent without labels
    graph::BufferHandle records;  // shared::SonarRecord [n_elevation][n_azimuth]; absent without
  };
  // Adds the passes PREFIX"sonar clear" and PREFIX"sonar gather". The object must outlive the
  // graph's run.
  Outputs declare(graph::FrameGraph& graph, const Inputs& inputs) const;

  // Usage of a buffer that is a target of sums or keys.
  VkBufferUsageFlags sums_usage() const;
  std::uint64_t sums_bytes() const;
  std::uint64_t keys_bytes() const;
  std::uint64_t records_bytes() const;
  // Outputs of a plain gather as read back, to an image. keys may be empty.
  SonarImage to_image(std::span<const std::uint32_t> sums,
                      std::span<const std::uint32_t> keys) const;
  // Class of each cell's strongest return; 0: nothing was heard.
  std::vector<std::uint16_t> to_labels(std::span<const std::uint32_t> keys) const;
  double image_scale() const { return 1.0 / (fixed_scale_ * grid_.bins.elevation); }
  double fixed_scale() const { return fixed_scale_; }
  const BeamGrid& grid() const { return grid_; }
  const std::vector<Sector>& sectors() const { return sectors_; }
  const GBufferLayout& layout() const { return layout_; }

 private:
  struct Pass;
  SonarGather() = default;
  Status check(const gpu::Device& device) const;
  Status make_pipeline(gpu::Device& device);
  Status make_tables(gpu::Device& device);
  std::uint64_t scratch_bytes() const;
  void record(const Pass& pass, graph::PassContext& context) const;

  BeamGrid grid_;
  std::vector<Sector> sectors_;
  GBufferLayout layout_;
  GatherOptions options_;
  std::vector<GatherPart> parts_;
  std::uint32_t groups_ = 1;
  double fixed_scale_ = 1.0;
  bool texels_ = false;  // sums, keys and scratch are texel buffers
  gpu::Pipeline pipeline_;
  gpu::Image rows_, no_labels_, weights_, gamma_quantiles_;
  gpu::Buffer no_buffer_;
};

// How a gather treats the ranges that a row's height spans (kSonarFootprint...): it shares
// counts out over them, so that a surface at grazing is no comb of single bins, and tells records
// of beams the span. Where a row may be wider than a range bin (its arc at the farthest range) the
// span ends where the neighbouring rows' begin. For the plane gather only: the others do not know
// the surface.
std::uint32_t footprint_of(const BeamGrid& grid, const GatherOptions& options);

// The parts that a gather takes, in turn: one, but for large images and very many bins.
std::vector<GatherPart> gather_parts(const BeamGrid& grid, std::span<const Sector> sectors,
                                     const GBufferLayout& layout, const GatherOptions& options);

// The tables of the pass, for tests. Columns depend on where the normals' axes are.
std::vector<shared::SonarColumn> column_table(const BeamGrid& grid, std::span<const Sector> sectors,
                                              const GBufferLayout& layout,
                                              const Mat3& sonar_from_gbuffer);
// tan and 1 / cos of the centre, tan of the lower and upper edge.
std::vector<glm::vec4> row_table(const BeamGrid& grid);

}  // namespace neritic::sonar
