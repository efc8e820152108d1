#include "testbed/samples/stream_table.hpp"

namespace neritic::testbed {

void StreamTable::add(OwnerSort sort, std::uint32_t owner, const std::string& name,
                      std::vector<PayloadKind> kinds, ModemSort modem) {
  if (modem != ModemSort::kNone) {
    kinds.push_back(PayloadKind::kSend);
    kinds.push_back(PayloadKind::kModem);
  }
  if (modem == ModemSort::kRanges) kinds.push_back(PayloadKind::kUsbl);
  auto& first = first_[static_cast<std::size_t>(sort)];
  if (owner == first.size()) first.push_back(static_cast<StreamId>(streams_.size()));
  for (const PayloadKind kind : kinds) {
    Stream stream{fmt::format("{}/{}", name, name_of(kind)), kind, sort, owner};
    ids_.emplace(stream.name, static_cast<StreamId>(streams_.size()));
    streams_.push_back(std::move(stream));
  }
}

void StreamTable::add_diver(const std::string& name, ModemSort modem,
                            const std::vector<PayloadKind>& named) {
  using enum PayloadKind;
  const auto owner = static_cast<std::uint32_t>(first_[0].size());
  std::vector<PayloadKind> kinds{kBodyJoints, kHandJoints, kHandPoses, kHeadPose, kGaze,
                                 kButtons,    kBreath,     kHeart,     kGas,      kEvent,
                                 kMotion,     kComputer,   kCollision, kHuman};
  kinds.insert(kinds.end(), named.begin(), named.end());
  add(OwnerSort::kDiver, owner, name, std::move(kinds), modem);
}

void StreamTable::add_vehicle(const std::string& name, const rov::SensorSet& sensors,
                              ModemSort modem, const std::vector<PayloadKind>& named) {
  using enum PayloadKind;
  std::vector<PayloadKind> kinds{kWrench, kThrusters, kSetpoint, kVelocity,
                                 kFault,  kEvent,     kCollision};
  if (sensors.imu) kinds.push_back(kImu);
  if (sensors.dvl) kinds.push_back(kDvl);
  if (sensors.pressure) kinds.push_back(kPressure);
  if (sensors.compass) kinds.push_back(kCompass);
  if (sensors.altimeter) kinds.push_back(kAltimeter);
  if (sensors.usbl) kinds.push_back(kUsbl);
  kinds.insert(kinds.end(), named.begin(), named.end());
  add(OwnerSort::kVehicle, static_cast<std::uint32_t>(first_[1].size()), name, kinds, modem);
}

void StreamTable::add_object(const std::string& name, ModemSort modem, bool limbs) {
  using enum PayloadKind;
  std::vector<PayloadKind> kinds{kObjectPose, kEvent};
  if (limbs) kinds.push_back(kBodyJoints);
  add(OwnerSort::kObject, static_cast<std::uint32_t>(first_[2].size()), name, kinds, modem);
}

std::optional<StreamId> StreamTable::find(const std::string& name) const {
  const auto at = ids_.find(name);
  if (at == ids_.end()) return std::nullopt;
  return at->second;
}

StreamId StreamTable::id(OwnerSort sort, std::uint32_t owner, PayloadKind kind) const {
  for (StreamId id = first_[static_cast<std::size_t>(sort)].at(owner); id < streams_.size(); ++id) {
    const Stream& stream = streams_[id];
    if (stream.sort != sort || stream.owner != owner) break;
    if (stream.kind == kind) return id;
  }
  check_failed(__FILE__, __LINE__, "the owner has the stream",
               fmt::format("owner {} has no {}", owner, name_of(kind)));
}

}  // namespace neritic::testbed
