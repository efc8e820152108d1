// A loaded model: plain data that mirrors glTF 2.0 after decoding (floats, index lists, RGBA8
// images), but for cameras: views are the scene's to name. Model frame as glTF: right-handed, Y up,
// metres. Immutable after loading, so any thread may read it. Source: Khronos glTF 2.0
// specification.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/math.hpp"

namespace neritic::scene {

struct Bounds {
  Vec3 min{std::numeric_limits<double>::infinity()};
  Vec3 max{-std::numeric_limits<double>::infinity()};
  bool empty() const { return !(min.x <= max.x); }
  void add(const Vec3& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
};

// Strips, fans and loops are turned into lists while loading.
enum class Topology { kPoints, kLines, kTriangles };

struct MorphTarget {
  // Displacements per vertex; each empty or as long as the primitive's positions. A file's of
  // tangents are not read: the deform pass moves positions and normals, and a normal map's tangent
  // is the base's, made perpendicular to the moved normal.
  std::vector<Vec3f> positions, normals;
};

struct Primitive {
  Topology topology = Topology::kTriangles;
  // One entry a vertex; positions and normals always (made from the faces where the file has none,
  // zero length for points and lines without normals); the others empty where the file has none.
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;   // unit
  std::vector<Vec4f> tangents;  // unit xyz, w = handedness; made where a normal map needs them
  std::vector<Vec2f> uv0, uv1;
  std::vector<Vec4f> colors;                         // linear RGBA
  std::vector<std::array<std::uint16_t, 4>> joints;  // indices into the skin's joints
  std::vector<Vec4f> weights;                        // sum 1, the four largest influences
  std::vector<std::uint32_t>
      indices;  // always present, in range, a multiple of the topology's size
  std::vector<MorphTarget> targets;
  int material = -1;  // -1: glTF's default material
  // Vertices in the file, before flat normals or mirrored texture seams split some of them.
  std::uint32_t file_vertices = 0;
  Bounds bounds;  // of the positions, without skin and morphs
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<float> weights;  // default morph weights, one a target
};

struct TextureRef {
  int texture = -1;  // -1: none
  int uv_set = 0;    // 0 or 1
  // KHR_texture_transform: uv' = transform * (u, v, 1), rows.
  Vec3f transform_u{1, 0, 0}, transform_v{0, 1, 0};
  bool present() const { return texture >= 0; }
};

enum class AlphaMode { kOpaque, kMask, kBlend };

struct Material {
  std::string name;
  Vec4f base_color{1.0f};  // linear
  float metallic = 1.0f, roughness = 1.0f;
  // (n - 1) / (n + 1) of the index of refraction, 0 to 0.8: squared, what a dielectric reflects in
  // air at normal incidence. KHR_materials_ior and KHR_materials_specular change it.
  float reflectance = 0.2f;
  Vec3f emissive{0.0f};  // linear, KHR_materials_emissive_strength multiplied in
  float normal_scale = 1.0f, occlusion_strength = 1.0f;
  float alpha_cutoff = 0.5f;
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  bool double_sided = false;
  bool unlit = false;
  // KHR_materials_transmission, of a thin pane: 1 - base colour's alpha of the light that is not
  // reflected passes, tinted by the base colour.
  bool transmissive = false;
  // KHR_materials_diffuse_transmission: of the diffuse light on a thin sheet, the share that leaves
  // on its other side, in the base colour.
  float diffuse_transmission = 0.0f;
  TextureRef base_color_texture, metallic_roughness_texture, normal_texture, occlusion_texture,
      emissive_texture;
  // For close views, linear: red and green add to the tangent-space normal, blue changes the base
  // colour by up to its own value; 0.5 is no change. In a .glb it is extras.detailTexture of a
  // material: index, texCoord and repeats.
  TextureRef detail_texture;
  // The name of a picture that a program may show here, on texture coordinates 0: where it does
  // (object_pictures.hpp), the surface glows with it. Empty: none. In a .glb it is extras.picture
  // of a material.
  std::string picture;
};

enum class Wrap { kRepeat, kMirroredRepeat, kClampToEdge };
struct Sampler {
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool mag_linear = true, min_linear = true, mip_linear = true, mipmapped = true;
};
struct Texture {
  int image = -1;  // -1: no picture of a supported kind; then no material refers to this texture
  Sampler sampler;
};

// A file's `range` is a hint to save time; light here falls with the square of the distance for
// ever.
struct Light {
  enum class Kind { kDirectional, kPoint, kSpot };
  Kind kind = Kind::kPoint;
  std::string name;
  Vec3f color{1.0f};
  float intensity = 1.0f;  // candela (point, spot) or lux (directional)
  float inner_cone_rad = 0.0f, outer_cone_rad = 0.785398f;
};

struct Node {
  std::string name;
  int parent = -1;
  std::vector<int> children;
  Vec3 translation_m{0.0};
  Quat rotation{1.0, 0.0, 0.0, 0.0};
  Vec3 scale{1.0};
  std::optional<Mat4> matrix;  // instead of the three above, where the file gives one
  int mesh = -1, skin = -1, light = -1;
  std::vector<float> weights;  // empty: the mesh's own
  // EXT_mesh_gpu_instancing: node_from_instance; empty: the mesh is drawn once.
  std::vector<Mat4> instances;
};

struct Skin {
  std::string name;
  std::vector<int> joints;         // nodes
  std::vector<Mat4> inverse_bind;  // one a joint
};

struct Channel {
  enum class Path { kTranslation, kRotation, kScale, kWeights };
  enum class Interpolation { kStep, kLinear, kCubic };
  int node = -1;
  Path path = Path::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times_s;  // strictly increasing
  std::vector<float> values;   // width (3, 4 or n weights) a key; three times that for kCubic
  int width = 3;
};

struct Clip {
  std::string name;
  double duration_s = 0.0;
  std::vector<Channel> channels;
};

// Heights in metres above the datum (y up), NaN where there is no data.
struct Heightfield {
  std::uint32_t columns = 0, rows = 0;  // samples along x and z
  double cell_m = 1.0;
  std::vector<float> heights_m;  // [rows][columns]; row 0 is north (-z)
};

struct Model {
  std::string name;  // the file's path as given
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  // RGBA8, row 0 on top; colour space is the use's, not the image's. Pictures that no material uses
  // or that cannot be read are one white pixel.
  std::vector<ImageU8> images;
  std::vector<Light> lights;
  std::vector<Node> nodes;
  // Roots of the default scene, else of the first; all parentless nodes if the file has no scenes.
  std::vector<int> roots;
  std::vector<Skin> skins;
  std::vector<Clip> clips;
  std::optional<Heightfield> heights;  // of a terrain: what it was made of
  std::vector<std::string> notes;      // what was ignored, one line each, said once to the user
};

}  // namespace neritic::scene
