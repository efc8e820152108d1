// The streams of a scene, computed once: each has a name ("diver/joints", "rov/imu"), a kind of
// payload and an owner. A stream's id is its place here. Read only afterwards; any thread.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "testbed/samples/sample.hpp"

namespace neritic::testbed {

// Numbers of owners count from 0 in the order of the scene, each sort by itself.
enum class OwnerSort : std::uint32_t { kDiver, kVehicle, kObject };

// The modem of an owner, if it has one.
enum class ModemSort { kNone, kTalks, kRanges };

struct Stream {
  std::string name;
  PayloadKind kind = PayloadKind::kEvent;
  OwnerSort sort = OwnerSort::kDiver;
  std::uint32_t owner = 0;
};

class StreamTable {
 public:
  // Streams of the scene's next diver: inputs, motion, dive computer, collisions, events.
  // named: further kinds, of what the scene names.
  void add_diver(const std::string& name, ModemSort modem = ModemSort::kNone,
                 const std::vector<PayloadKind>& named = {});
  // Streams of its next vehicle: inputs, the sensors that it has, collisions, events.
  void add_vehicle(const std::string& name, const rov::SensorSet& sensors,
                   ModemSort modem = ModemSort::kNone, const std::vector<PayloadKind>& named = {});
  // Streams of its next object that devices move: pose, events; limbs: joints.
  void add_object(const std::string& name, ModemSort modem = ModemSort::kNone, bool limbs = false);

  std::span<const Stream> streams() const { return streams_; }
  std::size_t size() const { return streams_.size(); }
  const Stream& operator[](StreamId id) const { return streams_.at(id); }
  // The first of that name: a scene may give two owners the same.
  std::optional<StreamId> find(const std::string& name) const;
  // Precondition: the owner has such a stream.
  StreamId id(OwnerSort sort, std::uint32_t owner, PayloadKind kind) const;

 private:
  void add(OwnerSort sort, std::uint32_t owner, const std::string& name,
           std::vector<PayloadKind> kinds, ModemSort modem);

  std::vector<Stream> streams_;
  std::unordered_map<std::string, StreamId> ids_;
  std::vector<StreamId> first_[3];  // of each owner, by sort
};

}  // namespace neritic::testbed
