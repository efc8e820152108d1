#include "testbed/sensors/view_sensor.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "engine/render/bands.hpp"
#include "engine/render/lighting.hpp"
#include "engine/render/sea_waves.hpp"
#include "testbed/sensors/session.hpp"
#include "testbed/sensors/view_light.hpp"

namespace neritic::testbed {
namespace {

Status check_size(const gpu::Device& device, const std::string& what,
                  const render::ViewSet& views) {
  const std::uint32_t limit = device.limits().maxImageDimension2D;
  if (views.width == 0 || views.height == 0 || views.width > limit || views.height > limit)
    return refusal(what, fmt::format("size {}x{}", views.width, views.height),
                   fmt::format("1 to {} pixels a side", limit));
  return {};
}

// Pixels a side whose mean is one of the picture.
std::uint32_t averaged(const scene::PictureDetail& detail) {
  return detail.resolution > 1.0 ? static_cast<std::uint32_t>(std::lround(detail.resolution)) : 1u;
}

// Gains that make a white card at the camera neutral, as the water leaves daylight there.
Result<Vec3f> automatic_white(const shared::Lighting& lighting, const scene::Water* water,
                              const scene::CameraTerms& terms) {
  if (!(lighting.terms & shared::kLightSun)) return Vec3f(1.0f);
  const float depth_m = water ? std::max(0.0f, lighting.origin_depth_m) : 0.0f;
  Vec3f light = lighting.surface_irradiance;
  if (water && terms.spectrum) {
    NERITIC_TRY(const Vec3 white,
                render::white_under_water(water->type, render::make_bands(*terms.spectrum),
                                          double(depth_m)));
    light *= glm::max(Vec3f(white), Vec3f(1e-30f));
  } else {
    for (int i = 0; i < 3; ++i) light[i] *= std::exp(-lighting.diffuse_attenuation[i] * depth_m);
  }
  if (!(light.y > 0.0f)) return Vec3f(1.0f);
  return glm::clamp(Vec3f(light.y) / glm::max(light, Vec3f(1e-30f)), 0.25f, 4.0f);
}

struct CameraHdr {
  graph::ImageHandle hdr;
  Vec3f white{1.0f};
};

// Applies lens and sensor to the picture, and leaves it as it is where none is named.
Result<CameraHdr> declare_camera(const FrameParts& frame, const std::string& prefix,
                                 graph::ImageHandle hdr, std::uint32_t layers,
                                 const CameraPicture& picture, const shared::Lighting& lighting) {
  const scene::CameraTerms& terms = picture.terms;
  if (!terms.lens && !terms.sensor && !terms.white_balance && !(terms.vignette > 0.0))
    return CameraHdr{hdr};
  shared::CameraParams params{};
  std::uint32_t bits = 0;
  params.focal_px = static_cast<float>(picture.focal_px);
  params.center_px = {0.5f * float(picture.width), 0.5f * float(picture.height)};
  if (terms.lens) {
    bits |= shared::kCameraLens;
    params.model =
        terms.lens->model == scene::LensModel::kFisheye ? shared::kLensFisheye : shared::kLensBrown;
    for (int i = 0; i < 4; ++i)
      params.k[i] = static_cast<float>(terms.lens->k[static_cast<std::size_t>(i)]);
    params.p = {float(terms.lens->p[0]), float(terms.lens->p[1])};
    params.port = static_cast<std::uint32_t>(terms.lens->port.kind);
    params.port_offset = static_cast<float>(terms.lens->port.offset);
    params.source_focal_px = static_cast<float>(picture.lens->source.fx);
    params.source_center_px = {float(picture.lens->source.cx), float(picture.lens->source.cy)};
  }
  if (terms.vignette > 0.0) {
    bits |= shared::kCameraVignette;
    params.vignette = static_cast<float>(terms.vignette);
  }
  if (terms.sensor) {
    bits |= shared::kCameraNoise;
    params.electrons = static_cast<float>(terms.sensor->electrons_per_unit());
    params.read_noise_e = static_cast<float>(terms.sensor->read_noise_e);
    params.saturation = static_cast<float>(terms.sensor->saturation());
    params.steps = static_cast<float>(std::exp2(terms.sensor->bits) - 1.0);
    params.seed = static_cast<std::uint32_t>(frame.seed ^ (frame.seed >> 32));
    params.stream = picture.stream;
    params.frame = frame.frame;
  }
  CameraHdr out;
  if (terms.white_balance) {
    bits |= shared::kCameraWhite;
    out.white = Vec3f(terms.white_balance->gains);
    if (terms.white_balance->automatic) {
      NERITIC_TRY(
          out.white,
          automatic_white(lighting, frame.scene.water ? &*frame.scene.water : nullptr, terms));
    }
    params.white = out.white;
  }
  NERITIC_TRY(out.hdr, frame.renderer.declare_camera(frame.graph, prefix, hdr, params, bits,
                                                     picture.width, picture.height, layers));
  return out;
}

// Fills the grid with the sensor's row that shows each point of the picture before the lens. A
// point that the lens does not show gets the row that it has without a lens.
void add_rows(const scene::Lens& lens, const scene::LensView& view, std::uint32_t height,
              shared::ShutterParams& params) {
  params.by_lens = 1;
  const Intrinsics &from = view.source, &to = view.lens;
  std::size_t out = 0;
  for (std::uint32_t j = 0; j <= shared::kRowSteps; ++j)
    for (std::uint32_t i = 0; i <= shared::kRowSteps; ++i) {
      const glm::dvec2 share = glm::dvec2(i, j) / double(shared::kRowSteps);
      const glm::dvec2 plane((share.x * view.width - from.cx) / from.fx,
                             (share.y * view.height - from.cy) / from.fy);
      const double row = scene::unfolded(lens, plane)
                             ? (to.fy * scene::through_lens(lens, plane).y + to.cy) / height
                             : share.y;
      params.row[out++] = static_cast<float>(std::clamp(row, 0.0, 1.0));
    }
}

// Focus and shutter, before the lens.
Result<graph::ImageHandle> declare_focus_and_shutter(const FrameParts& frame,
                                                     const std::string& prefix,
                                                     graph::ImageHandle hdr,
                                                     const render::GBuffer& g, double near_m,
                                                     const CameraPicture& picture) {
  const scene::CameraTerms& terms = picture.terms;
  if (terms.focus) {
    const scene::Focus& focus = *terms.focus;
    const double focal_px = picture.lens ? picture.lens->source.fx : picture.focal_px;
    const double opening_m = focus.focal_length_m / focus.f_number;
    // No spot is wider than a twentieth of the picture.
    const double widest_px =
        std::clamp(opening_m / 2.0 * focal_px / std::max(near_m, 0.2), 1.0, 0.05 * g.height + 1.0);
    NERITIC_TRY(hdr, frame.renderer.declare_focus(
                         frame.graph, prefix, hdr, g,
                         {static_cast<float>(near_m), static_cast<float>(focus.distance_m),
                          static_cast<float>(opening_m / 2.0 * focal_px),
                          static_cast<float>(widest_px), focus.samples}));
  }
  const double step_s = frame.state.next_time_s - frame.state.time_s;
  if (terms.shutter && g.motion && step_s > 0.0) {
    const scene::Shutter& shutter = *terms.shutter;
    shared::ShutterParams params{.exposed = static_cast<float>(shutter.exposure_s / step_s),
                                 .readout = static_cast<float>(shutter.readout_s / step_s),
                                 .samples = shutter.samples,
                                 .farthest_px = 0.25f * static_cast<float>(g.width)};
    if (picture.lens) add_rows(*terms.lens, *picture.lens, picture.height, params);
    NERITIC_TRY(hdr, frame.renderer.declare_shutter(frame.graph, prefix, hdr, g, params));
  }
  return hdr;
}

// The picture of the scene in its light and its water, before the camera.
Result<graph::ImageHandle> declare_lit(const FrameParts& frame, const std::string& prefix,
                                       const render::GBuffer& g, const render::ViewSet& views,
                                       const render::DrawList& draws, const ViewsRequest& request,
                                       const ViewsWork& work, const shared::Lighting& lighting,
                                       const render::LightImages& light) {
  const scene::PictureDetail& detail = request.detail;
  graph::ImageHandle scattered;
  std::optional<shared::Waves> waves;
  if (lighting.terms & shared::kLightWaves) {
    waves = render::gpu_waves(frame.waves, views.origin_m(), frame.state.time_s);
    // The slopes of what is left out count among those that no pixel resolves.
    waves->count = std::min(waves->count, detail.waves);
  }
  NERITIC_TRY(graph::ImageHandle hdr,
              frame.renderer.declare_shade(frame.graph, prefix,
                                           {.gbuffer = g,
                                            .views = views,
                                            .lighting = lighting,
                                            .light = light,
                                            .scattered = &scattered,
                                            .waves = waves ? &*waves : nullptr,
                                            .visibility_step = visibility_step(frame.scene, detail),
                                            .inscatter_samples = detail.inscatter_samples}));
  NERITIC_TRY(hdr, frame.renderer.declare_forward(frame.graph, prefix, hdr, g, frame.gpu_scene,
                                                  frame.deformed, views, draws, lighting,
                                                  detail.inscatter_samples, &frame.pictures));
  if (scattered) {
    scene::ForwardScatter scatter = *frame.scene.water->forward_scatter;
    scatter.levels = std::min(scatter.levels, detail.scatter_levels);
    scatter.levels += static_cast<std::uint32_t>(std::bit_width(averaged(detail) - 1u));
    NERITIC_TRY(hdr, frame.renderer.water().declare_forward_scatter(
                         frame.graph, prefix, hdr, scattered, g, views, lighting, scatter));
  }
  if (frame.scene.water && frame.scene.water->column && frame.scene.water->column->count > 0) {
    NERITIC_TRY(hdr, frame.renderer.water().declare_shimmer(frame.graph, prefix, hdr, g, views,
                                                            *frame.scene.water->column,
                                                            frame.state.time_s, frame.scene.seed));
  }
  if (render::has_particles(frame.scene)) {
    const double step_s = frame.state.next_time_s - frame.state.time_s;
    const double shutter = step_s > 0.0 ? work.particles.shutter_s / step_s : 0.0;
    NERITIC_TRY(
        hdr, frame.renderer.water().declare_particles(
                 frame.graph, prefix, hdr, g, views, lighting, work.particles,
                 static_cast<float>(shutter), light.shaft_inputs ? &*light.shaft_inputs : nullptr));
  }
  return hdr;
}

// The same in bands, three at a time.
Result<graph::ImageHandle> declare_spectrum(const FrameParts& frame, const std::string& prefix,
                                            const render::GBuffer& g, const render::ViewSet& views,
                                            const render::DrawList& draws,
                                            const ViewsRequest& request, const ViewsWork& work,
                                            const shared::Lighting& lighting,
                                            const render::LightImages& light) {
  const render::BandSet bands = render::make_bands(*request.camera->terms.spectrum);
  NERITIC_TRY(const render::GBuffer reflectance,
              frame.renderer.declare_band_albedo(frame.graph, prefix, g, bands.bands_from_rgb));
  const std::string water = frame.scene.water ? frame.scene.water->type : std::string();
  std::vector<graph::ImageHandle> pictures;
  for (std::size_t i = 0; i < bands.pictures.size(); ++i) {
    NERITIC_TRY(const shared::Lighting lit, render::band_lighting(lighting, water, bands, i));
    NERITIC_TRY(const graph::ImageHandle picture,
                declare_lit(frame, fmt::format("{}bands {} ", prefix, i + 1), reflectance, views,
                            draws, request, work, lit, light));
    pictures.push_back(picture);
  }
  return frame.renderer.declare_merge(frame.graph, prefix, pictures, bands.rgb_from_bands, g);
}

// The tonemapped picture of a surface G-buffer. own: the G-buffer of the picture's pixels, for the
// camera's focus and shutter; g itself where each is shaded once.
Result<graph::ImageHandle> declare_color(const FrameParts& frame, const std::string& prefix,
                                         const render::GBuffer& g, const render::GBuffer& own,
                                         const render::ViewSet& views,
                                         const render::DrawList& draws, const ViewsRequest& request,
                                         ViewsWork& work) {
  const scene::PictureDetail& detail = request.detail;
  const bool exposes = request.camera && request.camera->terms.shutter;
  NERITIC_TRY(shared::Lighting lighting,
              render::make_lighting(frame.scene, frame.state, views.origin_m(), request.exposure,
                                    frame.gpu_scene.has_emission(),
                                    exposes ? request.camera->terms.shutter->exposure_s : 0.0));
  if (frame.gpu_scene.has_thin()) lighting.terms |= shared::kLightThin;
  if (!request.thrift.forward_scatter) lighting.terms &= ~shared::kLightForwardScatter;
  NERITIC_TRY(const render::LightImages light,
              declare_light(frame, prefix, g, views, draws, detail, work, lighting));
  // Once for all bands: the passes borrow them until the graph has run.
  if (render::has_particles(frame.scene)) {
    const render::SkylightGrid* skylight = nullptr;
    if (lighting.terms & shared::kLightSkylight) {
      NERITIC_TRY(skylight, frame.skylight.grid(frame));
    }
    work.particles = render::view_particles(frame.motion, frame.snow, frame.bubbles,
                                            frame.scene.seed, views, frame.state.time_s,
                                            detail.particles, request.thrift.spot_px, skylight);
    if (request.each_particle)
      for (const std::uint32_t kind : work.particles.kinds)
        work.particles.particles.push_back({.position = Vec3f(0.0f, 0.0f, -1.0f),
                                            .radius_m = 0.01f,
                                            .opacity = 0.0f,
                                            .kind = kind});
  }
  NERITIC_TRY(graph::ImageHandle hdr,
              request.camera && request.camera->terms.spectrum
                  ? declare_spectrum(frame, prefix, g, views, draws, request, work, lighting, light)
                  : declare_lit(frame, prefix, g, views, draws, request, work, lighting, light));
  const render::ViewSet& asked = work.views;
  std::uint32_t width = g.width, height = g.height;
  if (const std::uint32_t side = averaged(detail); side > 1) {
    width = asked.width, height = asked.height;
    NERITIC_TRY(hdr, frame.renderer.declare_average(frame.graph, prefix, hdr, side, width, height,
                                                    g.layers));
  }
  if (request.camera) {
    NERITIC_TRY(hdr, declare_focus_and_shutter(frame, prefix, hdr, own, views.views.front().near_m,
                                               *request.camera));
    NERITIC_TRY(const CameraHdr made,
                declare_camera(frame, prefix, hdr, g.layers, *request.camera, lighting));
    hdr = made.hdr;
    work.white = made.white;
    width = request.camera->width;
    height = request.camera->height;
    const scene::CameraTerms& terms = request.camera->terms;
    const bool raw = terms.sensor && terms.sensor->bayer != scene::Bayer::kNone;
    if (request.capture.to_host && request.capture.linear && (terms.linear || raw)) {
      NERITIC_TRY(work.linear,
                  frame.readback.declare(frame.graph, frame.device, prefix + "linear", hdr,
                                         render::kHdrFormat, width, height, g.layers));
    }
  }
  NERITIC_TRY(const graph::ImageHandle color,
              frame.renderer.declare_picture(frame.graph, prefix, hdr, width, height, g.layers,
                                             request.antialias));
  if (request.camera || (width == asked.width && height == asked.height)) return color;
  return frame.renderer.declare_resize(frame.graph, prefix, color, asked.width, asked.height,
                                       g.layers);
}

// A side of the picture as it is shaded.
std::uint32_t shaded(std::uint32_t side, double resolution) {
  return std::max(static_cast<std::uint32_t>(std::lround(side * resolution)), 1u);
}

}  // namespace

render::GBufferParts parts_of(const Capture& capture) {
  // Images that are not read back other passes may read: a view set's handles are whole.
  if (!capture.to_host) return {};
  return {.normal = capture.normals, .label = capture.labels || capture.instances};
}

Result<SensorFrame::Views> declare_views(const FrameParts& frame, const std::string& label,
                                         const ViewsRequest& request, ViewsWork& work) {
  const Capture& capture = request.capture;
  NERITIC_CHECK(!request.views.views.empty() && request.views.views.size() <= shared::kMaxViews,
                "{} has {} views", label, request.views.views.size());
  NERITIC_TRY_STATUS(check_size(frame.device, label, request.views));
  work.views = request.views;
  work.capture = capture;
  work.owner = label;
  work.camera = request.camera;
  if (capture.boxes && capture.to_host)
    for (const render::ViewDesc& view : work.views.views) {
      PictureMap map{intrinsics_of(view.tangents, work.views.width, work.views.height),
                     {},
                     view.near_m,
                     work.views.width,
                     work.views.height};
      if (work.camera && work.camera->lens)
        map = {work.camera->lens->lens, work.camera->terms.lens, view.near_m, work.camera->width,
               work.camera->height};
      work.boxes.push_back(instance_boxes(frame.scene, frame.state, view.world_from_view, map));
    }
  // Arrays at the host are measurements: of the meshes as they are, and so is a picture beside
  // them.
  const bool arrays = capture.to_host && (capture.geometry() || capture.motion);
  const std::string prefix = request.name + " ";
  const auto declare = [&](const std::string& name, render::GBufferKind kind,
                           const render::ViewSet& views, render::DrawList& draws,
                           const render::GBufferParts& parts, double mesh_error_px) {
    draws = render::build_draw_list(
        frame.scene, frame.gpu_scene, frame.state, views,
        {.mesh_error_px = mesh_error_px, .deform_need = &frame.deform_need});
    return frame.renderer.declare_gbuffer(frame.graph, name, kind, frame.gpu_scene, frame.state,
                                          frame.deformed, views, draws, parts, &frame.pictures);
  };
  // Lens and image sensor work on the whole picture.
  const bool coarse = capture.color && request.detail.resolution < 1.0 && !request.camera;
  const bool apart = coarse || (capture.color && averaged(request.detail) > 1);
  const bool follows = capture.color && request.camera &&
                       (request.camera->terms.focus || request.camera->terms.shutter);
  work.mesh_error_px = arrays && !apart ? 0.0 : request.detail.mesh_error;
  SensorFrame::Views out{.near_m = work.views.views.front().near_m,
                         .width = work.views.width,
                         .height = work.views.height,
                         .layers = work.views.layers()};
  // With or without colour the same geometry: single-sided materials, no blended ones in the depth.
  render::GBuffer g;
  if (!apart || capture.geometry() || capture.motion || follows) {
    const bool surface = capture.color && !apart;
    NERITIC_TRY(
        g,
        declare(prefix, surface ? render::GBufferKind::kSurface : render::GBufferKind::kShape,
                work.views, work.draws, surface ? render::GBufferParts{} : parts_of(capture),
                arrays ? 0.0 : std::max(request.detail.mesh_error, request.thrift.mesh_error_px)));
    out.depth = g.depth;
    out.normal = g.normal;
    out.label = g.label;
  }
  if (apart) {
    work.shaded_views = work.views;
    work.shaded_views.width = shaded(work.views.width, request.detail.resolution);
    work.shaded_views.height = shaded(work.views.height, request.detail.resolution);
    NERITIC_TRY_STATUS(check_size(frame.device, label + ", finely shaded,", work.shaded_views));
    NERITIC_TRY(const render::GBuffer shading,
                declare(prefix + "shaded ", render::GBufferKind::kSurface, work.shaded_views,
                        work.shaded_draws, {}, request.detail.mesh_error));
    NERITIC_TRY(out.color, declare_color(frame, prefix, shading, g, work.shaded_views,
                                         work.shaded_draws, request, work));
  } else if (capture.color) {
    NERITIC_TRY(out.color,
                declare_color(frame, prefix, g, g, work.views, work.draws, request, work));
  }
  if (!capture.to_host) return out;
  const auto bring = [&](const char* name, graph::ImageHandle image, VkFormat format) {
    return frame.readback.declare(frame.graph, frame.device, prefix + name, image, format,
                                  out.width, out.height, out.layers);
  };
  if (capture.color) {
    const std::uint32_t width = request.camera ? request.camera->width : out.width,
                        height = request.camera ? request.camera->height : out.height;
    NERITIC_TRY(work.color,
                frame.readback.declare(frame.graph, frame.device, prefix + "color", out.color,
                                       render::kColorFormat, width, height, out.layers));
  }
  NERITIC_TRY_STATUS(bring_geometry(frame, prefix, g, work));
  if (capture.motion && g.motion) {
    NERITIC_TRY(work.motion, bring("motion", g.motion, render::kMotionFormat));
  }
  return out;
}

Status bring_geometry(const FrameParts& frame, const std::string& prefix, const render::GBuffer& g,
                      ViewsWork& work) {
  const auto bring = [&](const char* name, graph::ImageHandle image, VkFormat format) {
    return frame.readback.declare(frame.graph, frame.device, prefix + name, image, format, g.width,
                                  g.height, g.layers);
  };
  const Capture& capture = work.capture;
  // Normals and motion need the depth on their way: it tells where nothing was hit.
  if (capture.depth || capture.normals || (capture.motion && g.motion)) {
    NERITIC_TRY(work.depth, bring("depth", g.depth, render::kDepthFormat));
  }
  if (capture.normals) {
    NERITIC_TRY(work.normal, bring("normal", g.normal, render::kNormalFormat));
  }
  if (capture.labels || capture.instances) {
    NERITIC_TRY(work.label, bring("label", g.label, render::kLabelFormat));
  }
  return {};
}

std::optional<scene::LensView> lens_view_of(const scene::Camera& camera) {
  if (!camera.terms.lens) return std::nullopt;
  auto view =
      scene::lens_view(*camera.terms.lens, camera.width, camera.height, camera.vertical_fov_rad);
  NERITIC_CHECK(view.ok(), "camera {}: {}", camera.name, view.error().message);
  return *view;
}

render::ViewSet camera_views(const scene::MotionSource& motion, const scene::Camera& camera,
                             double time_s, double next_time_s) {
  render::ViewSet set;
  set.width = camera.width;
  set.height = camera.height;
  render::ViewDesc view;
  view.tangents = tangents_from_fov(camera.vertical_fov_rad, double(camera.width) / camera.height);
  if (const auto lens = lens_view_of(camera)) {
    set.width = lens->width;
    set.height = lens->height;
    view.tangents = lens->tangents;
  }
  view.near_m = camera.near_m;
  const Pose center = motion.world_from(camera.mount, time_s);
  const Pose next_center = motion.world_from(camera.mount, next_time_s);
  const int eyes = camera.stereo_baseline_m > 0.0 ? 2 : 1;
  for (int i = 0; i < eyes; ++i) {
    const double side = eyes == 1 ? 0.0 : (i == 0 ? -0.5 : 0.5);
    const Vec3 eye_m(side * camera.stereo_baseline_m, 0.0, 0.0);
    view.world_from_view = {center * eye_m, center.rotation};
    view.next_world_from_view = {next_center * eye_m, next_center.rotation};
    set.views.push_back(view);
  }
  set.worn_object = worn_by(motion, camera.mount, center.position_m, time_s);
  return set;
}

// A person's head reaches so far from the neck, on the side that the spine points to. The eyes are
// 0.18 m from it.
std::uint32_t worn_by(const scene::MotionSource& motion, const scene::Mount& mount,
                      const Vec3& eye_m, double time_s) {
  constexpr double kHead_m = 0.25;
  const scene::Scene& scene = motion.scene();
  for (int at = mount.object; at >= 0;
       at = scene.objects[static_cast<std::size_t>(at)].mount.object) {
    const auto i = static_cast<std::size_t>(at);
    const scene::Object& object = scene.objects[i];
    if (object.model < 0 || !object.copies.empty()) continue;
    const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
    const auto head = std::ranges::find(model.nodes, "head", &scene::Node::name);
    if (head == model.nodes.end() || head->parent < 0) continue;
    const scene::ModelPose pose = motion.model_pose(i, model, time_s);
    const Pose world_from_object = motion.world_from_object(i, time_s);
    const auto place = [&](std::size_t node) {
      return world_from_object * (object.scale * Vec3(pose.model_from_node[node][3]));
    };
    const Vec3 neck = place(static_cast<std::size_t>(head - model.nodes.begin()));
    const Vec3 spine = neck - place(static_cast<std::size_t>(head->parent));
    const Vec3 eye = eye_m - neck;
    if (glm::length(eye) < kHead_m && glm::dot(eye, spine) > 0.0)
      return static_cast<std::uint32_t>(i);
  }
  return render::ViewSet::kWornByNobody;
}

}  // namespace neritic::testbed
