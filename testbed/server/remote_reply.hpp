// An answer of a server, whole: apart from remote.hpp since its JSON costs to compile.
#pragma once

#include <nlohmann/json.hpp>

#include "testbed/server/remote.hpp"

namespace neritic::testbed {

struct Remote::Reply {
  nlohmann::json map;
  std::vector<std::vector<std::byte>> frames;  // the map's own first
};

}  // namespace neritic::testbed
