// The compositor: what the wearer of the headset sees in each view, on the CPU. Layers one over the
// other in their order, by rays from the eye where it is at the frame's display time. A projection
// layer is turned to the eye (its views' positions are the eye's own, up to the time between);
// quads and cylinders are seen in space.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "tests/fakes/openxr/runtime.hpp"
#include "tests/fakes/openxr/texels.hpp"

namespace neritic::fakes {
namespace {

struct Eye {
  Pose world_from_eye;
  XrFovf fov;
  std::uint32_t view = 0;
  bool right() const { return view % 2 == 1; }
};

struct Ray {
  glm::dvec3 origin, direction;  // in the world; the direction has depth 1 in the eye
};

// Where a ray meets a layer's picture, from 0 to 1, v downwards.
using Hit = std::optional<glm::dvec2>;

// A picture of a swapchain, and the part that a layer shows.
struct Shown {
  const Texels* texels = nullptr;
  XrRect2Di rect{};
  glm::vec4 at(const glm::dvec2& uv) const {
    const double x = std::clamp(uv.x * rect.extent.width, 0.5, rect.extent.width - 0.5);
    const double y = std::clamp(uv.y * rect.extent.height, 0.5, rect.extent.height - 0.5);
    return texels->at(rect.offset.x + x, rect.offset.y + y);
  }
};

Hit hit_projection(const Ray& ray, const Pose& world_from_view, const XrFovf& fov) {
  const glm::dvec3 d = glm::conjugate(world_from_view.rotation) * ray.direction;
  if (d.z >= 0) return {};
  const double l = std::tan(fov.angleLeft), r = std::tan(fov.angleRight);
  const double t = std::tan(fov.angleUp), b = std::tan(fov.angleDown);
  const glm::dvec2 uv((d.x / -d.z - l) / (r - l), (t - d.y / -d.z) / (t - b));
  constexpr double kEdge = 1e-6;  // angles are floats
  if (uv.x < -kEdge || uv.x > 1 + kEdge || uv.y < -kEdge || uv.y > 1 + kEdge) return {};
  return uv;
}

// Only the front, on the side of +Z, is seen.
Hit hit_quad(const Ray& ray, const Pose& world_from_quad, const XrExtent2Df& size) {
  const Pose quad_from_world = inverse(world_from_quad);
  const glm::dvec3 o = transform(quad_from_world, ray.origin);
  const glm::dvec3 d = quad_from_world.rotation * ray.direction;
  if (o.z <= 0 || d.z >= 0) return {};
  const glm::dvec3 p = o - d * (o.z / d.z);
  const glm::dvec2 uv(p.x / size.width + 0.5, 0.5 - p.y / size.height);
  if (uv.x < 0 || uv.x > 1 || uv.y < 0 || uv.y > 1) return {};
  return uv;
}

// Only the inside is seen. The axis is Y, the middle of the picture towards -Z; radius 0: infinite.
Hit hit_cylinder(const Ray& ray, const Pose& world_from_cylinder,
                 const XrCompositionLayerCylinderKHR& layer) {
  const Pose cylinder_from_world = inverse(world_from_cylinder);
  glm::dvec3 o = transform(cylinder_from_world, ray.origin);
  const glm::dvec3 d = cylinder_from_world.rotation * ray.direction;
  const bool infinite = layer.radius == 0 || std::isinf(layer.radius);
  const double radius = infinite ? 1 : layer.radius;
  if (infinite) o = glm::dvec3(0);
  const double a = d.x * d.x + d.z * d.z, b = o.x * d.x + o.z * d.z;
  const double c = o.x * o.x + o.z * o.z - radius * radius;
  if (a == 0 || b * b < a * c) return {};
  const double along = (-b + std::sqrt(b * b - a * c)) / a;  // the far side, met from within
  if (along <= 0) return {};
  const glm::dvec3 p = o + d * along;
  const double height = radius * layer.centralAngle / layer.aspectRatio;
  const glm::dvec2 uv(std::atan2(p.x, -p.z) / layer.centralAngle + 0.5, 0.5 - p.y / height);
  if (uv.x < 0 || uv.x > 1 || uv.y < 0 || uv.y > 1) return {};
  return uv;
}

void blend(glm::vec4& to, glm::vec4 from, XrCompositionLayerFlags flags) {
  if (!(flags & XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT))
    from.w = 1;
  else if (flags & XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT)
    from = glm::vec4(glm::vec3(from) * from.w, from.w);
  to = glm::vec4(glm::vec3(from) + glm::vec3(to) * (1 - from.w), 1);
}

// Metres before the view of a stored depth: nearZ at minDepth, farZ at maxDepth, linear in 1 / z.
float metres(float depth, const XrCompositionLayerDepthInfoKHR& info) {
  const double part = (depth - info.minDepth) / (info.maxDepth - info.minDepth);
  const double near = 1.0 / info.nearZ, far = 1.0 / info.farZ;  // of infinity, 0
  const double inverse = near + part * (far - near);
  return inverse > 0 ? static_cast<float>(1 / inverse) : std::numeric_limits<float>::infinity();
}

class Compositor {
 public:
  Compositor(Call& call, Session& session, const XrFrameEndInfo& info)
      : call_(call), session_(session), info_(info) {}

