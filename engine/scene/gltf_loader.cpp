// See gltf_loader.hpp. The recipe: container, JSON, then stage by stage into the model.
#include "engine/scene/gltf_loader.hpp"

#include <algorithm>
#include <new>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/scene/gltf_audit.hpp"
#include "engine/scene/gltf_container.hpp"
#include "engine/scene/gltf_stages.hpp"

namespace neritic::scene {
namespace gltf {
namespace {

constexpr std::string_view kSupported[] = {"EXT_mesh_gpu_instancing",
                                           "EXT_meshopt_compression",
                                           "EXT_texture_webp",
                                           "KHR_draco_mesh_compression",
                                           "KHR_lights_punctual",
                                           "KHR_materials_diffuse_transmission",
                                           "KHR_materials_emissive_strength",
                                           "KHR_materials_ior",
                                           "KHR_materials_pbrSpecularGlossiness",
                                           "KHR_materials_specular",
                                           "KHR_materials_transmission",
                                           "KHR_materials_unlit",
                                           "KHR_mesh_quantization",
                                           "KHR_texture_transform"};

bool is_supported(std::string_view extension) {
  return std::find(std::begin(kSupported), std::end(kSupported), extension) != std::end(kSupported);
}

std::string supported_list() {
  std::string list;
  for (const std::string_view name : kSupported)
    list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

// "2.0" or "2.1": major, minor. False where it is no version.
bool parse_version(const std::string& text, int& major, int& minor) {
  int end = 0;
  return std::sscanf(text.c_str(), "%5d.%5d%n", &major, &minor, &end) == 2 &&
         end == static_cast<int>(text.size()) && major >= 0 && minor >= 0;
}

void read_model(Loading& loading) {
  using Stage = void (*)(Loading&);
  constexpr Stage kStages[] = {check_asset, load_materials, load_meshes, load_lights,  load_nodes,
                               load_skins,  load_roots,     load_clips,  finish_images};
  for (const Stage stage : kStages) {
    stage(loading);
    if (loading.report.failed()) return;
  }
}

}  // namespace

void check_asset(Loading& loading) {
  const Field asset = loading.root["asset"];
  const Field version = asset["version"], min_version = asset["minVersion"];
  int major = 0, minor = 0;
  if (!parse_version(version.text(), major, minor) || major != 2)
    asset.report().fail("asset.version",
                        found_accepted("\"" + one_line(version.text(), 20) + "\"", "2.x"));
  if (min_version.present() &&
      (!parse_version(min_version.text(), major, minor) || major != 2 || minor > 0))
    min_version.refuse(fmt::format("\"{}\"", one_line(min_version.text(), 20)), "at most 2.0");

  const Field required = loading.root["extensionsRequired"], used = loading.root["extensionsUsed"];
  for (std::size_t i = 0; i < required.size(); ++i)
    if (const std::string name = required.at(i).text(); !is_supported(name))
      required.refuse(one_line(name, 80), supported_list());
  for (std::size_t i = 0; i < used.size(); ++i)
    if (const std::string name = used.at(i).text(); !is_supported(name))
      loading.report.note(fmt::format("the extension {} is not supported and ignored", name));
}

}  // namespace gltf

Result<Model> parse_gltf_bytes(std::span<const std::byte> bytes, const std::string& name,
                               const std::filesystem::path& folder) {
  using namespace gltf;
  Report report(name);
  try {
    auto container = open_container(bytes);
    if (!container.ok())
      return bad_input("{}: {}", one_line(name, 4096), container.error().message);
    Json document;
    parse_json(container->json, document, report);
    if (report.failed()) return report.error();
    const Field root(&document, &document, &report);
    Model model;
    model.name = name;
    Resources resources(root, container->bin, folder);
    ImageDecoder images;  // dies before the bytes that it reads
    Loading loading{root, report, resources, images, model};
    read_model(loading);
    if (report.failed()) return report.error();
    note_broken_values(loading, note_broken_rules(document, report));
    model.notes = report.take_notes();
    return model;
  } catch (const std::bad_alloc&) {
    return failure(ErrorCode::kOutOfMemory, "{}: not enough memory to load it",
                   one_line(name, 4096));
  } catch (const std::length_error&) {
    return bad_input("{}: a list longer than memory can hold", one_line(name, 4096));
  }
}

Result<Model> load_gltf(const std::filesystem::path& path) {
  NERITIC_TRY(const auto bytes, read_file(path));
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  return parse_gltf_bytes(bytes, path.string(), folder);
}

}  // namespace neritic::scene
