// Textures, samplers and materials. See gltf_stages.hpp. Source: Khronos glTF 2.0
// sections 3.8, 3.9; the extensions of materials that README.md lists, EXT_texture_webp,
// KHR_texture_transform, KHR_materials_emissive_strength, KHR_materials_unlit.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "engine/scene/gltf_container.hpp"
#include "engine/scene/gltf_mix.hpp"
#include "engine/scene/gltf_stages.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::scene::gltf {
namespace {

Wrap parse_wrap(Field field) {
  switch (field.whole(10497)) {
    case 10497:
      return Wrap::kRepeat;
    case 33648:
      return Wrap::kMirroredRepeat;
    case 33071:
      return Wrap::kClampToEdge;
    default:
      field.note_with("unknown wrap mode, repeat is used");
      return Wrap::kRepeat;
  }
}

Sampler parse_sampler(Field field) {
  Sampler out;
  out.wrap_u = parse_wrap(field["wrapS"]);
  out.wrap_v = parse_wrap(field["wrapT"]);
  out.mag_linear = field["magFilter"].whole(9729) != 9728;
  switch (field["minFilter"].whole(9987)) {  // OpenGL's enumerants
    case 9728:
      out.min_linear = out.mip_linear = out.mipmapped = false;
      break;
    case 9729:
      out.mip_linear = out.mipmapped = false;
      break;
    case 9984:
      out.min_linear = out.mip_linear = false;
      break;
    case 9985:
      out.mip_linear = false;
      break;
    case 9986:
      out.min_linear = false;
      break;
    default:
      break;
  }
  return out;
}

void load_textures(Loading& loading) {
  const Field textures = loading.root["textures"], samplers = loading.root["samplers"];
  const std::size_t n_images = loading.root["images"].size();
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const Field field = textures.at(i);
    Texture texture;
    const Field webp = field.extension("EXT_texture_webp")["source"];
    texture.image = (webp.present() ? webp : field["source"]).index(n_images, "images");
    const int sampler = field["sampler"].index(samplers.size(), "samplers");
    if (sampler >= 0) texture.sampler = parse_sampler(samplers.at(sampler));
    loading.model.textures.push_back(texture);
  }
}

// uv' = translation * rotation * scale * uv. A positive angle turns the coordinates
// counter-clockwise as seen in the picture, whose v axis points down; hence the signs. Checked
// against the extension's own example: offset (0, 1), a quarter turn, scale 1/2 is the lower left
// quadrant.
void parse_transform(Field field, TextureRef& out) {
  const auto offset = field["offset"].numbers<2>({0.0, 0.0});
  const auto scale = field["scale"].numbers<2>({1.0, 1.0});
  const double angle_rad = field["rotation"].number(0.0);
  const double c = std::isfinite(angle_rad) ? std::cos(angle_rad) : 1.0;
  const double s = std::isfinite(angle_rad) ? std::sin(angle_rad) : 0.0;
  out.transform_u = Vec3f(c * scale[0], s * scale[1], offset[0]);
  out.transform_v = Vec3f(-s * scale[0], c * scale[1], offset[1]);
}

TextureRef parse_texture_ref(Loading& loading, Field field) {
  TextureRef out;
  if (!field.present()) return out;
  out.texture = field["index"].index(loading.model.textures.size(), "textures");
  if (out.texture < 0) field.refuse("no texture", "the index of a texture");
  Field set = field["texCoord"];
  const Field transform = field.extension("KHR_texture_transform");
  if (transform.present()) {
    parse_transform(transform, out);
    if (transform["texCoord"].present()) set = transform["texCoord"];
  }
  const std::uint64_t uv_set = set.whole(0);
  if (uv_set > 1) set.note_with("texture coordinate set {}, 0 is used (0 and 1 are read)", uv_set);
  out.uv_set = uv_set == 1 ? 1 : 0;
  return out;
}

// The project's own, model.hpp: repeats is how often the picture repeats where the others do once.
TextureRef parse_detail_ref(Loading& loading, Field field) {
  TextureRef out = parse_texture_ref(loading, field);
  const float repeats = field["repeats"].number_f(1.0f);
  out.transform_u *= repeats;
  out.transform_v *= repeats;
  return out;
}

// A number that glTF lets lie in [0, 1]; another becomes the nearer end, with a note.
double clamped(Field field, double value) {
  if (value < 0.0 || value > 1.0)
    field.note_with("{:g} is outside [0, 1], {} is used", value, value < 0.0 ? 0 : 1);
  return std::clamp(value, 0.0, 1.0);
}
template <std::size_t N>
std::array<double, N> units(Field field) {
  std::array<double, N> ones;
  ones.fill(1.0);
  auto out = field.numbers<N>(ones);
  for (double& v : out) v = clamped(field, v);
  return out;
}
Vec3f color_of(const std::array<double, 3>& rgb) {
  return glm::clamp(Vec3f(rgb[0], rgb[1], rgb[2]), 0.0f, 1.0f);
}
Vec4f base_color_of(Field field) {
  const auto rgba = units<4>(field);
  return Vec4f(rgba[0], rgba[1], rgba[2], rgba[3]);
}
float unit(Field field, float fallback) {
  return static_cast<float>(clamped(field, field.number_f(fallback)));
}