  Texels see(const Eye& eye, std::uint32_t width, std::uint32_t height) {
    Texels picture{width, height, {}};
    const auto& background = call_.rt.script.background;
    picture.data.assign(std::size_t{width} * height,
                        glm::vec4(background[0], background[1], background[2], 1));
    for (std::uint32_t i = 0; i < info_.layerCount; ++i) draw(*info_.layers[i], eye, picture);
    return picture;
  }

  // The depth that comes with a view of the projection layer, in metres; empty without one.
  Texels depth(std::uint32_t view) {
    for (std::uint32_t i = 0; i < info_.layerCount; ++i) {
      if (info_.layers[i]->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION) continue;
      const auto* layer = reinterpret_cast<const XrCompositionLayerProjection*>(info_.layers[i]);
      const auto* with = Call::chained<XrCompositionLayerDepthInfoKHR>(layer->views[view].next);
      if (!with) continue;
      const XrRect2Di& rect = with->subImage.imageRect;
      const Shown shown = show(with->subImage);
      Texels to{static_cast<std::uint32_t>(rect.extent.width),
                static_cast<std::uint32_t>(rect.extent.height),
                {}};
      for (int y = 0; y < rect.extent.height; ++y) {
        for (int x = 0; x < rect.extent.width; ++x) {
          const glm::vec4 d = shown.texels->at(rect.offset.x + x + 0.5, rect.offset.y + y + 0.5);
          to.data.emplace_back(metres(d.x, *with), 0, 0, 0);
        }
      }
      return to;
    }
    return {};
  }

 private:
  void draw(const XrCompositionLayerBaseHeader& base, const Eye& eye, Texels& picture) {
    const auto seen_by = [&](XrEyeVisibility visibility) {
      return visibility == XR_EYE_VISIBILITY_BOTH ||
             (visibility == XR_EYE_VISIBILITY_RIGHT) == eye.right();
    };
    const Pose world_from_space =
        locate(call_.rt, call_.get<Space>(base.space), info_.displayTime).pose;
    if (base.type == XR_TYPE_COMPOSITION_LAYER_PROJECTION) {
      const auto& layer = reinterpret_cast<const XrCompositionLayerProjection&>(base);
      const XrCompositionLayerProjectionView& view = layer.views[eye.view];
      const Pose world_from_view = world_from_space * from_xr(view.pose);
      draw(picture, eye, base.layerFlags, view.subImage,
           [&](const Ray& ray) { return hit_projection(ray, world_from_view, view.fov); });
    } else if (base.type == XR_TYPE_COMPOSITION_LAYER_QUAD) {
      const auto& layer = reinterpret_cast<const XrCompositionLayerQuad&>(base);
      const Pose world_from_quad = world_from_space * from_xr(layer.pose);
      if (seen_by(layer.eyeVisibility)) {
        draw(picture, eye, base.layerFlags, layer.subImage,
             [&](const Ray& ray) { return hit_quad(ray, world_from_quad, layer.size); });
      }
    } else {
      const auto& layer = reinterpret_cast<const XrCompositionLayerCylinderKHR&>(base);
      const Pose world_from_cylinder = world_from_space * from_xr(layer.pose);
      if (seen_by(layer.eyeVisibility)) {
        draw(picture, eye, base.layerFlags, layer.subImage,
             [&](const Ray& ray) { return hit_cylinder(ray, world_from_cylinder, layer); });
      }
    }
  }

