// Every real model in the shared corpus loads, with the counts that the Khronos validator lists in
// MODELS.md. Someone else's program is the oracle.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "engine/scene/animation.hpp"
#include "engine/scene/gltf_geometry.hpp"
#include "engine/scene/gltf_loader.hpp"
#include "tests/scene/gltf_invariants.hpp"
#include "tests/support/support.hpp"

namespace neritic::test {
namespace {

struct Row {
  std::string file;
  std::map<std::string, std::size_t> counts;
};

// The table's cells by the names in its header.
std::vector<Row> read_table(const std::filesystem::path& path) {
  std::vector<Row> rows;
  std::vector<std::string> header;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| ")) continue;
    std::vector<std::string> cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) {
      const auto first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
      cells.push_back(first == cell.npos ? "" : cell.substr(first, last - first + 1));
    }
    if (header.empty()) {
      header = cells;
      continue;
    }
    Row row{cells[0], {}};
    for (std::size_t i = 1; i < cells.size() && i < header.size(); ++i)
      if (!cells[i].empty() && cells[i].find_first_not_of("0123456789") == std::string::npos)
        row.counts[header[i]] = std::stoul(cells[i]);
    rows.push_back(row);
  }
  return rows;
}

std::map<std::string, std::size_t> counts_of(const scene::Model& model) {
  std::size_t vertices = 0, triangles = 0;
  for (const auto& mesh : model.meshes)
    for (const auto& primitive : mesh.primitives) {
      vertices += primitive.file_vertices;
      if (primitive.topology == scene::Topology::kTriangles)
        triangles += primitive.indices.size() / 3;
    }
  return {{"nodes", model.nodes.size()},
          {"meshes", model.meshes.size()},
          {"materials", model.materials.size()},
          {"textures", model.textures.size()},
          {"animations", model.clips.size()},
          {"skins", model.skins.size()},
          {"vertices", vertices},
          {"triangles", triangles}};
}

// Refused by name, as the specification asks: a newer format, or an extension that the file
// requires and this loader does not have.
const std::map<std::string, std::string> kRefused = {
    {"gltf-asset-generator/Compatibility/Compatibility_04.gltf", "asset.minVersion"},
    {"gltf-asset-generator/Compatibility/Compatibility_05.gltf",
     "FAKE_materials_quantumRendering"}};

// Its one error is an extension's, which is noted as not supported.
constexpr const char* kErrorOfAnExtension = "khronos/ClearCoatTest/glTF-Binary/ClearCoatTest.glb";
// Panes with masks, which are drawn without them; pictures mixed for them count as textures too.
constexpr const char* kMixed = "khronos/TransmissionTest/glTF-Binary/TransmissionTest.glb";

// The notes about a file's rules and values.
std::string told(const scene::Model& model) {
  std::string out;
  for (const std::string& note : model.notes)
    if (!note.ends_with("is not supported and ignored")) out += note + "\n";
  return out;
}

// Notes, too, are where the validator finds errors and nowhere else.
TEST(GltfModels, EveryModelOfTheCorpusHasTheValidatorsCounts) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto folder = shared / "data/gltf";
  const auto rows = read_table(folder / "MODELS.md");
  ASSERT_GT(rows.size(), 150u);
  std::size_t n_loaded = 0;
  for (const Row& row : rows) {
    SCOPED_TRACE(row.file);
    const auto model = scene::load_gltf(folder / row.file);
    if (const auto refused = kRefused.find(row.file); refused != kRefused.end()) {
      ASSERT_FALSE(model.ok());
      EXPECT_NE(model.error().message.find(refused->second), std::string::npos)
          << model.error().message;
      continue;
    }
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_EQ(broken_promise(*model), "");
    const auto counts = counts_of(*model);
    for (const auto& [name, count] : counts)
      if (row.file != kMixed || name != "textures") {
        EXPECT_EQ(count, row.counts.at(name)) << name;
      }
    const auto bounds = scene::model_bounds(*model, scene::evaluate_pose(*model, -1, 0.0));
    EXPECT_EQ(bounds.empty(), counts.at("vertices") == 0);
    const bool of_an_extension = row.file == kErrorOfAnExtension || row.file == kMixed;
    EXPECT_TRUE(of_an_extension || told(*model).empty() != row.counts.contains("errors"))
        << told(*model);
    ++n_loaded;
  }
  EXPECT_EQ(n_loaded, rows.size() - kRefused.size());
}

