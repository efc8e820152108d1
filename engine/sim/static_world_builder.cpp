// Builds a static world from plain vertices, indices and heights.
#include <utility>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "engine/sim/convex_hull.hpp"
#include "engine/sim/static_things.hpp"

namespace neritic::sim {
namespace {

// So far below a seabed things are led out of it.
constexpr double kSolidBelow_m = 1000.0;

// A mesh of more triangles counts as not convex, since the question takes their number squared.
constexpr std::size_t kMostAsked = 500;
// Hulls and planes of single precision are no flatter.
constexpr double kFlat_m = 1e-5;

template <class Shape>
std::uint32_t add_shape(std::vector<StaticShape>& shapes, Shape shape) {
  shapes.emplace_back(std::move(shape));
  return static_cast<std::uint32_t>(shapes.size() - 1);
}

// Whether some corner lies before some face.
bool creased(const TriangleMesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.triangle_count());
  if (count > kMostAsked) return true;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Triangle face = mesh.triangle(i, 1.0, Vec3(0.0));
    const Vec3 normal = glm::normalize(face.area_normal());
    for (std::uint32_t k = 0; k < count; ++k)
      for (const Vec3& corner_m : mesh.triangle(k, 1.0, Vec3(0.0)).corner)
        if (glm::dot(normal, corner_m - face.corner[0]) > kFlat_m) return true;
  }
  return false;
}
bool creased(const HeightGrid& grid) {
  return grid.bounds().high.y - grid.bounds().low.y > kFlat_m;
}

}  // namespace

StaticWorld::StaticWorld() : things_(std::make_unique<Things>()) {}
StaticWorld::~StaticWorld() = default;
StaticWorld::StaticWorld(StaticWorld&&) noexcept = default;
StaticWorld& StaticWorld::operator=(StaticWorld&&) noexcept = default;

const StaticWorldCounts& StaticWorld::counts() const {
  return things_->counts;
}

StaticWorldBuilder::StaticWorldBuilder() : things_(std::make_unique<StaticWorld::Things>()) {}
StaticWorldBuilder::~StaticWorldBuilder() = default;

Result<StaticWorldBuilder::ShapeId> StaticWorldBuilder::add_mesh(
    std::span<const Vec3f> vertices_m, std::span<const std::uint32_t> indices,
    const std::string& name) {
  NERITIC_TRY(TriangleMesh mesh, TriangleMesh::build(vertices_m, indices, name));
  things_->counts.dropped += mesh.dropped_count();
  things_->creased.push_back(creased(mesh));
  return add_shape(things_->shapes, std::move(mesh));
}

Result<StaticWorldBuilder::ShapeId> StaticWorldBuilder::add_hull(std::span<const Vec3> points_m,
                                                                 const std::string& name) {
  for (std::size_t i = 0; i < points_m.size(); ++i)
    if (!is_finite(points_m[i]))
      return refusal(name, fmt::format("point {}, which is not finite", i), "finite numbers");
  const ConvexHull hull = convex_hull(points_m).hull;
  if (hull.triangles.empty())
    return refusal(name, fmt::format("a hull of {} points without volume", points_m.size()),
                   "four points or more, not in a plane");
  std::vector<Vec3f> vertices_m(hull.corners.begin(), hull.corners.end());
  std::vector<std::uint32_t> indices;
  for (const auto& triangle : hull.triangles)
    indices.insert(indices.end(), triangle.begin(), triangle.end());
  NERITIC_TRY(TriangleMesh mesh, TriangleMesh::build(vertices_m, indices, name));
  things_->counts.dropped += mesh.dropped_count();
  things_->creased.push_back(false);
  return add_shape(things_->shapes, std::move(mesh));
}

Result<StaticWorldBuilder::ShapeId> StaticWorldBuilder::add_heights(
    std::uint32_t columns, std::uint32_t rows, double cell_m, std::span<const float> heights_m,
    const std::string& name) {
  NERITIC_TRY(HeightGrid grid, HeightGrid::build(columns, rows, cell_m, heights_m, name));
  things_->creased.push_back(creased(grid));
  return add_shape(things_->shapes, std::move(grid));
}

void StaticWorldBuilder::place(ShapeId shape, const Placement& placement, const Surface& surface) {
  NERITIC_CHECK(shape < things_->shapes.size(), "shape {}", shape);
  const Pose& pose = placement.world_from_thing;
  NERITIC_CHECK(is_finite(pose.position_m) && std::isfinite(placement.scale) &&
                    placement.scale > 0.0 &&
                    std::abs(glm::dot(pose.rotation, pose.rotation) - 1.0) < 1e-6,
                "placement of shape {}", shape);
  NERITIC_CHECK(surface.friction >= 0.0 && surface.restitution >= 0.0 && surface.restitution <= 1.0,
                "friction {}, restitution {}", surface.friction, surface.restitution);
  auto bounds = std::visit([](const auto& s) { return s.bounds(); }, things_->shapes[shape]);
  if (bounds.empty()) return;
  if (std::holds_alternative<HeightGrid>(things_->shapes[shape])) bounds.low.y -= kSolidBelow_m;
  things_->things.push_back({shape, placement, surface,
                             transformed(placement.world_from_thing, placement.scale, bounds)});
  things_->counts.creased += things_->creased[shape] ? 1 : 0;
  things_->counts.triangles +=
      std::visit([](const auto& s) { return s.triangle_count(); }, things_->shapes[shape]);
}

StaticWorld StaticWorldBuilder::build() {
  std::vector<Box> boxes;
  for (const StaticThing& thing : things_->things) boxes.push_back(thing.bounds);
  things_->tree = BoxTree(boxes);
  things_->counts.things = things_->things.size();
  StaticWorld world;
  world.things_ = std::exchange(things_, std::make_unique<StaticWorld::Things>());
  return world;
}

}  // namespace neritic::sim
