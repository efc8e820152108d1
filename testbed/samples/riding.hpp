// Tracked poses that ride with a diver's body: bits of HeadPose::placed and HandPoses::tracked. A
// headset's room goes with the diver, so that what is tracked in it moves on between two frames.
// Plain values.
#pragma once

#include <cstdint>

namespace neritic::testbed {

// For HeadPose::placed: its place counts; the pose is in the frame of the diver's body (origin at
// the hips, axes as a standing person's), not in the world.
inline constexpr std::uint64_t kHeadPlaced = 1, kHeadRides = 2;
// For HandPoses::tracked, beside the bits of the two hands: both poses are in the body's frame.
inline constexpr std::uint64_t kHandsRide = 4;

}  // namespace neritic::testbed
