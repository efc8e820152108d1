// A map for an operator: participants from above with the ways that they came, north up, and where
// the view looks. Dear ImGui calls. Rendering thread.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "hud/numbers.hpp"
#include "testbed/view/panel_layout.hpp"

namespace neritic::testbed {

struct MapMark {
  std::string name;
  Vec3 position_m{0.0};
  double course_rad = 0.0;  // from north towards east
};

// The ways of participants, thinned as they grow longer: at most kMostPoints each.
class MapTrails {
 public:
  static constexpr std::size_t kMostPoints = 400;
  void add(const std::vector<MapMark>& marks, double time_s);
  const std::vector<Vec2>& of(const std::string& name) const;  // east, north

 private:
  struct Trail {
    std::vector<Vec2> points;
    double least_m = 0.5;  // between two points
  };
  std::map<std::string, Trail> trails_;
  double time_s_ = -1e9;
};

// A square of east and north that holds all marks and trails with some room.
struct MapFrame {
  Vec2 middle{0.0};
  double side_m = 20.0;
};
MapFrame map_frame(const std::vector<MapMark>& marks, const MapTrails& trails);

// The place of a label beside what it names, at `at`, `off` away from it: within the room and off
// what is taken; empty: there is none. Right above where that is free.
PanelRect label_place(const Vec2& at, float off, const Vec2& size, const PanelRect& room,
                      const std::vector<PanelRect>& taken);

inline constexpr PanelWish kMapWish{.wanted = 300.0f, .least = 180.0f};
void draw_map(const std::vector<MapMark>& marks, const MapMark& eye, const MapTrails& trails,
              const PanelRect& rect, hud::Units units, float scale);
// "grid 5 m", of so many metres
std::string grid_words(double step_m, hud::Units units);

}  // namespace neritic::testbed
