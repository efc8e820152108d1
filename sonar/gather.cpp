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
     {shared::kSonarBindRows, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindNormal, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindLabel, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindReflectivity, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindImage, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindLabels, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindScratch, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}}};

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
  made.rows_ = row_table(grid);
  made.fixed_scale_ = fixed_scale_for(grid.bins.elevation);
  const VkPhysicalDeviceLimits& limits = device.limits();
  if (made.image_bytes() > limits.maxStorageBufferRange)
    return failure(ErrorCode::kUnsupported,
                   "sonar image of {} x {} bins: {} bytes, the device allows {}", grid.bins.range,
                   grid.bins.azimuth, made.image_bytes(), limits.maxStorageBufferRange);

  // A processor runs a workgroup on one core, eight columns to a vector, each lane owning its
  // column: no atomics. Graphics hardware wants many threads: a workgroup a column, its rows shared
  // out.
  const bool cpu = device.info().kind == "CPU";
  const bool published = options.gather == Gather::kPublished;
  made.columns_per_group_ = cpu || published ? 8 : 1;
  const std::uint32_t lanes = cpu || published ? 1 : 64;
  made.groups_ = (grid.bins.azimuth + made.columns_per_group_ - 1) / made.columns_per_group_;
  const std::uint32_t kinds = published ? 3 : options.labels ? 2 : 1;
  const std::uint64_t words = std::uint64_t{kinds} * grid.bins.range * made.columns_per_group_;
  made.shared_sums_ = words * 4 <= limits.maxComputeSharedMemorySize;
  if (made.scratch_bytes() > limits.maxStorageBufferRange)
    return failure(
        ErrorCode::kUnsupported, "sonar of {} x {} bins: {} bytes to sum in, the device allows {}",
        grid.bins.range, grid.bins.azimuth, made.scratch_bytes(), limits.maxStorageBufferRange);

  gpu::ComputePipelineDesc desc;
  desc.name = std::string("sonar gather ") + name_of(options.gather);
  desc.code = published ? shaders::kSonarPublishedComp : shaders::kSonarGatherComp;
  desc.layout.bindings.assign(kBindings.begin(), kBindings.end());
  desc.layout.push_constant_bytes = sizeof(shared::SonarPush);
  desc.constants = {
      {shared::kSonarSpecColumns, made.columns_per_group_},
      {shared::kSonarSpecLanes, lanes},
      {shared::kSonarSpecSharedWords, made.shared_sums_ ? static_cast<std::uint32_t>(words) : 1u},
      {shared::kSonarSpecPlane, options.gather == Gather::kPlane},
      {shared::kSonarSpecReversedZ, layout.reversed_z},
      {shared::kSonarSpecOctahedral, layout.octahedral},
      {shared::kSonarSpecFacing, layout.normals_face_sensor},
      {shared::kSonarSpecReflect, options.reflectivity},
      {shared::kSonarSpecLabels, options.labels}};
  NERITIC_TRY(made.pipeline_, gpu::Pipeline::create(device, desc));

  // What is bound where a scene has no labels or no reflectivities.
  NERITIC_TRY(made.no_labels_, gpu::Image::create(device, {.name = "sonar no labels",
                                                           .format = VK_FORMAT_R16G16_UINT,
                                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                                    VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                                           .array_view = true}));
  const std::array<std::byte, 4> zero{};
  NERITIC_TRY_STATUS(gpu::upload_image(device, made.no_labels_, zero));
  NERITIC_TRY(made.no_buffer_,
              gpu::Buffer::create(device, {.name = "sonar no buffer",
                                           .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
  return made;
}

std::uint64_t SonarGather::image_bytes() const {
  return std::uint64_t{grid_.bins.range} * grid_.bins.azimuth * sizeof(float);
}

std::uint64_t SonarGather::scratch_bytes() const {
  if (shared_sums_) return 0;
  const std::uint64_t kinds = options_.gather == Gather::kPublished ? 3 : options_.labels ? 2 : 1;
  return kinds * grid_.bins.range * columns_per_group_ * groups_ * sizeof(std::uint32_t);
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
  const auto setup = [&](graph::PassBuilder& builder, Pass& pass) {
    pass.in = inputs;
    builder.read(inputs.depth, Access::kSampledCompute);
    builder.read(inputs.normals, Access::kSampledCompute);
    if (inputs.labels) builder.read(inputs.labels, Access::kSampledCompute);
    if (inputs.reflectivity) builder.read(inputs.reflectivity, Access::kStorageReadCompute);
    pass.out.image = inputs.image_target ? inputs.image_target
                                         : builder.create_buffer("sonar image", image_bytes());
    pass.out.image = builder.write(pass.out.image, Access::kStorageWriteCompute);
    if (options_.labels) {
      pass.out.labels = inputs.labels_target ? inputs.labels_target
                                             : builder.create_buffer("sonar labels", image_bytes());
      pass.out.labels = builder.write(pass.out.labels, Access::kStorageWriteCompute);
    }
    if (!shared_sums_) {
      pass.scratch = builder.create_buffer("sonar sums", scratch_bytes());
      pass.scratch = builder.write(pass.scratch, Access::kStorageWriteCompute);
    }
  };
  return graph
      .add_pass<Pass>(
          "sonar gather", setup,
          [this](const Pass& pass, graph::PassContext& context) { record(pass, context); })
      .out;
}

void SonarGather::record(const Pass& pass, graph::PassContext& context) const {
  gpu::Commands& commands = context.commands;
  const auto columns = column_table(grid_, sectors_, layout_, pass.in.sonar_from_gbuffer);
  const gpu::UploadSlice column_slice =
      commands.upload(std::span<const shared::SonarColumn>(columns));
  const gpu::UploadSlice row_slice = commands.upload(std::span<const shared::SonarRow>(rows_));
  const bool reflects = options_.reflectivity && pass.in.labels && pass.in.reflectivity;
  const auto buffer_or_none = [&](graph::BufferHandle handle) {
    return handle ? context.buffer(handle).handle() : no_buffer_.handle();
  };
  const Intrinsics& k = layout_.intrinsics;
  const shared::SonarPush push{
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
      .fixed_scale = static_cast<float>(fixed_scale_),
      .image_scale = static_cast<float>(1.0 / (fixed_scale_ * grid_.bins.elevation)),
      .edge_bias_bins = kEdgeBias_bins,
      .reflectivities = reflects ? pass.in.reflectivities : 0u};
  commands.bind_pipeline(pipeline_);
  commands.bind(
      pipeline_,
      {gpu::bound_buffer(shared::kSonarBindColumns, column_slice.buffer, column_slice.offset,
                         column_slice.size),
       gpu::bound_buffer(shared::kSonarBindRows, row_slice.buffer, row_slice.offset,
                         row_slice.size),
       gpu::bound_texel_image(shared::kSonarBindDepth, context.image(pass.in.depth).view()),
       gpu::bound_texel_image(shared::kSonarBindNormal, context.image(pass.in.normals).view()),
       gpu::bound_texel_image(shared::kSonarBindLabel, pass.in.labels
                                                           ? context.image(pass.in.labels).view()
                                                           : no_labels_.view()),
       gpu::bound_buffer(shared::kSonarBindReflectivity, buffer_or_none(pass.in.reflectivity)),
       gpu::bound_buffer(shared::kSonarBindImage, buffer_or_none(pass.out.image)),
       gpu::bound_buffer(shared::kSonarBindLabels, buffer_or_none(pass.out.labels)),
       gpu::bound_buffer(shared::kSonarBindScratch, buffer_or_none(pass.scratch))});
  commands.push(pipeline_, push);
  commands.dispatch(groups_);
}

}  // namespace neritic::sonar
