#include "tools/neritic/plan_picture.hpp"

#include <nlohmann/json.hpp>

#include "diver/gas_label.hpp"
#include "tools/common/picture.hpp"

namespace neritic::tools {
namespace {

using nlohmann::json;

// More rows than this cannot be seen in a picture.
constexpr std::size_t kMostRows = 3000;

bool same_kind(const TraceRow& a, const TraceRow& b) {
  return a.gas == b.gas && a.view.alarm == b.view.alarm &&
         a.view.ceiling_violated == b.view.ceiling_violated;
}

// Evenly thinned, the last row included; rows in which gas, alarm or violation change stay.
std::vector<const TraceRow*> thinned(const DiveTrace& trace) {
  std::vector<const TraceRow*> out;
  const std::size_t every = trace.rows.size() / kMostRows + 1;
  for (std::size_t i = 0; i < trace.rows.size(); ++i)
    if (i % every == 0 || i + 1 == trace.rows.size() ||
        !same_kind(trace.rows[i], trace.rows[i - 1]))
      out.push_back(&trace.rows[i]);
  return out;
}

template <class Value>
json column(const std::vector<const TraceRow*>& rows, Value value) {
  json out = json::array();
  for (const TraceRow* row : rows) out.push_back(value(*row));
  return out;
}

json numbers(const std::vector<double>& values) {
  json out = json::array();
  for (const double value : values) out.push_back(six_digits(value));
  return out;
}

// The pressure at which a compartment reaches its M-value here; null where it gives off no gas.
json m_value_bar(const diver::Buehlmann& model, const TraceMoment& moment, std::size_t i,
                 double ambient_bar) {
  const double share = diver::gradient_share(model, moment.tissues, i, ambient_bar);
  const double all_bar = moment.tissues.n2_bar[i] + moment.tissues.he_bar[i];
  if (!(share > 0.0)) return nullptr;
  return six_digits(ambient_bar + (all_bar - ambient_bar) / share);
}

json moment_data(const PlanPicture& picture, const TraceMoment& moment) {
  const diver::Buehlmann model = picture.conventions.model();
  const double ambient_bar = picture.conventions.environment.pressure_bar(moment.depth_m);
  json out{{"name", moment.name},
           {"run_min", six_digits(moment.run_min)},
           {"depth_m", six_digits(moment.depth_m)},
           {"ambient_bar", six_digits(ambient_bar)}};
  for (std::size_t i = 0; i < diver::kCompartments; ++i) {
    out["n2_bar"].push_back(six_digits(moment.tissues.n2_bar[i]));
    out["he_bar"].push_back(six_digits(moment.tissues.he_bar[i]));
    out["m_value_bar"].push_back(m_value_bar(model, moment, i, ambient_bar));
  }
  return out;
}

json curve_data(const GasCurve& curve) {
  json out{{"name", curve.name},
           {"gas", curve.gas},
           {"unit", curve.bar ? "bar" : "l"},
           {"run_min", numbers(curve.run_min)},
           {"value", numbers(curve.value)},
           {"used_up", curve.used_up},
           {"minimum", nullptr}};
  if (curve.minimum)
    out["minimum"] = {{"run_min", six_digits(*curve.minimum_run_min)},
                      {"bar", six_digits(*curve.minimum)},
                      {"then_bar", six_digits(*curve.then)}};
  return out;
}

}  // namespace

json plan_picture_data(const PlanPicture& picture, const DiveTrace& trace) {
  const std::vector<const TraceRow*> rows = thinned(trace);
  using R = const TraceRow&;
  json out{{"picture", "plan"},
           {"title", picture.title},
           {"facts", picture.facts},
           {"warnings", picture.warnings},
           {"gf_high", picture.gf_high},
           {"gases", json::array()},
           {"run_min", column(rows, [](R r) { return six_digits(r.run_min); })},
           {"depth_m", column(rows, [](R r) { return six_digits(r.depth_m); })},
           {"ceiling_m", column(rows, [](R r) { return six_digits(r.view.ceiling_m); })},
           {"gas", column(rows, [](R r) { return r.gas; })},
           {"alarm", column(rows, [](R r) { return static_cast<int>(r.view.alarm); })},
           {"ceiling_violated", column(rows, [](R r) { return r.view.ceiling_violated ? 1 : 0; })},
           {"stops", json::array()},
           {"gas_left", json::array()},
           {"moments", json::array()}};
  for (const diver::PlanGas& gas : picture.gases) out["gases"].push_back(diver::name_of(gas.mix));
  for (const diver::PlanStop& stop : picture.stops)
    out["stops"].push_back({{"depth_m", six_digits(stop.depth_m)},
                            {"minutes", six_digits(stop.minutes)},
                            {"leave_min", six_digits(stop.leave_min)}});
  for (const GasCurve& curve : picture.gas) out["gas_left"].push_back(curve_data(curve));
  for (const TraceMoment& moment : trace.moments)
    out["moments"].push_back(moment_data(picture, moment));
  return out;
}

}  // namespace neritic::tools
