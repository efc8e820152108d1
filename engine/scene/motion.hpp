// Where the things of a scene are, how they move and how that is known, at any time: by their
// tracks and clips, or by a simulation. Pictures, sonars and cameras that ride along all ask here;
// nothing changes the scene to move things. Plain values; any thread that may read both.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "engine/core/motion.hpp"
#include "engine/scene/animation.hpp"
#include "engine/scene/node_motion.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::scene {

enum class Knowledge {
  kExact,      // by a track, a clip, or a state of just that time
  kBetween,    // between two states
  kPredicted,  // from the newest state on, at its velocity
  kHeld,       // outside what is known: the oldest state, or the prediction at its limit
};
// "exact", "between", "predicted" or "held".
const char* name_of(Knowledge known);

struct MotionAt {
  Motion motion;
  Knowledge known = Knowledge::kExact;
  double predicted_s = 0.0;  // how far behind that time the newest state is
};

// A point that a simulation follows, where it was long ago.
struct FollowedPlace {
  Vec3 position_m{0.0};   // world
  double wash_m_s = 0.0;  // how fast thrusters drove the water over the bed below it
};

// Objects that something else than their track and clip moves: a simulation.
class SimulatedMotion {
 public:
  virtual ~SimulatedMotion() = default;
  // World_from_object; nothing for an object that the simulation does not move.
  virtual std::optional<MotionAt> at(std::size_t object, double time_s) const = 0;
  // The pose of the object's model; nothing where its clip says it.
  virtual std::optional<ModelPose> model_pose(std::size_t, const Model&, double) const {
    return std::nullopt;
  }
  // Model_from_node of one node of that pose; nothing where the object's clip says it.
  virtual std::optional<Mat4> model_from_node(std::size_t, const Model&, int, double) const {
    return std::nullopt;
  }
  // Where a point of an object, or of a joint of its model, was long ago. Nothing where the
  // simulation does not follow that point, or time_s is not long ago: the poses then say it.
  virtual std::optional<FollowedPlace> followed(std::size_t, int, const Vec3&, double) const {
    return std::nullopt;
  }
};

// Object_from_joint: where a node of the object's model is, without the node's scale; scale: the
// object's. A part that is not worn has no axes of its own (its scale is 0): it has the object's.
Pose object_from_joint(const Mat4& model_from_node, const Vec3& scale);

// A thing with what carries it, copied out of a scene that need not stay: where it is, as the
// scene's MotionSource says it.
class CarriedThing {
 public:
  CarriedThing(const Scene& scene, const Mount& mount);
  MotionAt at(double time_s, const SimulatedMotion* simulated) const;

 private:
  // Itself first; each is mounted on the object that follows.
  struct Link {
    Mount mount;
    std::shared_ptr<const Model> model = nullptr;  // where something hangs on a joint of it
    int clip = -1;
    double clip_offset_s = 0.0, clip_rate = 1.0;
    Vec3 scale{1.0};
  };
  std::vector<Link> chain_;
};

class MotionSource {
 public:
  // Both must outlive this; simulated may be nullptr: all moves by tracks and clips.
  MotionSource(const Scene& scene, const SimulatedMotion* simulated = nullptr)
      : scene_(&scene), simulated_(simulated) {}

  const Scene& scene() const { return *scene_; }
  // World_from_mount, with all that carries it.
  Pose world_from(const Mount& mount, double time_s) const { return at(mount, time_s).motion.pose; }
  MotionAt at(const Mount& mount, double time_s) const;
  Pose world_from_object(std::size_t object, double time_s) const;
  // The pose of a node of the object's model; joint -1: of the object.
  Pose world_from_joint(std::size_t object, int joint, double time_s) const;
  // A point of a joint's frame, or of the object's; also long ago, if the simulation follows it.
  FollowedPlace place_of(std::size_t object, int joint, const Vec3& position_m,
                         double time_s) const;
  ModelPose model_pose(std::size_t object, const Model& model, double time_s) const;

 private:
  std::optional<MotionAt> simulated(std::size_t object, double time_s) const;
  const Scene* scene_;
  const SimulatedMotion* simulated_;
};

}  // namespace neritic::scene
