#include "engine/scene/sonar_file.hpp"

#include <algorithm>
#include <vector>

#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {

namespace {

// Where a sonar is, which is a scene's to say.
constexpr auto kMountKeys =
    std::to_array<Key>({"on", "track", "position_m", "yaw_deg", "pitch_deg", "roll_deg",
                        "rotation_xyzw", "look_at_m", "look_at"});

Status refuse_mount(const SceneSource& source) {
  TableReader reader(source, source.root, "", kSonarKeys);
  bool any = false;
  for (const Key key : kMountKeys) {
    if (!reader.has(key)) continue;
    reader.refuse(key, "no such key in a sensor without a scene");
    any = true;
  }
  return any ? reader.status() : Status();
}

std::vector<Key> keys_without_mount() {
  std::vector<Key> keys;
  for (const Key key : kSonarKeys)
    if (std::ranges::find(kMountKeys, std::string_view(key)) == kMountKeys.end())
      keys.push_back(key);
  return keys;
}

}  // namespace

Result<Sonar> load_sonar(const std::filesystem::path& path) {
  NERITIC_TRY(const SceneSource source, read_scene_source(path));
  NERITIC_TRY_STATUS(refuse_mount(source));
  static const std::vector<Key> keys = keys_without_mount();
  TableReader reader(source, source.root, "", keys);
  Sonar sonar;
  sonar.name = reader.has("name") ? read_name(reader, "") : path.stem().string();
  read_sonar(reader, sonar);
  NERITIC_TRY_STATUS(reader.status());
  return sonar;
}

}  // namespace neritic::scene
