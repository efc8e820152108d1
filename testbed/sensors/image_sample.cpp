#include "testbed/sensors/image_sample.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace neritic::testbed {
namespace {

static_assert(std::endian::native == std::endian::little, "pixels are given as they lie");

using enum ImageKind;
constexpr std::array<ImageType, 8> kTypes{{{"color", "rgb8", 3},
                                           {"depth", "32FC1", 4},
                                           {"normals", "32FC3", 12},
                                           {"labels", "16UC1", 2},
                                           {"instances", "16UC1", 2},
                                           {"motion", "32FC2", 8},
                                           {"echoes", "32FC1", 4},
                                           {"echo_labels", "16UC1", 2}}};
constexpr ImageKind kOfCameras[] = {kColor, kDepth, kNormals, kLabels, kInstances, kMotion};
constexpr ImageKind kOfSonars[] = {kEchoes, kEchoLabels, kDepth, kNormals, kLabels, kInstances};

void add_streams(std::span<const ImageKind> kinds, ImageStream stream,
                 std::vector<ImageStream>& out) {
  for (const ImageKind kind : kinds) {
    stream.kind = kind;
    stream.name = stream.frame_id + "/" + type_of(kind).name;
    out.push_back(stream);
  }
}

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& data) {
  return std::as_bytes(std::span(data));
}

std::span<const std::byte> bytes_of(const ViewImages& view, ImageKind kind) {
  switch (kind) {
    case kColor:
      return bytes_of(view.color.data);
    case kDepth:
      return bytes_of(view.depth.data);
    case kNormals:
      return bytes_of(view.normals.data);
    case kLabels:
      return bytes_of(view.labels.data);
    case kInstances:
      return bytes_of(view.instances.data);
    case kMotion:
      return bytes_of(view.motion.data);
    default:
      return {};
  }
}

std::span<const std::byte> echoes_of(const SonarFrame& sonar, ImageKind kind) {
  if (kind == kEchoes) return bytes_of(sonar.image.intensity);
  return sonar.label_energy ? bytes_of(sonar.label_energy->classes) : bytes_of(sonar.image.labels);
}

void take_view(const ViewImages& view, ImageKind kind, ImageSample& out) {
  out.view = &view;
  out.width = view.width;
  out.height = view.height;
  out.world_from_frame = view.world_from_view;
  out.data = bytes_of(view, kind);
}

// A wedge of several sectors has no one view: its arrays are not given.
void take_sonar(const SonarFrame& sonar, ImageKind kind, ImageSample& out) {
  out.sonar = &sonar;
  if (kind != kEchoes && kind != kEchoLabels) {
    if (sonar.sectors.size() == 1) take_view(sonar.sectors.front(), kind, out);
    return;
  }
  out.width = sonar.image.n_azimuth;
  out.height = sonar.image.n_range;
  out.world_from_frame = sonar.world_from_head;
  out.data = echoes_of(sonar, kind);
}

}  // namespace

const ImageType& type_of(ImageKind kind) {
  return kTypes.at(static_cast<std::size_t>(kind));
}

Capture capture_of(ImageKind kind) {
  Capture out = Capture{.color = false, .motion = false, .echoes = false}.without_geometry();
  out.color = kind == kColor;
  out.depth = kind == kDepth;
  out.normals = kind == kNormals;
  out.labels = kind == kLabels;
  out.instances = kind == kInstances;
  out.motion = kind == kMotion;
  out.linear = false;
  out.echoes = kind == kEchoes || kind == kEchoLabels;
  return out;
}

std::vector<ImageStream> image_streams(const scene::Scene& scene) {
  std::vector<ImageStream> out;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const scene::Camera& camera = scene.cameras[i];
    const bool stereo = camera.stereo_baseline_m > 0.0;
    for (std::size_t eye = 0; eye < (stereo ? 2u : 1u); ++eye)
      add_streams(kOfCameras,
                  {.frame_id = camera.name + (!stereo    ? ""
                                              : eye == 0 ? "/left"
                                                         : "/right"),
                   .sensor = i,
                   .part = eye,
                   .rate_hz = camera.rate_hz},
                  out);
  }
  for (std::size_t i = 0; i < scene.sonars.size(); ++i) {
    const scene::Sonar& sonar = scene.sonars[i];
    const bool sides = sonar.kind == scene::SonarKind::kSideScan;
    for (std::size_t head = 0; head < (sides ? 2u : 1u); ++head)
      add_streams(kOfSonars,
                  {.frame_id = sonar.name + (!sides      ? ""
                                             : head == 0 ? "/port"
                                                         : "/starboard"),
                   .sonar = true,
                   .sensor = i,
                   .part = head,
                   .rate_hz = sonar.rate_hz},
                  out);
  }
  return out;
}

ImagePixels take_pixels(const ImageStream& stream, const scene::Scene& scene, FrameResult& result) {
  const auto of_view = [&](ViewImages& view) -> ImagePixels {
    switch (stream.kind) {
      case kColor:
        return std::move(view.color.data);
      case kDepth:
        return std::move(view.depth.data);
      case kNormals:
        return std::move(view.normals.data);
      case kLabels:
        return std::move(view.labels.data);
      case kInstances:
        return std::move(view.instances.data);
      default:
        return std::move(view.motion.data);
    }
  };
  if (!stream.sonar)
    return of_view(
        std::ranges::find(result.cameras, scene.cameras[stream.sensor].name, &CameraFrame::name)
            ->eyes.at(stream.part));
  const auto first =
      std::ranges::find(result.sonars, scene.sonars[stream.sensor].name, &SonarFrame::name);
  SonarFrame& sonar = *(first + static_cast<std::ptrdiff_t>(stream.part));
  if (stream.kind == kEchoes) return std::move(sonar.image.intensity);
  if (stream.kind != kEchoLabels) return of_view(sonar.sectors.front());
  return std::move(sonar.label_energy ? sonar.label_energy->classes : sonar.image.labels);
}

std::optional<ImageSample> image_of(const ImageStream& stream, const scene::Scene& scene,
                                    const FrameResult& result) {
  ImageSample out;
  out.stream = &stream;
  if (stream.sonar) {
    const auto first =
        std::ranges::find(result.sonars, scene.sonars[stream.sensor].name, &SonarFrame::name);
    if (first == result.sonars.end()) return std::nullopt;
    take_sonar(*(first + static_cast<std::ptrdiff_t>(stream.part)), stream.kind, out);
  } else {
    const auto camera =
        std::ranges::find(result.cameras, scene.cameras[stream.sensor].name, &CameraFrame::name);
    if (camera == result.cameras.end()) return std::nullopt;
    take_view(camera->eyes.at(stream.part), stream.kind, out);
  }
  if (out.data.empty()) return std::nullopt;
  return out;
}

}  // namespace neritic::testbed
