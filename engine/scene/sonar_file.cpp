#include "engine/scene/sonar_file.hpp"

#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {

Result<Sonar> load_sonar(const std::filesystem::path& path) {
  NERITIC_TRY(const SceneSource source, read_scene_source(path));
  TableReader reader(source, source.root, "", kSonarKeys);
  for (const Key key : {"on", "track", "position_m", "yaw_deg", "pitch_deg", "roll_deg",
                        "rotation_xyzw", "look_at_m", "look_at"})
    if (reader.has(key)) reader.refuse(key, "no such key in a sensor without a scene");
  Sonar sonar;
  sonar.name = reader.has("name") ? read_name(reader, "") : path.stem().string();
  read_sonar(reader, sonar);
  NERITIC_TRY_STATUS(reader.status());
  return sonar;
}

}  // namespace neritic::scene
