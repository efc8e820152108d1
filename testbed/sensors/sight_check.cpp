#include "testbed/sensors/sight_check.hpp"

#include <algorithm>

#include "testbed/sensors/sight.hpp"

namespace neritic::testbed {
namespace {

bool brings_geometry(const std::vector<ViewImages>& views) {
  return !views.empty() && !views.front().depth.data.empty() &&
         !views.front().instances.data.empty();
}

const SonarFrame* first_head(const FrameResult& frame, const std::string& sonar) {
  const auto found = std::ranges::find(frame.sonars, sonar, &SonarFrame::name);
  return found == frame.sonars.end() ? nullptr : &*found;
}

}  // namespace

SightCheck::SightCheck(Session& session, const scene::SimulatedMotion* simulated, Tell tell)
    : session_(session), simulated_(simulated), tell_(std::move(tell)) {}

// Whether anything but what has the carrier's class is the strongest in any bin. Without a carrier
// any echo is something else's.
bool SightCheck::hears(const scene::Sonar& sonar, const SonarFrame& head) const {
  const int carrier = sonar.mount.object;
  const std::uint16_t own = carrier < 0 ? 0 : session_.scene().objects[carrier].class_id;
  if (head.image.unclassed && (carrier < 0 || own != 0)) return true;
  return std::ranges::any_of(head.image.labels,
                             [own](std::uint16_t label) { return label != 0 && label != own; });
}

Status SightCheck::accept(const FrameResult& frame) {
  const scene::Scene& scene = session_.scene();
  std::vector<std::size_t> cameras, sonars;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const auto found = std::ranges::find(frame.cameras, scene.cameras[i].name, &CameraFrame::name);
    if (found == frame.cameras.end() || !seen_.insert("camera " + found->name).second) continue;
    if (brings_geometry(found->eyes)) {
      if (const auto line = blindness(scene, scene.cameras[i], *found)) tell_(*line);
    } else if (scene.cameras[i].mount.object >= 0) {
      cameras.push_back(i);  // worth another frame, since its carrier may be in its way
    }
  }
  for (std::size_t i = 0; i < scene.sonars.size(); ++i) {
    const scene::Sonar& sonar = scene.sonars[i];
    const SonarFrame* head = first_head(frame, sonar.name);
    if (!head || !seen_.insert("sonar " + sonar.name).second) continue;
    if (std::ranges::any_of(frame.sonars, [&](const SonarFrame& h) {
          return h.name == sonar.name && hears(sonar, h);
        }))
      continue;
    if (std::ranges::any_of(frame.sonars, [&](const SonarFrame& h) {
          return h.name == sonar.name && h.image.unclassed;
        }))
      unclassed_.insert(sonar.name);
    sonars.push_back(i);
  }
  return look(frame.time_s, cameras, sonars);
}

Status SightCheck::look(double time_s, const std::vector<std::size_t>& cameras,
                        const std::vector<std::size_t>& sonars) {
  if (cameras.empty() && sonars.empty()) return {};
  FrameRequest request;
  request.time_s = request.next_time_s = time_s;
  request.cameras = cameras;
  request.sonars = sonars;
  request.simulated = simulated_;
  request.capture.color = request.capture.motion = request.capture.echoes = false;
  NERITIC_TRY(const FrameResult result, session_.render(request));
  judge(result);
  return {};
}

void SightCheck::judge(const FrameResult& frame) {
  const scene::Scene& scene = session_.scene();
  for (const CameraFrame& camera : frame.cameras) {
    const auto of = std::ranges::find(scene.cameras, camera.name, &scene::Camera::name);
    if (const auto line = blindness(scene, *of, camera)) tell_(*line);
  }
  for (const scene::Sonar& sonar : scene.sonars) {
    std::vector<SonarFrame> heads;
    for (const SonarFrame& head : frame.sonars)
      if (head.name == sonar.name) heads.push_back(head);
    if (heads.empty()) continue;
    if (const auto line = blindness(scene, sonar, heads, unclassed_.contains(sonar.name)))
      tell_(*line);
  }
}

}  // namespace neritic::testbed
