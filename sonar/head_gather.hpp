// One head of a sonar on the GPU: the gather of its own view, a gather of each mirror's view
// (ghosts), the receiver, and the buffers that bring the results to the host. A scene's sonars and
// images from files use it alike. Made once for settings that stay; rendering thread.
//
// A ping in a frame's graph is begin, then add_ghost for each mirror in turn, then end. After the
// frame is done on the GPU, image and label_energy read the ping's buffers.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/graph/frame_graph.hpp"
#include "sonar/gather.hpp"
#include "sonar/head.hpp"
#include "sonar/label_energy.hpp"
#include "sonar/ping.hpp"
#include "sonar/receiver.hpp"
#include "sonar/reference.hpp"

namespace neritic::sonar {

// Host-readable results of one ping; a buffer that the head does not need is empty.
struct HeadBuffers {
  gpu::Buffer sums, keys, power, records;
  std::vector<gpu::Buffer> ghost_records;  // a mirror
};

struct HeadDesc {
  scene::Sonar sonar;  // the settings that the head was planned from
  Head head;
  std::vector<Sector> sectors;
  GBufferLayout layout;
  GatherOptions options;  // without the echo, which is the head's
  std::vector<Mirror> mirrors;
};

// One ping of a head in a frame's graph. The passes borrow it until the graph has run.
struct HeadPing {
  std::string prefix;                 // of the names of passes and buffers
  const HeadBuffers* host = nullptr;  // where the host reads; nullptr: nothing is brought there
  PingState state;
  Ping ping;
  std::vector<Ping> ghosts;  // a mirror
  SonarGather::Inputs inputs;
  SonarGather::Outputs out;
  // [n_range][n_azimuth]: uint32 sums of the plain cosine, or with terms floats of power.
  graph::BufferHandle image;
};

// Passes borrow it: it stays where it is from begin until the graph has run.
class HeadGather {
 public:
  static Result<HeadGather> create(gpu::Device& device, HeadDesc desc);

  Result<HeadBuffers> make_buffers(gpu::Device& device, const std::string& name) const;

  // A view's images, and the head's axes (or its mirror image's) from the axes of their normals.
  struct View {
    graph::ImageHandle depth, normals, labels;
    Mat3 sonar_from_gbuffer{1.0};
  };
  // Reflectivity or backscatter by instance label; empty where the options name none.
  struct Table {
    graph::BufferHandle buffer;
    std::uint32_t size = 0;
    std::span<const float> strengths = {};  // SonarGather::Inputs'
    std::span<const shared::SonarDrawnLarger> larger = {};
  };
  // Adds the gather of the head's own view. ping: with prefix, host and state.
  void begin(graph::FrameGraph& graph, const View& view, const Table& table, HeadPing& ping);
  // Adds the next mirror's ghosts to the sums. prefix: of these passes.
  void add_ghost(graph::FrameGraph& graph, const View& view, const Table& table,
                 const std::string& prefix, HeadPing& ping);
  // Adds the receiver and, if there is a host, what brings the results to it.
  void end(graph::FrameGraph& graph, HeadPing& ping) const;

  // The results of a ping with a host, after its frame is done.
  SonarImage image(const HeadPing& ping) const;
  std::optional<LabelImage> label_energy(const HeadPing& ping) const;

  const Head& head() const { return desc_.head; }
  const SonarGather& gather() const { return gather_; }
  bool has_receiver() const { return receiver_.has_value(); }

 private:
  HeadGather(HeadDesc desc, SonarGather gather, bool in_place)
      : desc_(std::move(desc)), gather_(std::move(gather)), in_place_(in_place) {}
  bool keeps_records() const { return desc_.head.echo && desc_.head.echo->records; }
  HeadDesc desc_;
  SonarGather gather_;
  std::optional<SonarGather> ghost_gather_;  // where mirrors are named
  std::optional<Receiver> receiver_;         // where terms are named
  bool in_place_;                            // host memory is the device's own: no copies
  RangeCorrections corrections_;
  std::vector<RangeCorrections> ghost_corrections_;  // a mirror
};

}  // namespace neritic::sonar
