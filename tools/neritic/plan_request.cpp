#include "tools/neritic/plan_request.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

#include "diver/gas_label.hpp"
#include "engine/core/refusal.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
namespace {

using diver::DecoConventions;
using diver::DivePlanRequest;
using diver::GasRole;
using diver::PlanGas;

Result<double> plan_number(const std::string& flag, std::string_view text) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return refusal(fmt::format("--{}", flag), fmt::format("'{}'", text.substr(0, 40)), "a number");
  return value;
}

// "30/85": two shares from percent.
Result<std::pair<double, double>> percent_pair(const std::string& flag, const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == text.npos)
    return refusal(fmt::format("--{}", flag), fmt::format("'{}'", text),
                   "two percentages, such as 30/85");
  NERITIC_TRY(const double first, plan_number(flag, std::string_view(text).substr(0, slash)));
  NERITIC_TRY(const double second, plan_number(flag, std::string_view(text).substr(slash + 1)));
  return std::pair{first / 100.0, second / 100.0};
}

Result<diver::GasMix> mix_of(const std::string& flag, const std::string& text) {
  const auto mix = diver::parse_mix(text);
  if (!mix.ok()) return Error{mix.error().code, fmt::format("--{}: {}", flag, mix.error().message)};
  return mix;
}

// "18/45", "ean50@21".
Result<PlanGas> gas_of(const std::string& flag, const std::string& text, GasRole role) {
  const std::size_t at = text.find('@');
  NERITIC_TRY(const diver::GasMix mix, mix_of(flag, text.substr(0, at)));
  PlanGas gas{mix, 0.0, role};
  if (at != text.npos) {
    NERITIC_TRY(gas.switch_depth_m, plan_number(flag, text.substr(at + 1)));
  } else if (role == GasRole::kDeco) {
    gas.switch_depth_m = diver::usual_switch_depth_m(mix);
  }
  return gas;
}

Result<std::vector<PlanGas>> gases_of(const PlanFlags& flags) {
  std::vector<PlanGas> gases;
  for (const std::string& text : flags.gases) {
    NERITIC_TRY(const PlanGas gas,
                gas_of("gas", text, gases.empty() ? GasRole::kBottom : GasRole::kDeco));
    gases.push_back(gas);
  }
  if (gases.empty()) gases.emplace_back();
  for (const std::string& text : flags.travel) {
    NERITIC_TRY(const PlanGas gas, gas_of("travel", text, GasRole::kTravel));
    gases.push_back(gas);
  }
  return gases;
}

Result<double> bar_per_m_of_water(const std::string& water) {
  if (water == "fresh") return diver::bar_per_m_of(1000.0);
  if (water == "salt") return diver::bar_per_m_of(1030.0);
  if (water == "en13319") return 0.1;
  double density = 0.0;
  const auto [end, fault] = std::from_chars(water.data(), water.data() + water.size(), density);
  if (fault != std::errc() || end != water.data() + water.size() ||
      !(density >= 900.0 && density <= 1300.0))
    return refusal("--water", fmt::format("'{}'", water),
                   "fresh, salt, en13319 or 900 to 1300 kg/m3");
  return diver::bar_per_m_of(density);
}

Result<DecoConventions> conventions_asked(const PlanFlags& flags) {
  NERITIC_TRY(DecoConventions c, diver::conventions_of(flags.convention));
  if (flags.altitude_m && flags.surface_bar)
    return refusal("--altitude, --surface", "both", "one of them");
  if (flags.altitude_m) {
    if (!(*flags.altitude_m >= -500.0 && *flags.altitude_m <= 9000.0))
      return refusal("--altitude", fmt::format("{}", *flags.altitude_m), "-500 to 9000 m");
    c.environment.surface_bar = diver::surface_bar_at(*flags.altitude_m);
  }
  c.environment.surface_bar = flags.surface_bar.value_or(c.environment.surface_bar);
  if (!flags.water.empty()) {
    NERITIC_TRY(c.environment.bar_per_m, bar_per_m_of_water(flags.water));
  }
  if (flags.table == "b" || flags.table == "c")
    c.table = flags.table == "b" ? diver::BuehlmannTable::kB : diver::BuehlmannTable::kC;
  else if (!flags.table.empty())
    return refusal("--table", fmt::format("'{}'", flags.table), "b or c");
  c.last_stop_m = flags.last_stop_m.value_or(c.last_stop_m);
  c.ascent_m_min = flags.ascent_m_min.value_or(c.ascent_m_min);
  c.descent_m_min = flags.descent_m_min.value_or(c.descent_m_min);
  if (!flags.saturation.empty()) {
    NERITIC_TRY(const auto speeds, percent_pair("saturation", flags.saturation));
    c.saturation = speeds.first;
    c.desaturation = speeds.second;
  }
  return c;
}

