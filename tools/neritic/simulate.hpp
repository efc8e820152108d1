// `neritic simulate`: simulators of a lab's devices. Parts that its kinds share. One thread.
#pragma once

#include "engine/scene/scene.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/simulators/lab.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/interrupt.hpp"

namespace neritic::tools {

// The recordings that flags name in place of the person's signals. It stays where it is while a lab
// uses it.
struct SimulatedSignals {
  std::optional<diver::LimbRecording> limbs;
  std::optional<diver::ButtonRecording> buttons;
  std::optional<diver::Recording> ecg, sound;
};
Status read_signals(const SimulateFlags& flags, SimulatedSignals& signals);
Result<testbed::LabOptions> lab_options(const SimulateFlags& flags,
                                        const SimulatedSignals& signals);

// simulate_lab.cpp: scene, devices and their simulators in one process, in simulated time.
Status simulate_lab(const SimulateFlags& flags, const scene::Scene& scene,
                    const Interrupt& interrupt);
// simulate_flood.cpp: a scene on the host's clock under a flood of packets.
Status simulate_flood(const SimulateFlags& flags, const scene::Scene& scene,
                      const Interrupt& interrupt);

// simulate_latency.cpp: from a packet to the picture that shows it.
Status simulate_latency(const SimulateFlags& flags, scene::Scene scene, const Interrupt& interrupt);

}  // namespace neritic::tools