AlphaMode parse_alpha_mode(Field field) {
  const std::string mode = field.text("OPAQUE");
  if (mode == "MASK") return AlphaMode::kMask;
  if (mode == "BLEND") return AlphaMode::kBlend;
  if (mode != "OPAQUE") field.note_with("\"{}\" is unknown, OPAQUE is used", mode);
  return AlphaMode::kOpaque;
}

// Reflectance (model.hpp) of a dielectric: KHR_materials_ior, times KHR_materials_specular, whose
// colour counts as its mean. An index of 0, "infinite" in the extension, gives the largest.
float parse_reflectance(Field field) {
  const double index = field.extension("KHR_materials_ior")["ior"].number(1.5);
  const Field specular = field.extension("KHR_materials_specular");
  const auto color = specular["specularColorFactor"].numbers<3>({1.0, 1.0, 1.0});
  for (const char* key : {"specularTexture", "specularColorTexture"})
    if (specular[key].present()) specular[key].note_with("ignored, only the factors are read");
  const double normal = index >= 1.0 ? (index - 1.0) / (index + 1.0) : index == 0.0 ? 1.0 : 0.0;
  const double strength = unit(specular["specularFactor"], 1.0f) *
                          std::max(0.0, (color[0] + color[1] + color[2]) / 3.0);
  return static_cast<float>(std::min(normal * std::sqrt(strength), 0.8));
}

MixedPictures parse_mixed(Loading& loading, Field field, Material& out) {
  MixedPictures mixed;
  const Field transmission = field.extension("KHR_materials_transmission");
  mixed.transmission = unit(transmission["transmissionFactor"], 0.0f);
  mixed.transmission_texture = parse_texture_ref(loading, transmission["transmissionTexture"]);
  const Field old = field.extension("KHR_materials_pbrSpecularGlossiness");
  mixed.specular_glossiness = old.present();
  if (!old.present()) return mixed;
  mixed.specular = color_of(units<3>(old["specularFactor"]));
  mixed.glossiness = unit(old["glossinessFactor"], 1.0f);
  mixed.specular_texture = parse_texture_ref(loading, old["specularGlossinessTexture"]);
  out.base_color = base_color_of(old["diffuseFactor"]);
  out.base_color_texture = parse_texture_ref(loading, old["diffuseTexture"]);
  out.metallic_roughness_texture = TextureRef{};
  return mixed;
}

