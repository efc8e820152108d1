#include "sonar/image_gather.hpp"

#include <algorithm>
#include <cstring>

#include "engine/core/clock.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::sonar {
namespace {

// Reflectivity a pixel travels as an index of a table of this many steps.
constexpr std::uint32_t kReflectivitySteps = 65536;

Status check_inputs(const BeamGrid& grid, std::span<const SonarInput> inputs,
                    const VkPhysicalDeviceLimits& limits) {
  if (inputs.empty()) return refusal("sonar", "no images", "one view or more");
  for (const SonarInput& in : inputs) {
    NERITIC_TRY_STATUS(validate(in));
    const SonarInput& first = inputs.front();
    if (in.width != first.width || in.height != first.height ||
        in.intrinsics.fx != first.intrinsics.fx || in.intrinsics.fy != first.intrinsics.fy ||
        in.intrinsics.cx != first.intrinsics.cx || in.intrinsics.cy != first.intrinsics.cy)
      return refusal("sonar", "views of different sizes or pinholes", "one size and one pinhole");
    if (in.width > limits.maxImageDimension2D || in.height > limits.maxImageDimension2D)
      return refusal("depth image", fmt::format("{} x {} pixels", in.width, in.height),
                     fmt::format("at most {} a side on this device (the reference takes any)",
                                 limits.maxImageDimension2D));
  }
  if (inputs.size() > 1 && inputs.size() != plan_sectors(grid).size())
    return refusal("sonar", fmt::format("{} views", inputs.size()),
                   fmt::format("1, or {} as the wedge has sectors", plan_sectors(grid).size()));
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

// Unit normals in the sonar's axes, which the gather wants for all views, and planar metres; zero
// where the view says nothing of the one or the other.
std::vector<glm::vec4> surfaces(const SonarInput& in) {
  const Mat3 turn = sonar_from_view(in.yaw_rad);
  std::vector<glm::vec4> out(in.depth.size(), glm::vec4(0.0f));
  for (std::uint32_t v = 0; v < in.height; ++v)
    for (std::uint32_t u = 0; u < in.width; ++u) {
      const std::size_t i = std::size_t{v} * in.width + u;
      if (const auto p = point_of(in, u, v)) out[i].w = static_cast<float>(-p->z);
      const Vec3 n(in.normals[3 * i], in.normals[3 * i + 1], in.normals[3 * i + 2]);
      // A direction that sees it from any side tells whether the normal means anything.
      if (incidence(n, Vec3(0, 0, -1), false))
        out[i] = glm::vec4(glm::vec3(turn * glm::normalize(n)), out[i].w);
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

Result<gpu::Image> image_like(gpu::Device& device, const std::string& name, VkFormat format,
                              const SonarInput& in, std::uint32_t layers) {
  return gpu::Image::create(device,
                            {.name = name,
                             .format = format,
                             .width = in.width,
                             .height = in.height,
                             .layers = layers,
                             .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                             .array_view = true});
}

graph::FrameGraph::ImportState readable() {
  return {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

}  // namespace

ImageGather::~ImageGather() {
  device_.wait_idle();
}

Result<std::unique_ptr<ImageGather>> ImageGather::create(gpu::Device& device, const BeamGrid& grid,
                                                         std::span<const SonarInput> inputs,
                                                         Gather gather, GatherThreads threads) {
  Head plain;
  plain.beams = plain.samples = grid;
  std::unique_ptr<ImageGather> made(new ImageGather(device));
  NERITIC_TRY_STATUS(made->prepare({}, plain, inputs, {.gather = gather, .threads = threads}));
  return made;
}

Result<std::unique_ptr<ImageGather>> ImageGather::create(gpu::Device& device,
                                                         const scene::Sonar& sonar,
                                                         const Head& head, const SonarInput& input,
                                                         Gather gather, GatherThreads threads) {
  std::unique_ptr<ImageGather> made(new ImageGather(device));
  NERITIC_TRY_STATUS(
      made->prepare(sonar, head, std::span(&input, 1), {.gather = gather, .threads = threads}));
  return made;
}

Status ImageGather::prepare(const scene::Sonar& sonar, const Head& head,
                            std::span<const SonarInput> inputs, GatherOptions options) {
  NERITIC_TRY_STATUS(check_inputs(head.samples, inputs, device_.limits()));
  labels_ = head.echo && head.echo->records;
  for (const SonarInput& in : inputs) {
    labels_ |= !in.labels.empty();
    reflect_ |= !in.reflectivity.empty();
  }
  options.labels = labels_;
  options.reflectivity = reflect_;
  GBufferLayout layout{inputs[0].width, inputs[0].height, inputs[0].intrinsics};
  layout.packed = true;
  layout.normals_face_sensor = inputs[0].normals_face_sensor;
  NERITIC_TRY(HeadGather made,
              HeadGather::create(device_, {.sonar = sonar,
                                           .head = head,
                                           .sectors = sectors_for(head.samples, inputs),
                                           .layout = layout,
                                           .options = options,
                                           .mirrors = {}}));
  head_ = std::make_unique<HeadGather>(std::move(made));
  NERITIC_TRY(buffers_, head_->make_buffers(device_, "sonar "));
  NERITIC_TRY_STATUS(make_images(inputs[0], static_cast<std::uint32_t>(inputs.size())));
  NERITIC_TRY_STATUS(upload(inputs));
  NERITIC_TRY(frames_, gpu::Frames::create(device_, 1));
  frames_->enable_timing(true);
  executor_ = std::make_unique<graph::Executor>(*frames_);
  return {};
}

Status ImageGather::make_images(const SonarInput& in, std::uint32_t layers) {
  NERITIC_TRY(surface_image_, image_like(device_, "sonar input surfaces",
                                         VK_FORMAT_R32G32B32A32_SFLOAT, in, layers));
  if (labels_ || reflect_) {
    NERITIC_TRY(label_image_,
                image_like(device_, "sonar input labels", VK_FORMAT_R16G16_UINT, in, layers));
  }
  if (!reflect_) return {};
  std::vector<float> table(kReflectivitySteps);
  for (std::uint32_t i = 0; i < kReflectivitySteps; ++i)
    table[i] = static_cast<float>(i) / (kReflectivitySteps - 1);
  NERITIC_TRY(reflectivity_,
              gpu::Buffer::create(device_, {.name = "sonar reflectivity",
                                            .size = table.size() * sizeof(float),
                                            .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  return gpu::upload_buffer(device_, reflectivity_, std::as_bytes(std::span(table)));
}

Status ImageGather::upload(std::span<const SonarInput> inputs) {
  const SonarInput& in = inputs[0];
  if (in.width != head_->gather().layout().width || in.height != head_->gather().layout().height)
    return refusal("depth image", fmt::format("{} x {} pixels", in.width, in.height),
                   fmt::format("{} x {} as before", head_->gather().layout().width,
                               head_->gather().layout().height));
  const auto put = [&](gpu::Image& image, const auto& texels) {
    return gpu::upload_image(device_, image, std::as_bytes(std::span(texels)));
  };
  NERITIC_TRY_STATUS(put(surface_image_, all_layers(inputs, surfaces)));
  if (labels_ || reflect_) return put(label_image_, all_layers(inputs, label_pairs));
  return {};
}

Result<SonarImage> ImageGather::run(const PingState& state) {
  const TimeNs start = now_ns();
  graph::FrameGraph graph;
  HeadGather::View view;
  view.normals = graph.import_image(surface_image_, readable());
  if (labels_ || reflect_) view.labels = graph.import_image(label_image_, readable());
  HeadGather::Table table;
  if (reflect_)
    table = {graph.import_buffer("sonar reflectivity", reflectivity_), kReflectivitySteps};
  HeadPing ping;
  ping.host = &buffers_;
  ping.state = state;
  ping.state.gbuffer_in_world_axes = false;
  head_->begin(graph, view, table, ping);
  head_->end(graph, ping);

  NERITIC_TRY(gpu::Commands * commands, frames_->begin());
  NERITIC_TRY([[maybe_unused]] const graph::Plan* plan, executor_->run(graph, *commands));
  NERITIC_TRY(const std::uint64_t done, frames_->submit());
  NERITIC_TRY_STATUS(frames_->wait(done));

  SonarImage out = head_->image(ping);
  label_energy_ = head_->label_energy(ping);
  wall_ms_ = to_ms(now_ns() - start);
  return out;
}

}  // namespace neritic::sonar
