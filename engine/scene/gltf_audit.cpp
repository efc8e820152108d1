// See gltf_audit.hpp: the rules of the JSON. They are those of glTF 2.0's specification (Khronos).
#include "engine/scene/gltf_audit.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace neritic::scene::gltf {
namespace {

constexpr std::uint64_t kNoNumber = UINT64_MAX;

// A member, or null where there is none or this is no object.
const Json* member_of(const Json& value, const char* key) {
  if (!value.is_object()) return nullptr;
  const auto it = value.find(key);
  return it == value.end() ? nullptr : &*it;
}

std::uint64_t whole_of(const Json& value, const char* key, std::uint64_t fallback) {
  const Json* m = member_of(value, key);
  return m && m->is_number_unsigned() ? m->get<std::uint64_t>() : fallback;
}

std::string text_of(const Json& value, const char* key) {
  const Json* m = member_of(value, key);
  return m && m->is_string() ? m->get<std::string>() : std::string();
}

std::uint64_t component_bytes(std::uint64_t type) {
  if (type == 5120 || type == 5121) return 1;
  if (type == 5122 || type == 5123) return 2;
  return type == 5125 || type == 5126 ? 4 : 0;
}

std::uint64_t component_count(const std::string& type) {
  constexpr std::pair<std::string_view, std::uint64_t> kCounts[] = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [name, count] : kCounts)
    if (type == name) return count;
  return 0;
}

struct Reference {
  const char *list, *key, *target;
};
constexpr Reference kReferences[] = {{"accessors", "bufferView", "bufferViews"},
                                     {"bufferViews", "buffer", "buffers"},
                                     {"images", "bufferView", "bufferViews"},
                                     {"textures", "source", "images"},
                                     {"textures", "sampler", "samplers"},
                                     {"nodes", "mesh", "meshes"},
                                     {"nodes", "skin", "skins"},
                                     {"nodes", "camera", "cameras"},
                                     {"skins", "inverseBindMatrices", "accessors"}};

constexpr Reference kNeeded[] = {{"accessors", "componentType", ""}, {"accessors", "count", ""},
                                 {"accessors", "type", ""},          {"bufferViews", "buffer", ""},
                                 {"bufferViews", "byteLength", ""},  {"buffers", "byteLength", ""}};

class Audit {
 public:
  Audit(const Json& document, Report& report) : document_(document), report_(report) {}

  std::set<std::string> run() {
    for (const Json& name : list("extensionsUsed"))
      if (name.is_string()) declared_.insert(name.get<std::string>());
    walk(document_, "", 0);
    check_references();
    each("buffers", [this](const Json& buffer, const std::string& path) {
      check_length(buffer, path);
      check_uri(buffer, path);
    });
    each("images", [this](const Json& image, const std::string& path) { check_uri(image, path); });
    each("bufferViews",
         [this](const Json& view, const std::string& path) { check_view(view, path); });
    each("accessors",
         [this](const Json& accessor, const std::string& path) { check_accessor(accessor, path); });
    each("nodes", [this](const Json& node, const std::string& path) { check_node(node, path); });
    each("cameras",
         [this](const Json& camera, const std::string& path) { check_camera(camera, path); });
    each("meshes", [this](const Json& mesh, const std::string& path) { check_mesh(mesh, path); });
    each("animations",
         [this](const Json& clip, const std::string& path) { check_animation(clip, path); });
    each("skins", [this](const Json& skin, const std::string&) {
      check_packed(skin, "inverseBindMatrices");
    });
    check_required();
    return std::move(told_);
  }

 private:
  void say(const std::string& path, std::string_view found, std::string_view accepted) {
    told_.insert(path.substr(0, path.find(']') + 1));
    if (report_.takes_notes()) report_.note(path + ": " + found_accepted(found, accepted));
  }

  const Json& list(const char* key) const {
    static const Json kEmpty = Json::array();
    const Json* found = member_of(document_, key);
    return found && found->is_array() ? *found : kEmpty;
  }

  const Json& element(const char* key, std::uint64_t index) const {
    static const Json kNull;
    const Json& all = list(key);
    return index < all.size() ? all[index] : kNull;
  }

  template <class Check>
  void each(const char* key, Check check) {
    const Json& all = list(key);
    for (std::size_t i = 0; i < all.size() && report_.takes_notes(); ++i)
      if (all[i].is_object()) check(all[i], fmt::format("{}[{}]", key, i));
  }

  // Lists have an element; extensions are declared and stand where they belong. Extras are
  // anybody's.
  void walk(const Json& value, const std::string& path, int depth) {
    if (depth > 32 || !report_.takes_notes()) return;
    if (value.is_array()) {
      if (value.empty()) say(path, "an empty list", "one element or more");
      for (std::size_t i = 0; i < value.size() && i < 4096; ++i)
        if (value[i].is_structured()) walk(value[i], fmt::format("{}[{}]", path, i), depth + 1);
    }
    if (!value.is_object()) return;
    for (const auto& [key, inner] : value.items()) {
      if (key == "extras" || !inner.is_structured()) continue;
      if (key == "extensions") check_extensions(inner, value, path);
      walk(inner, path.empty() ? key : path + "." + key, depth + 1);
    }
  }

