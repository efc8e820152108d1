#include "testbed/sensors/participants.hpp"

namespace neritic::testbed {
namespace {

bool moves(const scene::Scene& scene, const scene::Object& object) {
  if (object.dynamics || object.human || !object.inputs.empty() || object.mount.track ||
      object.mount.afloat)
    return true;
  // The fish of a mill swim, but the mill stays where it is.
  const bool mills = object.flock && object.flock->mill;
  if (object.clip >= 0 && !mills) return true;
  return object.mount.object >= 0 &&
         moves(scene, scene.objects[static_cast<std::size_t>(object.mount.object)]);
}

const char* kind_of(const scene::Object& object) {
  return object.human ? "diver" : object.dynamics ? "vehicle" : "object";
}

}  // namespace

std::vector<Participant> participants_of(const scene::Scene& scene) {
  std::vector<Participant> out;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const scene::Object& object = scene.objects[i];
    if (moves(scene, object))
      out.push_back({object.name, kind_of(object), {.object = static_cast<int>(i)}});
  }
  for (const scene::Camera& camera : scene.cameras)
    out.push_back({camera.name, "camera", camera.mount});
  for (const scene::Sonar& sonar : scene.sonars) out.push_back({sonar.name, "sonar", sonar.mount});
  return out;
}

std::vector<scene::MotionAt> motions_of(const std::vector<Participant>& participants,
                                        const scene::MotionSource& motion, double time_s) {
  std::vector<scene::MotionAt> out;
  out.reserve(participants.size());
  for (const Participant& one : participants) out.push_back(motion.at(one.mount, time_s));
  return out;
}

}  // namespace neritic::testbed
