// Writes small glTF files for tests of the loader: one feature or fault each.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "engine/scene/gltf_loader.hpp"
#include "tests/scene/gltf_invariants.hpp"

namespace neritic::scene {
using Json = nlohmann::json;

// Builds a file with one buffer; accessors are added as lists of numbers.
struct GltfBuilder {
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::uint8_t> bytes;
  std::size_t fallback_bytes = 0;  // of a second buffer without data, for compressed views

  template <class T>
  int view(const std::vector<T>& values, int stride = 0) {
    while (bytes.size() % 4 != 0) bytes.push_back(0);
    Json view = {
        {"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride > 0) view["byteStride"] = stride;
    const auto* from = reinterpret_cast<const std::uint8_t*>(values.data());
    bytes.insert(bytes.end(), from, from + values.size() * sizeof(T));
    json["bufferViews"].push_back(view);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  template <class T>
  int accessor(const char* type, std::size_t components, const std::vector<T>& values,
               bool normalized = false) {
    const int component = std::is_same_v<T, float>           ? 5126
                          : std::is_same_v<T, std::uint8_t>  ? 5121
                          : std::is_same_v<T, std::int8_t>   ? 5120
                          : std::is_same_v<T, std::uint16_t> ? 5123
                          : std::is_same_v<T, std::int16_t>  ? 5122
                                                             : 5125;
    Json accessor = {{"bufferView", view(values)},
                     {"componentType", component},
                     {"type", type},
                     {"count", values.size() / components}};
    if (normalized) accessor["normalized"] = true;
    std::vector<double> least(components, 0.0), most(components, 0.0);  // numbers only
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double value = std::isfinite(double(values[i])) ? double(values[i]) : 0.0;
      const std::size_t c = i % components;
      least[c] = i < components ? value : std::min(least[c], value);
      most[c] = i < components ? value : std::max(most[c], value);
    }
    accessor["min"] = least;
    accessor["max"] = most;
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int vec3(const std::vector<float>& values) { return accessor("VEC3", 3, values); }

  // The quad (0,0) (1,0) (1,1) (0,1) in the xy plane, facing +z, as two triangles. Its primitive.
  Json& quad();
  // The model, with pictures and buffers below the folder.
  Result<Model> load(const std::filesystem::path& folder = {});
};

// The file is refused with one line that holds the words.
void expect_refused(GltfBuilder& builder, const std::string& words);

}  // namespace neritic::scene

#define ASSERT_LOADS(model)                         \
  ASSERT_TRUE(model.ok()) << model.error().message; \
  ASSERT_EQ(test::broken_promise(*model), "")
