#include "testbed/simulation/modem_outlook.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

// A modem that ranges, and the one that answers; where both are at the start.
struct RangingPair {
  const Modems& modems;
  std::size_t asker, target;
  Vec3 asker_ned_m, target_ned_m;

  const PhysicsModem& by() const { return modems.all()[asker]; }
  const PhysicsModem& of() const { return modems.all()[target]; }
};

bool add_in_air(const RangingPair& pair, std::vector<std::string>& lines) {
  for (const auto& [modem, at] :
       {std::pair(&pair.by(), pair.asker_ned_m), {&pair.of(), pair.target_ned_m}})
    if (at.z < 0.0) {
      lines.push_back(fmt::format(
          "{}: usbl: {}'s modem is {:.3g} m above the surface at the start, where it hears and "
          "says nothing",
          pair.by().name, modem->name, -at.z));
      return true;
    }
  return false;
}

bool add_weak(const RangingPair& pair, std::vector<std::string>& lines) {
  const auto settings = pair.modems.settings();
  const auto weak = [&](std::size_t from, std::size_t to, const Vec3& from_m, const Vec3& to_m,
                        const char* what) {
    // Bands without overlap were refused.
    const double db =
        sonar::modem_level_db(pair.modems.water(), settings[from], settings[to], from_m, to_m)
            .value() -
        sonar::modem_noise_db(pair.modems.water(), settings[to]);
    if (db >= settings[to].detection_db) return false;
    lines.push_back(
        fmt::format("{}: usbl: at the start, {:.3g} m apart, its {} {} {} with {:.3g} dB of signal "
                    "to noise; accepted: detection_db, {:g} or more",
                    pair.by().name, glm::distance(from_m, to_m), what,
                    from == pair.asker ? "reaches" : "comes from", pair.of().name, db,
                    settings[to].detection_db));
    return true;
  };
  return weak(pair.asker, pair.target, pair.asker_ned_m, pair.target_ned_m, "request") ||
         weak(pair.target, pair.asker, pair.target_ned_m, pair.asker_ned_m, "answer");
}

void add_late(const RangingPair& pair, std::vector<std::string>& lines) {
  const double travel_s =
      sonar::modem_travel_s(pair.modems.water(), pair.asker_ned_m, pair.target_ned_m);
  const double comes_s = 2.0 * travel_s + pair.of().turnaround_s + pair.modems.answer_s(pair.asker);
  const double wait_s = pair.modems.wait_s(pair.asker);
  if (comes_s <= wait_s) return;
  lines.push_back(fmt::format(
      "{}: usbl: at the start, {:.3g} m apart, {}'s answer comes {:.3g} s after the request, and "
      "{} {:g} s are over: no fix; accepted: {} of {:.3g} or more",
      pair.by().name, glm::distance(pair.asker_ned_m, pair.target_ned_m), pair.of().name, comes_s,
      pair.by().ranging->wait_s ? "the wait_s of" : "the interval_s of", wait_s,
      pair.by().ranging->wait_s ? "wait_s" : "interval_s or wait_s", comes_s));
}

// Whether the requests of two leave within one request's duration of each other, each time.
bool ask_together(const Modems& modems, std::size_t a, std::size_t b) {
  const scene::Ranging &one = *modems.all()[a].ranging, &two = *modems.all()[b].ranging;
  if (one.interval_s != two.interval_s) return false;
  const double apart_s = std::abs(std::remainder(one.offset_s - two.offset_s, one.interval_s));
  return apart_s < std::max(modems.request_s(a), modems.request_s(b));
}

void add_together(const Modems& modems, std::size_t a, std::size_t b,
                  std::vector<std::string>& lines) {
  const auto settings = modems.settings();
  const auto disturbs = [&](std::size_t sender, std::size_t asker) {
    return sonar::modem_band(settings[sender], settings[modems.all()[asker].target]).share > 0.0;
  };
  if (!ask_together(modems, a, b) || !(disturbs(a, b) || disturbs(b, a))) return;
  lines.push_back(fmt::format(
      "{}, {}: usbl: both ask at the same instants, so that their requests collide; accepted: "
      "offset_s further apart than {:.3g} s, of an interval_s of {:g}",
      modems.all()[a].name, modems.all()[b].name,
      std::max(modems.request_s(a), modems.request_s(b)), modems.all()[a].ranging->interval_s));
}

}  // namespace

void add_ranging(const PhysicsWorld& world, const PhysicsState& start,
                 std::vector<std::string>& lines) {
  const Modems& modems = world.modems();
  for (std::size_t i = 0; i < modems.all().size(); ++i) {
    if (!modems.all()[i].ranging) continue;
    const std::size_t target = modems.all()[i].target;
    const RangingPair pair{modems, i, target, modems.position_ned_m(i, start, 0.0),
                           modems.position_ned_m(target, start, 0.0)};
    if (!add_in_air(pair, lines) && !add_weak(pair, lines)) add_late(pair, lines);
    for (std::size_t k = 0; k < i; ++k)
      if (modems.all()[k].ranging) add_together(modems, k, i, lines);
  }
}

}  // namespace neritic::testbed