  template <class Meet>
  void draw(Texels& picture, const Eye& eye, XrCompositionLayerFlags flags,
            const XrSwapchainSubImage& image, const Meet& meet) {
    const Shown shown = show(image);
    const double l = std::tan(eye.fov.angleLeft), r = std::tan(eye.fov.angleRight);
    const double t = std::tan(eye.fov.angleUp), b = std::tan(eye.fov.angleDown);
    for (std::uint32_t y = 0; y < picture.height; ++y) {
      for (std::uint32_t x = 0; x < picture.width; ++x) {
        const glm::dvec3 d(l + (x + 0.5) / picture.width * (r - l),
                           t - (y + 0.5) / picture.height * (t - b), -1);
        const Hit uv = meet({eye.world_from_eye.position, eye.world_from_eye.rotation * d});
        if (uv) blend(picture.data[std::size_t{y} * picture.width + x], shown.at(*uv), flags);
      }
    }
  }

  // Each picture is read once a frame.
  Shown show(const XrSwapchainSubImage& image) {
    const Swapchain& swapchain = call_.get<Swapchain>(image.swapchain);
    Texels& texels = read_[{swapchain.handle, image.imageArrayIndex}];
    if (texels.data.empty()) {
      const VkImage vk = swapchain.images[static_cast<std::size_t>(swapchain.released)].image;
      const auto bytes = read_back(*session_.gpu, swapchain.info, vk, image.imageArrayIndex);
      if (bytes.empty()) call_.refuse(XR_ERROR_RUNTIME_FAILURE);
      texels = decode(bytes, swapchain.info.format, swapchain.info.width, swapchain.info.height);
    }
    return {&texels, image.imageRect};
  }

  Call& call_;
  Session& session_;
  const XrFrameEndInfo& info_;
  std::map<std::pair<std::uint64_t, std::uint32_t>, Texels> read_;
};

}  // namespace

void compose(Call& call, Session& session, const XrFrameEndInfo& info) {
  const Script& script = call.rt.script;
  const std::uint64_t frame = session.begun.number;
  if (script.out.empty()) return;
  if (!script.out_frames.empty() && !script.out_frames.contains(frame)) return;
  std::filesystem::create_directories(script.out);
  Compositor compositor(call, session, info);
  const Pose head = locate_view_space(call.rt, info.displayTime).pose;
  std::optional<glm::dquat> gaze;
  if (session.foveated) gaze = script.gaze.at(call.rt.seconds(info.displayTime)).rotation;
  const auto views = views_in_head(script, session.views, gaze);
  for (std::uint32_t i = 0; i < views.size(); ++i) {
    const Eye eye{head * from_xr(views[i].pose), views[i].fov, i};
    const std::string path = fmt::format("{}/{}frame_{:04}_view_{}", script.out,
                                         session.overlay ? "overlay_" : "", frame, i);
    const Texels picture = compositor.see(eye, i < 2 ? script.width : script.focus_width,
                                          i < 2 ? script.height : script.focus_height);
    if (!write_png(path + ".png", picture)) call.note_fault("the fake cannot write " + path);
    const Texels depth = compositor.depth(i);
    if (!depth.data.empty()) write_npy(path + "_depth.npy", depth);
  }
}

}  // namespace neritic::fakes
