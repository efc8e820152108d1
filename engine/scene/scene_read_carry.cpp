// Reads what is carried and what carries: the tables thing, gripper and hands; and a
// vehicle's wash.
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"
#include "engine/scene/scene_table.hpp"

namespace neritic::scene {

std::optional<Thing> read_thing(TableReader& parent) {
  return read_term<Thing>(parent, "thing", kThingKeys, [](TableReader& reader) {
    Thing thing;
    thing.mass_kg = reader.number("mass_kg", thing.mass_kg, {0, 1e4, true, false, "kg"});
    thing.volume_m3 =
        1e-3 * reader.number("volume_l", 1e3 * thing.volume_m3, {0, 1e4, false, false, "litres"});
    thing.drag_area_m2 =
        reader.number("drag_area_m2", thing.drag_area_m2, {0, 100, false, false, "m^2"});
    thing.racked = reader.flag("racked", thing.racked);
    return thing;
  });
}

std::optional<Grip> read_grip(TableReader& parent, Key key) {
  const bool hands = key == "hands";
  return read_term<Grip>(
      parent, key, hands ? KeyList(kHandsKeys) : KeyList(kGripperKeys),
      [hands](TableReader& reader) {
        Grip grip;
        if (!hands) {
          if (!reader.has("position_m")) reader.refuse("position_m", "[x, y, z] in metres");
          grip.position_m =
              reader.vector3("position_m", grip.position_m, {-10, 10, false, false, "metres"});
        }
        // A hand's grip gives way at some 300 N (Mathiowetz et al. 1985, Arch. Phys. Med. Rehabil.
        // 66, 69: 400 to 540 N bare, men of 20 to 60), less in a glove.
        if (hands) grip.strength_n = 300.0;
        grip.reach_m = reader.number("reach_m", grip.reach_m, {0, 2, true, false, "metres"});
        grip.strength_n = reader.number("strength_n", grip.strength_n, {0, 1e5, true, false, "N"});
        grip.most_m_s = reader.number("most_m_s", grip.most_m_s, {0, 10, true, false, "m/s"});
        return grip;
      });
}

std::optional<Wash> read_wash(TableReader& parent) {
  return read_term<Wash>(parent, "wash", kWashKeys, [](TableReader& reader) {
    Wash wash;
    wash.diameter_m =
        reader.number("diameter_m", wash.diameter_m, {0.005, 10, false, false, "metres"});
    wash.reach_m = reader.number("reach_m", wash.reach_m, {0, 1000, true, false, "metres"});
    return wash;
  });
}

}  // namespace neritic::scene