  void check_extensions(const Json& extensions, const Json& owner, const std::string& path) {
    if (!extensions.is_object()) return;
    for (const auto& [name, value] : extensions.items()) {
      if (!declared_.contains(name))
        say(path.empty() ? "extensions" : path + ".extensions", fmt::format("{}", name),
            "extensions that extensionsUsed names");
      const bool material = path.starts_with("materials[") && path.ends_with("]");
      const bool wrong =
          (name.starts_with("KHR_materials_") && !material && name != "KHR_materials_variants") ||
          (name == "KHR_texture_transform" && !owner.contains("index"));
      if (wrong) say(path, fmt::format("{}", name), "extensions that belong to this object");
    }
  }

  void check_references() {
    for (const Reference& r : kReferences)
      each(r.list, [&](const Json& owner, const std::string& path) {
        const std::uint64_t index = whole_of(owner, r.key, kNoNumber);
        if (index != kNoNumber && index >= list(r.target).size())
          say(path + "." + r.key, fmt::format("{}", index),
              fmt::format("an index below {}, the number of {}", list(r.target).size(), r.target));
      });
    for (const Reference& r : kNeeded)
      each(r.list, [&](const Json& owner, const std::string& path) {
        if (!owner.contains(r.key)) say(path, fmt::format("no {}", r.key), "one");
      });
  }

  void check_length(const Json& owner, const std::string& path) {
    if (whole_of(owner, "byteLength", 1) == 0) say(path + ".byteLength", "0", "1 or more");
  }

  void check_uri(const Json& owner, const std::string& path) {
    const std::string uri = text_of(owner, "uri");
    const std::size_t colon = uri.find(':'), slash = uri.find('/');
    if (colon == std::string::npos || colon == 1 || slash < colon) return;  // a file's name
    const bool data = uri.starts_with("data:") && uri.find(";base64,") != std::string::npos;
    if (!data) say(path + ".uri", one_line(uri, 40), "a file, or data in base64");
  }

  void check_view(const Json& view, const std::string& path) {
    check_length(view, path);
    const Json& buffer = element("buffers", whole_of(view, "buffer", kNoNumber));
    const std::uint64_t holds = whole_of(buffer, "byteLength", kNoNumber),
                        offset = whole_of(view, "byteOffset", 0),
                        length = whole_of(view, "byteLength", 0);
    if (holds != kNoNumber && (offset > holds || length > holds - offset))
      say(path, fmt::format("{} bytes from byte {} on", length, offset),
          fmt::format("a range inside its buffer of {} bytes", holds));
    const std::uint64_t stride = whole_of(view, "byteStride", kNoNumber);
    if (stride == kNoNumber) return;
    if (stride < 4 || stride > 252 || stride % 4 != 0)
      say(path + ".byteStride", fmt::format("{}", stride), "a multiple of 4 from 4 to 252");
    else if (length > 0 && stride > length)
      say(path + ".byteStride", fmt::format("{}", stride),
          fmt::format("at most {}, the bytes of the view", length));
  }

  void check_accessor(const Json& accessor, const std::string& path) {
    const std::uint64_t component = component_bytes(whole_of(accessor, "componentType", 0)),
                        components = component_count(text_of(accessor, "type")),
                        offset = whole_of(accessor, "byteOffset", 0);
    const Json& view = element("bufferViews", whole_of(accessor, "bufferView", kNoNumber));
    if (component > 0 && (offset + whole_of(view, "byteOffset", 0)) % component != 0)
      say(path + ".byteOffset", fmt::format("{}", offset),
          fmt::format("an offset whose sum with the view's is a multiple of {} bytes", component));
    const std::uint64_t stride = whole_of(view, "byteStride", kNoNumber);
    if (stride != kNoNumber && stride < component * components)
      say(path, fmt::format("elements of {} bytes", component * components),
          fmt::format("at most {}, the view's byteStride", stride));
    if (accessor.contains("byteOffset") && !accessor.contains("bufferView"))
      say(path + ".byteOffset", "a value without a bufferView",
          "none, unless a bufferView is named");
    const Json* sparse = member_of(accessor, "sparse");
    if (!sparse) return;
    const std::uint64_t count = whole_of(*sparse, "count", 0);
    if (count == 0 || count > whole_of(accessor, "count", kNoNumber))
      say(path + ".sparse.count", fmt::format("{}", count), "1 to the accessor's count");
  }

