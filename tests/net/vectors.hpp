// The bytes that devices send, and their meaning (data/wire_vectors.json).
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/net/wire_bytes.hpp"
#include "tests/support/support.hpp"

namespace neritic::net {

inline nlohmann::json wire_vectors() {
  const auto text = read_text(test::source_dir() / "tests/net/data/wire_vectors.json");
  return parse_json(text.value()).value();
}

inline std::vector<std::byte> bytes_of(const std::string& hex) {
  std::vector<std::byte> out;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    out.push_back(static_cast<std::byte>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return out;
}
inline std::vector<std::byte> bytes_of(const nlohmann::json& vector) {
  return bytes_of(vector.at("hex").get<std::string>());
}

}  // namespace neritic::net
