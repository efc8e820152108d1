#include "testbed/record/source_watch.hpp"

#include "testbed/samples/authority_words.hpp"

namespace neritic::testbed {
namespace {

bool told(const GroupState& before, const GroupState& now) {
  return before.phase == now.phase && before.authority == now.authority &&
         before.source == now.source;
}

std::string change_words(const GroupState& before, const GroupState& now,
                         const std::vector<std::string>& sources) {
  GroupState words = now;
  words.unheeded = 0;
  if (now.phase == GroupPhase::kLost || now.phase == GroupPhase::kWaiting)
    return trouble_words(words, sources);
  if (before.phase == GroupPhase::kLost && before.source == now.source)
    return sources[now.source] + " is heard again";
  return authority_words(words, sources);
}

// Group: DiverGroup, VehicleGroup or ObjectGroup.
template <class Group, class Groups>
void tell_changes(double time_s, const std::string& name, const SampleInbox& inbox,
                  const Groups& groups, Groups& before, const SourceWatch::Tell& tell) {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (told(before[i], groups[i])) continue;
    tell(fmt::format("{:.2f} s: {}: {}: {}", time_s, name, name_of(static_cast<Group>(i)),
                     change_words(before[i], groups[i], inbox.source_names())));
    before[i] = groups[i];
  }
}

}  // namespace

SourceWatch::SourceWatch(const PhysicsWorld& world, const SampleInbox& inbox, Tell tell)
    : world_(world),
      inbox_(inbox),
      tell_(std::move(tell)),
      vehicles_(world.vehicles().size()),
      humans_(world.humans().size()),
      objects_(world.objects().size()) {
  // The scene's own choices are no news.
  for (std::size_t i = 0; i < vehicles_.size(); ++i)
    for (std::size_t k = 0; k < kVehicleGroups; ++k)
      vehicles_[i][k] = next_group({}, world.start_inputs().vehicles()[i].control[k], 0, 0.0);
  for (std::size_t i = 0; i < humans_.size(); ++i)
    for (std::size_t k = 0; k < kDiverGroups; ++k)
      humans_[i][k] = next_group({}, world.start_inputs().humans()[i].control[k], 0, 0.0);
  for (std::size_t i = 0; i < objects_.size(); ++i)
    for (std::size_t k = 0; k < kObjectGroups; ++k)
      objects_[i][k] = next_group({}, world.start_inputs().objects()[i].control[k], 0, 0.0);
}

Status SourceWatch::accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) {
  if (step.step == 0) return {};  // before the first step no group has a phase
  for (std::size_t i = 0; i < vehicles_.size(); ++i)
    tell_changes<VehicleGroup>(step.time_s, world_.vehicles()[i].name, inbox_,
                               step.state.vehicles()[i].groups, vehicles_[i], tell_);
  for (std::size_t i = 0; i < humans_.size(); ++i)
    tell_changes<DiverGroup>(step.time_s, world_.humans()[i].name, inbox_,
                             step.state.humans()[i].groups, humans_[i], tell_);
  for (std::size_t i = 0; i < objects_.size(); ++i)
    tell_changes<ObjectGroup>(step.time_s, world_.objects()[i].name, inbox_,
                              step.state.objects()[i].groups, objects_[i], tell_);
  return {};
}

}  // namespace neritic::testbed