Material parse_material(Loading& loading, Field field) {
  Material out;
  out.name = field["name"].text();
  const Field pbr = field["pbrMetallicRoughness"];
  out.base_color = base_color_of(pbr["baseColorFactor"]);
  out.metallic = unit(pbr["metallicFactor"], 1.0f);
  out.roughness = unit(pbr["roughnessFactor"], 1.0f);
  out.base_color_texture = parse_texture_ref(loading, pbr["baseColorTexture"]);
  out.metallic_roughness_texture = parse_texture_ref(loading, pbr["metallicRoughnessTexture"]);
  out.normal_texture = parse_texture_ref(loading, field["normalTexture"]);
  out.normal_scale = field["normalTexture"]["scale"].number_f(1.0f);
  out.occlusion_texture = parse_texture_ref(loading, field["occlusionTexture"]);
  out.occlusion_strength = unit(field["occlusionTexture"]["strength"], 1.0f);
  out.emissive_texture = parse_texture_ref(loading, field["emissiveTexture"]);
  // Extras are any program's: ours are read where they have our shape.
  const Field extras = field["extras"];
  if (extras.present() && extras.place()->is_object()) {
    out.detail_texture = parse_detail_ref(loading, extras["detailTexture"]);
    if (const Field picture = extras["picture"]; picture.present() && picture.place()->is_string())
      out.picture = picture.text();
  }
  // Emitted light has no upper limit: kept below 1e6 so that products stay finite.
  const float strength =
      field.extension("KHR_materials_emissive_strength")["emissiveStrength"].number_f(1.0f);
  out.emissive = color_of(field["emissiveFactor"].numbers<3>({0.0, 0.0, 0.0})) *
                 std::clamp(strength, 0.0f, 1e6f);
  out.alpha_mode = parse_alpha_mode(field["alphaMode"]);
  out.alpha_cutoff = std::max(0.0f, field["alphaCutoff"].number_f(0.5f));
  out.double_sided = field["doubleSided"].boolean(false);
  out.unlit = field.extension("KHR_materials_unlit").present();
  out.reflectance = parse_reflectance(field);
  const Field through = field.extension("KHR_materials_diffuse_transmission");
  out.diffuse_transmission = unit(through["diffuseTransmissionFactor"], 0.0f);
  for (const char* key : {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture"})
    if (through[key].present()) through[key].note_with("ignored, only the factor is read");
  loading.mixed.push_back(parse_mixed(loading, field, out));
  return out;
}

// All of material i, those to be mixed in too.
std::array<TextureRef*, 8> texture_refs(Loading& loading, std::size_t i) {
  Material& material = loading.model.materials[i];
  MixedPictures& mixed = loading.mixed[i];
  return {&material.base_color_texture, &material.metallic_roughness_texture,
          &material.normal_texture,     &material.occlusion_texture,
          &material.emissive_texture,   &material.detail_texture,
          &mixed.specular_texture,      &mixed.transmission_texture};
}

// Textures whose pictures are the same bytes get the same picture: it is decoded and held once.
// Returns which pictures materials use.
std::vector<bool> share_pictures(Loading& loading) {
  const Field images = loading.root["images"];
  // By URI, else by the bytes of the buffer view.
  std::map<std::tuple<std::string, const std::byte*, std::size_t>, int> first_of;
  const auto source_of = [&](int image) {
    const Field field = images.at(image);
    const std::string uri = field["uri"].text();
    const auto bytes =
        uri.empty() ? loading.resources.view(field["bufferView"]) : std::span<const std::byte>{};
    return std::tuple(uri, bytes.data(), bytes.size());
  };
  std::vector<int> shared(images.size(), -1);
  std::vector<bool> used(images.size(), false);
  for (std::size_t i = 0; i < loading.model.materials.size(); ++i)
    for (const TextureRef* ref : texture_refs(loading, i)) {
      if (!ref->present()) continue;
      int& image = loading.model.textures[ref->texture].image;
      if (image < 0) continue;
      if (shared[image] < 0)
        shared[image] = first_of.emplace(source_of(image), image).first->second;
      image = shared[image];
      used[image] = true;
    }
  return used;
}

// The job with its bytes; one that cannot or must not be decoded comes with its error.
ImageDecoder::Job picture_job(Loading& loading, Field field, std::size_t image) {
  ImageDecoder::Job job;
  job.image = image;
  job.name = fmt::format("images[{}]", image);
  const std::string uri = field["uri"].text();
  if (uri.empty()) {
    job.bytes = loading.resources.view(field["bufferView"]);
  } else if (auto bytes = read_uri(uri, loading.resources.folder()); bytes.ok()) {
    job.owned = std::move(bytes).value();
    job.bytes = job.owned;
  } else {
    job.error = fmt::format("{}: {}", job.name, bytes.error().message);
    return job;
  }
  const PictureSize size = peek_size(job.bytes);
  const std::size_t bytes = std::size_t{size.width} * size.height * 4;
  if (!loading.resources.charge_picture(bytes, job.owned.size()))
    job.error = fmt::format(
        "{}: {} x {} pixels, with the file's other pictures too much for a file of this size",
        job.name, size.width, size.height);
  return job;
}

void start_images(Loading& loading) {
  const std::vector<bool> used = share_pictures(loading);
  std::vector<ImageDecoder::Job> jobs;
  for (std::size_t i = 0; i < used.size() && !loading.report.failed(); ++i)
    if (used[i]) jobs.push_back(picture_job(loading, loading.root["images"].at(i), i));
  loading.model.images.assign(used.size(), ImageU8(1, 1, 4, 255));
  if (!loading.report.failed()) loading.images.start(std::move(jobs));
}

}  // namespace

void load_materials(Loading& loading) {
  load_textures(loading);
  const Field materials = loading.root["materials"];
  for (std::size_t i = 0; i < materials.size() && !loading.report.failed(); ++i)
    loading.model.materials.push_back(parse_material(loading, materials.at(i)));
  if (!loading.report.failed()) start_images(loading);
}

void finish_images(Loading& loading) {
  std::vector<bool> broken(loading.model.images.size(), false);
  for (ImageDecoder::Job& job : loading.images.wait()) {
    if (job.error.empty()) {
      loading.model.images[job.image] = std::move(job.picture);
    } else {
      broken[job.image] = true;
      loading.report.note(job.error + "; drawn without it");
    }
  }
  for (std::size_t i = 0; i < loading.model.materials.size(); ++i)
    for (TextureRef* ref : texture_refs(loading, i)) {
      if (!ref->present()) continue;
      const int image = loading.model.textures[ref->texture].image;
      if (image < 0)
        loading.report.note(fmt::format(
            "textures[{}]: no picture of a supported kind; drawn without it", ref->texture));
      if (image < 0 || broken[image]) *ref = TextureRef{};
    }
  mix_pictures(loading);
}

}  // namespace neritic::scene::gltf
