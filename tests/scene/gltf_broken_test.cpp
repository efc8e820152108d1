// Every file of the shared corpus of corrupt and tricky files: valid ones load, the others load
// with a note or end in one line that names the file. The verdicts are the Khronos glTF
// validator's. To be run under AddressSanitizer as well (preset asan-ubsan).
#include <gtest/gtest.h>

#include <ctime>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/animation.hpp"
#include "engine/scene/gltf_loader.hpp"
#include "tests/scene/gltf_invariants.hpp"
#include "tests/support/support.hpp"

namespace neritic::test {
namespace {
namespace fs = std::filesystem;

struct BrokenCase {
  fs::path file;
  std::set<std::string> errors;  // the validator's codes; empty: valid
};

std::vector<BrokenCase> validator_cases(const fs::path& folder) {
  std::vector<BrokenCase> cases;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().string();
    if (!name.ends_with(".report.json")) continue;
    const auto issues = parse_json(read_text(entry.path()).value()).value()["issues"];
    BrokenCase one{name.substr(0, name.size() - std::string(".report.json").size()), {}};
    for (const auto& message : issues["messages"])
      if (message["severity"] == 0) one.errors.insert(message["code"]);
    cases.push_back(one);
  }
  return cases;
}

std::vector<BrokenCase> bad_inputs(const fs::path& folder) {
  std::vector<BrokenCase> cases;
  const auto verdicts = parse_json(read_text(folder / "validator.json").value()).value();
  for (const auto& [name, verdict] : verdicts.items()) {
    BrokenCase one{folder / name, {}};
    for (const auto& [code, count] : verdict["codes"].items()) one.errors.insert(code);
    if (verdict["validator_errors"] == 0) one.errors.clear();
    cases.push_back(one);
  }
  return cases;
}

// Valid, but asks for a newer reader: "clients MUST NOT load the asset" (glTF 2.0 section 3.2).
constexpr const char* kNewerFormat = "min_version_valid.gltf";

// Faults after which nothing sensible can be shown.
const std::set<std::string> kMustRefuse = {"ACCESSOR_INDEX_OOB",

                                           "ACCESSOR_JOINTS_INDEX_OOB",
                                           "GLB_CHUNK_TOO_BIG",
                                           "GLB_DUPLICATE_CHUNK",
                                           "GLB_INVALID_MAGIC",
                                           "GLB_INVALID_VERSION",
                                           "GLB_LENGTH_TOO_SMALL",
                                           "GLB_UNEXPECTED_END_OF_CHUNK_DATA",
                                           "GLB_UNEXPECTED_FIRST_CHUNK",
                                           "INVALID_JSON",
                                           "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
                                           "NODE_LOOP",
                                           "NODE_PARENT_OVERRIDE",
                                           "UNKNOWN_ASSET_MAJOR_VERSION"};

void check_case(const BrokenCase& one) {
  SCOPED_TRACE(one.file.string());
  const std::clock_t start = std::clock();  // processor time: a neighbour costs none
  const auto model = scene::load_gltf(one.file);
  EXPECT_LT(std::clock() - start, 5 * CLOCKS_PER_SEC);
  if (model.ok()) {
    EXPECT_EQ(broken_promise(*model), "");
    EXPECT_TRUE(one.errors.empty() || !model->notes.empty()) << "shown without a word";
    const auto pose = scene::evaluate_pose(*model, 0, 0.3);
    scene::model_bounds(*model, pose);
    bool draws = false;  // a primitive without positions is skipped before its other faults matter
    for (const auto& mesh : model->meshes) draws = draws || !mesh.primitives.empty();
    for (const auto& code : one.errors) EXPECT_FALSE(draws && kMustRefuse.contains(code)) << code;
    return;
  }
  const std::string& message = model.error().message;
  EXPECT_TRUE(!one.errors.empty() || one.file.filename() == kNewerFormat)
      << "valid, but refused: " << message;
  EXPECT_EQ(model.error().code, ErrorCode::kBadInput) << message;
  EXPECT_NE(message.find(one.file.filename().string()), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_GT(message.size(), one.file.string().size() + 10) << message;
}

TEST(GltfBroken, ValidatorCasesLoadOrEndInOneLine) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto cases = validator_cases(shared / "data/gltf-broken/gltf-validator-cases");
  ASSERT_GT(cases.size(), 140u);
  for (const BrokenCase& one : cases) check_case(one);
}

TEST(GltfBroken, OtherProjectsBadInputsLoadOrEndInOneLine) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto cases = bad_inputs(shared / "data/gltf-broken/gltf-bad-inputs");
  ASSERT_GE(cases.size(), 30u);
  for (const BrokenCase& one : cases) check_case(one);
}

// Every prefix of a real .glb, and every byte of its header and JSON flipped, must end the same
// way.
TEST(GltfBroken, TruncatedAndFlippedBinaryFilesNeverBreakAPromise) {
  NERITIC_REQUIRE_SHARED(shared);
  const auto bytes =
      read_file(shared / "data/gltf/khronos/SimpleInstancing/glTF-Binary/SimpleInstancing.glb");
  ASSERT_TRUE(bytes.ok());
  for (std::size_t length = 0; length < bytes->size(); length += 1 + length / 64) {
    const auto model = scene::parse_gltf_bytes(std::span(*bytes).first(length), "cut.glb");
    EXPECT_FALSE(model.ok()) << length;
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(bytes->size(), 3000); ++i) {
    auto flipped = *bytes;
    flipped[i] ^= std::byte{0x11};
    const auto model = scene::parse_gltf_bytes(flipped, "flipped.glb");
    if (model.ok()) {
      EXPECT_EQ(broken_promise(*model), "") << i;
    } else {
      EXPECT_NE(model.error().message.find("flipped.glb"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace neritic::test
