#include "sonar/image_gather.hpp"

#include <algorithm>
#include <cstring>

#include "engine/core/clock.hpp"
#include "sonar/head_decode.hpp"

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

constexpr VkBufferUsageFlags kReadableUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

graph::FrameGraph::ImportState readable() {
  return {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

}  // namespace

ImageGather::~ImageGather() {
  if (device_ != nullptr) device_->wait_idle();
}

Result<std::unique_ptr<ImageGather>> ImageGather::create(gpu::Device& device, const BeamGrid& grid,
                                                         std::span<const SonarInput> inputs,
                                                         Gather gather, GatherThreads threads) {
  std::unique_ptr<ImageGather> made(new ImageGather);
  NERITIC_TRY_STATUS(made->prepare(device, grid, inputs, {.gather = gather, .threads = threads}));
  return made;
}

Result<std::unique_ptr<ImageGather>> ImageGather::create(gpu::Device& device,
                                                         const scene::Sonar& sonar,
                                                         const Head& head, const SonarInput& input,
                                                         Gather gather, GatherThreads threads) {
  std::unique_ptr<ImageGather> made(new ImageGather);
  made->sonar_ = sonar;
  made->head_ = head;
  NERITIC_TRY_STATUS(made->prepare(device, head.samples, std::span(&input, 1),
                                   {.gather = gather, .threads = threads, .echo = head.echo}));
  if (!head.echo) return made;
  ReceiverDesc desc = head.receiver;
  desc.sum_scale = made->gather_->fixed_scale();
  NERITIC_TRY(Receiver receiver, Receiver::create(device, std::move(desc)));
  made->receiver_ = std::make_unique<Receiver>(std::move(receiver));
  NERITIC_TRY_STATUS(made->make_buffers());
  return made;
}

Status ImageGather::prepare(gpu::Device& device, const BeamGrid& grid,
                            std::span<const SonarInput> inputs, GatherOptions options) {
  NERITIC_TRY_STATUS(check_inputs(grid, inputs, device.limits()));
  device_ = &device;
  const bool records = options.echo && options.echo->records;
  for (const SonarInput& in : inputs) {
    labels_ |= !in.labels.empty() || records;
    reflect_ |= !in.reflectivity.empty();
  }
  GBufferLayout layout{inputs[0].width, inputs[0].height, inputs[0].intrinsics};
  layout.packed = true;
  layout.normals_face_sensor = inputs[0].normals_face_sensor;
  options.labels = labels_;
  options.reflectivity = reflect_;
  const bool terms = options.echo.has_value();
  NERITIC_TRY(SonarGather sonar,
              SonarGather::create(device, grid, sectors_for(grid, inputs), layout, options));
  gather_ = std::make_unique<SonarGather>(std::move(sonar));
  NERITIC_TRY_STATUS(make_images(inputs[0], static_cast<std::uint32_t>(inputs.size())));
  if (!terms) NERITIC_TRY_STATUS(make_buffers());
  NERITIC_TRY_STATUS(upload(inputs));
  NERITIC_TRY(frames_, gpu::Frames::create(device, 1));
  frames_->enable_timing(true);
  executor_ = std::make_unique<graph::Executor>(*frames_);
  return {};
}

Status ImageGather::make_images(const SonarInput& in, std::uint32_t layers) {
  NERITIC_TRY(surface_image_, image_like(*device_, "sonar input surfaces",
                                         VK_FORMAT_R32G32B32A32_SFLOAT, in, layers));
  if (labels_ || reflect_) {
    NERITIC_TRY(label_image_,
                image_like(*device_, "sonar input labels", VK_FORMAT_R16G16_UINT, in, layers));
  }
  if (!reflect_) return {};
  std::vector<float> table(kReflectivitySteps);
  for (std::uint32_t i = 0; i < kReflectivitySteps; ++i)
    table[i] = static_cast<float>(i) / (kReflectivitySteps - 1);
  NERITIC_TRY(reflectivity_,
              gpu::Buffer::create(*device_, {.name = "sonar reflectivity",
                                             .size = table.size() * sizeof(float),
                                             .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                                      VK_BUFFER_USAGE_TRANSFER_DST_BIT}));
  return gpu::upload_buffer(*device_, reflectivity_, std::as_bytes(std::span(table)));
}

Status ImageGather::make_buffers() {
  const auto result = [&](const char* name, std::uint64_t bytes,
                          VkBufferUsageFlags usage = kReadableUsage) {
    return gpu::Buffer::create(
        *device_,
        {.name = name, .size = bytes, .usage = usage, .memory = gpu::MemoryUse::kReadback});
  };
  if (labels_) {
    NERITIC_TRY(keys_, result("sonar keys", gather_->keys_bytes(), gather_->sums_usage()));
  }
  if (!receiver_) {
    NERITIC_TRY(sums_, result("sonar sums", gather_->sums_bytes(), gather_->sums_usage()));
    return {};
  }
  NERITIC_TRY(power_, result("sonar power", receiver_->power_bytes()));
  if (head_.echo->records) {
    NERITIC_TRY(records_, result("sonar records", gather_->records_bytes()));
  }
  return {};
}

Status ImageGather::upload(std::span<const SonarInput> inputs) {
  const SonarInput& in = inputs[0];
  if (in.width != gather_->layout().width || in.height != gather_->layout().height)
    return bad_input("depth image: {} x {} pixels found, {} x {} as before is accepted", in.width,
                     in.height, gather_->layout().width, gather_->layout().height);
  const auto put = [&](gpu::Image& image, const auto& texels) {
    return gpu::upload_image(*device_, image, std::as_bytes(std::span(texels)));
  };
  NERITIC_TRY_STATUS(put(surface_image_, all_layers(inputs, surfaces)));
  if (labels_ || reflect_) return put(label_image_, all_layers(inputs, label_pairs));
  return {};
}

Result<SonarImage> ImageGather::run(const PingState& state) {
  const TimeNs start = now_ns();
  graph::FrameGraph graph;
  SonarGather::Inputs inputs;
  inputs.normals = graph.import_image(surface_image_, readable());
  if (labels_ || reflect_) inputs.labels = graph.import_image(label_image_, readable());
  if (reflect_) {
    inputs.reflectivity = graph.import_buffer("sonar reflectivity", reflectivity_);
    inputs.reflectivities = kReflectivitySteps;
  }
  const bool in_place = device_->info().shared_memory;
  if (in_place && !receiver_) inputs.sums_target = graph.import_buffer("sonar sums", sums_);
  if (in_place && labels_) inputs.keys_target = graph.import_buffer("sonar keys", keys_);
  if (records_.size() > 0) inputs.records_target = graph.import_buffer("sonar records", records_);
  Ping ping;
  if (receiver_) {
    PingState here = state;
    here.gbuffer_in_world_axes = false;
    ping = ping_of(sonar_, head_, here);
    inputs.echo = ping.echo;
    inputs.correction = ping.correction;
  }
  SonarGather::Outputs outputs = gather_->declare(graph, inputs);
  if (!in_place && !receiver_)
    outputs.sums = copy_buffer(graph, "sonar sums to host", outputs.sums, "sonar sums", sums_);
  if (!in_place && labels_)
    outputs.keys = copy_buffer(graph, "sonar keys to host", outputs.keys, "sonar keys", keys_);
  if (labels_) graph.output(outputs.keys, graph::Access::kHostRead);
  if (outputs.records) graph.output(outputs.records, graph::Access::kHostRead);
  graph.output(receiver_ ? receiver_->declare(graph, outputs.sums, ping.receiver(),
                                              graph.import_buffer("sonar power", power_), "")
                         : outputs.sums,
               graph::Access::kHostRead);

  NERITIC_TRY(gpu::Commands * commands, frames_->begin());
  NERITIC_TRY([[maybe_unused]] const graph::Plan* plan, executor_->run(graph, *commands));
  NERITIC_TRY(const std::uint64_t done, frames_->submit());
  NERITIC_TRY_STATUS(frames_->wait(done));

  const auto keys = keys_.mapped<std::uint32_t>();
  SonarImage out;
  if (receiver_) {
    const auto power = power_.mapped<float>();
    out = {head_.beams.bins.range,
           head_.beams.bins.azimuth,
           {power.begin(), power.end()},
           beam_labels(head_, keys)};
    if (records_.size() > 0)
      label_energy_ = beam_energies(head_, ping, {records_.mapped<shared::SonarRecord>()});
  } else {
    out = gather_->to_image(sums_.mapped<std::uint32_t>(), keys);
  }
  wall_ms_ = to_ms(now_ns() - start);
  return out;
}

}  // namespace neritic::sonar
