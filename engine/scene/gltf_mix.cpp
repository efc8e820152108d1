// See gltf_mix.hpp.
#include "engine/scene/gltf_mix.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace neritic::scene::gltf {
namespace {

constexpr float kDielectric = 0.04f;  // what a metallic-roughness dielectric reflects

float mean_of(const Vec3f& c) {
  return (c.x + c.y + c.z) / 3.0f;
}

// IEC 61966-2-1.
float linear_of(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}
float srgb_of(float linear) {
  return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}
std::uint8_t byte_of(float v) {
  return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f);
}

bool same_mapping(const TextureRef& a, const TextureRef& b) {
  return a.uv_set == b.uv_set && a.transform_u == b.transform_u && a.transform_v == b.transform_v;
}

// A texture's picture as linear RGBA at any place; white where there is none.
class Picture {
 public:
  Picture(const Model& model, const TextureRef& ref)
      : image_(ref.present() ? &model.images[model.textures[ref.texture].image] : nullptr) {}
  std::uint32_t width() const { return image_ ? image_->width : 1; }
  std::uint32_t height() const { return image_ ? image_->height : 1; }
  // The value at pixel (x, y) of a picture of width x height; color: its RGB is sRGB.
  Vec4f at(std::uint32_t x, std::uint32_t y, std::uint32_t w, std::uint32_t h, bool color) const {
    if (!image_) return Vec4f(1.0f);
    const auto px = static_cast<std::uint32_t>(std::uint64_t{x} * image_->width / w);
    const auto py = static_cast<std::uint32_t>(std::uint64_t{y} * image_->height / h);
    Vec4f out;
    for (int c = 0; c < 4; ++c) {
      const std::uint8_t byte = image_->at(px, py, static_cast<std::uint32_t>(c));
      out[c] = color && c < 3 ? table()[byte] : byte / 255.0f;
    }
    return out;
  }

 private:
  static const std::array<float, 256>& table() {
    static const std::array<float, 256> values = [] {
      std::array<float, 256> out{};
      for (int i = 0; i < 256; ++i) out[i] = linear_of(i / 255.0f);
      return out;
    }();
    return values;
  }
  const ImageU8* image_;
};

class Mixer {
 public:
  Mixer(Loading& loading, std::size_t i)
      : loading_(loading),
        material_(loading.model.materials[i]),
        mixed_(loading.mixed[i]),
        field_(loading.root["materials"].at(i)) {}

  void run() {
    if (mixed_.specular_glossiness) mix_specular();
    if (mixed_.transmission > 0.0f) mix_transmission();
  }

 private:
  // The reference that a mixed picture is drawn by: base colour's, or the other's. Two pictures
  // that lie differently on the surface cannot be mixed: the other one is dropped.
  TextureRef common(TextureRef& other, const char* extension) {
    const TextureRef& base = material_.base_color_texture;
    if (base.present() && other.present() && !same_mapping(base, other)) {
      field_.extension(extension).note_with(
          "textures of two sets or transforms; drawn without the extension's own");
      other = TextureRef{};
    }
    return base.present() ? base : other;
  }

  // A new texture, drawn as `from`.
  void add(const TextureRef& from, ImageU8 picture, TextureRef& out) {
    Model& model = loading_.model;
    Texture texture = model.textures[from.texture];
    texture.image = static_cast<int>(model.images.size());
    model.images.push_back(std::move(picture));
    out = from;
    out.texture = static_cast<int>(model.textures.size());
    model.textures.push_back(texture);
  }

  bool affords(std::uint64_t width, std::uint64_t height, int pictures) {
    if (loading_.resources.charge_picture(width * height * 4 * pictures, 0)) return true;
    field_.note_with("{} x {} pixels are too much for a file of this size; drawn without textures",
                     width, height);
    return false;
  }

