// Reads [[objects]] and [[vehicles]]: what is drawn, where, how often, and what is mounted on it.
#include <algorithm>

#include "engine/core/files.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/scene_copies.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_materials.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr Interval kSizes{0, 1e6, true, false, "metres"};
constexpr Interval kFraction{0, 1};

struct ShapeKeys {
  Key shape;
  std::array<Key, 3> keys;  // beside those that every shape has
};
constexpr ShapeKeys kShapes[] = {{"sphere", {"radius_m", "segments", "inside_out"}},
                                 {"box", {"size_m", "inside_out", "texture_m"}},
                                 {"plane", {"size_m", "texture_m", ""}},
                                 {"cylinder", {"radius_m", "height_m", "segments"}}};
constexpr auto kShapeNames = std::to_array<Key>({"sphere", "box", "plane", "cylinder"});

// Keys that describe a drawing; each kind of drawing takes only some of them.
constexpr auto kDrawingKeys = std::to_array<Key>(
    {"node", "radius_m", "size_m", "height_m", "segments", "inside_out", "cell_m", "height_scale",
     "height_offset_m", "texture_m", "color", "color_texture", "normal_texture", "detail_texture",
     "detail_m", "roughness", "metallic", "double_sided"});
constexpr auto kLookKeys =
    std::to_array<Key>({"color", "color_texture", "roughness", "metallic", "double_sided"});
constexpr auto kTerrainKeys =
    std::to_array<Key>({"cell_m", "height_scale", "height_offset_m", "texture_m", "normal_texture",
                        "detail_texture", "detail_m"});

