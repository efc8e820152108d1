// Meshes made from numbers: sphere, box, plane, cylinder and heightfields. Model frame: Y up, metres,
// outward normals, texture coordinates in metres where flat. Pure functions.
#pragma once

#include <filesystem>

#include "engine/core/image.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/model.hpp"

namespace neritic::scene {

Model make_sphere(double radius_m, int segments = 48);
Model make_box(const Vec3& size_m);
Model make_plane(double size_x_m, double size_z_m);      // faces +Y
Model make_cylinder(double radius_m, double height_m, int segments = 48);  // axis Y, capped

// Heights in metres above the datum (y up), NaN where there is no data.
struct Heightfield {
  std::uint32_t columns = 0, rows = 0;  // samples along x and z
  double cell_m = 1.0;
  std::vector<float> heights_m;  // [rows][columns]; row 0 is north (-z)
};
// .asc (ESRI grid), .npy [rows, columns] or 16-bit PNG. scale multiplies the stored number, then
// offset is added; negative scale turns positive-down depths into heights. cell_m <= 0: the file's own
// (an error for files without one).
struct HeightfieldOptions {
  double cell_m = 0.0, scale = 1.0, offset_m = 0.0;
};
Result<Heightfield> read_heightfield(const std::filesystem::path& path, const HeightfieldOptions& options);
// Centred on the origin in x and z; triangles with a NaN corner are left out; smooth normals.
Model make_terrain(const Heightfield& field, double texture_m = 2.5);

}  // namespace neritic::scene
