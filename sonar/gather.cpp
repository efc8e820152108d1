#include "sonar/gather.hpp"

#include <algorithm>
#include <array>

#include "engine/core/check.hpp"
#include "engine/gpu/device.hpp"
#include "shaders.hpp"

namespace neritic::sonar {
namespace {

// A surface that lies exactly on a bin's edge must not flicker between two rows by float rounding.
constexpr float kEdgeBias_bins = 1.0f / 1024.0f;

// Counts for intensity 1, a power of two: n_elevation of them fit 32 bits, and a float holds each.
double fixed_scale_for(std::uint32_t n_elevation) {
  double scale = 0x1p20;
  while (scale * n_elevation >= 0x1p32) scale /= 2.0;
  return scale;
}

constexpr std::array<gpu::BindingDesc, 9> kBindings{
    {{shared::kSonarBindColumns, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindRows, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindNormal, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindLabel, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindReflectivity, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindSums, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindKeys, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindStamps, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}}};

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
  return bad_input("gather: '{}' found, nearest, plane or published is accepted", name);
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
  made.fixed_scale_ = fixed_scale_for(grid.bins.elevation);
  const VkPhysicalDeviceLimits& limits = device.limits();
  if (made.buffer_bytes() > limits.maxStorageBufferRange)
    return failure(ErrorCode::kUnsupported,
                   "sonar image of {} x {} bins: {} bytes, the device allows {}", grid.bins.range,
                   grid.bins.azimuth, made.buffer_bytes(), limits.maxStorageBufferRange);
  if (grid.bins.elevation > limits.maxImageDimension2D)
    return failure(ErrorCode::kUnsupported, "sonar of {} bins of elevation: the device allows {}",
                   grid.bins.elevation, limits.maxImageDimension2D);

  // A processor runs a workgroup on one core, eight columns to a vector, each lane owning its
  // column: no atomics. Graphics hardware wants many threads: a workgroup a column, its rows shared
  // out.
  const bool published = options.gather == Gather::kPublished;
  const bool own_columns = published || !options.atomics.value_or(device.info().kind != "CPU");
  const std::uint32_t columns = own_columns ? 8 : 1, lanes = own_columns ? 1 : 64;
  made.groups_ = (grid.bins.azimuth + columns - 1) / columns;

  gpu::ComputePipelineDesc desc;
  desc.name = std::string("sonar gather ") + name_of(options.gather);
  desc.code = published ? shaders::kSonarPublishedComp : shaders::kSonarGatherComp;
  desc.layout.bindings.assign(kBindings.begin(), kBindings.end());
  desc.layout.push_constant_bytes = sizeof(shared::SonarPush);
  desc.constants = {{shared::kSonarSpecColumns, columns},
                    {shared::kSonarSpecLanes, lanes},
                    {shared::kSonarSpecPlane, options.gather == Gather::kPlane},
                    {shared::kSonarSpecReversedZ, layout.reversed_z},
                    {shared::kSonarSpecOctahedral, layout.octahedral},
                    {shared::kSonarSpecFacing, layout.normals_face_sensor},
                    {shared::kSonarSpecReflect, options.reflectivity},
                    {shared::kSonarSpecLabels, options.labels}};
  NERITIC_TRY(made.pipeline_, gpu::Pipeline::create(device, desc));

