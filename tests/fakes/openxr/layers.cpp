// Checks of the layers that a frame ends with.
#include <fmt/format.h>

#include <cmath>

#include "tests/fakes/openxr/runtime.hpp"

namespace neritic::fakes {
namespace {

constexpr XrCompositionLayerFlags kFlags = XR_COMPOSITION_LAYER_CORRECT_CHROMATIC_ABERRATION_BIT |
                                           XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT |
                                           XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT;

class LayerCheck {
 public:
  LayerCheck(Call& call, const Session& session, std::uint32_t index)
      : call_(call), session_(session), index_(index) {}

  void operator()(const XrCompositionLayerBaseHeader* layer) {
    require(layer, XR_ERROR_LAYER_INVALID, "is a null pointer");
    switch (layer->type) {
      case XR_TYPE_COMPOSITION_LAYER_PROJECTION:
        return projection(*reinterpret_cast<const XrCompositionLayerProjection*>(layer));
      case XR_TYPE_COMPOSITION_LAYER_QUAD:
        return quad(*reinterpret_cast<const XrCompositionLayerQuad*>(layer));
      case XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR:
        require(call_.enabled(XR_KHR_COMPOSITION_LAYER_CYLINDER_EXTENSION_NAME),
                XR_ERROR_LAYER_INVALID,
                "is a cylinder, but XR_KHR_composition_layer_cylinder was not enabled");
        return cylinder(*reinterpret_cast<const XrCompositionLayerCylinderKHR*>(layer));
      default:
        require(false, XR_ERROR_LAYER_INVALID, "has the type " + name_of(layer->type));
    }
  }

 private:
  void require(bool fine, XrResult result, const std::string& rule) {
    call_.require(fine, result, fmt::format("layer {} {}", index_, rule));
  }

  void header(XrCompositionLayerFlags flags, XrSpace space) {
    require((flags & ~kFlags) == 0, XR_ERROR_VALIDATION_FAILURE, "has unknown layerFlags");
    const Space& found = call_.get<Space>(space);
    require(&found.session == &session_, XR_ERROR_VALIDATION_FAILURE,
            "is in a space of another session");
  }

  const Swapchain& sub_image(const XrSwapchainSubImage& image, bool depth) {
    const Swapchain& swapchain = call_.get<Swapchain>(image.swapchain);
    require(&swapchain.session == &session_, XR_ERROR_VALIDATION_FAILURE,
            "shows a swapchain of another session");
    require(swapchain.released >= 0, XR_ERROR_LAYER_INVALID,
            "shows a swapchain of which no image was released yet");
    require(is_depth(swapchain.info.format) == depth, XR_ERROR_VALIDATION_FAILURE,
            depth ? "gives as depth a swapchain of a colour format"
                  : "shows a swapchain of a depth format");
    require(image.imageArrayIndex < swapchain.info.arraySize, XR_ERROR_VALIDATION_FAILURE,
            fmt::format("has imageArrayIndex {}; the swapchain's arraySize is {}",
                        image.imageArrayIndex, swapchain.info.arraySize));
    const XrRect2Di& r = image.imageRect;
    const auto w = static_cast<std::int64_t>(swapchain.info.width);
    const auto h = static_cast<std::int64_t>(swapchain.info.height);
    require(r.offset.x >= 0 && r.offset.y >= 0 && r.extent.width > 0 && r.extent.height > 0 &&
                std::int64_t{r.offset.x} + r.extent.width <= w &&
                std::int64_t{r.offset.y} + r.extent.height <= h,
            XR_ERROR_SWAPCHAIN_RECT_INVALID,
            fmt::format("has an imageRect of {} x {} at {}, {}, which is not within {} x {}",
                        r.extent.width, r.extent.height, r.offset.x, r.offset.y, w, h));
    return swapchain;
  }

  // Turned round, a frustum flips its content; flat, it shows nothing.
  void fov(const XrFovf& f) {
    constexpr float kRight = 1.5707964f;
    const auto fine = [&](float low, float high) {
      return std::abs(low) < kRight && std::abs(high) < kRight && low != high;
    };
    require(
        fine(f.angleLeft, f.angleRight) && fine(f.angleDown, f.angleUp),
        XR_ERROR_VALIDATION_FAILURE,
        fmt::format("has a fov of {:.3f} to {:.3f} and {:.3f} to {:.3f} rad; each angle must be "
                    "within a right angle, and opposite ones must differ",
                    f.angleLeft, f.angleRight, f.angleDown, f.angleUp));
  }

