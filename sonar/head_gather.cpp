#include "sonar/head_gather.hpp"

#include "engine/core/check.hpp"
#include "sonar/head_decode.hpp"

namespace neritic::sonar {

Result<HeadGather> HeadGather::create(gpu::Device& device, HeadDesc desc) {
  GatherOptions options = desc.options;
  options.echo = desc.head.echo;
  const auto gather = [&] {
    return SonarGather::create(device, desc.head.samples, desc.sectors, desc.layout, options);
  };
  NERITIC_TRY(SonarGather direct, gather());
  HeadGather made(std::move(desc), std::move(direct), device.info().shared_memory);
  const Head& head = made.desc_.head;
  if (!head.echo) return made;
  ReceiverDesc receiver = head.receiver;
  receiver.sum_scale = made.gather_.fixed_scale();
  NERITIC_TRY(made.receiver_, Receiver::create(device, std::move(receiver)));
  if (made.desc_.mirrors.empty()) return made;
  options.echo->ghost = true;
  options.echo->weights = ghost_weights(made.desc_.sonar, head);
  NERITIC_TRY(made.ghost_gather_, SonarGather::create(device, head.samples, made.desc_.sectors,
                                                      made.desc_.layout, options));
  made.ghost_corrections_.resize(made.desc_.mirrors.size());
  return made;
}

Result<HeadBuffers> HeadGather::make_buffers(gpu::Device& device, const std::string& name) const {
  HeadBuffers buffers;
  // A window keeps a copy of the power.
  constexpr VkBufferUsageFlags kPlain = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                        VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  const auto readable = [&](const std::string& of, std::uint64_t bytes, VkBufferUsageFlags usage) {
    return gpu::Buffer::create(device, {name + of, bytes, usage, gpu::MemoryUse::kReadback});
  };
  if (desc_.options.labels) {
    NERITIC_TRY(buffers.keys, readable("keys", gather_.keys_bytes(), gather_.sums_usage()));
  }
  if (!receiver_) {
    NERITIC_TRY(buffers.sums, readable("sums", gather_.sums_bytes(), gather_.sums_usage()));
    return buffers;
  }
  NERITIC_TRY(buffers.power, readable("power", receiver_->power_bytes(), kPlain));
  if (!keeps_records()) return buffers;
  NERITIC_TRY(buffers.records, readable("records", gather_.records_bytes(), kPlain));
  for (std::size_t i = 0; i < desc_.mirrors.size(); ++i) {
    NERITIC_TRY(gpu::Buffer ghosts,
                readable(fmt::format("ghost records {}", i), gather_.records_bytes(), kPlain));
    buffers.ghost_records.push_back(std::move(ghosts));
  }
  return buffers;
}

void HeadGather::begin(graph::FrameGraph& graph, const View& view, const Table& table,
                       HeadPing& ping) {
  SonarGather::Inputs& inputs = ping.inputs;
  inputs.prefix = ping.prefix;
  inputs.depth = view.depth;
  inputs.normals = view.normals;
  inputs.labels = view.labels;
  inputs.sonar_from_gbuffer = view.sonar_from_gbuffer;
  inputs.reflectivity = table.buffer;
  inputs.reflectivities = table.size;
  inputs.strengths = table.strengths;
  inputs.larger = table.larger;
  inputs.surface_m = surface_over_eye_m(ping.state);
  const auto target = [&](const gpu::Buffer& buffer, const char* name) {
    return buffer ? graph.import_buffer(ping.prefix + name, buffer) : graph::BufferHandle{};
  };
  if (ping.host && in_place_) {
    inputs.sums_target = target(ping.host->sums, "sums");
    inputs.keys_target = target(ping.host->keys, "keys");
  }
  if (ping.host) inputs.records_target = target(ping.host->records, "records");
  if (desc_.head.echo) {
    ping.state.corrections = &corrections_;
    ping.ping = ping_of(desc_.sonar, desc_.head, ping.state);
    inputs.echo = ping.ping.echo;
    inputs.correction = ping.ping.correction;
  }
  ping.out = gather_.declare(graph, inputs);
  if (inputs.records_target) graph.output(ping.out.records, graph::Access::kHostRead);
}

void HeadGather::add_ghost(graph::FrameGraph& graph, const View& view, const Table& table,
                           const std::string& prefix, HeadPing& ping) {
  const std::size_t i = ping.ghosts.size();
  NERITIC_CHECK(i < desc_.mirrors.size(), "ghosts of {} mirrors", desc_.mirrors.size());
  PingState state = ping.state;
  state.corrections = &ghost_corrections_[i];
  // The passes borrow spans of its vectors, which stay where they are when the ping itself moves.
  ping.ghosts.push_back(ping_of(desc_.sonar, desc_.head, state, &desc_.mirrors[i]));
  SonarGather::Inputs inputs = ping.inputs;
  inputs.prefix = prefix;
  inputs.depth = view.depth;
  inputs.normals = view.normals;
  inputs.labels = view.labels;
  inputs.sonar_from_gbuffer = view.sonar_from_gbuffer;
  inputs.reflectivity = table.buffer;
  inputs.reflectivities = table.size;
  inputs.strengths = table.strengths;
  inputs.larger = table.larger;
  inputs.surface_m = surface_over_eye_m(ping.state, &desc_.mirrors[i]);
  inputs.direct_depth = ping.inputs.depth;
  inputs.direct_labels = ping.inputs.labels;
  inputs.sums_so_far = ping.out.sums;
  inputs.keys_so_far = ping.out.keys;
  inputs.echo = ping.ghosts.back().echo;
  inputs.correction = ping.ghosts.back().correction;
  inputs.records_target = {};
  if (ping.host && i < ping.host->ghost_records.size())
    inputs.records_target = graph.import_buffer(prefix + "records", ping.host->ghost_records[i]);
  const SonarGather::Outputs added = ghost_gather_->declare(graph, inputs);
  if (inputs.records_target) graph.output(added.records, graph::Access::kHostRead);
  ping.out.sums = added.sums;
  ping.out.keys = added.keys;
}

void HeadGather::end(graph::FrameGraph& graph, HeadPing& ping) const {
  NERITIC_CHECK(ping.ghosts.size() == desc_.mirrors.size(), "{} ghosts of {} mirrors",
                ping.ghosts.size(), desc_.mirrors.size());
  ping.image = ping.out.sums;
  if (receiver_)
    ping.image =
        receiver_->declare(graph, ping.out.sums, ping.ping.receiver(),
                           ping.host ? graph.import_buffer(ping.prefix + "power", ping.host->power)
                                     : graph::BufferHandle{},
                           ping.prefix);
  if (!ping.host) return;
  const auto output = [&](graph::BufferHandle from, const gpu::Buffer& to, const char* name) {
    graph.output(in_place_ ? from
                           : graph::copy_buffer(graph, ping.prefix + name + " to host", from,
                                                ping.prefix + name, to),
                 graph::Access::kHostRead);
  };
  if (receiver_)
    graph.output(ping.image, graph::Access::kHostRead);
  else
    output(ping.out.sums, ping.host->sums, "sums");
  if (ping.host->keys) output(ping.out.keys, ping.host->keys, "keys");
}

SonarImage HeadGather::image(const HeadPing& ping) const {
  const auto keys = ping.host->keys.mapped<std::uint32_t>();
  if (!receiver_) {
    SonarImage image = gather_.to_image(ping.host->sums.mapped<std::uint32_t>(), keys);
    image.unclassed = any_unclassed(keys);
    return image;
  }
  const auto power = ping.host->power.mapped<float>();
  const Bins& bins = desc_.head.beams.bins;
  return {bins.range,
          bins.azimuth,
          {power.begin(), power.end()},
          beam_labels(desc_.head, keys),
          any_unclassed(keys)};
}

std::optional<LabelImage> HeadGather::label_energy(const HeadPing& ping) const {
  if (!keeps_records()) return {};
  std::vector<std::span<const shared::SonarRecord>> layers{
      ping.host->records.mapped<shared::SonarRecord>()};
  for (const gpu::Buffer& ghosts : ping.host->ghost_records)
    layers.push_back(ghosts.mapped<shared::SonarRecord>());
  return beam_energies(desc_.head, ping.ping, layers);
}

}  // namespace neritic::sonar
