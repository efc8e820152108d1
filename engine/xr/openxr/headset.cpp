#include "engine/xr/openxr/headset.hpp"

#include <thread>

#include "engine/core/check.hpp"
#include "engine/core/log.hpp"
#include "engine/xr/compositor.hpp"
#include "engine/xr/openxr/inputs.hpp"
#include "engine/xr/openxr/panels.hpp"
#include "engine/xr/openxr/views.hpp"

namespace neritic::xr {
namespace openxr {
namespace {

// While nobody wears it: the program's other work goes on at this pace.
constexpr std::chrono::milliseconds kIdle{10};
// Between two tries to reach a runtime that went away.
constexpr TimeNs kRetry_ns = 500'000'000;
// So many calls that fail in a row (XR_ERROR_RUNTIME_FAILURE) are no passing trouble.
constexpr int kMostStumbles = 10;

// Between two pictures: what the runtime says, where that can be a screen's, else 90 a second.
TimeNs period_of(const XrFrameState& state) {
  constexpr TimeNs kLeast_ns = 1'000'000, kMost_ns = 100'000'000, kUnknown_ns = 11'111'111;
  const TimeNs told_ns = state.predictedDisplayPeriod;
  return told_ns >= kLeast_ns && told_ns <= kMost_ns ? told_ns : kUnknown_ns;
}

// The left upper part of an image of the runtime that a picture fills, texel by texel.
VkExtent2D part_of(const graph::FrameGraph& graph, graph::ImageHandle picture,
                   const gpu::ImageDesc& image) {
  const graph::ResourceDecl& drawn = graph.declaration().resources[picture.resource];
  return {std::min(drawn.width, image.width), std::min(drawn.height, image.height)};
}

class OpenXrHeadset final : public Headset {
 public:
  OpenXrHeadset(const HeadsetOptions& options, ActionTable actions)
      : options_(options), actions_(std::move(actions)) {}
  ~OpenXrHeadset() override { disconnect(); }
  Status connect();

  void require(gpu::DeviceOptions& options) override;
  Status attach(gpu::Device& device) override;
  const HeadsetInfo& info() const override { return info_; }
  const std::vector<std::string>& validation_messages() const override { return messages_; }

  Result<DisplayFrame> begin_frame(const Pose& world_from_stage) override;
  std::vector<ViewGroup> groups_ahead() const override;
  bool paces_device() const override { return true; }
  void track(DisplayFrame& frame, const Pose& world_from_stage) override;
  Result<ShownPicture> declare(graph::FrameGraph& graph, const Pose& world_from_head,
                               std::span<const Layer> layers) override;
  gpu::Frames::SubmitSync sync() const override { return {}; }
  Status end_frame(bool submitted) override;
  ActionValues take_actions(const InputClaims& claims) override;

 private:
  // The children of a session, in the order of creation.
  struct Parts {
    std::unique_ptr<Session> session;
    std::unique_ptr<Views> views;
    std::unique_ptr<Panels> panels;
    std::unique_ptr<Inputs> inputs;
  };
  Status start_session();
  void end_session();
  void disconnect();
  void reconnect();
  Status try_again();
  // After a failed call: goes on without the session or the runtime where it was lost, else gives
  // the error back.
  Status recover(const Status& status);
  Status begin(DisplayFrame& frame);
  Status end(bool submitted);
  Status declare_layers(graph::FrameGraph& graph, std::span<const Layer> layers,
                        ShownPicture& shown);
  Status declare_projection(graph::FrameGraph& graph, const ProjectionLayer& layer);
  void fill(DisplayFrame& frame) const;
  void fill_tracked(DisplayFrame& frame) const;

