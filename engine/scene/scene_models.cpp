// Loads the models of a scene: each distinct file, shape and terrain once, several at a time. The
// order of the result is that of first use, whatever the threads did. Called from one thread.
#include <algorithm>
#include <map>

#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/parallel.hpp"
#include "engine/scene/gltf_loader.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/scene_draft.hpp"

namespace neritic::scene {
namespace fs = std::filesystem;
namespace {

std::string identity_of(const fs::path& file) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(file, error);
  return error ? file.string() : canonical.string();
}

// The error with the place of the key that it is about.
Error at_place(const std::string& place, const Error& error) {
  return {error.code, place + ": " + error.message};
}

// Adds the picture as a texture of the model and refers to it.
Status add_texture(const fs::path& file, const std::string& place, double repeats_per_unit,
                   Model& model, TextureRef& ref) {
  if (file.empty()) return {};
  Result<ImageU8> read = read_image8(file, 4);
  if (!read.ok()) return at_place(place, read.error());
  ImageU8 image = std::move(read).value();
  ref.texture = static_cast<int>(model.textures.size());
  const auto repeats = static_cast<float>(repeats_per_unit);
  ref.transform_u = {repeats, 0, 0};
  ref.transform_v = {0, repeats, 0};
  model.textures.push_back({static_cast<int>(model.images.size()), {}});
  model.images.push_back(std::move(image));
  return {};
}

Result<Material> make_material(const Look& look, bool metres_in_uv, Model& model) {
  Material material;
  material.base_color = Vec4f(Vec3f(look.color), 1.0f);
  material.roughness = static_cast<float>(look.roughness);
  material.metallic = static_cast<float>(look.metallic);
  material.double_sided = look.double_sided;
  const double repeats = metres_in_uv ? 1.0 / look.texture_m : 1.0;
  NERITIC_TRY_STATUS(add_texture(look.color_texture, look.place_color_texture, repeats, model,
                                 material.base_color_texture));
  NERITIC_TRY_STATUS(add_texture(look.normal_texture, look.place_normal_texture, repeats, model,
                                 material.normal_texture));
  // Texture coordinates of a terrain count repeats of texture_m.
  NERITIC_TRY_STATUS(add_texture(look.detail_texture, look.place_detail_texture,
                                 look.texture_m / look.detail_m, model, material.detail_texture));
  return material;
}

// A terrain's texture runs along +x and, downwards in the picture, +z: the tangent is +x made
// perpendicular to the normal, and the bitangent (up in the picture) is -z, handedness 1.
void add_terrain_tangents(Model& model) {
  for (Primitive& primitive : model.meshes[0].primitives)
    for (const Vec3f& normal : primitive.normals)
      primitive.tangents.emplace_back(glm::normalize(Vec3f(1, 0, 0) - normal * normal.x), 1.0f);
}

Model make_shape(const ModelRequest& request) {
  if (request.shape == "box") return make_box(request.size_m);
  if (request.kind == ModelRequest::Kind::kTether)
    return make_tube(request.segments, request.radius_m, request.height_m);
  if (request.shape == "plane") return make_plane(request.size_m.x, request.size_m.z);
  if (request.shape == "cylinder")
    return make_cylinder(request.radius_m, request.height_m, request.segments);
  return make_sphere(request.radius_m, request.segments);
}

// Errors begin with the place of the key that they are about.
Result<Model> load_base(const ModelRequest& request) {
  if (request.kind == ModelRequest::Kind::kFile) {
    Result<Model> model = load_gltf(request.file);
    if (!model.ok()) return at_place(request.place, model.error());
    // A scene has notes of many files.
    for (std::string& note : model->notes) note = request.file.string() + ": " + note;
    return model;
  }
  Model model;
  if (request.kind == ModelRequest::Kind::kTerrain) {
    const Result<Heightfield> field = read_heightfield(request.file, request.heights);
    if (!field.ok()) return at_place(request.place, field.error());
    model = make_terrain(*field, request.look.texture_m);
    if (!request.look.normal_texture.empty()) add_terrain_tangents(model);
  } else {
    model = make_shape(request);
    if (request.inside_out) turn_inside_out(model);
  }
  const bool metres_in_uv = request.shape == "box" || request.shape == "plane";
  NERITIC_TRY(Material material, make_material(request.look, metres_in_uv, model));
  model.materials.push_back(std::move(material));
  for (Primitive& primitive : model.meshes[0].primitives) primitive.material = 0;
  return model;
}

// The same with a line about it.
Result<Model> load_and_say(const ModelRequest& request) {
  const TimeNs start = now_ns();
  Result<Model> model = load_base(request);
  if (model.ok())
    log_info("{}: {} triangles, {} pictures, {:.0f} ms",
             request.file.empty() ? request.shape : request.file.string(), triangle_count(*model),
             model->images.size(), to_ms(now_ns() - start));
  return model;
}

// Runs load_base for each base, the largest files first, on as many threads as the machine has.
std::vector<std::optional<Result<Model>>> load_bases(
    const std::vector<const ModelRequest*>& bases) {
  std::vector<std::size_t> order(bases.size());
  std::vector<std::uintmax_t> bytes(bases.size(), 0);
  for (std::size_t i = 0; i < bases.size(); ++i) {
    order[i] = i;
    std::error_code error;
    const std::uintmax_t size = fs::file_size(bases[i]->file, error);
    if (!error) bytes[i] = size;
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return bytes[a] > bytes[b]; });
  std::vector<std::optional<Result<Model>>> results(bases.size());
  each_on_cores(order.size(),
                [&](std::size_t i) { results[order[i]].emplace(load_and_say(*bases[order[i]])); });
  return results;
}

}  // namespace

