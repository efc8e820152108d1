// The types that GLSL and C++ both know by the same name, so that one header holds each struct.
// Structs use scalar layout: no padding members; tests/shaders compares offsets with offsetof.
// GLSL files that include a shared header start with
//   #version 460
//   #extension GL_GOOGLE_include_directive : require
//   #extension GL_EXT_scalar_block_layout : require
#ifndef NERITIC_SHARED_TYPES_H
#define NERITIC_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace neritic::shared {
using uint = std::uint32_t;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using uvec2 = glm::uvec2;
using uvec3 = glm::uvec3;
using uvec4 = glm::uvec4;
using ivec2 = glm::ivec2;
using mat3 = glm::mat3;
using mat4 = glm::mat4;
using glm::abs;
using glm::cos;
using glm::exp;
using glm::max;
using glm::min;
using glm::normalize;
using glm::pow;
using glm::sin;
}  // namespace neritic::shared
#define NERITIC_SHARED_BEGIN namespace neritic::shared {
#define NERITIC_SHARED_END }
#define NERITIC_INLINE inline
#define NERITIC_CONST constexpr
#else
#define NERITIC_SHARED_BEGIN
#define NERITIC_SHARED_END
#define NERITIC_INLINE
#define NERITIC_CONST const
#endif

#endif
