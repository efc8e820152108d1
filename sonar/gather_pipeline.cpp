// The parts of a gather: its shader with the constants of its options, and the images of its
// tables. Made once.
#include <array>

#include "engine/core/check.hpp"
#include "engine/gpu/device.hpp"
#include "shaders.hpp"
#include "sonar/gather.hpp"

namespace neritic::sonar {
namespace {

constexpr std::array<gpu::BindingDesc, 20> kBindings{
    {{shared::kSonarBindColumns, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindRows, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindNormal, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindLabel, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindReflectivity, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindSums, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindKeys, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindScratch, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindSumTexels, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 1},
     {shared::kSonarBindKeyTexels, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 1},
     {shared::kSonarBindScratchTexels, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 1},
     {shared::kSonarBindLarger, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     // For a gather with terms only.
     {shared::kSonarBindEcho, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
     {shared::kSonarBindWeights, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindCorrection, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindTexture, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindRecords, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
     {shared::kSonarBindDirectDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1},
     {shared::kSonarBindDirectLabel, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1}}};
constexpr std::size_t kPlainBindings = 13;

struct TableSize {
  std::uint32_t width = 1, height = 1;
};

Result<gpu::Image> table_image(gpu::Device& device, const char* name, VkFormat format,
                               TableSize size, std::span<const std::byte> bytes,
                               bool array = false) {
  NERITIC_TRY(gpu::Image image,
              gpu::Image::create(
                  device, {.name = name,
                           .format = format,
                           .width = size.width,
                           .height = size.height,
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                           .array_view = array}));
  NERITIC_TRY_STATUS(gpu::upload_image(device, image, bytes));
  return image;
}

}  // namespace

std::uint32_t footprint_of(const BeamGrid& grid, const GatherOptions& options) {
  if (options.gather != Gather::kPlane) return shared::kSonarFootprintNone;
  const bool tall = grid.elevation_step_rad() * grid.limits.range_max_m > grid.range_step_m();
  return tall ? shared::kSonarFootprintBounded : shared::kSonarFootprintShared;
}

Status SonarGather::make_pipeline(gpu::Device& device) {
  const EchoOptions* echo = options_.echo ? &*options_.echo : nullptr;
  const bool published = options_.gather == Gather::kPublished;
  // A processor runs a workgroup on one core, eight columns to a vector, each lane owning its
  // column: no atomics. Graphics hardware wants many threads: a workgroup a column, its rows shared
  // out. Runs of beams that meet one scatterer want their column's rows in order.
  const bool own_columns = published || (echo && echo->coherent) ||
                           !options_.threads.atomics.value_or(device.info().kind != "CPU");
  const std::uint32_t columns = own_columns ? 8 : 1, lanes = own_columns ? 1 : 64;
  const std::uint64_t most_texels = device.limits().maxTexelBufferElements;
  texels_ =
      own_columns && options_.threads.texels && sums_bytes() / sizeof(std::uint32_t) <= most_texels;
  groups_ = (grid_.bins.azimuth + columns - 1) / columns;

  gpu::ComputePipelineDesc desc;
  desc.name = std::string(echo ? "sonar echo " : "sonar gather ") + name_of(options_.gather);
  desc.code = echo ? shaders::kSonarEchoComp
                   : (published ? shaders::kSonarPublishedComp : shaders::kSonarGatherComp);
  desc.layout.bindings.assign(kBindings.begin(),
                              echo ? kBindings.end() : kBindings.begin() + kPlainBindings);
  desc.layout.push_constant_bytes = sizeof(shared::SonarPush);
  desc.constants = {{shared::kSonarSpecColumns, columns},
                    {shared::kSonarSpecLanes, lanes},
                    {shared::kSonarSpecPlane, options_.gather == Gather::kPlane},
                    {shared::kSonarSpecPacked, layout_.packed},
                    {shared::kSonarSpecFacing, layout_.normals_face_sensor},
                    {shared::kSonarSpecReflect, options_.reflectivity},
                    {shared::kSonarSpecLabels, options_.labels},
                    {shared::kSonarSpecLarger, options_.larger},
                    {shared::kSonarSpecFootprint, footprint_of(grid_, options_)},
                    {shared::kSonarSpecTexels, texels_},
                    {shared::kSonarSpecLeaning, layout_.lean != 0.0}};
  if (echo)
    for (const auto& [constant, on] : std::initializer_list<std::pair<std::uint32_t, bool>>{
             {shared::kSonarSpecCoherent, echo->coherent},
             {shared::kSonarSpecWeighted, !echo->weights.empty()},
             {shared::kSonarSpecCorrected, echo->corrected},
             {shared::kSonarSpecBent, echo->bent},
             {shared::kSonarSpecTextured, !echo->gamma_quantiles.empty()},
             {shared::kSonarSpecRecords, echo->records},
             {shared::kSonarSpecGhost, echo->ghost},
             {shared::kSonarSpecMoving, echo->moving}})
      desc.constants.push_back({constant, on});
  NERITIC_TRY(pipeline_, gpu::Pipeline::create(device, desc));
  return {};
}

Status SonarGather::make_tables(gpu::Device& device) {
  const auto rows = row_table(grid_);
  NERITIC_TRY(rows_, table_image(device, "sonar rows", VK_FORMAT_R32G32B32A32_SFLOAT,
                                 {grid_.bins.elevation, 1}, std::as_bytes(std::span(rows))));
  const EchoOptions* echo = options_.echo ? &*options_.echo : nullptr;
  if (echo && !echo->weights.empty()) {
    NERITIC_CHECK(echo->weights.size() == std::size_t{grid_.bins.azimuth} * grid_.bins.elevation,
                  "a weight a beam is needed");
    NERITIC_TRY(weights_, table_image(device, "sonar weights", VK_FORMAT_R32_SFLOAT,
                                      {grid_.bins.azimuth, grid_.bins.elevation},
                                      std::as_bytes(std::span(echo->weights))));
  }
  if (echo && !echo->gamma_quantiles.empty()) {
    NERITIC_TRY(gamma_quantiles_,
                table_image(device, "sonar gamma texture", VK_FORMAT_R32_SFLOAT,
                            {static_cast<std::uint32_t>(echo->gamma_quantiles.size()), 1},
                            std::as_bytes(std::span(echo->gamma_quantiles))));
  }
  // Bound where a scene has no labels or no reflectivities.
  const std::array<std::byte, 4> zero{};
  NERITIC_TRY(no_labels_, table_image(device, "sonar no labels", VK_FORMAT_R16G16_UINT, {1, 1},
                                      zero, /*array=*/true));
  NERITIC_TRY(no_buffer_,
              gpu::Buffer::create(device, {.name = "sonar no buffer",
                                           .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                    VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT}));
  return {};
}

}  // namespace neritic::sonar
