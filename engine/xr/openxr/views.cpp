#include "engine/xr/openxr/views.hpp"

#include <algorithm>
#include <limits>

#include "engine/core/log.hpp"

namespace neritic::xr::openxr {
namespace {

// Height of the eyes of a standing adult of 1.7 m over the floor.
constexpr double kEyes_m = 1.6;

XrExtent2Di extent_of(const VkExtent2D& extent) {
  return {static_cast<std::int32_t>(extent.width), static_cast<std::int32_t>(extent.height)};
}

}  // namespace

Result<std::unique_ptr<Views>> Views::create(Runtime& runtime, const Session& session,
                                             gpu::Device& device, bool pictures) {
  std::unique_ptr<Views> views(new Views(runtime, session));
  NERITIC_TRY_STATUS(views->choose_configuration());
  NERITIC_TRY_STATUS(views->choose_blend_mode());
  views->foveated_ = views->foveated_ && pictures;
  NERITIC_TRY_STATUS(views->make_eyes());
  NERITIC_TRY(const auto sizes, views->sizes());
  if (pictures) NERITIC_TRY_STATUS(views->make_swapchains(device, sizes));
  views->views_.assign(sizes.size(), {XR_TYPE_VIEW});
  for (XrView& view : views->views_) view.pose = to_xr({});
  if (pictures) views->read_masks();
  return views;
}

// Four views where they are offered, else two, else one.
Status Views::choose_configuration() {
  std::vector<XrViewConfigurationType> offered;
  const XrResult result =
      enumerate(offered, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO,
                [&](auto capacity, auto count, auto items) {
                  return runtime_.xr().EnumerateViewConfigurations(
                      runtime_.instance(), runtime_.system(), capacity, count, items);
                });
  NERITIC_TRY_STATUS(runtime_.check(result, "xrEnumerateViewConfigurations"));
  for (const XrViewConfigurationType wanted :
       {XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO,
        XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO}) {
    if (wanted == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO && !runtime_.has().quad_views)
      continue;
    if (std::find(offered.begin(), offered.end(), wanted) == offered.end()) continue;
    configuration_ = wanted;
    foveated_ =
        wanted == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO && runtime_.foveation_here();
    return {};
  }
  return failure(ErrorCode::kUnsupported, "{} shows neither one, two nor four views",
                 runtime_.info().runtime);
}

// The sea hides the room; glasses that cannot do that add it to the room.
Status Views::choose_blend_mode() {
  std::vector<XrEnvironmentBlendMode> offered;
  const XrResult result = enumerate(
      offered, XR_ENVIRONMENT_BLEND_MODE_OPAQUE, [&](auto capacity, auto count, auto items) {
        return runtime_.xr().EnumerateEnvironmentBlendModes(runtime_.instance(), runtime_.system(),
                                                            configuration_, capacity, count, items);
      });
  NERITIC_TRY_STATUS(runtime_.check(result, "xrEnumerateEnvironmentBlendModes"));
  if (!offered.empty() &&
      std::find(offered.begin(), offered.end(), XR_ENVIRONMENT_BLEND_MODE_OPAQUE) == offered.end())
    blend_mode_ = offered.front();
  return {};
}

// The space by which the sharp views follow the gaze.
Status Views::make_eyes() {
  if (!foveated_) return {};
  XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO};
  info.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_COMBINED_EYE_VARJO;
  info.poseInReferenceSpace = to_xr({});
  const Status made =
      runtime_.check(runtime_.xr().CreateReferenceSpace(session_.handle(), &info, &eyes_),
                     "xrCreateReferenceSpace");
  if (made.ok()) return {};
  if (!runtime_.goes_without(made.error(), "the sharp views stay in the middle"))
    return made.error();
  foveated_ = false;
  return {};
}

Result<std::vector<XrViewConfigurationView>> Views::sizes() {
  XrFoveatedViewConfigurationViewVARJO foveated{XR_TYPE_FOVEATED_VIEW_CONFIGURATION_VIEW_VARJO};
  foveated.foveatedRenderingActive = XR_TRUE;
  std::vector<XrViewConfigurationView> sizes;
  // Each item needs a chained structure of its own; all say the same.
  std::vector<XrFoveatedViewConfigurationViewVARJO> chained(16, foveated);
  const XrResult result = enumerate(
      sizes, {XR_TYPE_VIEW_CONFIGURATION_VIEW}, [&](auto capacity, auto count, auto items) {
        for (std::uint32_t i = 0; foveated_ && i < capacity && i < chained.size(); ++i)
          items[i].next = &chained[i];
        return runtime_.xr().EnumerateViewConfigurationViews(
            runtime_.instance(), runtime_.system(), configuration_, capacity, count, items);
      });
  NERITIC_TRY_STATUS(runtime_.check(result, "xrEnumerateViewConfigurationViews"));
  for (XrViewConfigurationView& size : sizes) size.next = nullptr;
  if (sizes.empty())
    return failure(ErrorCode::kUnsupported, "{} has no views", runtime_.info().runtime);
  return sizes;
}

