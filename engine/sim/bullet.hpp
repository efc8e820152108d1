// The only place that includes Bullet: its collision queries, in double precision. Bullet's headers
// define names of their own at global scope, so only the sources that query it include this.
#pragma once

#ifndef BT_USE_DOUBLE_PRECISION
#define BT_USE_DOUBLE_PRECISION  // as the libraries linked were built
#endif

#include <BulletCollision/BroadphaseCollision/btQuantizedBvh.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <LinearMath/btConvexHullComputer.h>

#include "engine/core/math.hpp"

namespace neritic::sim {

inline btVector3 to_bullet(const Vec3& v) {
  return {v.x, v.y, v.z};
}
inline Vec3 from_bullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace neritic::sim
