#include "sonar/image_gather.hpp"

#include <algorithm>
#include <cstring>

#include "engine/core/clock.hpp"

namespace neritic::sonar {
namespace {

// Reflectivity a pixel travels as an index of a table of this many steps.
constexpr std::uint32_t kReflectivitySteps = 65536;

Status check_inputs(const BeamGrid& grid, std::span<const SonarInput> inputs,
                    const VkPhysicalDeviceLimits& limits) {
  if (inputs.empty()) return bad_input("sonar: no images found, at least one view is accepted");
  for (const SonarInput& in : inputs) {
    NERITIC_TRY_STATUS(validate(in));
    const SonarInput& first = inputs.front();
    if (in.width != first.width || in.height != first.height ||
        in.intrinsics.fx != first.intrinsics.fx || in.intrinsics.fy != first.intrinsics.fy ||
        in.intrinsics.cx != first.intrinsics.cx || in.intrinsics.cy != first.intrinsics.cy)
      return bad_input(
          "sonar: views of different sizes or pinholes found, one for all is accepted");
    if (in.width > limits.maxImageDimension2D || in.height > limits.maxImageDimension2D)
      return bad_input(
          "depth image: {} x {} pixels found, the device takes at most {} a side (the "
          "reference takes any)",
          in.width, in.height, limits.maxImageDimension2D);
  }
  if (inputs.size() > 1 && inputs.size() != plan_sectors(grid).size())
    return bad_input("sonar: {} views found, the wedge has {} sectors", inputs.size(),
                     plan_sectors(grid).size());
  return {};
}

std::vector<Sector> sectors_for(const BeamGrid& grid, std::span<const SonarInput> inputs) {
  if (inputs.size() > 1) return plan_sectors(grid);
  Sector whole;
  whole.yaw_rad = inputs[0].yaw_rad;
  whole.azimuth_min_rad = grid.limits.azimuth_min_rad;
  whole.azimuth_max_rad = grid.limits.azimuth_max_rad;
  whole.end_column = grid.bins.azimuth;
  return {whole};
}

std::vector<float> planar_depths(const SonarInput& in) {
  std::vector<float> out(in.depth.size(), 0.0f);
  for (std::uint32_t v = 0; v < in.height; ++v)
    for (std::uint32_t u = 0; u < in.width; ++u)
      if (const auto p = point_of(in, u, v))
        out[std::size_t{v} * in.width + u] = static_cast<float>(-p->z);
  return out;
}

std::vector<glm::vec4> unit_normals(const SonarInput& in) {
  std::vector<glm::vec4> out(in.depth.size(), glm::vec4(0.0f));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec3 n(in.normals[3 * i], in.normals[3 * i + 1], in.normals[3 * i + 2]);
    // A direction that sees it from any side tells whether the normal means anything.
    if (incidence(n, Vec3(0, 0, -1), false)) out[i] = glm::vec4(glm::normalize(n), 0.0);
  }
  return out;
}

std::vector<std::uint16_t> label_pairs(const SonarInput& in) {
  std::vector<std::uint16_t> out(2 * in.depth.size(), 0);
  for (std::size_t i = 0; i < in.depth.size(); ++i) {
    if (!in.labels.empty()) out[2 * i] = in.labels[i];
    const float r = in.reflectivity.empty() ? 1.0f : std::clamp(in.reflectivity[i], 0.0f, 1.0f);
    out[2 * i + 1] = static_cast<std::uint16_t>(r * (kReflectivitySteps - 1) + 0.5f);
  }
  return out;
}

// The layers of all views, one after the other.
template <class Make>
auto all_layers(std::span<const SonarInput> inputs, Make make) {
  auto all = make(inputs[0]);
  for (const SonarInput& in : inputs.subspan(1)) {
    const auto more = make(in);
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

template <class T>
Result<gpu::Image> image_of(gpu::Device& device, const std::string& name, VkFormat format,
                            const SonarInput& in, std::uint32_t layers,
                            const std::vector<T>& texels) {
  NERITIC_TRY(gpu::Image image,
              gpu::Image::create(
                  device, {.name = name,
                           .format = format,
                           .width = in.width,
                           .height = in.height,
                           .layers = layers,
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                           .array_view = true}));
  NERITIC_TRY_STATUS(gpu::upload_image(device, image, std::as_bytes(std::span(texels))));
  return image;
}

graph::FrameGraph::ImportState readable() {
  return {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

}  // namespace

ImageGather::~ImageGather() {
  if (device_ != nullptr) device_->wait_idle();
}

Result<std::unique_ptr<ImageGather>> ImageGather::create(gpu::Device& device, const BeamGrid& grid,
                                                         std::span<const SonarInput> inputs,
                                                         Gather gather,
                                                         std::optional<bool> atomics) {
  NERITIC_TRY_STATUS(check_inputs(grid, inputs, device.limits()));
  std::unique_ptr<ImageGather> made(new ImageGather);
  made->device_ = &device;
  for (const SonarInput& in : inputs) {
    made->labels_ |= !in.labels.empty();
    made->reflect_ |= !in.reflectivity.empty();
  }
  GBufferLayout layout{inputs[0].width, inputs[0].height, inputs[0].intrinsics};
  layout.reversed_z = layout.octahedral = false;
  layout.normals_face_sensor = inputs[0].normals_face_sensor;
  NERITIC_TRY(SonarGather sonar,
              SonarGather::create(device, grid, sectors_for(grid, inputs), layout,
                                  {gather, made->labels_, made->reflect_, atomics}));
  made->gather_ = std::make_unique<SonarGather>(std::move(sonar));
  NERITIC_TRY_STATUS(made->upload(inputs));
  NERITIC_TRY(made->frames_, gpu::Frames::create(device, 1));
  made->frames_->enable_timing(true);
  made->executor_ = std::make_unique<graph::Executor>(*made->frames_);
  return made;
}

Status ImageGather::upload(std::span<const SonarInput> inputs) {
  const auto layers = static_cast<std::uint32_t>(inputs.size());
  const SonarInput& in = inputs[0];
  NERITIC_TRY(depth_image_, image_of(*device_, "sonar depth", VK_FORMAT_R32_SFLOAT, in, layers,
                                     all_layers(inputs, planar_depths)));
  std::vector<glm::vec4> normals;
  // Each view's normals are in its own axes; the gather wants one set of axes: the sonar's.
  for (const SonarInput& view : inputs) {
    const Mat3 turn = sonar_from_view(view.yaw_rad);
    for (const glm::vec4& n : unit_normals(view))
      normals.emplace_back(glm::vec3(turn * Vec3(n.x, n.y, n.z)), 0.0f);
  }
  NERITIC_TRY(normal_image_, image_of(*device_, "sonar normals", VK_FORMAT_R32G32B32A32_SFLOAT, in,
                                      layers, normals));
  if (labels_ || reflect_) {
    NERITIC_TRY(label_image_, image_of(*device_, "sonar input labels", VK_FORMAT_R16G16_UINT, in,
                                       layers, all_layers(inputs, label_pairs)));
  }
  if (reflect_) {
    std::vector<float> table(kReflectivitySteps);
    for (std::uint32_t i = 0; i < kReflectivitySteps; ++i)
      table[i] = static_cast<float>(i) / (kReflectivitySteps - 1);
    NERITIC_TRY(reflectivity_,
                gpu::Buffer::create(*device_, {.name = "sonar reflectivity",
                                               .size = table.size() * sizeof(float),
                                               .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                        VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
    NERITIC_TRY_STATUS(
        gpu::upload_buffer(*device_, reflectivity_, std::as_bytes(std::span(table))));
  }
  const auto result = [&](const char* name, std::uint64_t bytes) {
    return gpu::Buffer::create(
        *device_, {.name = name,
                   .size = bytes,
                   .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                   .memory = gpu::MemoryUse::kReadback});
  };
  NERITIC_TRY(sums_, result("sonar sums", gather_->sums_bytes()));
  if (labels_) {
    NERITIC_TRY(keys_, result("sonar keys", gather_->keys_bytes()));
  }
  return {};
}

Result<SonarImage> ImageGather::run() {
  const TimeNs start = now_ns();
  graph::FrameGraph graph;
  SonarGather::Inputs inputs;
  inputs.depth = graph.import_image(depth_image_, readable());
  inputs.normals = graph.import_image(normal_image_, readable());
  if (labels_ || reflect_) inputs.labels = graph.import_image(label_image_, readable());
  if (reflect_) {
    inputs.reflectivity = graph.import_buffer("sonar reflectivity", reflectivity_);
    inputs.reflectivities = kReflectivitySteps;
  }
  inputs.sums_target = graph.import_buffer("sonar sums", sums_);
  if (labels_) inputs.keys_target = graph.import_buffer("sonar keys", keys_);
  const SonarGather::Outputs outputs = gather_->declare(graph, inputs);
  graph.output(outputs.sums, graph::Access::kHostRead);
  if (labels_) graph.output(outputs.keys, graph::Access::kHostRead);

  NERITIC_TRY(gpu::Commands * commands, frames_->begin());
  NERITIC_TRY([[maybe_unused]] const graph::Plan* plan, executor_->run(graph, *commands));
  NERITIC_TRY(const std::uint64_t done, frames_->submit());
  NERITIC_TRY_STATUS(frames_->wait(done));

  SonarImage out = gather_->to_image(sums_.mapped<std::uint32_t>(), keys_.mapped<std::uint32_t>());
  wall_ms_ = to_ms(now_ns() - start);
  return out;
}

}  // namespace neritic::sonar