// "18/45=24,232".
Result<diver::PlanTank> tank_of(const std::string& text, const DivePlanRequest& request) {
  const std::size_t equals = text.find('=');
  if (equals == text.npos)
    return refusal("--tank", fmt::format("'{}'", text), "GAS=LITRES,BAR, such as 18/45=24,232");
  NERITIC_TRY(const diver::GasMix mix, mix_of("tank", text.substr(0, equals)));
  NERITIC_TRY(const auto sizes, parse_numbers("tank", text.substr(equals + 1), 2, 2));
  for (std::size_t i = 0; i < request.gases.size(); ++i)
    if (request.gases[i].mix == mix) return diver::PlanTank{i, sizes[0], sizes[1]};
  return refusal("--tank", fmt::format("a tank of {}", diver::name_of(mix)), "gases of the plan");
}

// Conventions, gradient factors and gases.
Result<DivePlanRequest> bare_request(const PlanFlags& flags) {
  DivePlanRequest request;
  NERITIC_TRY(request.conventions, conventions_asked(flags));
  NERITIC_TRY(const auto gf, percent_pair("gf", flags.gf));
  if (!(gf.first >= 0.01 && gf.first <= gf.second && gf.second <= 1.5))
    return refusal("--gf", fmt::format("'{}'", flags.gf),
                   "1 to 150 percent, the first not above the second, such as 30/85");
  request.gf_low = gf.first;
  request.gf_high = gf.second;
  NERITIC_TRY(request.gases, gases_of(flags));
  return request;
}

// "30,25,60" or "30,25,60,ean32".
Result<diver::EarlierDive> earlier_dive(const std::string& text, const DivePlanRequest& base) {
  diver::EarlierDive earlier;
  earlier.dive = base;
  earlier.dive.gases = {PlanGas{}};
  std::string numbers = text;
  if (std::ranges::count(text, ',') == 3) {
    NERITIC_TRY(const PlanGas gas,
                gas_of("after", text.substr(text.rfind(',') + 1), GasRole::kBottom));
    earlier.dive.gases = {gas};
    numbers = text.substr(0, text.rfind(','));
  }
  NERITIC_TRY(const auto values, parse_numbers("after", numbers, 3, 3));
  earlier.dive.levels = {{values[0], values[1]}};
  earlier.surface_min = values[2];
  if (!(earlier.surface_min >= 0.0))
    return refusal("--after", fmt::format("an interval of {} min", values[2]), "0 or more");
  return earlier;
}

Status add_earlier(const PlanFlags& flags, DivePlanRequest& request) {
  if (flags.after.empty()) return {};
  std::vector<diver::EarlierDive> dives;
  for (const std::string& text : flags.after) {
    NERITIC_TRY(diver::EarlierDive dive, earlier_dive(text, request));
    dives.push_back(std::move(dive));
  }
  std::vector<diver::DivePlan> plans;
  NERITIC_TRY(request.start, diver::tissues_after(dives, &plans));
  request.oxygen_before = diver::oxygen_after(dives, plans);
  return {};
}

}  // namespace

