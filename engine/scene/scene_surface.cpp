#include "engine/scene/scene_surface.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/animation.hpp"

namespace neritic::scene {

Surface::Surface(const Model& model, const std::vector<Mat4>& world_from_model) {
  for (const Mat4& world_from : world_from_model) add_triangles(model, world_from);
  sort_into_cells();
}

void Surface::add_triangles(const Model& model, const Mat4& world_from_model) {
  const ModelPose pose = evaluate_pose(model, -1, 0.0);
  std::vector<int> open = model.roots;
  std::size_t visits = 0;
  while (!open.empty() && visits++ <= model.nodes.size()) {
    const auto index = static_cast<std::size_t>(open.back());
    open.pop_back();
    const Node& node = model.nodes[index];
    open.insert(open.end(), node.children.begin(), node.children.end());
    if (node.mesh < 0) continue;
    const Mat4 world_from_node = world_from_model * pose.model_from_node[index];
    for (const Primitive& primitive :
         model.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
      if (primitive.topology != Topology::kTriangles) continue;
      const auto first = static_cast<std::uint32_t>(corners_.size());
      for (const auto& position : primitive.positions)
        corners_.push_back(Vec3(world_from_node * Vec4(Vec3(position), 1.0)));
      const auto& indices = primitive.indices;
      for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        triangles_.push_back({first + indices[i], first + indices[i + 1], first + indices[i + 2]});
    }
  }
}

std::size_t Surface::cell_of(double value_m, double min_m, double size_m) const {
  const double cell = std::floor((value_m - min_m) / size_m);
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(side_ - 1)));
}

Surface::Cells Surface::cells_of(const Triangle& t) const {
  const Vec3 &a = corners_[t[0]], &b = corners_[t[1]], &c = corners_[t[2]];
  const auto [x0, x1] = std::minmax({a.x, b.x, c.x});
  const auto [z0, z1] = std::minmax({a.z, b.z, c.z});
  return {cell_of(x0, min_x_m_, cell_x_m_), cell_of(z0, min_z_m_, cell_z_m_),
          cell_of(x1, min_x_m_, cell_x_m_), cell_of(z1, min_z_m_, cell_z_m_)};
}

void Surface::sort_into_cells() {
  Bounds bounds;
  for (const Triangle& triangle : triangles_)
    for (const std::uint32_t corner : triangle) bounds.add(corners_[corner]);
  if (!bounds.empty() && is_finite(bounds.min) && is_finite(bounds.max)) {
    // About two triangles a cell.
    side_ = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::sqrt(static_cast<double>(triangles_.size()) / 2.0)), 1, 1024);
    min_x_m_ = bounds.min.x;
    min_z_m_ = bounds.min.z;
    const auto side = static_cast<double>(side_);
    cell_x_m_ = std::max((bounds.max.x - bounds.min.x) / side, 1e-9);
    cell_z_m_ = std::max((bounds.max.z - bounds.min.z) / side, 1e-9);
  } else {
    triangles_.clear();
  }
  const auto for_each_cell = [this](auto visit) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Cells cells = cells_of(triangles_[t]);
      for (std::size_t z = cells.z0; z <= cells.z1; ++z)
        for (std::size_t x = cells.x0; x <= cells.x1; ++x) visit(z * side_ + x, t);
    }
  };
  first_.assign(side_ * side_ + 1, 0);
  for_each_cell([this](std::size_t cell, std::size_t) { ++first_[cell + 1]; });
  for (std::size_t cell = 0; cell < side_ * side_; ++cell) first_[cell + 1] += first_[cell];
  items_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for_each_cell([this, &next](std::size_t cell, std::size_t t) {
    items_[next[cell]++] = static_cast<std::uint32_t>(t);
  });
}

std::optional<SurfacePoint> Surface::at(double x_m, double z_m) const {
  const std::size_t cell =
      cell_of(z_m, min_z_m_, cell_z_m_) * side_ + cell_of(x_m, min_x_m_, cell_x_m_);
  std::optional<SurfacePoint> best;
  for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
    const Triangle& of = triangles_[items_[i]];
    const Vec3 &a = corners_[of[0]], &b = corners_[of[1]], &c = corners_[of[2]];
    // Barycentric coordinates in the x-z plane, by signed areas.
    const double area = (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z);
    if (area == 0.0) continue;
    const double wb = ((x_m - a.x) * (c.z - a.z) - (c.x - a.x) * (z_m - a.z)) / area;
    const double wc = ((b.x - a.x) * (z_m - a.z) - (x_m - a.x) * (b.z - a.z)) / area;
    const double wa = 1.0 - wb - wc;
    if (wa < 0.0 || wb < 0.0 || wc < 0.0) continue;
    const double y = wa * a.y + wb * b.y + wc * c.y;
    if (best && best->y_m >= y) continue;
    const Vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    best = {y, normal.y < 0.0 ? -normal : normal};
  }
  return best;
}

}  // namespace neritic::scene