std::string ModelRequest::base_identity() const {
  if (kind == Kind::kFile) return "file " + identity_of(file);
  const std::string of_look =
      fmt::format("{} {} {} {} {} {} {} {} {} {} {}", look.color.x, look.color.y, look.color.z,
                  look.roughness, look.metallic, look.double_sided, look.texture_m,
                  look.color_texture.empty() ? std::string() : identity_of(look.color_texture),
                  look.normal_texture.empty() ? std::string() : identity_of(look.normal_texture),
                  look.detail_texture.empty() ? std::string() : identity_of(look.detail_texture),
                  look.detail_m);
  if (kind == Kind::kTerrain)
    return fmt::format("terrain {} {} {} {} {}", heights.cell_m, heights.scale, heights.offset_m,
                       identity_of(file), of_look);
  return fmt::format("shape {} {} {} {} {} {} {} {} {}", shape, radius_m, height_m, size_m.x,
                     size_m.y, size_m.z, segments, inside_out, of_look);
}

Result<LoadedModels> load_models(const std::vector<ModelRequest>& requests) {
  std::map<std::string, std::size_t> base_index;
  std::vector<const ModelRequest*> bases;
  std::vector<std::size_t> base_of_request;
  for (const ModelRequest& request : requests) {
    const auto [at, is_new] = base_index.emplace(request.base_identity(), bases.size());
    if (is_new) bases.push_back(&request);
    base_of_request.push_back(at->second);
  }
  auto results = load_bases(bases);
  for (std::size_t i = 0; i < bases.size(); ++i)
    if (!results[i]->ok()) return results[i]->error();

  LoadedModels loaded;
  std::map<std::string, int> model_index;
  std::vector<std::shared_ptr<const Model>> whole(bases.size());
  for (std::size_t i = 0; i < bases.size(); ++i)
    whole[i] = std::make_shared<const Model>(std::move(*results[i]).value());
  for (std::size_t r = 0; r < requests.size(); ++r) {
    const auto [at, is_new] =
        model_index.emplace(requests[r].identity(), static_cast<int>(loaded.models.size()));
    loaded.model_of_request.push_back(at->second);
    if (!is_new) continue;
    const std::shared_ptr<const Model>& base = whole[base_of_request[r]];
    if (requests[r].node.empty()) {
      loaded.models.push_back(base);
      continue;
    }
    Result<Model> part = model_of_node(*base, requests[r].node);
    if (!part.ok()) return at_place(requests[r].place, part.error());
    loaded.models.push_back(std::make_shared<const Model>(std::move(part).value()));
  }
  return loaded;
}

}  // namespace neritic::scene
