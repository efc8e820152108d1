// Helps Mesa's CPU driver read uniform blocks fast. It reads a number of a block once for all lanes only in
// compute, at a fixed offset and before any branch or early return of main(): so such files copy what they need
// there. Elsewhere it reads lane by lane, eight loads and inserts for each number; where all lanes go the same way,
// each can read another number (lane_of()) and pass it on (from_lane()). Compute and fragment stages, GLSL only.
#ifndef NERITIC_EVEN_GLSL
#define NERITIC_EVEN_GLSL

// Given to every stage by engine/gpu/pipeline.cpp.
layout(constant_id = 31) const bool kOnProcessor = false;
const uint kLanes = 8u;  // fewer on an older processor: then as on a GPU

bool by_lanes() { return kOnProcessor && gl_SubgroupSize == kLanes; }
uint lane() { return gl_SubgroupInvocationID; }
float from_lane(float x, uint i) { return subgroupShuffle(x, i); }
// Whether some lane needs a thing, so that all go on or none does; the least of the lanes.
bool for_any(bool x) { return kOnProcessor ? subgroupAny(x) : x; }
float least_of(float x) { return kOnProcessor ? subgroupMin(x) : x; }

#endif
