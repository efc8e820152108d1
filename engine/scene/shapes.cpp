// Sphere, box, plane and cylinder from numbers. Triangles run counter-clockwise seen from outside
// (glTF's front face). Pure functions; any thread.
#include "engine/scene/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace neritic::scene {
namespace {

// A circle's segments: three make the least solid; the limit keeps a sphere under 2^24 triangles.
constexpr int kMinSegments = 3, kMaxSegments = 4096;

int clamp_segments(int segments) {
  return std::clamp(segments, kMinSegments, kMaxSegments);
}

std::uint32_t add_vertex(Primitive& primitive, const Vec3& position, const Vec3& normal, double u,
                         double v) {
  primitive.positions.emplace_back(position);
  primitive.normals.emplace_back(normal);
  primitive.uv0.emplace_back(u, v);
  primitive.bounds.add(Vec3(primitive.positions.back()));
  return static_cast<std::uint32_t>(primitive.positions.size() - 1);
}

void add_triangle(Primitive& primitive, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  primitive.indices.insert(primitive.indices.end(), {a, b, c});
}

// A parallelogram around centre; its normal is right x up, texture coordinates in metres.
void add_quad(Primitive& primitive, const Vec3& centre, const Vec3& half_right,
              const Vec3& half_up) {
  const Vec3 normal = glm::normalize(glm::cross(half_right, half_up));
  const double width = 2.0 * glm::length(half_right), height = 2.0 * glm::length(half_up);
  const auto a = add_vertex(primitive, centre - half_right - half_up, normal, 0.0, height);
  const auto b = add_vertex(primitive, centre + half_right - half_up, normal, width, height);
  const auto c = add_vertex(primitive, centre + half_right + half_up, normal, width, 0.0);
  const auto d = add_vertex(primitive, centre - half_right + half_up, normal, 0.0, 0.0);
  add_triangle(primitive, a, b, c);
  add_triangle(primitive, a, c, d);
}

// A point of the unit circle in the x-z plane; the last segment's end is exactly the first's start.
Vec3 on_circle(int i, int segments) {
  const double angle = 2.0 * kPi * (i % segments) / segments;
  return {std::sin(angle), 0.0, std::cos(angle)};
}

void add_cap(Primitive& primitive, double radius_m, double y_m, int segments) {
  const double side = y_m < 0.0 ? -1.0 : 1.0;
  const Vec3 normal(0.0, side, 0.0);
  const auto centre = add_vertex(primitive, {0.0, y_m, 0.0}, normal, 0.0, 0.0);
  for (int i = 0; i <= segments; ++i) {
    const Vec3 rim = radius_m * on_circle(i, segments);
    add_vertex(primitive, {rim.x, y_m, rim.z}, normal, rim.x, side * rim.z);
  }
  for (int i = 0; i < segments; ++i) {
    const auto a = centre + 1 + static_cast<std::uint32_t>(i);
    if (side > 0.0)
      add_triangle(primitive, centre, a, a + 1);
    else
      add_triangle(primitive, centre, a + 1, a);
  }
}

}  // namespace

Model model_of_primitive(Primitive primitive, std::string name) {
  Model model;
  model.name = name;
  model.meshes.push_back({std::move(name), {}, {}});
  model.meshes.back().primitives.push_back(std::move(primitive));
  Node node;
  node.name = model.name;
  node.mesh = 0;
  model.nodes.push_back(std::move(node));
  model.roots.push_back(0);
  return model;
}

Model make_sphere(double radius_m, int segments) {
  segments = clamp_segments(segments);
  const int rings = std::max(2, segments / 2);
  Primitive primitive;
  for (int ring = 0; ring <= rings; ++ring) {
    const double polar = kPi * ring / rings;  // from +Y
    const double across = ring == 0 || ring == rings ? 0.0 : std::sin(polar);
    const double along = ring == 0 ? 1.0 : ring == rings ? -1.0 : std::cos(polar);
    for (int i = 0; i <= segments; ++i) {
      Vec3 normal = across * on_circle(i, segments);
      normal.y = along;
      add_vertex(primitive, radius_m * normal, normal, static_cast<double>(i) / segments,
                 static_cast<double>(ring) / rings);
    }
  }
  const auto stride = static_cast<std::uint32_t>(segments + 1);
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < segments; ++i) {
      const auto above = static_cast<std::uint32_t>(ring) * stride + static_cast<std::uint32_t>(i);
      const auto below = above + stride;
      if (ring + 1 < rings) add_triangle(primitive, above, below, below + 1);
      if (ring > 0) add_triangle(primitive, above, below + 1, above + 1);
    }
  return model_of_primitive(std::move(primitive), "sphere");
}

