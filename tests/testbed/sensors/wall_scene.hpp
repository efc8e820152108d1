// A wall 1 m ahead of a camera, for tests of what materials look like.
#pragma once

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"

namespace neritic::test {

// A box 4 m wide and high, 1 m deep, whose texture coordinates are metres, all of one material.
inline scene::Model wall_of(const scene::Material& material) {
  scene::Model model = scene::make_box({4.0, 4.0, 1.0});
  model.materials = {material};
  for (scene::Primitive& primitive : model.meshes[0].primitives) primitive.material = 0;
  return model;
}

// In air, 1 m ahead of a square camera of so many pixels.
inline scene::Scene wall_scene(scene::Model wall, std::uint32_t pixels) {
  scene::Scene scene;
  scene.path = "test";
  scene.models.push_back(std::make_shared<scene::Model>(std::move(wall)));
  scene::Object object;
  object.model = 0;
  object.mount.pose.position_m = {0.0, 0.0, -1.5};
  scene.objects.push_back(object);
  scene::Camera camera;
  camera.width = camera.height = pixels;
  scene.cameras.push_back(camera);
  return scene;
}

// The picture of the scene's first camera.
inline Result<ImageU8> picture_of(gpu::Device& device, scene::Scene scene) {
  NERITIC_TRY(const auto session, testbed::Session::create(device, std::move(scene)));
  testbed::FrameRequest request;
  request.cameras = {0};
  NERITIC_TRY(const testbed::FrameResult result, session->render(request));
  return result.cameras[0].eyes[0].color;
}

}  // namespace neritic::test
