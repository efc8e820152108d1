#include "testbed/simulation/physics_inputs.hpp"

#include <algorithm>

namespace neritic::testbed {
namespace {

SourceId source_named(const std::string& name, SourceNames& sources) {
  const auto at = std::ranges::find(sources, name);
  const auto id = static_cast<SourceId>(at - sources.begin() + 1);
  if (at == sources.end()) sources.push_back(name);
  return id;
}

Authority authority_of(const std::string& from) {
  for (const Authority authority :
       {Authority::kNobody, Authority::kAutopilot, Authority::kRecording})
    if (name_of(authority) == from) return authority;
  return Authority::kLive;
}

// Group is DiverGroup, VehicleGroup or ObjectGroup.
template <class Group, class Inputs>
void choose(const std::vector<scene::InputChoice>& choices, Inputs& inputs, SourceNames& sources) {
  for (const scene::InputChoice& choice : choices)
    for (std::size_t i = 0; i < inputs.control.size(); ++i) {
      if (name_of(static_cast<Group>(i)) != choice.group) continue;
      GroupControl& control = inputs.control[i];
      control.authority = authority_of(choice.from);
      if (control.authority == Authority::kLive)
        control.source = source_named(choice.from, sources);
      control.hold_s = choice.hold_s.value_or(control.hold_s);
      control.then = authority_of(choice.then);
    }
}

}  // namespace

VehicleInputs chosen_inputs(const std::vector<scene::InputChoice>& choices, SourceNames& sources) {
  VehicleInputs inputs = autopilot_vehicle();
  choose<VehicleGroup>(choices, inputs, sources);
  return inputs;
}

ObjectInputs chosen_object_inputs(const std::vector<scene::InputChoice>& choices,
                                  SourceNames& sources) {
  ObjectInputs inputs = autopilot_object();
  choose<ObjectGroup>(choices, inputs, sources);
  return inputs;
}

DiverInputs chosen_inputs(const std::vector<scene::InputChoice>& choices, bool recorded_body,
                          bool recorded_buttons, SourceNames& sources) {
  DiverInputs inputs = autopilot_diver();
  if (recorded_body) inputs.of(DiverGroup::kBody).authority = Authority::kRecording;
  if (recorded_buttons) inputs.of(DiverGroup::kButtons).authority = Authority::kRecording;
  choose<DiverGroup>(choices, inputs, sources);
  return inputs;
}

}  // namespace neritic::testbed