  void mix_specular() {
    const TextureRef ref = common(mixed_.specular_texture, "KHR_materials_pbrSpecularGlossiness");
    const Picture diffuse(loading_.model, material_.base_color_texture),
        specular(loading_.model, mixed_.specular_texture);
    const std::uint32_t w = std::max(diffuse.width(), specular.width()),
                        h = std::max(diffuse.height(), specular.height());
    const Vec4f factor = material_.base_color;
    if (!ref.present() || !affords(w, h, 2)) {
      const SolvedColor solved = solve_specular(Vec3f(factor), mixed_.specular);
      material_.base_color = Vec4f(solved.base, factor.w);
      material_.metallic = solved.metallic;
      material_.roughness = 1.0f - mixed_.glossiness;
      material_.base_color_texture = TextureRef{};
      return;
    }
    ImageU8 base(w, h, 4), metal_rough(w, h, 4, 255);
    for (std::uint32_t y = 0; y < h; ++y)
      for (std::uint32_t x = 0; x < w; ++x) {
        const Vec4f d = diffuse.at(x, y, w, h, true) * factor, s = specular.at(x, y, w, h, true);
        const SolvedColor solved = solve_specular(Vec3f(d), Vec3f(s) * mixed_.specular);
        for (int c = 0; c < 3; ++c)
          base.at(x, y, static_cast<std::uint32_t>(c)) = byte_of(srgb_of(solved.base[c]));
        base.at(x, y, 3) = byte_of(d.w);
        metal_rough.at(x, y, 1) = byte_of(1.0f - s.w * mixed_.glossiness);
        metal_rough.at(x, y, 2) = byte_of(solved.metallic);
      }
    add(ref, std::move(base), material_.base_color_texture);
    add(ref, std::move(metal_rough), material_.metallic_roughness_texture);
    material_.base_color = Vec4f(1.0f);
    material_.metallic = material_.roughness = 1.0f;
  }

  void mix_transmission() {
    if (material_.alpha_mode == AlphaMode::kMask) {
      field_["alphaMode"].note_with("MASK beside KHR_materials_transmission; drawn without that");
      return;
    }
    material_.transmissive = true;
    const TextureRef ref = common(mixed_.transmission_texture, "KHR_materials_transmission");
    const Picture color(loading_.model, material_.base_color_texture),
        share(loading_.model, mixed_.transmission_texture);
    const std::uint32_t w = std::max(color.width(), share.width()),
                        h = std::max(color.height(), share.height());
    material_.base_color.w = 1.0f;
    if (!ref.present() || !affords(w, h, 1)) {
      material_.base_color.w = 1.0f - mixed_.transmission;
      material_.base_color_texture = TextureRef{};
      return;
    }
    ImageU8 base(w, h, 4);
    for (std::uint32_t y = 0; y < h; ++y)
      for (std::uint32_t x = 0; x < w; ++x) {
        const Vec4f c = color.at(x, y, w, h, true);
        for (int k = 0; k < 3; ++k)
          base.at(x, y, static_cast<std::uint32_t>(k)) = byte_of(srgb_of(c[k]));
        base.at(x, y, 3) = byte_of(1.0f - mixed_.transmission * share.at(x, y, w, h, false).x);
      }
    add(ref, std::move(base), material_.base_color_texture);
  }

  Loading& loading_;
  Material& material_;
  MixedPictures& mixed_;
  Field field_;
};

}  // namespace

// Both models describe the same light: a metallic-roughness surface sends diffusely
// D = base (1 - m) (1 - 0.04) and reflects s = 0.04 (1 - m) + base m; a specular-glossiness one
// sends D = d (1 - max s). Without base that is 0.04 m^2 + (D / 0.96 + s - 0.08) m + 0.04 - s = 0,
// solved for the means of the channels.
SolvedColor solve_specular(const Vec3f& diffuse, const Vec3f& specular) {
  const Vec3f sent = diffuse * (1.0f - std::max({specular.x, specular.y, specular.z}));
  const float s = mean_of(specular);
  SolvedColor out;
  if (s > kDielectric) {
    const float half = 0.5f * (mean_of(sent) / (1.0f - kDielectric) + s - 2.0f * kDielectric);
    const float root = std::sqrt(std::max(half * half - kDielectric * (kDielectric - s), 0.0f));
    out.metallic = std::clamp((root - half) / kDielectric, 0.0f, 1.0f);
  }
  const float m = out.metallic;
  const Vec3f of_diffuse = sent / ((1.0f - kDielectric) * std::max(1.0f - m, 1e-4f));
  const Vec3f of_specular = (specular - kDielectric * (1.0f - m)) / std::max(m, 1e-4f);
  // The diffuse part says nothing of a metal's colour, the specular part nothing of a dielectric's.
  out.base = glm::clamp(glm::mix(of_diffuse, of_specular, m * m), 0.0f, 1.0f);
  return out;
}

void mix_pictures(Loading& loading) {
  for (std::size_t i = 0; i < loading.model.materials.size(); ++i) Mixer(loading, i).run();
}

}  // namespace neritic::scene::gltf
