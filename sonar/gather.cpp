#include "sonar/gather.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "engine/gpu/device.hpp"

namespace neritic::sonar {
namespace {

// A surface that lies exactly on a bin's edge must not flicker between two rows by float rounding.
constexpr float kEdgeBias_bins = 1.0f / 1024.0f;

// Counts for intensity 1, a power of two: n_elevation of them fit 32 bits, and a float holds each.
double plain_scale(std::uint32_t n_elevation) {
  double scale = 0x1p20;
  while (scale * n_elevation >= 0x1p32) scale /= 2.0;
  return scale;
}

// Counts for amplitude 1: a bin's amplitudes fit 31 bits although each may be eight times as large
// by chance (the chance of more is below e^-64).
double amplitude_scale(std::uint32_t n_elevation) {
  double scale = 0x1p24;
  while (scale * n_elevation * 8.0 >= 0x1p31) scale /= 2.0;
  return scale;
}

double scale_for(const GatherOptions& options, std::uint32_t n_elevation) {
  if (!options.echo) return plain_scale(n_elevation);
  return options.echo->coherent ? amplitude_scale(n_elevation) : double(shared::kSonarRecordScale);
}

// For the frame graph's dump.
std::string names_of_terms(const GatherOptions& options) {
  std::string names = name_of(options.gather);
  const auto add = [&](bool on, const char* name) {
    if (on) names += std::string(", ") + name;
  };
  add(options.labels, "labels");
  add(options.reflectivity, "reflectivity");
  add(options.larger, "small targets");
  if (!options.echo) return names;
  const EchoOptions& echo = *options.echo;
  add(!echo.weights.empty(), "beam weights");
  add(echo.coherent, "speckle");
  add(!echo.gamma_quantiles.empty(), "texture");
  add(echo.corrected, echo.bent ? "sound speed profile, bent rays" : "sound speed profile");
  add(echo.moving, "motion");
  add(echo.records, "labels by energy");
  add(echo.ghost, "ghost");
  return names;
}

}  // namespace

const char* name_of(Gather gather) {
  switch (gather) {
    case Gather::kNearest:
      return "nearest";
    case Gather::kPlane:
      return "plane";
    case Gather::kPublished:
      return "published";
  }
  return "";
}

Result<Gather> gather_of(const std::string& name) {
  for (const Gather g : {Gather::kNearest, Gather::kPlane, Gather::kPublished})
    if (name == name_of(g)) return g;
  return refusal("gather", fmt::format("'{}'", name), "nearest, plane or published");
}

Status SonarGather::check(const gpu::Device& device) const {
  const VkPhysicalDeviceLimits& limits = device.limits();
  if (options_.gather == Gather::kPublished && options_.echo)
    return refusal("gather", "published with terms",
                   "plane or nearest (published is without terms)");
  NERITIC_CHECK(options_.gather != Gather::kPublished || layout_.lean == 0.0,
                "the published gather takes upright images");
  if (const std::uint64_t most = limits.maxStorageBufferRange; sums_bytes() > most) {
    const double part = static_cast<double>(most) / static_cast<double>(sums_bytes());
    const Limits& l = grid_.limits;
    return failure(
        ErrorCode::kUnsupported, "sonar image: {}",
        found_accepted(
            fmt::format("{} x {} bins, {} bytes", grid_.bins.range, grid_.bins.azimuth,
                        sums_bytes()),
            fmt::format("{} bytes on this device: at most {:.0f} range bins, or (with a quality) "
                        "range_m = [{:g}, {:.4g}], or fewer beams or samples of a beam",
                        most, std::floor(grid_.bins.range * part), l.range_min_m,
                        l.range_min_m + 0.99 * part * (l.range_max_m - l.range_min_m))));
  }
  if (options_.echo && options_.echo->records && records_bytes() > limits.maxStorageBufferRange) {
    const std::uint64_t most = limits.maxStorageBufferRange;
    const double part = static_cast<double>(most) / static_cast<double>(records_bytes());
    const Limits& l = grid_.limits;
    return failure(
        ErrorCode::kUnsupported, "sonar: labels.energy: {}",
        found_accepted(
            fmt::format("{} columns x {} bins of elevation, {} bytes", grid_.bins.azimuth,
                        grid_.bins.elevation, records_bytes()),
            fmt::format("{} bytes on this device: {:.1f} degrees of elevation_deg or {:.1f} of "
                        "azimuth_deg, a coarser quality, or no labels.energy",
                        most, std::floor(degrees(l.elevation_max_rad - l.elevation_min_rad) * part),
                        std::floor(degrees(l.azimuth_max_rad - l.azimuth_min_rad) * part))));
  }
  if (grid_.bins.elevation > limits.maxImageDimension2D)
    return failure(ErrorCode::kUnsupported, "sonar: {}",
                   found_accepted(fmt::format("{} bins of elevation", grid_.bins.elevation),
                                  fmt::format("{} on this device", limits.maxImageDimension2D)));
  return {};
}

Result<SonarGather> SonarGather::create(gpu::Device& device, const BeamGrid& grid,
                                        std::vector<Sector> sectors, const GBufferLayout& layout,
                                        const GatherOptions& options) {
  NERITIC_TRY_STATUS(validate(grid));
  SonarGather made;
  made.grid_ = grid;
  made.sectors_ = std::move(sectors);
  made.layout_ = layout;
  made.options_ = options;
  made.fixed_scale_ = scale_for(options, grid.bins.elevation);
  made.parts_ = gather_parts(made.grid_, made.sectors_, layout, options);
  NERITIC_TRY_STATUS(made.check(device));
  NERITIC_TRY_STATUS(made.make_pipeline(device));
  NERITIC_TRY_STATUS(made.make_tables(device));
  return made;
}

std::uint64_t SonarGather::keys_bytes() const {
  return std::uint64_t{grid_.bins.range} * grid_.bins.azimuth * sizeof(std::uint32_t);
}

VkBufferUsageFlags SonarGather::sums_usage() const {
  constexpr VkBufferUsageFlags kWords = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                        VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  return texels_ ? kWords | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT : kWords;
}

std::uint64_t SonarGather::sums_bytes() const {
  return keys_bytes() * (options_.echo ? 2 : 1);
}

std::uint64_t SonarGather::scratch_bytes() const {
  if (options_.echo && options_.echo->coherent) return sums_bytes();
  return options_.gather == Gather::kPublished ? keys_bytes() : 0;
}

std::uint64_t SonarGather::records_bytes() const {
  return std::uint64_t{grid_.bins.elevation} * grid_.bins.azimuth * sizeof(shared::SonarRecord);
}

std::vector<std::uint16_t> SonarGather::to_labels(std::span<const std::uint32_t> keys) const {
  std::vector<std::uint16_t> labels(std::size_t{grid_.bins.range} * grid_.bins.azimuth);
  // A key is the strength above, 65535 less the label below; 0: nothing was heard.
  for (std::size_t i = 0; i < labels.size() && i < keys.size(); ++i)
    labels[i] = keys[i] == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(~keys[i]);
  return labels;
}

SonarImage SonarGather::to_image(std::span<const std::uint32_t> sums,
                                 std::span<const std::uint32_t> keys) const {
  NERITIC_CHECK(!options_.echo, "the sums of a gather with terms go through a receiver");
  const std::size_t cells = std::size_t{grid_.bins.range} * grid_.bins.azimuth;
  SonarImage image{grid_.bins.range, grid_.bins.azimuth, {}, to_labels(keys)};
  image.intensity.resize(cells);
  const auto scale = static_cast<float>(image_scale());
  for (std::size_t i = 0; i < cells; ++i) image.intensity[i] = static_cast<float>(sums[i]) * scale;
  return image;
}

struct SonarGather::Pass {
  Inputs in;
  Outputs out;
  graph::BufferHandle scratch;
};

SonarGather::Outputs SonarGather::declare(graph::FrameGraph& graph, const Inputs& inputs) const {
  using graph::Access;
  NERITIC_CHECK(inputs.labels || (!options_.labels && !options_.reflectivity),
                "a gather with labels or reflectivities needs the label image");
  const bool ghost = options_.echo && options_.echo->ghost;
  NERITIC_CHECK(!ghost || (inputs.direct_depth && inputs.direct_labels),
                "ghosts need what the sonar itself sees");
  struct Cleared {
    graph::BufferHandle sums, keys, scratch;
  };
  const auto clear = [&]() -> const Cleared& {
    return graph.add_pass<Cleared>(
        inputs.prefix + "sonar clear",
        [&](graph::PassBuilder& builder, Cleared& pass) {
          const auto make = [&](graph::BufferHandle target, const char* name, std::uint64_t bytes) {
            return builder.write(
                target ? target : builder.create_buffer(inputs.prefix + name, bytes),
                Access::kTransferWrite);
          };
          if (!inputs.sums_so_far) {
            pass.sums = make(inputs.sums_target, "sonar sums", sums_bytes());
            if (options_.labels) pass.keys = make(inputs.keys_target, "sonar keys", keys_bytes());
          }
          if (scratch_bytes() > 0) pass.scratch = make({}, "sonar scratch", scratch_bytes());
        },
        [](const Cleared& pass, graph::PassContext& context) {
          for (const graph::BufferHandle buffer : {pass.sums, pass.keys, pass.scratch})
            if (buffer)
              vkCmdFillBuffer(context.cmd(), context.buffer(buffer).handle(), 0, VK_WHOLE_SIZE, 0);
        });
  };
  Cleared cleared;
  if (!inputs.sums_so_far || scratch_bytes() > 0) cleared = clear();
  if (inputs.sums_so_far) {
    cleared.sums = inputs.sums_so_far;
    cleared.keys = inputs.keys_so_far;
  }
  const Access words_access = texels_ ? Access::kTexelWriteCompute : Access::kStorageWriteCompute;
  const auto setup = [&](graph::PassBuilder& builder, Pass& pass) {
    builder.terms(names_of_terms(options_));
    pass.in = inputs;
    pass.in.echo.sum_scale = static_cast<float>(fixed_scale_);
    if (!layout_.packed) builder.read(inputs.depth, Access::kSampledCompute);
    builder.read(inputs.normals, Access::kSampledCompute);
    for (const graph::ImageHandle image :
         {inputs.labels, inputs.direct_depth, inputs.direct_labels})
      if (image) builder.read(image, Access::kSampledCompute);
    if (inputs.reflectivity) builder.read(inputs.reflectivity, Access::kStorageReadCompute);
    pass.out.sums = builder.write(cleared.sums, words_access);
    if (cleared.keys) pass.out.keys = builder.write(cleared.keys, words_access);
    if (cleared.scratch) pass.scratch = builder.write(cleared.scratch, words_access);
    if (options_.echo && options_.echo->records)
      pass.out.records = builder.write(
          inputs.records_target
              ? inputs.records_target
              : builder.create_buffer(inputs.prefix + "sonar records", records_bytes()),
          Access::kStorageWriteCompute);
  };
  return graph
      .add_pass<Pass>(
          inputs.prefix + "sonar gather", setup,
          [this](const Pass& pass, graph::PassContext& context) { record(pass, context); })
      .out;
}

void SonarGather::record(const Pass& pass, graph::PassContext& context) const {
  gpu::Commands& commands = context.commands;
  const auto columns = column_table(grid_, sectors_, layout_, pass.in.sonar_from_gbuffer);
  const gpu::UploadSlice column_slice =
      commands.upload(std::span<const shared::SonarColumn>(columns));
  const bool reflects = options_.reflectivity && pass.in.labels &&
                        (pass.in.reflectivity || !pass.in.strengths.empty());
  const auto buffer_or_none = [&](graph::BufferHandle handle) {
    return handle ? context.buffer(handle).handle() : no_buffer_.handle();
  };
  const auto texels_or_none = [&](graph::BufferHandle handle) {
    return handle && texels_ ? context.buffer(handle).texels() : no_buffer_.texels();
  };
  const auto words_or_none = [&](graph::BufferHandle handle) {
    return buffer_or_none(texels_ ? graph::BufferHandle{} : handle);
  };
  const gpu::UploadSlice table =
      pass.in.strengths.empty()
          ? gpu::UploadSlice{buffer_or_none(pass.in.reflectivity), 0, VK_WHOLE_SIZE}
          : commands.upload(pass.in.strengths);
  // A buffer of its own even where nothing is drawn larger: no_buffer_ stands for written ones too.
  const shared::SonarDrawnLarger nothing{};
  const gpu::UploadSlice larger = pass.in.larger.empty() ? commands.upload(&nothing, sizeof nothing)
                                                         : commands.upload(pass.in.larger);
  const Intrinsics& k = layout_.intrinsics;
  shared::SonarPush push{
      .n_range = grid_.bins.range,
      .n_azimuth = grid_.bins.azimuth,
      .n_elevation = grid_.bins.elevation,
      .width = layout_.width,
      .height = layout_.height,
      .fx = static_cast<float>(k.fx),
      .fy = static_cast<float>(k.fy),
      .cx = static_cast<float>(k.cx),
      .cy = static_cast<float>(k.cy),
      .near_m = static_cast<float>(layout_.near_m),
      .range_min_m = static_cast<float>(grid_.limits.range_min_m),
      .bins_per_m = static_cast<float>(1.0 / grid_.range_step_m()),
      .bin_m = static_cast<float>(grid_.range_step_m()),
      .fixed_scale = static_cast<float>(fixed_scale_),
      .edge_bias_bins = kEdgeBias_bins,
      .reflectivities = !reflects ? 0u
                        : pass.in.strengths.empty()
                            ? pass.in.reflectivities
                            : static_cast<std::uint32_t>(pass.in.strengths.size()),
      .lean = static_cast<float>(layout_.lean),
      .azimuth_step_rad = static_cast<float>(grid_.azimuth_step_rad()),
      .drawn_larger = static_cast<std::uint32_t>(pass.in.larger.size()),
      .surface_m = static_cast<float>(pass.in.surface_m)};
  const graph::ImageHandle depth = layout_.packed ? pass.in.normals : pass.in.depth;
  std::vector<gpu::BoundResource> bound{
      gpu::bound_buffer(shared::kSonarBindColumns, column_slice.buffer, column_slice.offset,
                        column_slice.size),
      gpu::bound_texel_image(shared::kSonarBindRows, rows_.view()),
      gpu::bound_texel_image(shared::kSonarBindDepth, context.image(depth).view()),
      gpu::bound_texel_image(shared::kSonarBindNormal, context.image(pass.in.normals).view()),
      gpu::bound_texel_image(shared::kSonarBindLabel, pass.in.labels
                                                          ? context.image(pass.in.labels).view()
                                                          : no_labels_.view()),
      gpu::bound_buffer(shared::kSonarBindReflectivity, table.buffer, table.offset, table.size),
      gpu::bound_buffer(shared::kSonarBindSums, words_or_none(pass.out.sums)),
      gpu::bound_buffer(shared::kSonarBindKeys, words_or_none(pass.out.keys)),
      gpu::bound_buffer(shared::kSonarBindScratch, words_or_none(pass.scratch)),
      gpu::bound_texel_buffer(shared::kSonarBindSumTexels, texels_or_none(pass.out.sums)),
      gpu::bound_texel_buffer(shared::kSonarBindKeyTexels, texels_or_none(pass.out.keys)),
      gpu::bound_texel_buffer(shared::kSonarBindScratchTexels, texels_or_none(pass.scratch)),
      gpu::bound_buffer(shared::kSonarBindLarger, larger.buffer, larger.offset, larger.size)};
  if (options_.echo) {
    const gpu::UploadSlice echo = commands.upload(&pass.in.echo, sizeof pass.in.echo);
    const gpu::UploadSlice correction =
        options_.echo->corrected ? commands.upload(pass.in.correction)
                                 : gpu::UploadSlice{no_buffer_.handle(), 0, VK_WHOLE_SIZE};
    const auto image_or_rows = [&](const gpu::Image& image) {
      return image.handle() ? image.view() : rows_.view();
    };
    bound.insert(
        bound.end(),
        {gpu::bound_buffer(shared::kSonarBindEcho, echo.buffer, echo.offset, echo.size),
         gpu::bound_texel_image(shared::kSonarBindWeights, image_or_rows(weights_)),
         gpu::bound_buffer(shared::kSonarBindCorrection, correction.buffer, correction.offset,
                           correction.size),
         gpu::bound_texel_image(shared::kSonarBindTexture, image_or_rows(gamma_quantiles_)),
         gpu::bound_buffer(shared::kSonarBindRecords, buffer_or_none(pass.out.records)),
         gpu::bound_texel_image(
             shared::kSonarBindDirectDepth,
             context.image(pass.in.direct_depth ? pass.in.direct_depth : depth).view()),
         gpu::bound_texel_image(shared::kSonarBindDirectLabel,
                                pass.in.direct_labels ? context.image(pass.in.direct_labels).view()
                                                      : no_labels_.view())});
  }
  commands.bind_pipeline(pipeline_);
  commands.bind(pipeline_, bound);
  for (const GatherPart& part : parts_) {
    if (&part != &parts_.front()) commands.wait_for_dispatch();
    push.first_row = part.first_row;
    push.end_row = part.end_row;
    push.first_v = part.first_v;
    push.end_v = part.end_v;
    commands.push(pipeline_, push);
    commands.dispatch(groups_);
  }
}

}  // namespace neritic::sonar