TEST(GltfModels, FilesThatTheTableLeavesOutLoadToo) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto folder = shared / "data/gltf";
  std::set<std::string> listed;
  for (const Row& row : read_table(folder / "MODELS.md")) listed.insert(row.file);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    const auto file = std::filesystem::relative(entry.path(), folder).string();
    if ((extension != ".gltf" && extension != ".glb") || listed.contains(file)) continue;
    const auto model = scene::load_gltf(entry.path());
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_EQ(broken_promise(*model), "") << file;
  }
}

TEST(GltfModels, EveryClipOfTheCorpusKeepsItsModelFiniteAndMoves) {
  NERITIC_REQUIRE_SHARED(shared);
  std::size_t n_clips = 0, n_moving = 0;
  const auto folder = shared / "data/gltf";
  for (const Row& row : read_table(folder / "MODELS.md")) {
    if (kRefused.contains(row.file) || !row.counts.contains("animations") ||
        row.counts.at("animations") == 0)
      continue;
    const auto model = scene::load_gltf(folder / row.file);
    ASSERT_TRUE(model.ok()) << model.error().message;
    for (int clip = 0; clip < static_cast<int>(model->clips.size()); ++clip, ++n_clips) {
      const double duration_s = model->clips[clip].duration_s;
      const auto start = scene::evaluate_pose(*model, clip, 0.0);
      bool moves = false;
      for (const double part : {0.21, 0.5, 0.83, 1.7}) {
        const auto pose = scene::evaluate_pose(*model, clip, part * duration_s);
        for (const Mat4& m : pose.model_from_node)
          for (int k = 0; k < 4; ++k)
            EXPECT_TRUE(is_finite(Vec3(m[k]))) << row.file << " clip " << clip;
        moves = moves || pose.model_from_node != start.model_from_node ||
                pose.morph_weights != start.morph_weights;
      }
      n_moving += moves;
    }
  }
  EXPECT_GT(n_clips, 70u);
  EXPECT_GT(n_moving, n_clips * 8 / 10);  // a few clips hold one pose
}

// True for vertices of a face whose texture coordinates span next to no area: any tangent will do.
std::vector<bool> without_direction(const scene::Primitive& p) {
  std::vector<bool> out(p.positions.size(), false);
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const Vec2 a(p.uv0[p.indices[i]]), b(p.uv0[p.indices[i + 1]]), c(p.uv0[p.indices[i + 2]]);
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    for (int k = 0; k < 3; ++k)
      if (std::abs(area) < 1e-7) out[p.indices[i + k]] = true;
  }
  return out;
}

// These files carry tangents that other programs made (MikkTSpace and the like).
TEST(GltfModels, TangentsMadeHereAgreeWithTheFilesOwn) {
  NERITIC_REQUIRE_SHARED(shared);
  for (const char* file :
       {"khronos/BoomBoxWithAxes/glTF/BoomBoxWithAxes.gltf",
        "khronos/BarramundiFish/glTF/BarramundiFish.gltf",
        "gltf-asset-generator/Mesh_PrimitiveAttribute/Mesh_PrimitiveAttribute_06.gltf"}) {
    const auto model = scene::load_gltf(shared / "data/gltf" / file);
    ASSERT_TRUE(model.ok()) << model.error().message;
    std::size_t n = 0, n_direction = 0, n_handedness = 0;
    for (const auto& mesh : model->meshes)
      for (const auto& own : mesh.primitives) {
        if (own.tangents.empty()) continue;
        scene::Primitive made = own;
        made.tangents.clear();
        scene::TextureRef ref;
        ref.texture = 0;
        scene::gltf::make_tangents(made, ref);
        const auto any_will_do = without_direction(own);
        for (std::size_t i = 0; i < own.tangents.size(); ++i) {
          if (any_will_do[i]) continue;
          ++n;
          n_direction += glm::dot(Vec3(own.tangents[i]), Vec3(made.tangents[i])) > 0.9;
          n_handedness += own.tangents[i].w == made.tangents[i].w;
        }
      }
    EXPECT_GT(n, 3u) << file;
    EXPECT_GE(n_direction, n * 98 / 100) << file << " of " << n;
    EXPECT_GE(n_handedness, n * 99 / 100) << file << " of " << n;
  }
}

}  // namespace
}  // namespace neritic::test
