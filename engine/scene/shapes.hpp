// Meshes made from numbers: sphere, box, plane, cylinder and heightfields. Model frame: Y up,
// metres, outward normals, texture coordinates in metres where flat. Pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/image.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/model.hpp"

namespace neritic::scene {

Model make_sphere(double radius_m, int segments = 48);
Model make_box(const Vec3& size_m);
Model make_plane(double size_x_m, double size_z_m);                        // faces +Y
Model make_cylinder(double radius_m, double height_m, int segments = 48);  // axis Y, capped
// A tube bent by its joints: nodes 1 to joints, from the top down, each with a ring across its own
// y; at rest it hangs straight down from the origin.
Model make_tube(int joints, double radius_m, double length_m);
// Triangles: sphere 2 n (floor(n / 2) - 1), cylinder 4 n, for n segments.

// A model of one node that draws one primitive.
Model model_of_primitive(Primitive primitive, std::string name);
// Turns every face and normal round: what was seen from outside is then seen from inside.
void turn_inside_out(Model& model);
// The sum over all meshes, each counted once.
std::size_t triangle_count(const Model& model);

// Limits of a heightfield: 4096 x 4096 samples are some 800 MB of mesh; no sea is 1000 km deep.
inline constexpr std::size_t kMaxHeightfieldSamples = std::size_t{1} << 24;
inline constexpr float kMaxHeight_m = 1e6f;

// .asc (ESRI grid), .npy [rows, columns] or 16-bit PNG. scale multiplies the stored number, then
// offset is added; negative scale turns positive-down depths into heights. cell_m <= 0: the file's
// own (an error for files without one).
struct HeightfieldOptions {
  double cell_m = 0.0, scale = 1.0, offset_m = 0.0;
};
Result<Heightfield> read_heightfield(const std::filesystem::path& path,
                                     const HeightfieldOptions& options);
// The text of an .asc file already in memory; name stands in messages. Stored numbers, unscaled.
// cell_m is 0 where the text names none.
Result<Heightfield> parse_asc(std::string_view text, const std::string& name);
// Centred on the origin in x and z; triangles with a NaN corner are left out; smooth normals. The
// model keeps the heights.
Model make_terrain(const Heightfield& field, double texture_m = 2.5);

}  // namespace neritic::scene
