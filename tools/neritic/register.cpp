// `neritic register PAIRS.csv`: the place of a lab's tracking frame in a scene, from places that
// are marked in both; prints the scene's [lab] table and how well the pairs fit.
#include <nlohmann/json.hpp>
#include <span>

#include "diver/physio_csv.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/registration.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/register_headset.hpp"

namespace neritic::tools {
namespace {

// Lab axes with z up (motion suits) to those with y up.
Vec3 y_up(const Vec3& z_up) {
  return {z_up.x, z_up.z, -z_up.y};
}
const Quat& y_up_from_z_up() {
  static const Quat turn(std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0);
  return turn;
}

// flags.headset: the places of the scene alone; the lab's side is left at 0.
Result<std::vector<PointPair>> read_pairs(const RegisterFlags& flags) {
  NERITIC_TRY(const std::string text, read_text(flags.file));
  NERITIC_TRY(const diver::SampleTable table, diver::parse_sample_table(text, flags.file));
  constexpr std::array<std::string_view, 6> kNames{"lab_x_m",   "lab_y_m",   "lab_z_m",
                                                   "scene_x_m", "scene_y_m", "scene_z_m"};
  std::array<const std::vector<double>*, 6> columns{};
  const std::size_t first = flags.headset ? 3 : 0;
  for (std::size_t i = first; i < kNames.size(); ++i) {
    const auto column = table.find(kNames[i]);
    if (!column)
      return refusal(flags.file, fmt::format("columns {}", fmt::join(table.names, ", ")),
                     fmt::format("{}", fmt::join(std::span(kNames).subspan(first), ", ")));
    columns[i] = &table.columns[*column];
  }
  std::vector<PointPair> pairs;
  for (std::size_t row = 0; row < table.lines.size(); ++row) {
    for (std::size_t i = first; i < kNames.size(); ++i)
      if (!std::isfinite((*columns[i])[row]))
        return refusal(fmt::format("{}:{}: {}", flags.file, table.lines[row], kNames[i]),
                       "no number", "metres");
    const Vec3 lab = flags.headset
                         ? Vec3(0.0)
                         : Vec3((*columns[0])[row], (*columns[1])[row], (*columns[2])[row]);
    pairs.push_back({flags.lab_up == "z" ? y_up(lab) : lab,
                     {(*columns[3])[row], (*columns[4])[row], (*columns[5])[row]}});
  }
  return pairs;
}

std::string number(double value) {
  return fmt::format("{:.9g}", value == 0.0 ? 0.0 : value);
}

std::string summary_of(const Registration& fit) {
  std::string text =
      fmt::format("{} pairs, residual {:.4f} m rms", fit.residual_m.size(), fit.rms_m);
  if (std::isfinite(fit.turn_error_rad))
    text += fmt::format(", turn known to {:.3f} degrees (1 sigma)", degrees(fit.turn_error_rad));
  text += "; by pair:";
  for (const double residual : fit.residual_m) text += fmt::format(" {:.4f}", residual);
  return text;
}

}  // namespace

Status run_register(const RegisterFlags& flags) {
  if (flags.headset && flags.lab_up != "y")
    return refusal("--lab-up", flags.lab_up + " beside --headset", "y, as headsets have it");
  NERITIC_TRY(std::vector<PointPair> pairs, read_pairs(flags));
  if (flags.headset) NERITIC_TRY_STATUS(measure_by_headset(pairs));
  const RegistrationFreedom freedom =
      flags.tilted ? RegistrationFreedom::kFree : RegistrationFreedom::kLevel;
  Result<Registration> found = register_points(pairs, freedom);
  if (!found.ok()) return failure(found.error().code, "{}: {}", flags.file, found.error().message);
  const Registration& fit = *found;
  const std::string summary = summary_of(fit);
  fmt::print(stderr, "{}\n", summary);
  const std::string wrong = misfit(pairs, freedom, fit);
  if (!wrong.empty()) return failure(ErrorCode::kUnsupported, "{}: {}", flags.file, wrong);
  Pose world_from_lab = fit.to_from;
  if (flags.lab_up == "z")
    world_from_lab.rotation = glm::normalize(world_from_lab.rotation * y_up_from_z_up());
  const Quat& q = world_from_lab.rotation;
  const Vec3& p = world_from_lab.position_m;
  if (flags.json) {
    nlohmann::json json{{"position_m", {p.x, p.y, p.z}},
                        {"rotation_xyzw", {q.x, q.y, q.z, q.w}},
                        {"pairs", pairs.size()},
                        {"rms_m", fit.rms_m},
                        {"residual_m", fit.residual_m},
                        {"turn_error_deg", nullptr},
                        {"mirrored_rms_m", fit.mirrored_rms_m}};
    if (std::isfinite(fit.turn_error_rad)) json["turn_error_deg"] = degrees(fit.turn_error_rad);
    fmt::print("{}\n", json_text(json));
  } else {
    fmt::print("[lab]\nposition_m = [{}, {}, {}]\nrotation_xyzw = [{}, {}, {}, {}]\n# {}\n",
               number(p.x), number(p.y), number(p.z), number(q.x), number(q.y), number(q.z),
               number(q.w), summary);
  }
  return {};
}

}  // namespace neritic::tools
