// The pictures of a scene's objects that change (scene::ObjectPictures), in one frame: each that is
// in sight and differs from what its image has is uploaded by a pass of its own, before the first
// pass that draws it. Only the scene must live until the graph has run; rendering thread.
#pragma once

#include <vector>

#include "engine/graph/frame_graph.hpp"
#include "engine/render/gpu_scene.hpp"

namespace neritic::render {

class FramePictures {
 public:
  // source: has the places that the scene was made with; nullptr: images stay as they are.
  FramePictures(graph::FrameGraph& graph, GpuScene& scene, scene::ObjectPictures* source)
      : graph_(graph), scene_(scene), source_(source), images_(scene.pictures().size()) {}

  // The image of a picture of the scene, for a pass that draws it.
  graph::ImageHandle image(std::uint32_t picture);

 private:
  graph::FrameGraph& graph_;
  GpuScene& scene_;
  scene::ObjectPictures* source_;
  std::vector<graph::ImageHandle> images_;  // those that were asked for
};

}  // namespace neritic::render
