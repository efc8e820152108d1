// The triangles of a placed model, for vertical rays: what stands on a seabed asks it for the
// height. World frame (or any other with Y up); built once, then immutable.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/scene/model.hpp"

namespace neritic::scene {

struct SurfacePoint {
  double y_m = 0.0;
  Vec3 normal{0.0, 1.0, 0.0};  // unit, of the face, upwards
};

class Surface {
 public:
  // All triangles of the model at rest, once for each of world_from_model.
  Surface(const Model& model, const std::vector<Mat4>& world_from_model);
  // The highest face over or under (x, z); nothing where there is none.
  std::optional<SurfacePoint> at(double x_m, double z_m) const;
  std::size_t triangle_count() const { return triangles_.size(); }

 private:
  using Triangle = std::array<std::uint32_t, 3>;  // corners, in corners_
  struct Cells {
    std::size_t x0, z0, x1, z1;
  };
  void add_triangles(const Model& model, const Mat4& world_from_model);
  void sort_into_cells();
  Cells cells_of(const Triangle& triangle) const;
  std::size_t cell_of(double value_m, double min_m, double size_m) const;

  std::vector<Vec3> corners_;
  std::vector<Triangle> triangles_;
  std::size_t side_ = 1;  // cells along x and along z
  double min_x_m_ = 0, min_z_m_ = 0, cell_x_m_ = 1, cell_z_m_ = 1;
  std::vector<std::uint32_t> first_;  // of each cell in items_, and the end
  std::vector<std::uint32_t> items_;  // triangles
};

}  // namespace neritic::scene
