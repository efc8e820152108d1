// See gltf_audit.hpp: the rules of values.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/scene/gltf_audit.hpp"
#include "engine/scene/gltf_container.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::scene::gltf {
namespace {

// The total size of files that are read for pictures that no material draws.
constexpr std::size_t kMaxIdlePictureBytes = std::size_t{256} << 20;

class ValueAudit {
 public:
  ValueAudit(Loading& loading, const std::set<std::string>& told)
      : loading_(loading), report_(loading.report), told_(told) {}

  void run() {
    check_pictures();
    const Field accessors = loading_.root["accessors"];
    extremes_.resize(accessors.size());
    each(accessors, "accessors",
         [this](Field accessor, std::size_t i) { check_accessor(accessor, i); });
    each(loading_.root["meshes"], "meshes", [this](Field mesh, std::size_t) {
      each(mesh["primitives"], "",
           [this](Field primitive, std::size_t) { check_restart(primitive["indices"]); });
    });
    if (!loading_.resources.examined_all())
      report_.note("accessors: some lie over one another and were not compared with min and max");
    check_skins();
    report_.note_failure();
  }

 private:
  // Checks the elements of a list that have no note yet; a failure becomes a note.
  template <class Check>
  void each(Field list, const char* name, Check check) {
    const std::size_t n = list.size();
    for (std::size_t i = 0; i < n && report_.takes_notes(); ++i) {
      if (!told(name, i)) check(list.at(i), i);
      report_.note_failure();
    }
  }

  bool told(const char* list, std::uint64_t i) const {
    return !told_.empty() && told_.contains(fmt::format("{}[{}]", list, i));
  }

  void check_pictures() {
    const Field images = loading_.root["images"];
    std::vector<bool> drawn(images.size(), false);
    for (const ImageDecoder::Job& job : loading_.images.wait()) drawn[job.image] = true;
    std::size_t bytes_read = 0;
    each(images, "images", [&](Field image, std::size_t i) {
      if (!drawn[i] && bytes_read < kMaxIdlePictureBytes) bytes_read += check_picture(image);
    });
    if (bytes_read >= kMaxIdlePictureBytes)
      report_.note("images: not all that nothing is drawn with were looked at");
  }

  // A picture that nothing is drawn with. Returns the bytes that were read.
  std::size_t check_picture(Field image) {
    const std::string uri = image["uri"].text();
    if (uri.empty()) {
      const Field view = image["bufferView"];
      if (view.present() && !told("bufferViews", view.whole(0)))
        check_header(image, loading_.resources.view(view));
      return 0;
    }
    const auto bytes = read_uri(uri, loading_.resources.folder());
    if (bytes.ok())
      check_header(image, *bytes);
    else
      image["uri"].fail(bytes.error().message);
    return bytes.ok() ? bytes->size() : 0;
  }

  void check_header(Field image, std::span<const std::byte> bytes) {
    const PictureSize size = peek_size(bytes);
    if (report_.failed() || (size.width > 0 && size.height > 0) || other_formats()) return;
    image.refuse(fmt::format("{} bytes of another kind", bytes.size()),
                 "a PNG, JPEG or WebP picture");
  }

  // True where an extension brings pictures of other kinds.
  bool other_formats() const {
    const Field used = loading_.root["extensionsUsed"];
    for (std::size_t i = 0; i < used.size(); ++i)
      for (const char* kind : {"_texture_basisu", "_texture_avif", "_texture_dds"})
        if (used.at(i).text().ends_with(kind)) return true;
    return false;
  }

  // True where the JSON said nothing of the accessor's bytes.
  bool whole_bytes(Field accessor) const {
    const Field root = loading_.root;
    for (const Field part :
         {accessor, accessor["sparse"]["indices"], accessor["sparse"]["values"]}) {
      const Field view = part["bufferView"];
      if (!view.present()) continue;
      const std::uint64_t i = view.whole(0);
      if (told("bufferViews", i) || told("buffers", root["bufferViews"].at(i)["buffer"].whole(0)))
        return false;
    }
    return true;
  }