Result<DivePlanRequest> plan_request(const PlanFlags& flags) {
  NERITIC_TRY(DivePlanRequest request, bare_request(flags));
  if (!flags.depth_m || !flags.time_min) {
    const char* what = flags.depth_m ? "--time" : flags.time_min ? "--depth" : "--depth and --time";
    return refusal("plan", fmt::format("no {}", what),
                   "depth (m) and time at the bottom (min, descent included), such as --depth 30 "
                   "--time 25; or --log FILE of a recorded dive");
  }
  for (const auto& [flag, value] :
       {std::pair("--depth", *flags.depth_m), {"--time", *flags.time_min}})
    if (!std::isfinite(value)) return refusal(flag, fmt::format("{}", value), "a number");
  const PlanGas& bottom = request.gases[0];
  if (flags.travel.empty() && bottom.switch_depth_m > 0.0)
    return refusal("--gas",
                   fmt::format("{} from {:g} m, with nothing to breathe above",
                               diver::name_of(bottom.mix), bottom.switch_depth_m),
                   "a bottom gas without a depth, or --travel with the gas above");
  request.levels = {{*flags.depth_m, *flags.time_min}};
  for (const std::string& text : flags.levels) {
    NERITIC_TRY(const auto level, parse_numbers("level", text, 2, 2));
    request.levels.push_back({level[0], level[1]});
  }
  NERITIC_TRY_STATUS(add_earlier(flags, request));
  return request;
}

Result<PlanGasFlags> plan_gas(const PlanFlags& flags, const DivePlanRequest& request) {
  PlanGasFlags out;
  NERITIC_TRY(const auto rmv, parse_numbers("rmv", flags.rmv, 1, 2));
  out.breathing.bottom_l_min = rmv[0];
  out.breathing.ascent_l_min = rmv.back();
  NERITIC_TRY(const auto minimum, parse_numbers("minimum-gas", flags.minimum_gas, 3, 3));
  out.breathing.divers = minimum[0];
  out.breathing.stress = minimum[1];
  out.breathing.problem_min = minimum[2];
  for (const std::string& text : flags.tanks) {
    NERITIC_TRY(const diver::PlanTank tank, tank_of(text, request));
    out.tanks.push_back(tank);
  }
  return out;
}

Result<diver::DiveComputerSettings> log_settings(const PlanFlags& flags,
                                                 const diver::DepthLog& log) {
  NERITIC_TRY(const DivePlanRequest request, bare_request(flags));
  diver::DiveComputerSettings settings;
  settings.conventions = request.conventions;
  settings.gf_low = request.gf_low;
  settings.gf_high = request.gf_high;
  settings.gases.clear();
  // Where a flag names a gas of the log, its depth and what it is for are the flag's.
  const std::span asked = std::span(request.gases).subspan(flags.gases.empty() ? 1 : 0);
  std::optional<std::size_t> unnamed;
  for (const diver::GasMix& mix : log.gases) {
    const auto named = std::ranges::find(asked, mix, &PlanGas::mix);
    if (named == asked.end() && !unnamed) unnamed = settings.gases.size();
    settings.gases.push_back(named != asked.end()
                                 ? *named
                                 : PlanGas{mix, diver::usual_switch_depth_m(mix), GasRole::kDeco});
  }
  const auto has_bottom = [&] {
    return std::ranges::find(settings.gases, GasRole::kBottom, &PlanGas::role) !=
           settings.gases.end();
  };
  // Otherwise the log's first gas is the bottom gas, and gases of flags alone were never breathed.
  if (!has_bottom() && unnamed) settings.gases[*unnamed].role = GasRole::kBottom;
  for (const PlanGas& gas : request.gases) {
    const bool known =
        std::ranges::find(settings.gases, gas.mix, &PlanGas::mix) != settings.gases.end();
    if (known || (gas.role == GasRole::kBottom && has_bottom())) continue;
    settings.gases.push_back(gas);
  }
  return settings;
}

Result<diver::DiveComputerState> log_start(const PlanFlags& flags,
                                           const diver::DiveComputer& computer) {
  NERITIC_TRY(DivePlanRequest request, bare_request(flags));
  NERITIC_TRY_STATUS(add_earlier(flags, request));
  diver::DiveComputerState state =
      request.start ? computer.start(*request.start) : computer.start();
  state.oxygen = request.oxygen_before;
  return state;
}

}  // namespace neritic::tools
