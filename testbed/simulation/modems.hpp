// A scene's acoustic modems (sonar/modem.hpp), on vehicles, divers and objects that devices move:
// their messages as a part of the step, and the ranging of those that find another one as a USBL
// does. Built once, then only read; the step is pure. Depths positive; north, east, down.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/sim/step_time.hpp"
#include "testbed/simulation/places.hpp"

namespace neritic::testbed {

struct PhysicsModem {
  std::string name;  // of its owner
  OwnerSort sort = OwnerSort::kVehicle;
  std::uint32_t owner = 0;
  Vec3 position_m{0.0};  // on the owner: forward, starboard, down
  Place object;          // of an object: by samples, or by its own track or carrier
  double turnaround_s = 0.5;
  std::optional<scene::Ranging> ranging;
  std::size_t target = 0;  // of the ranging: a modem
};

class Modems {
 public:
  // Errors in one line: too many, or a target without a modem.
  static Result<Modems> create(const scene::Scene& scene, const Movers& movers);

  const std::vector<PhysicsModem>& all() const { return all_; }
  // The modem of an owner.
  std::optional<std::size_t> find(OwnerSort sort, std::uint32_t owner) const;
  ModemSort sort_of(OwnerSort sort, std::uint32_t owner) const;
  const sonar::ModemWater& water() const { return water_; }
  std::span<const sonar::ModemSettings> settings() const { return settings_; }
  // The durations of a ranging modem's request and of its target's answer, and how long it waits
  // for that. An answer is complete after twice the travel, the target's turnaround and its
  // duration.
  double request_s(std::size_t modem) const;
  double answer_s(std::size_t modem) const;
  double wait_s(std::size_t modem) const;
  // Where a modem is; time_s: of the state.
  Vec3 position_ned_m(std::size_t modem, const PhysicsState& state, double time_s) const;

  // After everything has moved: what is to be sent leaves where its sender was at the instant, what
  // arrives is heard where its receiver is at the end.
  void step(const PhysicsState& before, const PhysicsInputs& inputs, const sim::StepTime& time,
            std::uint64_t seed, PhysicsState& after) const;

 private:
  struct Call;
  // Errors in one line, of a configuration that never gives a fix. path: the scene's.
  Status check_ranging(const std::string& path, std::size_t modem) const;
  bool say(const Call& call, std::size_t modem, sonar::ModemMessage message, double at_s) const;
  void send_asked(const Call& call, std::size_t modem) const;
  void send_answers(const Call& call, std::size_t modem) const;
  void range(const Call& call, std::size_t modem) const;
  void look(const Call& call, std::size_t modem) const;
  void take_answer(const Call& call, std::size_t modem, const sonar::ModemReport& answer) const;
  void miss_overdue(const Call& call, std::size_t modem) const;

  std::vector<PhysicsModem> all_;
  std::vector<sonar::ModemSettings> settings_;
  sonar::ModemWater water_;
};

// As a sample says it.
ModemReading modem_reading(const sonar::ModemReport& report);

}  // namespace neritic::testbed
