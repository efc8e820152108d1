// All devices that a scene connects. The thread that runs the loop owns it; health() from any.
#pragma once

#include "testbed/devices/device_source.hpp"

namespace neritic::testbed {

class Devices {
 public:
  // None in a scene without [sources]. An Error names the source that cannot be opened.
  static Result<std::unique_ptr<Devices>> open(const scene::Scene& scene, const PhysicsWorld& world,
                                               SampleInbox& inbox, DeviceSource::Pace pace);

  bool empty() const { return sources_.empty(); }
  std::vector<SampleSource*> sources() const;
  std::vector<DeviceHealth> health() const;
  const std::vector<std::unique_ptr<DeviceSource>>& all() const { return sources_; }
  // The queues of microphones and straps, for a recording; they live as long as this does.
  std::vector<SignalSource> signals();
  const DeviceSource* find(std::string_view name) const;

 private:
  std::vector<std::unique_ptr<DeviceSource>> sources_;
};

}  // namespace neritic::testbed
