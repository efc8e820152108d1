// The sonar's receiver on the GPU: the integers of a gather with terms become a field, which is
// spread along range by the pulse and across beams by their pattern, meets noise and leaves as
// power. Only the passes that its description names are declared. Made once; rendering thread.
#pragma once

#include <string>
#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "shared/sonar_echo.h"

namespace neritic::sonar {

// A kernel: weights[k] is for the value at distance first + k. If each beam has a kernel, row b is
// beam b's.
struct Taps {
  int first = 0;
  std::vector<float> weights;  // [kernels][size]; empty: none, each value stays where it is
  std::uint32_t kernels = 1;
  std::uint32_t size() const { return static_cast<std::uint32_t>(weights.size()) / kernels; }
};

struct ReceiverDesc {
  std::uint32_t rows = 1, columns = 1;  // of the gather: range bins, columns
  std::uint32_t beams = 1, stride = 1;  // beam b's kernel is centred on column b * stride
  bool wrap = false;                    // a full turn
  bool coherent = false;                // sums are amplitudes, else powers
  bool noise = false;
  bool shift = false;  // bearings turn while the echo comes back
  double first_bearing_rad = 0.0, bearing_step_rad = 0.0;  // of the beams
  Taps range, across;                                      // amplitudes where coherent, else powers
  double sum_scale = 1.0;                                  // of the gather
};

class Receiver {
 public:
  static Result<Receiver> create(gpu::Device& device, ReceiverDesc desc);

  struct Ping {
    // A range bin: factor of the field (of amplitude where coherent, else of power), and of the
    // power after noise (time-varied gain). As long as rows; until the run.
    std::span<const glm::vec2> gains;
    float noise_power = 0.0f;          // mean, of a bin
    std::uint32_t seed = 0, ping = 0;  // of its noise
    float first_shift_columns = 0.0f, shift_columns_per_row = 0.0f;
    float shift_columns_right = 0.0f,
          shift_columns_back = 0.0f;  // by the way to starboard and back
  };
  // Adds PREFIX"sonar resolve", "sonar pulse", "sonar beams", "sonar receive". target: where the
  // power goes, float [rows][beams]; absent: a transient buffer.
  graph::BufferHandle declare(graph::FrameGraph& graph, graph::BufferHandle sums, const Ping& ping,
                              graph::BufferHandle target, const std::string& prefix) const;

  const ReceiverDesc& desc() const { return desc_; }
  std::uint64_t power_bytes() const {
    return std::uint64_t{desc_.rows} * desc_.beams * sizeof(float);
  }

 private:
  Receiver() = default;
  struct Field;
  graph::ImageHandle declare_spread(graph::FrameGraph& graph, const std::string& name,
                                    graph::ImageHandle field, bool across, const Ping& ping) const;
  graph::ImageHandle declare_resolve(graph::FrameGraph& graph, const std::string& prefix,
                                     graph::BufferHandle sums, const Ping& ping) const;
  graph::BufferHandle declare_receive(graph::FrameGraph& graph, const std::string& prefix,
                                      graph::ImageHandle field, const Ping& ping,
                                      graph::BufferHandle target) const;
  shared::SonarReceiverPush push(const Ping& ping) const;

  ReceiverDesc desc_;
  gpu::Pipeline resolve_, pulse_, beams_, receive_;
  gpu::Image range_taps_, across_taps_;
};

}  // namespace neritic::sonar
