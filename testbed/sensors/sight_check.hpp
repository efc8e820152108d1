// Says once a sensor, at its first frame, why it shows nothing (sight.hpp). It reads the data that
// the frame brings to the host anyhow; for the rest it draws one G-buffer, once: of a sonar only if
// it heard nothing or nothing but its carrier's class, of a camera only if an object carries it.
// Rendering thread.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "testbed/sensors/frame_sink.hpp"

namespace neritic::testbed {

class SightCheck final : public FrameSink {
 public:
  using Tell = std::function<void(const std::string& line)>;
  // simulated: as FrameRequest's. session and simulated outlive it.
  SightCheck(Session& session, const scene::SimulatedMotion* simulated, Tell tell);
  Status accept(const FrameResult& frame) override;
  Status finish() override { return {}; }
  // For sensors whose frames stay on the GPU: renders their geometry.
  Status look(double time_s, const std::vector<std::size_t>& cameras,
              const std::vector<std::size_t>& sonars);

 private:
  void judge(const FrameResult& frame);
  bool hears(const scene::Sonar& sonar, const SonarFrame& head) const;
  Session& session_;
  const scene::SimulatedMotion* simulated_;
  Tell tell_;
  std::set<std::string> seen_;       // sensors whose first frame is past
  std::set<std::string> unclassed_;  // sonars that heard something of no class
};

}  // namespace neritic::testbed
