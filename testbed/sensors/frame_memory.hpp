// Whether the machine has room for a frame, and what a person can do where it has not. Private to
// testbed/sensors; pure functions, any thread.
#pragma once

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/scene/scene.hpp"
#include "testbed/sensors/frame_request.hpp"

namespace neritic::testbed {

// Bytes that the pictures of a frame need of the machine's own memory.
std::uint64_t host_bytes(const gpu::Device& device, const scene::Scene& scene,
                         const FrameRequest& request);
// kOutOfMemory if the machine has less than this left.
Status check_room(std::uint64_t bytes);
// The error; where memory ran out, with the name and size of the frame's largest picture.
Error advised(const Error& error, const scene::Scene& scene, const FrameRequest& request);

}  // namespace neritic::testbed