// The larger of what the runtime recommends for the views, but no more than each view, and its
// images, may have: a setting of supersampling may ask for more than either.
VkExtent2D Views::size_of_pair(std::span<const XrViewConfigurationView> sizes) const {
  VkExtent2D wanted{1, 1};
  // A runtime that names no limit has none.
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  const auto limit = [](std::uint32_t told) { return told > 0 ? told : kNone; };
  const XrSystemGraphicsProperties& images = runtime_.properties().graphicsProperties;
  VkExtent2D most{limit(images.maxSwapchainImageWidth), limit(images.maxSwapchainImageHeight)};
  for (const XrViewConfigurationView& view : sizes) {
    wanted.width = std::max(wanted.width, view.recommendedImageRectWidth);
    wanted.height = std::max(wanted.height, view.recommendedImageRectHeight);
    most.width = std::min(most.width, limit(view.maxImageRectWidth));
    most.height = std::min(most.height, limit(view.maxImageRectHeight));
  }
  const VkExtent2D size{std::min(wanted.width, most.width), std::min(wanted.height, most.height)};
  if (size.width < wanted.width || size.height < wanted.height)
    log_warn("{} recommends views of {} x {} pixels, but takes {} x {} at most: they are drawn so",
             runtime_.info().runtime, wanted.width, wanted.height, most.width, most.height);
  return size;
}

Status Views::make_swapchains(gpu::Device& device, std::span<const XrViewConfigurationView> sizes) {
  NERITIC_TRY(const auto formats, swapchain_formats(runtime_, session_.handle()));
  NERITIC_TRY(const VkFormat color, choose_color(formats));
  VkFormat depth = runtime_.has().depth ? choose_depth(formats) : VK_FORMAT_UNDEFINED;
  // The views of a pair share one image: its size is the larger of the two.
  for (std::size_t first = 0; first < sizes.size(); first += 2) {
    Group group{.first = first, .count = std::min<std::size_t>(2, sizes.size() - first)};
    const VkExtent2D size = size_of_pair(sizes.subspan(first, group.count));
    const auto number = groups_.size();
    SwapchainDesc desc{
        .name = fmt::format("headset color {}", number),
        .format = color,
        .usage = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_SAMPLED_BIT,
        .width = size.width,
        .height = size.height,
        .layers = static_cast<std::uint32_t>(group.count)};
    NERITIC_TRY(group.color, Swapchain::create(runtime_, session_.handle(), device, desc));
    if (depth != VK_FORMAT_UNDEFINED) {
      desc.name = fmt::format("headset depth {}", number);
      desc.format = depth;
      desc.usage = XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                   XR_SWAPCHAIN_USAGE_SAMPLED_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
      auto made = Swapchain::create(runtime_, session_.handle(), device, desc);
      if (made.ok())
        group.depth = std::move(made).value();
      else if (!runtime_.goes_without(made.error(), "the pictures go without their depth"))
        return made.error();
      else
        depth = VK_FORMAT_UNDEFINED;
    }
    groups_.push_back(std::move(group));
  }
  return {};
}

void Views::read_masks() {
  hidden_.assign(views_.size(), {});
  if (!runtime_.has().mask || !runtime_.xr().GetVisibilityMaskKHR) return;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const auto ask = [&](XrVisibilityMaskKHR& mask) {
      return XR_SUCCEEDED(runtime_.xr().GetVisibilityMaskKHR(
          session_.handle(), configuration_, static_cast<std::uint32_t>(i),
          XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR, &mask));
    };
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    // A sharp view that follows the gaze has another frustum in each frame.
    if (foveated_ && i >= 2) break;
    if (!ask(mask) || mask.vertexCountOutput == 0 || mask.indexCountOutput == 0 ||
        mask.vertexCountOutput > kMostHiddenCorners || mask.indexCountOutput > kMostHiddenCorners)
      continue;
    std::vector<XrVector2f> points(mask.vertexCountOutput);
    std::vector<std::uint32_t> corners(mask.indexCountOutput);
    mask.vertexCapacityInput = mask.vertexCountOutput;
    mask.indexCapacityInput = mask.indexCountOutput;
    mask.vertices = points.data();
    mask.indices = corners.data();
    // A mesh that names points it has not, or more triangles than a mask needs, is no mask.
    if (!ask(mask) || corners.size() % 3 != 0 || corners.size() > kMostHiddenCorners) continue;
    if (std::ranges::any_of(corners, [&](std::uint32_t c) { return c >= points.size(); })) continue;
    for (const std::uint32_t c : corners) hidden_[i].emplace_back(points[c].x, points[c].y);
  }
}

bool Views::gaze_ready(XrTime at) const {
  XrSpaceLocation eyes{XR_TYPE_SPACE_LOCATION};
  return foveated_ && XR_SUCCEEDED(runtime_.xr().LocateSpace(eyes_, session_.head(), at, &eyes)) &&
         (eyes.locationFlags & XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT);
}