  void check_node(const Json& node, const std::string& path) {
    if (node.contains("matrix") &&
        (node.contains("translation") || node.contains("rotation") || node.contains("scale")))
      say(path, "a matrix beside translation, rotation or scale", "one of the two");
    for (const char* key : {"skin", "weights"})
      if (node.contains(key) && !node.contains("mesh"))
        say(path + "." + key, "a value without a mesh", "none, unless the node has a mesh");
    const Json* extensions = member_of(node, "extensions");
    const Json* light = extensions ? member_of(*extensions, "KHR_lights_punctual") : nullptr;
    if (light && light->is_object() && !light->contains("light"))
      say(path + ".extensions.KHR_lights_punctual", "no light", "the index of a light");
  }

  void check_camera(const Json& camera, const std::string& path) {
    if (camera.contains("perspective") && camera.contains("orthographic"))
      say(path, "perspective and orthographic", "one of them");
    const Json* flat = member_of(camera, "orthographic");
    for (const char* key : {"xmag", "ymag"})
      if (const Json* size = flat ? member_of(*flat, key) : nullptr;
          size && size->is_number() && size->get<double>() == 0.0)
        say(path + ".orthographic." + key, "0", "a size other than 0");
  }

  bool has_bounds(std::uint64_t accessor) const {
    const Json& a = element("accessors", accessor);
    return !a.is_object() || (a.contains("min") && a.contains("max"));
  }

  // Elements of all but vertex attributes lie one behind another.
  void check_packed(const Json& owner, const char* key) {
    const Json& accessor = element("accessors", whole_of(owner, key, kNoNumber));
    const std::uint64_t view = whole_of(accessor, "bufferView", kNoNumber);
    if (element("bufferViews", view).contains("byteStride"))
      say(fmt::format("bufferViews[{}].byteStride", view), fmt::format("a stride for {}", key),
          "none, since these elements are packed");
  }

  void check_mesh(const Json& mesh, const std::string& path) {
    const Json* primitives = member_of(mesh, "primitives");
    if (!primitives || !primitives->is_array()) return;
    for (std::size_t i = 0; i < primitives->size(); ++i) {
      const std::string at = fmt::format("{}.primitives[{}]", path, i);
      if (const Json* attributes = member_of((*primitives)[i], "attributes"))
        check_attributes(*attributes, at + ".attributes");
      check_packed((*primitives)[i], "indices");
      const Json* targets = member_of((*primitives)[i], "targets");
      for (std::size_t t = 0; targets && targets->is_array() && t < targets->size(); ++t)
        check_attributes((*targets)[t], fmt::format("{}.targets[{}]", at, t));
    }
  }

  void check_attributes(const Json& attributes, const std::string& path) {
    constexpr std::string_view kSemantics[] = {"POSITION", "NORMAL", "TANGENT"};
    constexpr std::string_view kNumbered[] = {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"};
    if (!attributes.is_object()) return;
    for (const auto& [name, accessor] : attributes.items()) {
      const auto starts = [&key = name](std::string_view s) { return key.starts_with(s); };
      const bool known = name.starts_with("_") ||
                         std::ranges::find(kSemantics, name) != std::end(kSemantics) ||
                         std::ranges::any_of(kNumbered, starts);
      if (!known) say(path, one_line(name, 60), "glTF's names, or names that begin with _");
    }
    if (!has_bounds(whole_of(attributes, "POSITION", kNoNumber)))
      say(path + ".POSITION", "an accessor without min and max", "one with both");
  }

  void check_animation(const Json& clip, const std::string& path) {
    const Json* samplers = member_of(clip, "samplers");
    for (std::size_t i = 0; samplers && samplers->is_array() && i < samplers->size(); ++i) {
      check_packed((*samplers)[i], "input");
      check_packed((*samplers)[i], "output");
      if (!has_bounds(whole_of((*samplers)[i], "input", kNoNumber)))
        say(fmt::format("{}.samplers[{}].input", path, i), "an accessor without min and max",
            "one with both");
    }
    const Json* channels = member_of(clip, "channels");
    std::set<std::pair<std::uint64_t, std::string>> moved;
    for (std::size_t i = 0; channels && channels->is_array() && i < channels->size(); ++i) {
      const Json* target = member_of((*channels)[i], "target");
      const std::uint64_t node = target ? whole_of(*target, "node", kNoNumber) : kNoNumber;
      if (node != kNoNumber && !moved.emplace(node, text_of(*target, "path")).second)
        say(fmt::format("{}.channels[{}].target", path, i),
            "the node and path of an earlier channel", "each once");
    }
  }

  void check_required() {
    constexpr const char* kQuantization = "KHR_mesh_quantization";
    const Json& required = list("extensionsRequired");
    if (declared_.contains(kQuantization) &&
        !std::ranges::any_of(required, [&](const Json& name) { return name == kQuantization; }))
      say("extensionsUsed", "{} found, extensionsRequired does not name it", kQuantization);
  }

  const Json& document_;
  Report& report_;
  std::set<std::string> declared_, told_;
};

}  // namespace

std::set<std::string> note_broken_rules(const Json& document, Report& report) {
  return Audit(document, report).run();
}

}  // namespace neritic::scene::gltf
