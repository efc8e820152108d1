#include "tools/common/curves.hpp"

#include <nlohmann/json.hpp>

#include "tools/common/picture.hpp"

namespace neritic::tools {
namespace {

using nlohmann::json;

json numbers(const std::vector<double>& values) {
  json out = json::array();
  for (const double value : values) out.push_back(six_digits(value));
  return out;
}

json axis_data(const Axis& axis) {
  return {{"label", axis.label}, {"log", axis.log}};
}

json marks_data(const std::vector<Mark>& marks) {
  json out = json::array();
  for (const Mark& mark : marks)
    out.push_back({{"x", six_digits(mark.x)}, {"y", six_digits(mark.y)}, {"words", mark.words}});
  return out;
}

json panel_data(const Panel& panel) {
  json out{{"title", panel.title},
           {"x_axis", axis_data(panel.x)},
           {"y_axis", axis_data(panel.y)},
           {"series", json::array()},
           {"marks", marks_data(panel.marks)},
           {"levels", marks_data(panel.levels)},
           {"bars", json::array()}};
  for (const Series& series : panel.series)
    out["series"].push_back({{"name", series.name},
                             {"x", numbers(series.x)},
                             {"y", numbers(series.y)},
                             {"notes", series.notes},
                             {"joined", series.joined}});
  for (const Bar& bar : panel.bars)
    out["bars"].push_back(
        {{"name", bar.name}, {"group", bar.group}, {"value", six_digits(bar.value)}});
  return out;
}

}  // namespace

json page_data(const Page& page) {
  json out{{"picture", "curves"},     {"title", page.title},     {"facts", page.facts},
           {"columns", page.columns}, {"panels", json::array()}, {"lanes", page.lanes},
           {"rows", json::array()}};
  for (const Panel& panel : page.panels) out["panels"].push_back(panel_data(panel));
  for (const BarRow& row : page.rows)
    out["rows"].push_back(
        {{"name", row.name}, {"values", numbers(row.values)}, {"note", row.note}});
  return out;
}

}  // namespace neritic::tools