  void depth(const XrCompositionLayerDepthInfoKHR& info) {
    require(!info.next, XR_ERROR_VALIDATION_FAILURE, "has a chain after its depth");
    sub_image(info.subImage, true);
    require(info.minDepth >= 0 && info.minDepth < info.maxDepth && info.maxDepth <= 1,
            XR_ERROR_VALIDATION_FAILURE,
            fmt::format("has minDepth {} and maxDepth {}; 0 <= minDepth < maxDepth <= 1 must hold",
                        info.minDepth, info.maxDepth));
    require(info.nearZ > 0 && info.farZ > 0 && info.nearZ != info.farZ, XR_ERROR_VALIDATION_FAILURE,
            fmt::format("has nearZ {} and farZ {}; both must be above 0 and differ", info.nearZ,
                        info.farZ));
  }

  void projection(const XrCompositionLayerProjection& layer) {
    call_.in(&layer);
    header(layer.layerFlags, layer.space);
    require(layer.viewCount == view_count(session_.views), XR_ERROR_VALIDATION_FAILURE,
            fmt::format("has {} views; the session's configuration has {}", layer.viewCount,
                        view_count(session_.views)));
    for (std::uint32_t i = 0; i < layer.viewCount; ++i) {
      const auto& view =
          call_.in(layer.views + i, {{XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR,
                                      XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME}});
      call_.check_pose(view.pose);
      fov(view.fov);
      sub_image(view.subImage, false);
      if (const auto* info = Call::chained<XrCompositionLayerDepthInfoKHR>(view.next)) {
        depth(*info);
      }
    }
  }

  void eye(XrEyeVisibility visibility) {
    require(visibility >= XR_EYE_VISIBILITY_BOTH && visibility <= XR_EYE_VISIBILITY_RIGHT,
            XR_ERROR_VALIDATION_FAILURE, "has an unknown eyeVisibility");
  }

  void quad(const XrCompositionLayerQuad& layer) {
    call_.in(&layer);
    header(layer.layerFlags, layer.space);
    eye(layer.eyeVisibility);
    sub_image(layer.subImage, false);
    call_.check_pose(layer.pose);
    require(layer.size.width > 0 && layer.size.height > 0, XR_ERROR_VALIDATION_FAILURE,
            fmt::format("has the size {} x {} m", layer.size.width, layer.size.height));
  }

  void cylinder(const XrCompositionLayerCylinderKHR& layer) {
    call_.in(&layer);
    header(layer.layerFlags, layer.space);
    eye(layer.eyeVisibility);
    sub_image(layer.subImage, false);
    call_.check_pose(layer.pose);
    require(layer.radius >= 0, XR_ERROR_VALIDATION_FAILURE,
            fmt::format("has the radius {} m", layer.radius));
    require(layer.centralAngle >= 0 && layer.centralAngle < 6.2831855f, XR_ERROR_VALIDATION_FAILURE,
            fmt::format("has the centralAngle {}; accepted: 0 to below 2 pi", layer.centralAngle));
    require(layer.aspectRatio > 0, XR_ERROR_VALIDATION_FAILURE,
            fmt::format("has the aspectRatio {}", layer.aspectRatio));
  }

  Call& call_;
  const Session& session_;
  std::uint32_t index_;
};

}  // namespace

void check_layers(Call& call, Session& session, const XrFrameEndInfo& info) {
  call.require(
      info.layerCount <= call.rt.script.max_layers, XR_ERROR_LAYER_LIMIT_EXCEEDED,
      fmt::format("{} layers; maxLayerCount is {}", info.layerCount, call.rt.script.max_layers));
  if (info.layerCount > 0) call.not_null(info.layers, "layers");
  for (std::uint32_t i = 0; i < info.layerCount; ++i) {
    LayerCheck(call, session, i)(info.layers[i]);
  }
}

}  // namespace neritic::fakes