Model make_box(const Vec3& size_m) {
  const Vec3 h = 0.5 * size_m;
  const Vec3 x(h.x, 0, 0), y(0, h.y, 0), z(0, 0, h.z);
  Primitive primitive;
  add_quad(primitive, z, x, y);
  add_quad(primitive, -z, -x, y);
  add_quad(primitive, x, -z, y);
  add_quad(primitive, -x, z, y);
  add_quad(primitive, y, x, -z);
  add_quad(primitive, -y, x, z);
  return model_of_primitive(std::move(primitive), "box");
}

Model make_plane(double size_x_m, double size_z_m) {
  Primitive primitive;
  add_quad(primitive, Vec3(0.0), Vec3(0.5 * size_x_m, 0, 0), Vec3(0, 0, -0.5 * size_z_m));
  return model_of_primitive(std::move(primitive), "plane");
}

Model make_cylinder(double radius_m, double height_m, int segments) {
  segments = clamp_segments(segments);
  const double half = 0.5 * height_m;
  Primitive primitive;
  for (int i = 0; i <= segments; ++i) {
    const Vec3 normal = on_circle(i, segments);
    const double around_m = 2.0 * kPi * radius_m * i / segments;
    const Vec3 rim = radius_m * normal;
    add_vertex(primitive, {rim.x, half, rim.z}, normal, around_m, 0.0);
    add_vertex(primitive, {rim.x, -half, rim.z}, normal, around_m, height_m);
  }
  for (int i = 0; i < segments; ++i) {
    const auto top = static_cast<std::uint32_t>(2 * i), bottom = top + 1;
    add_triangle(primitive, top, bottom, bottom + 2);
    add_triangle(primitive, top, bottom + 2, top + 2);
  }
  add_cap(primitive, radius_m, half, segments);
  add_cap(primitive, radius_m, -half, segments);
  return model_of_primitive(std::move(primitive), "cylinder");
}

Model make_tube(int joints, double radius_m, double length_m) {
  constexpr int kSides = 6;
  Primitive primitive;
  Skin skin;
  std::vector<Node> nodes;
  for (int j = 0; j < joints; ++j) {
    const Vec3 at(0.0, -length_m * j / std::max(joints - 1, 1), 0.0);
    for (int i = 0; i <= kSides; ++i) {
      const Vec3 normal = on_circle(i, kSides);
      add_vertex(primitive, at + radius_m * normal, normal, 2.0 * kPi * radius_m * i / kSides,
                 -at.y);
      primitive.joints.push_back({static_cast<std::uint16_t>(j), 0, 0, 0});
      primitive.weights.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
    }
    Node node;
    node.name = fmt::format("joint_{}", j);
    node.translation_m = at;
    nodes.push_back(std::move(node));
    skin.joints.push_back(j + 1);
    Mat4 inverse_bind(1.0);
    inverse_bind[3] = Vec4(-at, 1.0);
    skin.inverse_bind.push_back(inverse_bind);
  }
  for (int j = 0; j + 1 < joints; ++j)
    for (int i = 0; i < kSides; ++i) {
      const auto top = static_cast<std::uint32_t>(j * (kSides + 1) + i);
      const std::uint32_t bottom = top + kSides + 1;
      add_triangle(primitive, top, bottom, bottom + 1);
      add_triangle(primitive, top, bottom + 1, top + 1);
    }
  Model model = model_of_primitive(std::move(primitive), "tether");
  model.skins.push_back(std::move(skin));
  model.nodes[0].skin = 0;
  for (Node& node : nodes) {
    model.roots.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(std::move(node));
  }
  return model;
}

void turn_inside_out(Model& model) {
  for (Mesh& mesh : model.meshes)
    for (Primitive& primitive : mesh.primitives) {
      for (Vec3f& normal : primitive.normals) normal = -normal;
      for (Vec4f& tangent : primitive.tangents) tangent.w = -tangent.w;
      if (primitive.topology != Topology::kTriangles) continue;
      for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
        std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
    }
}

std::size_t triangle_count(const Model& model) {
  std::size_t count = 0;
  for (const Mesh& mesh : model.meshes)
    for (const Primitive& primitive : mesh.primitives)
      if (primitive.topology == Topology::kTriangles) count += primitive.indices.size() / 3;
  return count;
}

}  // namespace neritic::scene