  void check_accessor(Field accessor, std::size_t i) {
    if (loading_.resources.is_supplied(accessor)) return;  // compression rounds, beyond the bounds
    const std::string type = accessor["type"].text();
    if (!whole_bytes(accessor) || type == "MAT2" || type == "MAT3") return;
    if (!accessor["min"].present() && !accessor["max"].present())
      return loading_.resources.check(accessor);
    extremes_[i] = loading_.resources.extremes(accessor);
    if (extremes_[i]->min.empty()) return;
    check_bound(accessor["min"], extremes_[i]->min, "least");
    check_bound(accessor["max"], extremes_[i]->max, "largest");
  }

  // The specification (section 3.6.2.5) has the bounds exact in single precision; the rounding of
  // exporters that write six or seven digits is let pass.
  void check_bound(Field bound, const std::vector<double>& found, const char* which) {
    if (!bound.present()) return;
    if (bound.size() != found.size())
      return bound.refuse(fmt::format("{} numbers", bound.size()), fmt::format("{}", found.size()));
    for (std::size_t c = 0; c < found.size() && std::isfinite(found[c]); ++c) {
      const double declared = bound.at(c).number(found[c]);
      if (std::abs(declared - found[c]) > 2e-6 * std::abs(found[c]) + 1e-9)
        return bound.at(c).refuse(fmt::format("{}", declared),
                                  fmt::format("the {} value of the data, {}", which, found[c]));
    }
  }

  // The largest value of the type restarts a strip in other formats and is no index in glTF.
  void check_restart(Field indices) {
    if (!indices.present() || !indices.report().takes_notes()) return;
    const std::uint64_t i = indices.whole(0);
    if (i >= extremes_.size() || told("accessors", i)) return;
    const Field accessor = loading_.root["accessors"].at(i);
    if (!whole_bytes(accessor)) return;
    if (!extremes_[i]) extremes_[i] = loading_.resources.extremes(accessor);
    if (extremes_[i]->max.size() == 1 && extremes_[i]->max[0] == extremes_[i]->type_max)
      indices.refuse(fmt::format("{}", extremes_[i]->type_max),
                     "smaller values, since glTF reserves the largest of each type");
  }

  void check_skins() {
    const Model& model = loading_.model;
    const Field skins = loading_.root["skins"], nodes = loading_.root["nodes"];
    each(skins, "", [&](Field skin, std::size_t s) {
      const auto& matrices = model.skins[s].inverse_bind;
      for (std::size_t j = 0; j < matrices.size(); ++j) {
        const Vec4 row(matrices[j][0].w, matrices[j][1].w, matrices[j][2].w, matrices[j][3].w);
        if (glm::distance(row, Vec4(0.0, 0.0, 0.0, 1.0)) > 1e-5)
          return skin["inverseBindMatrices"].refuse(
              fmt::format("the last row {}, {}, {}, {} in matrix {}", row.x, row.y, row.z, row.w,
                          j),
              "0, 0, 0, 1");
      }
    });
    std::vector<bool> shown(model.nodes.size(), false);
    std::vector<int> open = model.roots;
    while (!open.empty()) {
      const int node = open.back();
      open.pop_back();
      shown[node] = true;
      open.insert(open.end(), model.nodes[node].children.begin(), model.nodes[node].children.end());
    }
    each(nodes, "", [&](Field node, std::size_t n) {
      if (!shown[n] || model.nodes[n].skin < 0) return;
      for (const int joint : model.skins[model.nodes[n].skin].joints)
        if (!shown[joint])
          return node["skin"].refuse(fmt::format("joint node {} outside the shown scene", joint),
                                     "nodes of that scene");
    });
  }

  Loading& loading_;
  Report& report_;
  const std::set<std::string>& told_;
  std::vector<std::optional<Resources::Extremes>> extremes_;
};

}  // namespace

void note_broken_values(Loading& loading, const std::set<std::string>& told) {
  ValueAudit(loading, told).run();
}

}  // namespace neritic::scene::gltf
