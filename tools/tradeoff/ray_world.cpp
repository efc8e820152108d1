#include "tools/tradeoff/ray_world.hpp"

#include <embree3/rtcore.h>

#include <array>

namespace neritic::tools {
namespace {

class TriangleWorld : public RayWorld {
 public:
  explicit TriangleWorld(Triangles triangles)
      : triangles_(std::move(triangles)), device_(rtcNewDevice(nullptr)) {}
  ~TriangleWorld() override {
    if (scene_ != nullptr) rtcReleaseScene(scene_);
    if (device_ != nullptr) rtcReleaseDevice(device_);
  }
  TriangleWorld(const TriangleWorld&) = delete;
  TriangleWorld& operator=(const TriangleWorld&) = delete;

  Status build() {
    if (device_ == nullptr)
      return failure(ErrorCode::kUnsupported, "Embree: no device on this machine");
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               triangles_.indices.data(), 0, 3 * sizeof(std::uint32_t),
                               triangles_.indices.size() / 3);
    // Embree reads 16 bytes at each vertex: one more keeps the last inside.
    triangles_.positions.emplace_back(0.0f);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               triangles_.positions.data(), 0, sizeof(Vec3f),
                               triangles_.positions.size() - 1);
    rtcCommitGeometry(geometry);
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
      return failure(ErrorCode::kOutOfMemory, "Embree: could not build a scene of {} triangles",
                     triangles_.indices.size() / 3);
    return {};
  }

  RayHit cast_from(const Vec3& origin_m, const Vec3& direction) const override {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(origin_m.x);
    ray.ray.org_y = static_cast<float>(origin_m.y);
    ray.ray.org_z = static_cast<float>(origin_m.z);
    ray.ray.dir_x = static_cast<float>(direction.x);
    ray.ray.dir_y = static_cast<float>(direction.y);
    ray.ray.dir_z = static_cast<float>(direction.z);
    ray.ray.tnear = 1e-3f;
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const std::uint32_t triangle = ray.hit.primID;
    const auto normal_at = [&](int corner) {
      return triangles_.normals[triangles_.indices[3 * triangle + corner]];
    };
    Vec3f n = (1.0f - ray.hit.u - ray.hit.v) * normal_at(0) + ray.hit.u * normal_at(1) +
              ray.hit.v * normal_at(2);
    const Vec3f face(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
    if (glm::dot(face, Vec3f(direction)) > 0.0f) n = -n;  // the back of the face is seen
    const float size = glm::length(n);
    return {ray.ray.tfar, size > 0.0f ? n / size : Vec3f(0.0f), triangles_.reflectivity[triangle],
            triangles_.classes[triangle], triangles_.backscatter[triangle]};
  }

 private:
  Triangles triangles_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

class AnalyticWorld : public RayWorld {
 public:
  RayHit cast_from(const Vec3& o, const Vec3& d) const override {
    RayHit best;
    const auto offer = [&](double t, const Vec3& normal, std::uint16_t label) {
      if (t > 0.0 && (best.t == 0.0 || t < best.t)) best = {t, Vec3f(normal), 1.0f, label};
    };
    if (d.y < 0.0) offer((-kDepthBelow_m - o.y) / d.y, Vec3(0, 1, 0), 1);
    for (const Sphere& s : spheres_) {
      const Vec3 to_centre = s.centre - o;
      const double a = glm::dot(d, d), b = glm::dot(d, to_centre),
                   c = glm::dot(to_centre, to_centre) - s.radius * s.radius, root = b * b - a * c;
      if (root <= 0.0) continue;
      const double t = (b - std::sqrt(root)) / a;
      offer(t, (t * d - to_centre) / s.radius, 12);
    }
    return best;
  }

 private:
  struct Sphere {
    Vec3 centre;
    double radius;
  };
  static constexpr double kDepthBelow_m = 0.8;
  const std::array<Sphere, 2> spheres_{
      {{Vec3(0.5, -0.1, -2.95), 0.35}, {Vec3(-1.3, 0.2, -3.75), 0.15}}};
};

}  // namespace

Result<std::unique_ptr<RayWorld>> make_triangle_world(Triangles triangles) {
  auto world = std::make_unique<TriangleWorld>(std::move(triangles));
  NERITIC_TRY_STATUS(world->build());
  return std::unique_ptr<RayWorld>(std::move(world));
}

std::unique_ptr<RayWorld> make_analytic_world() {
  return std::make_unique<AnalyticWorld>();
}

}  // namespace neritic::tools