bool contains(KeyList keys, Key key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

// A key that the drawing would ignore is a mistake of the writer.
void refuse_other_keys(TableReader& reader, const std::string& what, KeyList first,
                       KeyList second = {}) {
  for (const Key key : kDrawingKeys)
    if (reader.has(key) && !contains(first, key) && !contains(second, key))
      reader.refuse(key, fmt::format("no such key for {}", what));
}

void read_look(TableReader& reader, ModelRequest& request, double default_texture_m) {
  Look& look = request.look;
  look.color = reader.vector3("color", look.color, kFraction);
  look.roughness = reader.number("roughness", look.roughness, kFraction);
  look.metallic = reader.number("metallic", look.metallic, kFraction);
  look.double_sided = reader.flag("double_sided", false);
  look.color_texture = reader.file("color_texture");
  look.normal_texture = reader.file("normal_texture");
  look.detail_texture = reader.file("detail_texture");
  look.place_color_texture = reader.place("color_texture");
  look.place_normal_texture = reader.place("normal_texture");
  look.place_detail_texture = reader.place("detail_texture");
  look.detail_m = reader.number("detail_m", look.detail_m, kSizes);
  look.texture_m = reader.number("texture_m", default_texture_m, kSizes);
}

void read_shape(TableReader& reader, ModelRequest& request) {
  request.kind = ModelRequest::Kind::kShape;
  request.shape = reader.choice("shape", "sphere", kShapeNames);
  for (const ShapeKeys& shape : kShapes)
    if (shape.shape == request.shape)
      refuse_other_keys(reader, "a " + request.shape, shape.keys, kLookKeys);
  request.radius_m = reader.number("radius_m", 0.5, kSizes);
  request.height_m = reader.number("height_m", 1.0, kSizes);
  const bool flat = request.shape == "plane";
  const std::vector<double> size =
      reader.numbers("size_m", {flat ? std::size_t{2} : std::size_t{3}}, kSizes);
  if (size.size() == 2) request.size_m = {size[0], 0.0, size[1]};
  if (size.size() == 3) request.size_m = {size[0], size[1], size[2]};
  request.segments = static_cast<int>(reader.whole("segments", 48, 3, 4096));
  request.inside_out = reader.flag("inside_out", false);
  read_look(reader, request, 1.0);
}

void read_terrain(TableReader& reader, ModelRequest& request) {
  request.kind = ModelRequest::Kind::kTerrain;
  request.file = reader.file("terrain");
  refuse_other_keys(reader, "a terrain", kTerrainKeys, kLookKeys);
  request.heights.cell_m = reader.number("cell_m", 0.0, kSizes);
  request.heights.scale = reader.number("height_scale", 1.0, {-1e6, 1e6});
  request.heights.offset_m = reader.number("height_offset_m", 0.0, kAnyMetres);
  read_look(reader, request, 2.5);
}

void read_model(TableReader& reader, ModelRequest& request) {
  request.kind = ModelRequest::Kind::kFile;
  request.file = reader.file("model");
  refuse_other_keys(reader, "a model file", std::to_array<Key>({"node"}));
  request.node = reader.text("node", "");
}

// Whether it may go undrawn: what only carries sensors, or moves for others to hang on.
bool is_carrier(const TableReader& reader) {
  return reader.has("track") || reader.has("inputs") || reader.has("cameras") ||
         reader.has("sonars") || reader.has("lamps");
}

// Nothing for a carrier that is not drawn.
std::optional<ModelRequest> read_drawing(TableReader& reader) {
  ModelRequest request;
  const bool model = reader.has("model"), shape = reader.has("shape"),
             terrain = reader.has("terrain");
  const int drawings = int{model} + int{shape} + int{terrain};
  if (drawings == 0 && is_carrier(reader)) {
    refuse_other_keys(reader, "what is not drawn", {});
    for (const Key key : {"scale", "clip", "copies", "copies_file", "scatter", "flock", "material",
                          "backscatter_db", "reflectivity"})
      if (reader.has(key)) reader.refuse(key, "no such key for what is not drawn");
    return std::nullopt;
  }
  if (drawings != 1) {
    reader.refuse_table(
        fmt::format("{} of model, shape, terrain", drawings > 0 ? "more than one" : "none"),
        "one of them");
    return request;
  }
  request.place = reader.place(model ? "model" : shape ? "shape" : "terrain");
  if (model) read_model(reader, request);
  if (shape) read_shape(reader, request);
  if (terrain) read_terrain(reader, request);
  return request;
}

// scale: a number or one an axis.
Vec3 read_scale(TableReader& reader) {
  const TomlValue* value = reader.find("scale");
  constexpr Interval kScale{0, 1e6, true};
  if (value && value->kind == TomlValue::Kind::kArray)
    return reader.vector3("scale", Vec3(1.0), kScale);
  return Vec3(reader.number("scale", 1.0, kScale));
}

std::uint16_t read_class(TableReader& reader, const Scene& scene, std::uint16_t otherwise) {
  const std::string name = reader.text("class", "");
  if (name.empty()) return otherwise;
  std::vector<Key> names;
  for (const auto& [id, known] : scene.class_names) {
    if (known == name) return id;
    names.push_back(known);
  }
  reader.refuse("class", fmt::format("one of {} (nearest: {}), or a name under [classes]",
                                     join(names), nearest(name, names)));
  return otherwise;
}

// The surface's backscatter in decibels: by its material, or as a number.
void read_acoustics(TableReader& reader, Object& object) {
  object.reflectivity = static_cast<float>(reader.number("reflectivity", 1.0, kFraction));
  object.material = reader.text("material", "");
  if (!object.material.empty() && !contains(kMaterialNames, object.material))
    reader.refuse("material", fmt::format("one of {} (nearest: {})", join(kMaterialNames),
                                          nearest(object.material, kMaterialNames)));
  if (!reader.has("backscatter_db")) return;
  object.backscatter_db =
      reader.number("backscatter_db", 0.0, {-100, 20, false, false, "decibels"});
  if (reader.has("material")) reader.refuse("backscatter_db", "no such key beside material");
}

std::vector<Mat4> read_copies(TableReader& reader) {
  if (int{reader.has("copies")} + int{reader.has("copies_file")} + int{reader.has("scatter")} > 1)
    reader.refuse_table("more than one of copies, copies_file, scatter", "one of them");
  std::vector<Mat4> copies;
  for (const auto& row : reader.rows("copies", {3, 4, 5}, kAnyMetres)) {
    if (row.size() == 5 && !(row[4] > 0.0))
      reader.refuse("copies", "lists of x, y, z, yaw_deg and a positive scale");
    copies.push_back(copy_from_row(row));
  }
  if (reader.has("copies") && copies.empty()) reader.refuse("copies", "one copy or more");
  const std::filesystem::path file = reader.file("copies_file");
  if (file.empty()) return copies;
  Result<std::vector<Mat4>> read = read_copies_file(file);
  if (!read.ok())
    reader.fail({read.error().code, reader.place("copies_file") + ": " + read.error().message});
  else
    copies = std::move(read).value();
  return copies;
}

std::optional<ScatterDraft> read_scatter(TableReader& parent, std::uint64_t scene_seed) {
  const TomlValue* table = parent.table("scatter");
  if (!table) return std::nullopt;
  TableReader reader(parent.source(), *table, parent.path("scatter"), kScatterKeys);
  ScatterDraft scatter;
  scatter.place = parent.place("scatter");
  scatter.count = static_cast<std::uint32_t>(reader.whole("count", 1, 1, 65535));
  scatter.seed = reader.whole("seed", scene_seed, 0, INT64_MAX);
  scatter.on = reader.text("on", "");
  const std::vector<double> area = reader.numbers("area_m", {4}, kAnyMetres);
  if (area.size() == 4) {
    std::tie(scatter.x_min_m, scatter.z_min_m, scatter.x_max_m, scatter.z_max_m) =
        std::tie(area[0], area[1], area[2], area[3]);
    if (!(area[0] < area[2] && area[1] < area[3]))
      reader.refuse("area_m", "[x0, z0, x1, z1] with x0 < x1 and z0 < z1");
  } else {
    reader.refuse("area_m", "[x0, z0, x1, z1] in metres");
  }
  const std::vector<double> scale = reader.numbers("scale", {2}, {0, 1000, true});
  if (scale.size() == 2) {
    scatter.scale_min = scale[0];
    scatter.scale_max = scale[1];
    if (scale[0] > scale[1]) reader.refuse("scale", "[smallest, largest]");
  }
  scatter.align_to_surface =
      reader.choice("align", "up", std::to_array<Key>({"up", "surface"})) == "surface";
  scatter.sink_m = reader.number("sink_m", 0.0, {-1000, 1000, false, false, "metres"});
  for (const auto& row : reader.rows("keep_out_m", {3}, kAnyMetres))
    scatter.keep_out.push_back({row[0], row[1], row[2]});
  if (!reader.ok()) parent.fail(reader.status().error());
  for (const Key key : {"position_m", "yaw_deg", "pitch_deg", "roll_deg", "rotation_xyzw",
                        "look_at_m", "look_at", "on", "track"})
    if (parent.has(key)) parent.refuse(key, "no such key beside scatter");
  return scatter;
}

// The names of the objects that fish avoid: one, or a list.
std::vector<std::string> read_avoid(TableReader& reader) {
  const TomlValue* value = reader.find("avoid");
  if (!value) return {};
  std::vector<std::string> names;
  const auto add = [&](const TomlValue& item) {
    if (item.kind == TomlValue::Kind::kString) return names.push_back(item.text);
    reader.refuse("avoid", "the name of an object, or a list of names");
  };
  if (value->kind != TomlValue::Kind::kArray)
    add(*value);
  else
    for (const TomlValue& item : value->items) add(item);
  return names;
}

std::optional<Flock> read_flock(TableReader& parent, const Scene& scene, double scale) {
  const TomlValue* table = parent.table("flock");
  if (!table) return std::nullopt;
  TableReader reader(parent.source(), *table, parent.path("flock"), kFlockKeys);
  Flock flock;
  flock.count = static_cast<std::uint32_t>(reader.whole("count", flock.count, 1, kMostFlock));
  flock.mill = reader.choice("kind", parent.has("track") ? "stream" : "mill",
                             std::to_array<Key>({"mill", "stream"})) == "mill";
  flock.radius_m = reader.vector3("radius_m", flock.radius_m, {0, 1e4, true, false, "metres"});
  flock.speed_m_s = reader.number("speed_m_s", flock.speed_m_s, {0, 100, true, false, "m/s"});
  flock.seed = reader.whole("seed", scene.seed, 0, INT64_MAX);
  flock.avoid_names = read_avoid(reader);
  flock.place_avoid = reader.place("avoid");
  flock.avoid_m = reader.number("avoid_m", flock.avoid_m, {0, 1e3, true, false, "metres"});
  if (reader.has("avoid_m") && flock.avoid_names.empty()) reader.refuse("avoid_m", "beside avoid");
  if (reader.has("speed_m_s") && !flock.mill)
    reader.refuse("speed_m_s", "of a mill; a stream has its track's");
  flock.scale = scale;
  if (!reader.ok()) parent.fail(reader.status().error());
  for (const Key key : {"copies", "copies_file", "scatter"})
    if (parent.has(key)) parent.refuse(key, "no such key beside flock");
  return flock;
}

std::shared_ptr<const Afloat> read_afloat(TableReader& parent, const Scene& scene) {
  const TomlValue* table = parent.table("afloat");
  if (!table) return nullptr;
  TableReader reader(parent.source(), *table, parent.path("afloat"), kAfloatKeys);
  Afloat out;
  const auto size_m = [&](Key key) {
    if (!reader.has(key)) reader.refuse(key, "its size on the water, in metres");
    return reader.number(key, 1.0, {0, 1000, true, false, "metres"});
  };
  out.length_breadth_m = {size_m("length_m"), size_m("breadth_m")};
  if (!reader.ok()) parent.fail(reader.status().error());
  for (const Key key : {"on", "dynamics", "human", "inputs", "thing", "flock", "copies",
                        "copies_file", "scatter", "collision", "look_at"})
    if (parent.has(key)) parent.refuse(key, "no such key beside afloat");
  if (!scene.water || !scene.water->waves) {
    parent.refuse("afloat", "a scene with [water.waves]");
    return nullptr;
  }
  out.sea = *scene.water->waves;
  out.waves = SeaWaves(out.sea);
  return std::make_shared<const Afloat>(std::move(out));
}

ObjectDraft read_object(TableReader& reader, const Scene& scene, const std::string& default_name,
                        std::uint16_t default_class) {
  ObjectDraft draft;
  Object& object = draft.object;
  object.name = read_name(reader, default_name);
  draft.place = reader.place("name");
  object.class_id = read_class(reader, scene, default_class);
  read_acoustics(reader, object);
  draft.placement = read_placement(reader, "");
  object.mount.afloat = read_afloat(reader, scene);
  object.scale = read_scale(reader);
  draft.clip = reader.text("clip", "");
  draft.place_clip = reader.place("clip");
  object.clip_offset_s = reader.number("clip_offset_s", 0.0, {-1e6, 1e6, false, false, "seconds"});
  object.clip_rate = reader.number("clip_rate", 1.0, {-1000, 1000});
  object.copies = read_copies(reader);
  draft.scatter = read_scatter(reader, scene.seed);
  object.flock = read_flock(reader, scene, object.scale.x);
  if (object.flock) object.copies.assign(object.flock->count, Mat4(1.0));
  return draft;
}

}  // namespace

Status read_objects(SceneDraft& draft, const SceneSource& source,
                    const std::vector<TomlValue>& tables, const std::string& path) {
  const bool vehicles = path == "vehicles";
  for (std::size_t i = 0; i < tables.size(); ++i) {
    TableReader reader(source, tables[i], fmt::format("{}[{}]", path, i), kObjectKeys);
    NERITIC_TRY_STATUS(reader.status());
    ObjectDraft object =
        read_object(reader, draft.scene, fmt::format("{}_{}", vehicles ? "vehicle" : "object", i),
                    vehicles ? std::uint16_t{5} : std::uint16_t{0});
    std::optional<ModelRequest> request = read_drawing(reader);
    NERITIC_TRY_STATUS(reader.status());
    const std::string name = object.object.name;
    if (request) {
      object.request = draft.requests.size();
      draft.requests.push_back(std::move(*request));
    }
    draft.objects.push_back(std::move(object));
    NERITIC_TRY_STATUS(read_sensors(draft, reader, name));
  }
  return {};
}

}  // namespace neritic::scene
