#include "testbed/devices/devices.hpp"

#include <algorithm>

namespace neritic::testbed {

Result<std::unique_ptr<Devices>> Devices::open(const scene::Scene& scene, const PhysicsWorld& world,
                                               SampleInbox& inbox, DeviceSource::Pace pace) {
  auto out = std::make_unique<Devices>();
  for (const scene::DeviceSource& source : scene.sources) {
    NERITIC_TRY(auto opened, DeviceSource::open(source, world, inbox, pace));
    out->sources_.push_back(std::move(opened));
  }
  return out;
}

std::vector<SampleSource*> Devices::sources() const {
  std::vector<SampleSource*> out;
  for (const auto& source : sources_) out.push_back(source.get());
  return out;
}

std::vector<DeviceHealth> Devices::health() const {
  std::vector<DeviceHealth> out;
  for (const auto& source : sources_) out.push_back(source->health());
  return out;
}

std::vector<SignalSource> Devices::signals() {
  std::vector<SignalSource> out;
  for (const auto& source : sources_)
    if (const std::string kind = source->signal_kind(); !kind.empty())
      out.push_back({source->name(), kind, &source->signal()});
  return out;
}

const DeviceSource* Devices::find(std::string_view name) const {
  const auto at = std::ranges::find_if(sources_, [&](const auto& s) { return s->name() == name; });
  return at == sources_.end() ? nullptr : at->get();
}

}  // namespace neritic::testbed
