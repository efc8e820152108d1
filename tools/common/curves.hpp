// A page of panels with curves or bars, as tools/plot/curves.py draws it ("picture": "curves"):
// what the tradeoffs show. Plain values; any thread.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace neritic::tools {

struct Axis {
  std::string label;  // with the unit
  bool log = true;    // values that are not positive are then left out
};

struct Series {
  std::string name;
  std::vector<double> x, y;
  std::vector<std::string> notes = {};  // beside the points; empty: none
  bool joined = true;                   // by lines
};

// A ring around a point, with words: the default, the knee.
struct Mark {
  double x = 0.0, y = 0.0;
  std::string words;
};

struct Bar {
  std::string name, group;  // bars of a group have one colour
  double value = 0.0;
};

// Curves over x and y, or bars over y.
struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Series> series = {};
  std::vector<Mark> marks = {};
  std::vector<Mark> levels = {};  // lines across at y, with words
  std::vector<Bar> bars = {};
};

// Rows of bars side by side: a name, a value a lane (not finite: none), words.
struct BarRow {
  std::string name;
  std::vector<double> values;
  std::string note;
};

struct Page {
  std::string title;
  std::vector<std::string> facts;  // lines under the title
  int columns = 2;                 // of panels
  std::vector<Panel> panels = {};
  std::vector<std::string> lanes = {};  // titles of the bars beneath
  std::vector<BarRow> rows = {};
};
nlohmann::json page_data(const Page& page);

}  // namespace neritic::tools
