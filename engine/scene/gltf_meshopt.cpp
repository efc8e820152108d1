// See gltf_meshopt.hpp.
#include "engine/scene/gltf_meshopt.hpp"

#include <meshoptimizer.h>

#include "engine/core/refusal.hpp"
#include "engine/scene/gltf_json.hpp"

namespace neritic::scene::gltf {

Status check_meshopt(const MeshoptStream& s) {
  const bool attributes = s.mode == "ATTRIBUTES", triangles = s.mode == "TRIANGLES";
  if (!attributes && !triangles && s.mode != "INDICES")
    return refusal("", fmt::format("mode \"{}\"", one_line(s.mode, 20)),
                   "ATTRIBUTES, TRIANGLES or INDICES");
  if (attributes && (s.stride == 0 || s.stride > 256 || s.stride % 4 != 0))
    return refusal("", fmt::format("byteStride {}", s.stride), "a multiple of 4 from 4 to 256");
  if (!attributes && s.stride != 2 && s.stride != 4)
    return refusal("", fmt::format("byteStride {}", s.stride), "2 or 4 for indices");
  if (triangles && s.count % 3 != 0)
    return refusal("", fmt::format("count {}", s.count), "a multiple of 3 for triangles");
  if (s.filter == "NONE") return {};
  if (!attributes)
    return refusal("", fmt::format("a filter with mode {}", s.mode), "one with ATTRIBUTES only");
  const bool octahedral = s.filter == "OCTAHEDRAL", quaternion = s.filter == "QUATERNION";
  if (!octahedral && !quaternion && s.filter != "EXPONENTIAL")
    return refusal("", fmt::format("filter \"{}\"", one_line(s.filter, 20)),
                   "NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL");
  if ((octahedral && s.stride != 4 && s.stride != 8) || (quaternion && s.stride != 8))
    return refusal("", fmt::format("byteStride {} with filter {}", s.stride, s.filter),
                   octahedral ? "4 or 8" : "8");
  return {};
}

Result<std::vector<std::byte>> decode_meshopt(const MeshoptStream& s,
                                              std::span<const std::byte> bytes) {
  std::vector<std::byte> out(s.count * s.stride);
  const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
  int failed = 0;
  if (s.count == 0) return out;
  if (s.mode == "ATTRIBUTES")
    failed = meshopt_decodeVertexBuffer(out.data(), s.count, s.stride, from, bytes.size());
  else if (s.mode == "TRIANGLES")
    failed = meshopt_decodeIndexBuffer(out.data(), s.count, s.stride, from, bytes.size());
  else
    failed = meshopt_decodeIndexSequence(out.data(), s.count, s.stride, from, bytes.size());
  if (failed != 0)
    return refusal("", fmt::format("a broken meshopt stream of {} bytes", bytes.size()),
                   fmt::format("a whole one of {} elements", s.count));
  if (s.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), s.count, s.stride);
  if (s.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), s.count, s.stride);
  if (s.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), s.count, s.stride);
  return out;
}

}  // namespace neritic::scene::gltf