  HeadsetOptions options_;
  ActionTable actions_;
  HeadsetInfo info_;
  std::vector<std::string> messages_;
  gpu::Device* device_ = nullptr;
  EnabledVulkan vulkan_;
  std::unique_ptr<Runtime> runtime_;  // nullptr: it went away
  std::unique_ptr<Presenter> presenter_;
  Parts parts_;  // empty: no session
  TimeNs retry_at_ns_ = 0;
  std::string told_;       // why the last try failed
  Status not_declared_;    // of this frame: a passing failure
  bool stumbled_ = false;  // in this frame
  int stumbles_ = 0;       // calls in a row that failed without a loss
  Pose world_from_stage_;
  bool in_frame_ = false;  // between xrBeginFrame and xrEndFrame
  XrTime display_at_ = 0;
  std::vector<Views::Drawn> drawn_;  // of each group this frame
};

Status OpenXrHeadset::connect() {
  NERITIC_TRY(runtime_, Runtime::create(options_, true, &messages_));
  info_ = runtime_->info();
  log_info("headset {} by {}", info_.system, info_.runtime);
  return {};
}

void OpenXrHeadset::require(gpu::DeviceOptions& options) {
  options.maker.instance = [this](const VkInstanceCreateInfo& info, VkInstance* instance) {
    return runtime_->make_instance(info, instance, vulkan_);
  };
  options.maker.physical = [this](VkInstance instance, VkPhysicalDevice* device) {
    return runtime_->find_physical(instance, device);
  };
  options.maker.device = [this](VkPhysicalDevice physical, const VkDeviceCreateInfo& info,
                                VkDevice* device) {
    return runtime_->make_device(physical, info, device, vulkan_);
  };
}

Status OpenXrHeadset::attach(gpu::Device& device) {
  NERITIC_CHECK(!device_, "attached twice");
  device_ = &device;
  NERITIC_TRY(presenter_, Presenter::create(device));
  return start_session();
}

Status OpenXrHeadset::start_session() {
  Parts parts;
  NERITIC_TRY(parts.session, Session::create(*runtime_, *device_, options_));
  NERITIC_TRY(parts.views, Views::create(*runtime_, *parts.session, *device_, !options_.overlay));
  for (const Views::Group& group : parts.views->swapchains())
    NERITIC_TRY_STATUS(
        presenter_->make_ready(group.color->desc().format, group.color->desc().layers, true));
  NERITIC_TRY(parts.panels, Panels::create(*runtime_, *parts.session, *device_, *presenter_));
  NERITIC_TRY(parts.inputs, Inputs::create(*runtime_, *parts.session));
  parts_ = std::move(parts);
  return {};
}

void OpenXrHeadset::end_session() {
  if (parts_.session) device_->wait_idle();  // the runtime's images may still be drawn to
  parts_.inputs.reset();
  parts_.panels.reset();
  parts_.views.reset();
  parts_.session.reset();
  in_frame_ = false;
}

void OpenXrHeadset::disconnect() {
  end_session();
  runtime_.reset();
}

Status OpenXrHeadset::recover(const Status& status) {
  if (runtime_ && runtime_->take_failure() && runtime_->loss() == Loss::kNone && !status.ok()) {
    // One failed call costs a frame. Where they go on to fail a new session may help.
    stumbled_ = true;
    if (stumbles_++ == 0) log_warn("{}: a frame is not shown", status.error().message);
    if (stumbles_ < kMostStumbles) return {};
    runtime_->lose(Loss::kSession);
  }
  if (status.ok() && (!runtime_ || runtime_->loss() == Loss::kNone)) return {};
  if (!runtime_ || runtime_->loss() == Loss::kNone) return status;
  const bool instance = runtime_->loss() == Loss::kInstance;
  log_warn("{} lost the headset{}: the dive goes on, and shows again when it is back",
           info_.runtime, status.ok() ? "" : " (" + status.error().message + ")");
  end_session();
  if (instance)
    runtime_.reset();
  else
    runtime_->forget_session_loss();
  retry_at_ns_ = now_ns() + (instance ? kRetry_ns : 0);
  stumbles_ = 0;
  return {};
}

// Tries again what was lost, once a while. Its failures are those of a runtime that is not back, or
// of a headset that is not plugged in: only the loss of the instance makes it connect anew.
void OpenXrHeadset::reconnect() {
  if (parts_.session || now_ns() < retry_at_ns_) return;
  retry_at_ns_ = now_ns() + kRetry_ns;
  const Status status = try_again();
  if (status.ok()) {
    log_warn("{}: the headset is back, and shows the dive again", info_.runtime);
    told_.clear();
    stumbles_ = 0;
    return;
  }
  if (status.error().message != told_) log_warn("{}", status.error().message);
  told_ = status.error().message;
  if (!runtime_) return;
  if (runtime_->take_failure() && ++stumbles_ >= kMostStumbles) runtime_->lose(Loss::kInstance);
  if (runtime_->loss() == Loss::kInstance) {
    runtime_.reset();
    stumbles_ = 0;
  } else {
    runtime_->forget_session_loss();
  }
}

Status OpenXrHeadset::try_again() {
  if (!runtime_) {
    NERITIC_TRY(runtime_, Runtime::create(options_, false, &messages_));
  }
  NERITIC_TRY_STATUS(runtime_->find_system());
  info_ = runtime_->info();
  NERITIC_TRY_STATUS(runtime_->ask_vulkan());
  NERITIC_TRY_STATUS(runtime_->check_device(*device_, vulkan_));
  return start_session();
}

Result<DisplayFrame> OpenXrHeadset::begin_frame(const Pose& world_from_stage) {
  NERITIC_CHECK(device_, "a frame before attach");
  world_from_stage_ = world_from_stage;
  DisplayFrame frame;
  frame.display_at_ns = now_ns();
  reconnect();
  if (runtime_) (void)runtime_->take_failure();  // of calls that nobody missed
  stumbled_ = false;
  if (parts_.session) NERITIC_TRY_STATUS(recover(begin(frame)));
  if (!in_frame_ && frame.verdict != FrameVerdict::kQuit) std::this_thread::sleep_for(kIdle);
  if (!in_frame_ && frame.verdict == FrameVerdict::kDraw) frame.verdict = FrameVerdict::kHidden;
  return frame;
}

Status OpenXrHeadset::begin(DisplayFrame& frame) {
  Session& session = *parts_.session;
  NERITIC_TRY_STATUS(session.poll(parts_.views->configuration()));
  if (session.take_mask_change()) parts_.views->read_masks();
  if (runtime_->loss() != Loss::kNone) return {};
  if (session.exits()) {
    frame.verdict = FrameVerdict::kQuit;
    return {};
  }
  if (!session.running()) return {};
  XrFrameState state{XR_TYPE_FRAME_STATE};
  NERITIC_TRY_STATUS(
      runtime_->check(runtime_->xr().WaitFrame(session.handle(), nullptr, &state), "xrWaitFrame"));
  runtime_->note_frame(state.predictedDisplayTime, state.predictedDisplayPeriod);
  const Status begun =
      runtime_->check(runtime_->xr().BeginFrame(session.handle(), nullptr), "xrBeginFrame");
  if (!begun.ok()) {
    // The runtime waits for the begin of the frame that it announced: a new session is needed.
    if (runtime_->take_failure()) runtime_->lose(Loss::kSession);
    return begun;
  }
  in_frame_ = true;
  not_declared_ = {};
  display_at_ = state.predictedDisplayTime;
  drawn_.assign(parts_.views->swapchains().size(), {});
  frame.display_at_ns = runtime_->to_host(display_at_);
  frame.period_ns = period_of(state);
  if (!state.shouldRender) return {};
  NERITIC_TRY(const bool known, parts_.views->locate(display_at_));
  if (!known) return {};
  frame.verdict = FrameVerdict::kDraw;
  fill(frame);
  fill_tracked(frame);
  return {};
}

// The session is made, but begins with the first frame: until then the runtime shows what it shows
// while a program loads.
std::vector<ViewGroup> OpenXrHeadset::groups_ahead() const {
  return parts_.views && !options_.overlay ? parts_.views->groups() : std::vector<ViewGroup>();
}

void OpenXrHeadset::fill(DisplayFrame& frame) const {
  frame.world_from_head = world_from_stage_ * parts_.views->stage_from_head();
  frame.groups = parts_.views->groups();
}

void OpenXrHeadset::fill_tracked(DisplayFrame& frame) const {
  parts_.inputs->track(display_at_, frame.tracked);
  for (std::optional<Pose>& hand : frame.tracked.hands)
    if (hand) *hand = world_from_stage_ * *hand;
  if (frame.tracked.gaze) frame.tracked.gaze->pose = world_from_stage_ * frame.tracked.gaze->pose;
}

// Where the session was lost meanwhile, end_frame finds it out.
ActionValues OpenXrHeadset::take_actions(const InputClaims& claims) {
  DeviceState state;
  if (parts_.inputs && !parts_.inputs->sync(state).ok()) state = {};
  return actions_.values(state, claims);
}

// Where it fails, or knows no better, the frame keeps what it had.
void OpenXrHeadset::track(DisplayFrame& frame, const Pose& world_from_stage) {
  if (!in_frame_ || frame.verdict != FrameVerdict::kDraw) return;
  world_from_stage_ = world_from_stage;
  (void)parts_.views->locate(display_at_);
  fill(frame);
}

Result<ShownPicture> OpenXrHeadset::declare(graph::FrameGraph& graph, const Pose&,
                                            std::span<const Layer> layers) {
  NERITIC_CHECK(in_frame_, "layers without a frame");
  ShownPicture shown;
  (void)runtime_->take_failure();  // of calls that nobody missed
  const Status status = declare_layers(graph, layers, shown);
  if (!status.ok() && !runtime_->failed() && runtime_->loss() == Loss::kNone) return status.error();
  // end_frame drops what was lost, and counts what may pass.
  not_declared_ = status;
  return shown;
}

Status OpenXrHeadset::declare_layers(graph::FrameGraph& graph, std::span<const Layer> layers,
                                     ShownPicture& shown) {
  if (const ProjectionLayer* first = projection_of(layers, 0)) {
    const graph::ResourceDecl& image = graph.declaration().resources[first->color.resource];
    shown = {first->color, image.format, image.width, image.height, true};
  }
  for (const Layer& layer : layers) {
    if (const auto* panel = std::get_if<PanelLayer>(&layer)) {
      NERITIC_TRY_STATUS(parts_.panels->declare(graph, *panel));
    } else {
      NERITIC_TRY_STATUS(declare_projection(graph, std::get<ProjectionLayer>(layer)));
    }
  }
  return {};
}

Status OpenXrHeadset::declare_projection(graph::FrameGraph& graph, const ProjectionLayer& layer) {
  Views::Group& group = parts_.views->swapchains()[layer.group];
  NERITIC_TRY(const gpu::Image* const color, group.color->acquire());
  Views::Drawn& drawn = drawn_[layer.group];
  // The runtime scales a smaller picture: to do it here too would cost as much as all else that is
  // drawn at a fifth of the width.
  drawn.color = part_of(graph, layer.color, color->desc());
  NERITIC_TRY_STATUS(
      presenter_->declare(graph, color->desc().name, layer.color, *color, drawn.color, true));
  if (!layer.depth || !group.depth) return {};
  NERITIC_TRY(const gpu::Image* const depth, group.depth->acquire());
  graph.output(copy_depth(graph, depth->desc().name, layer.depth, graph.import_image(*depth, {})),
               graph::Access::kDepthAttachment);
  drawn.depth = part_of(graph, layer.depth, depth->desc());
  drawn.near_m = layer.near_m;
  return {};
}

Status OpenXrHeadset::end_frame(bool submitted) {
  if (!in_frame_) return {};
  Status status = end(submitted);
  in_frame_ = false;
  if (status.ok()) status = not_declared_;
  if (status.ok() && !stumbled_) stumbles_ = 0;
  return recover(status);
}

Status OpenXrHeadset::end(bool submitted) {
  if (runtime_->loss() != Loss::kNone) return {};
  std::vector<const XrCompositionLayerBaseHeader*> layers;
  if (submitted) {
    bool whole = true;
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
      Views::Group& group = parts_.views->swapchains()[i];
      const bool projected = drawn_[i].color.width > 0;
      if (projected) NERITIC_TRY_STATUS(group.color->release());
      if (drawn_[i].near_m > 0.0) NERITIC_TRY_STATUS(group.depth->release());
      whole = whole && projected;
    }
    if (whole && !drawn_.empty()) layers.push_back(parts_.views->layer(drawn_));
    NERITIC_TRY(const auto panels, parts_.panels->finish(world_from_stage_, layers.size()));
    layers.insert(layers.end(), panels.begin(), panels.end());
  } else {
    parts_.panels->drop();
  }
  XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO};
  info.displayTime = display_at_;
  info.environmentBlendMode = parts_.views->blend_mode();
  info.layerCount = static_cast<std::uint32_t>(layers.size());
  info.layers = layers.data();
  in_frame_ = false;
  return runtime_->check(runtime_->xr().EndFrame(parts_.session->handle(), &info), "xrEndFrame");
}

}  // namespace
}  // namespace openxr

Result<std::unique_ptr<Headset>> Headset::connect(const HeadsetOptions& options) {
  NERITIC_TRY(ActionTable actions, ActionTable::create(options.actions));
  auto headset = std::make_unique<openxr::OpenXrHeadset>(options, std::move(actions));
  NERITIC_TRY_STATUS(headset->connect());
  return std::unique_ptr<Headset>(std::move(headset));
}

Result<HeadsetInfo> examine_headset() {
  NERITIC_TRY(const auto runtime, openxr::Runtime::create({}, false, nullptr));
  (void)runtime->find_system();  // without one its name stays empty
  return runtime->info();
}

}  // namespace neritic::xr
