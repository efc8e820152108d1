// Reads a vehicle's tether: its line, its top, its winch; and the object that draws it.
#include <algorithm>

#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"

namespace neritic::scene {
namespace {

constexpr std::uint16_t kStructure = 11;  // of kClasses

std::optional<Tether::Winch> read_winch(TableReader& parent, double length_m) {
  return read_term<Tether::Winch>(parent, "winch", kWinchKeys, [length_m](TableReader& reader) {
    Tether::Winch winch;
    winch.hold_n = reader.number("hold_n", winch.hold_n, {0, 1e6, true, false, "N"});
    winch.speed_m_s = reader.number("speed_m_s", winch.speed_m_s, {0, 10, true, false, "m/s"});
    winch.least_m =
        reader.number("least_m", std::min(1.0, length_m), {0.1, 1e5, false, false, "metres"});
    winch.most_m = reader.number("most_m", 2.0 * length_m, {0.1, 1e5, false, false, "metres"});
    if (!(winch.least_m <= length_m && length_m <= winch.most_m))
      reader.refuse_table("lengths that leave out the tether's own",
                          "least_m up to length_m, most_m from it on");
    return winch;
  });
}

}  // namespace

std::optional<Tether> read_tether(TableReader& parent, const std::string& vehicle,
                                  TetherDraft& drawn) {
  return read_term<Tether>(parent, "tether", kTetherKeys, [&](TableReader& reader) {
    Tether t;
    ObjectDraft object;
    if (!reader.has("from_m")) reader.refuse("from_m", "[x, y, z] in metres: the tether's top");
    object.placement.pose.position_m = reader.vector3("from_m", Vec3(0.0), kAnyMetres);
    object.placement.on = reader.text("from", "");
    object.placement.place_on = reader.place("from");
    if (!object.placement.on.empty() && object.placement.on == vehicle)
      reader.refuse("from", "another object than the vehicle at its end");
    t.attachment_m =
        reader.vector3("attachment_m", t.attachment_m, {-100, 100, false, false, "metres"});
    t.length_m = reader.number("length_m", t.length_m, {0.1, 1e5, false, false, "metres"});
    t.segments = static_cast<std::uint32_t>(reader.whole("segments", t.segments, 1, 128));
    t.diameter_m = reader.number("diameter_m", t.diameter_m, {1e-4, 1, false, false, "metres"});
    t.net_weight_n_m =
        reader.number("net_weight_n_m", t.net_weight_n_m, {-1e4, 1e4, false, false, "N/m"});
    t.stiffness_n = reader.number("stiffness_n", t.stiffness_n, {1, 1e9, false, false, "N"});
    t.damping_n_s = reader.number("damping_n_s", t.damping_n_s, {0, 1e7, false, false, "N s"});
    t.normal_drag = reader.number("normal_drag", t.normal_drag, {0, 10});
    t.tangential_drag = reader.number("tangential_drag", t.tangential_drag, {0, 10});
    t.friction = reader.number("friction", t.friction, {0, 10});
    ModelRequest& request = drawn.request;
    request.kind = ModelRequest::Kind::kTether;
    request.shape = "tether";
    request.segments = static_cast<int>(t.segments * kTetherJoints + 1);
    request.radius_m = 0.5 * t.diameter_m;
    request.height_m = t.length_m;
    // The yellow of neutrally buoyant tethers.
    request.look.color = reader.vector3("color", Vec3(0.75, 0.62, 0.05), {0, 1});
    request.look.roughness = 0.6;
    request.place = parent.place("tether");
    t.winch = read_winch(reader, t.length_m);
    object.object.name = vehicle + "_tether";
    object.object.class_id = kStructure;
    object.place = request.place;
    drawn.object = std::move(object);
    return t;
  });
}

}  // namespace neritic::scene
