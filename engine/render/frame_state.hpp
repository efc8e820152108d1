// Where everything of a scene is at one instant (and, for motion, at the next frame's): object and
// node transforms, joint matrices, morph weights. Computed on the CPU in double, once a frame,
// shared by all view sets. A plain value.
#pragma once

#include <span>
#include <vector>

#include "engine/render/gpu_scene.hpp"
#include "engine/scene/motion.hpp"

namespace neritic::render {

// One skinned or morphed primitive of one object's node: its vertices are made anew this frame.
struct DeformJob {
  std::uint32_t group = 0, object = 0, node = 0;
  bool headless = false;  // beside the whole one
  // A ball in the object's frame that nothing of it leaves, and half of a box round its centre that
  // nothing of it leaves either; a negative radius: none is known.
  Vec3 center_m{0.0};
  double radius_m = -1.0;
  Vec3 half_m{0.0};
  shared::DeformPush push{};
};

// A model's light (scene.model_lights) where it is now, in the world.
struct PlacedLight {
  const scene::Light* light = nullptr;  // the scene's
  Vec3 position_m{0.0};
  Vec3 direction{0.0, 0.0, -1.0};  // unit, the way it shines
};

struct FrameState {
  double time_s = 0.0, next_time_s = 0.0;
  bool motion = false;
  std::vector<Pose> world_from_object, next_world_from_object;  // an object
  std::vector<scene::ModelPose> poses, next_poses;              // an object
  // Object_from_copy of the objects that are schools; empty lists of others, and without motion of
  // the next instant.
  std::vector<std::vector<Mat4>> flock, next_flock;
  std::vector<PlacedLight> lights;    // of models
  std::vector<Pose> world_from_lamp;  // of the scene's
  std::vector<Mat4f> joints;          // of all jobs: now, then next
  std::vector<float> weights;         // likewise
  std::vector<DeformJob> deforms;
  std::uint32_t deformed_vertices = 0;

  // The job of that appearance, whose push.first_out is its first vertex in the deformed stream;
  // nullptr where it does not deform. headless: of its skinned mesh without the head, where the
  // object is worn and has one.
  const DeformJob* job_of(std::uint32_t group, std::uint32_t object, std::uint32_t node,
                          bool headless = false) const;
};

// with_next: the next instant too, for motion. worn: objects that some view looks out of; what
// hangs on their models' node "head" is drawn into its neck there.
FrameState evaluate_frame(const scene::MotionSource& motion, const GpuScene& gpu_scene,
                          double time_s, double next_time_s, bool with_next,
                          std::span<const std::uint32_t> worn = {});

// World_from_primitive of an appearance: object, copy, node (unless skinned: joints hold it),
// instance. flock: the object's copies where they swim; empty: the scene's.
Mat4 world_from_appearance(const scene::Scene& scene, const Pose& world_from_object,
                           const scene::ModelPose& pose, const Appearance& appearance, bool skinned,
                           const std::vector<Mat4>& flock = {});

}  // namespace neritic::render
