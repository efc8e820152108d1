#include "tools/tradeoff/gbuffer_images.hpp"

#include <algorithm>

#include "engine/core/intrinsics.hpp"
#include "shared/octahedral.h"
#include "sonar/offline_input.hpp"

namespace neritic::tools {
namespace {

constexpr double kGamma = 2.2;

// Signed-normalised 16 bit, stored and read (Vulkan specification, fixed-point conversion).
float snorm16(float v) {
  return std::round(std::clamp(v, -1.0f, 1.0f) * 32767.0f) / 32767.0f;
}

double rgb8(double n, double gamma) {
  const double v = std::pow(std::clamp((n + 1.0) / 2.0, 0.0, 1.0), 1.0 / gamma);
  return sonar::decode_normal(std::round(v * 255.0), 255.0, gamma);
}

}  // namespace

const char* name_of(NormalCoding coding) {
  switch (coding) {
    case NormalCoding::kFloat:
      return "float";
    case NormalCoding::kOctahedral16:
      return "octahedral 16";
    case NormalCoding::kRgb8:
      return "rgb 8";
    case NormalCoding::kRgb8Gamma:
      return "rgb 8 gamma 2.2";
  }
  return "";
}

sonar::SonarInput cast_gbuffer(const RayWorld& world, const sonar::Sector& sector,
                               std::uint32_t width, std::uint32_t height) {
  sonar::SonarInput in;
  in.width = width;
  in.height = height;
  in.intrinsics = intrinsics_of(sector.tangents, width, height);
  in.yaw_rad = sector.yaw_rad;
  const Mat3 sonar_from_view = sonar::sonar_from_view(sector.yaw_rad);
  const Mat3 view_from_sonar = glm::transpose(sonar_from_view);
  for (std::uint32_t v = 0; v < height; ++v)
    for (std::uint32_t u = 0; u < width; ++u) {
      const Intrinsics& k = in.intrinsics;
      const Vec3 ray((u + 0.5 - k.cx) / k.fx, -(v + 0.5 - k.cy) / k.fy, -1.0);
      const RayHit hit = world.cast(sonar_from_view * ray);
      in.depth.push_back(hit.t);
      const Vec3 n = view_from_sonar * Vec3(hit.normal);
      in.normals.insert(in.normals.end(), {n.x, n.y, n.z});
      in.labels.push_back(hit.label);
      in.reflectivity.push_back(hit.reflectivity);
    }
  return in;
}

sonar::SonarInput with_normals(const sonar::SonarInput& input, NormalCoding coding) {
  sonar::SonarInput out = input;
  if (coding == NormalCoding::kFloat) return out;
  for (std::size_t i = 0; i + 2 < out.normals.size(); i += 3) {
    double* n = &out.normals[i];
    if (n[0] == 0.0 && n[1] == 0.0 && n[2] == 0.0) continue;
    if (coding == NormalCoding::kOctahedral16) {
      const glm::vec2 e = shared::octahedral_encode(glm::vec3(n[0], n[1], n[2]));
      const glm::vec3 back = shared::octahedral_decode(glm::vec2(snorm16(e.x), snorm16(e.y)));
      for (int k = 0; k < 3; ++k) n[k] = back[k];
    } else {
      for (int k = 0; k < 3; ++k) n[k] = rgb8(n[k], coding == NormalCoding::kRgb8 ? 1.0 : kGamma);
    }
  }
  return out;
}

}  // namespace neritic::tools