  const auto texels = [&](const char* what, VkFormat format, std::uint32_t width, bool array,
                          std::span<const std::byte> bytes) -> Result<gpu::Image> {
    NERITIC_TRY(gpu::Image image,
                gpu::Image::create(
                    device, {.name = what,
                             .format = format,
                             .width = width,
                             .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                             .array_view = array}));
    NERITIC_TRY_STATUS(gpu::upload_image(device, image, bytes));
    return image;
  };
  const auto rows = row_table(grid);
  NERITIC_TRY(made.rows_, texels("sonar rows", VK_FORMAT_R32G32B32A32_SFLOAT, grid.bins.elevation,
                                 false, std::as_bytes(std::span(rows))));
  // What is bound where a scene has no labels or no reflectivities.
  const std::array<std::byte, 4> zero{};
  NERITIC_TRY(made.no_labels_, texels("sonar no labels", VK_FORMAT_R16G16_UINT, 1, true, zero));
  NERITIC_TRY(made.no_buffer_,
              gpu::Buffer::create(device, {.name = "sonar no buffer",
                                           .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
  return made;
}

std::uint64_t SonarGather::buffer_bytes() const {
  return std::uint64_t{grid_.bins.range} * grid_.bins.azimuth * sizeof(std::uint32_t);
}

SonarImage SonarGather::to_image(std::span<const std::uint32_t> sums,
                                 std::span<const std::uint32_t> keys) const {
  const std::size_t cells = std::size_t{grid_.bins.range} * grid_.bins.azimuth;
  SonarImage image{grid_.bins.range, grid_.bins.azimuth, {}, {}};
  image.intensity.resize(cells);
  image.labels.resize(cells);
  const auto scale = static_cast<float>(image_scale());
  for (std::size_t i = 0; i < cells; ++i) image.intensity[i] = static_cast<float>(sums[i]) * scale;
  // A key is the strength above, 65535 less the label below; 0: nothing was heard.
  if (!keys.empty())
    for (std::size_t i = 0; i < cells; ++i)
      image.labels[i] = keys[i] == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(~keys[i]);
  return image;
}

struct SonarGather::Pass {
  Inputs in;
  Outputs out;
  graph::BufferHandle stamps;
};

SonarGather::Outputs SonarGather::declare(graph::FrameGraph& graph, const Inputs& inputs) const {
  using graph::Access;
  NERITIC_CHECK(inputs.labels || (!options_.labels && !options_.reflectivity),
                "a gather with labels or reflectivities needs the label image");
  struct Cleared {
    graph::BufferHandle sums, keys, stamps;
  };
  const Cleared& cleared = graph.add_pass<Cleared>(
      inputs.prefix + "sonar clear",
      [&](graph::PassBuilder& builder, Cleared& pass) {
        const auto make = [&](graph::BufferHandle target, const char* name) {
          return builder.write(target ? target : builder.create_buffer(inputs.prefix + name, buffer_bytes()),
                               Access::kTransferWrite);
        };
        pass.sums = make(inputs.sums_target, "sonar sums");
        if (options_.labels) pass.keys = make(inputs.keys_target, "sonar keys");
        if (options_.gather == Gather::kPublished) pass.stamps = make({}, "sonar stamps");
      },
      [](const Cleared& pass, graph::PassContext& context) {
        for (const graph::BufferHandle buffer : {pass.sums, pass.keys, pass.stamps})
          if (buffer)
            vkCmdFillBuffer(context.cmd(), context.buffer(buffer).handle(), 0, VK_WHOLE_SIZE, 0);
      });
  const auto setup = [&](graph::PassBuilder& builder, Pass& pass) {
    pass.in = inputs;
    builder.read(inputs.depth, Access::kSampledCompute);
    builder.read(inputs.normals, Access::kSampledCompute);
    if (inputs.labels) builder.read(inputs.labels, Access::kSampledCompute);
    if (inputs.reflectivity) builder.read(inputs.reflectivity, Access::kStorageReadCompute);
    pass.out.sums = builder.write(cleared.sums, Access::kStorageWriteCompute);
    if (cleared.keys) pass.out.keys = builder.write(cleared.keys, Access::kStorageWriteCompute);
    if (cleared.stamps) pass.stamps = builder.write(cleared.stamps, Access::kStorageWriteCompute);
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
  const bool reflects = options_.reflectivity && pass.in.labels && pass.in.reflectivity;
  const auto buffer_or_none = [&](graph::BufferHandle handle) {
    return handle ? context.buffer(handle).handle() : no_buffer_.handle();
  };
  const Intrinsics& k = layout_.intrinsics;
  const shared::SonarPush push{.n_range = grid_.bins.range,
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
                               .fixed_scale = static_cast<float>(fixed_scale_),
                               .edge_bias_bins = kEdgeBias_bins,
                               .reflectivities = reflects ? pass.in.reflectivities : 0u};
  commands.bind_pipeline(pipeline_);
  commands.bind(
      pipeline_,
      {gpu::bound_buffer(shared::kSonarBindColumns, column_slice.buffer, column_slice.offset,
                         column_slice.size),
       gpu::bound_texel_image(shared::kSonarBindRows, rows_.view()),
       gpu::bound_texel_image(shared::kSonarBindDepth, context.image(pass.in.depth).view()),
       gpu::bound_texel_image(shared::kSonarBindNormal, context.image(pass.in.normals).view()),
       gpu::bound_texel_image(shared::kSonarBindLabel, pass.in.labels
                                                           ? context.image(pass.in.labels).view()
                                                           : no_labels_.view()),
       gpu::bound_buffer(shared::kSonarBindReflectivity, buffer_or_none(pass.in.reflectivity)),
       gpu::bound_buffer(shared::kSonarBindSums, buffer_or_none(pass.out.sums)),
       gpu::bound_buffer(shared::kSonarBindKeys, buffer_or_none(pass.out.keys)),
       gpu::bound_buffer(shared::kSonarBindStamps, buffer_or_none(pass.stamps))});
  commands.push(pipeline_, push);
  commands.dispatch(groups_);
}

}  // namespace neritic::sonar