Result<bool> Views::locate(XrTime at) {
  XrSpaceLocation head{XR_TYPE_SPACE_LOCATION};
  NERITIC_TRY_STATUS(runtime_.check(
      runtime_.xr().LocateSpace(session_.head(), session_.stage(), at, &head), "xrLocateSpace"));
  std::vector<XrView> found;
  NERITIC_TRY(const XrViewStateFlags state, locate_in(session_.stage(), at, found));
  if (!(state & XR_VIEW_STATE_ORIENTATION_VALID_BIT) ||
      !(head.locationFlags & XR_SPACE_LOCATION_ORIENTATION_VALID_BIT))
    return false;
  if ((state & XR_VIEW_STATE_POSITION_VALID_BIT) &&
      (head.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT)) {
    views_ = std::move(found);
    stage_from_head_ = to_pose(head.pose);
    last_m_ = stage_from_head_.position_m;
    return true;
  }
  // The eyes in the head are known wherever that is.
  NERITIC_TRY(const XrViewStateFlags in_head, locate_in(session_.head(), at, found));
  constexpr XrViewStateFlags kWhole =
      XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;
  const Pose before = stage_from_head_;
  head.pose.position = {0.0f, 0.0f, 0.0f};
  stage_from_head_ = {last_m_.value_or(standing_eyes_m()), to_pose(head.pose).rotation};
  for (std::size_t i = 0; i < found.size(); ++i) {
    // Else as they were in the head.
    const Pose head_from_view = (in_head & kWhole) == kWhole
                                    ? to_pose(found[i].pose)
                                    : inverse(before) * to_pose(views_[i].pose);
    found[i].pose = to_xr(stage_from_head_ * head_from_view);
  }
  views_ = std::move(found);
  return true;
}

// In the room above its floor; else the origin is where the head was.
Vec3 Views::standing_eyes_m() const {
  return {0.0, session_.in_room() ? kEyes_m : 0.0, 0.0};
}

Result<XrViewStateFlags> Views::locate_in(XrSpace space, XrTime at,
                                          std::vector<XrView>& found) const {
  XrViewLocateFoveatedRenderingVARJO foveated{XR_TYPE_VIEW_LOCATE_FOVEATED_RENDERING_VARJO};
  foveated.foveatedRenderingActive = gaze_ready(at) ? XR_TRUE : XR_FALSE;
  XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO, foveated_ ? &foveated : nullptr};
  info.viewConfigurationType = configuration_;
  info.displayTime = at;
  info.space = space;
  XrViewState state{XR_TYPE_VIEW_STATE};
  found.assign(views_.size(), {XR_TYPE_VIEW});
  std::uint32_t count = 0;
  NERITIC_TRY_STATUS(runtime_.check(
      runtime_.xr().LocateViews(session_.handle(), &info, &state,
                                static_cast<std::uint32_t>(found.size()), &count, found.data()),
      "xrLocateViews"));
  return count == found.size() ? state.viewStateFlags : XrViewStateFlags{0};
}

std::vector<ViewGroup> Views::groups() const {
  std::vector<ViewGroup> out;
  for (const Group& group : groups_) {
    ViewGroup views{group.color->desc().width, group.color->desc().height, {}};
    for (std::size_t i = group.first; i < group.first + group.count; ++i)
      views.views.push_back({inverse(stage_from_head_) * to_pose(views_[i].pose),
                             to_tangents(views_[i].fov), hidden_[i]});
    out.push_back(std::move(views));
  }
  return out;
}

const XrCompositionLayerBaseHeader* Views::layer(std::span<const Drawn> drawn) {
  layer_views_.assign(views_.size(), {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW});
  layer_depths_.assign(views_.size(), {XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR});
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (std::size_t i = 0; i < groups_[g].count; ++i) {
      XrCompositionLayerProjectionView& view = layer_views_[groups_[g].first + i];
      view.pose = views_[groups_[g].first + i].pose;
      view.fov = views_[groups_[g].first + i].fov;
      view.subImage = groups_[g].color->sub_image(static_cast<std::uint32_t>(i));
      view.subImage.imageRect.extent = extent_of(drawn[g].color);
      if (!(drawn[g].near_m > 0.0) || !groups_[g].depth) continue;
      // Reversed: 0 is at infinity, 1 at near_m.
      XrCompositionLayerDepthInfoKHR& depth = layer_depths_[groups_[g].first + i];
      depth.subImage = groups_[g].depth->sub_image(static_cast<std::uint32_t>(i));
      depth.subImage.imageRect.extent = extent_of(drawn[g].depth);
      depth.minDepth = 0.0f;
      depth.maxDepth = 1.0f;
      depth.nearZ = std::numeric_limits<float>::infinity();
      depth.farZ = static_cast<float>(drawn[g].near_m);
      view.next = &depth;
    }
  layer_.space = session_.stage();
  layer_.viewCount = static_cast<std::uint32_t>(layer_views_.size());
  layer_.views = layer_views_.data();
  return reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer_);
}

}  // namespace neritic::xr::openxr
