#include "sonar/modem.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "engine/sim/fields.hpp"

namespace neritic::sonar {
namespace {

// Steady, quiet and quick, unless a test says otherwise.
ModemSettings plain() {
  ModemSettings modem;
  modem.fading = false;
  return modem;
}

struct Sea {
  explicit Sea(std::vector<Vec3> at, ModemSettings settings = plain())
      : positions(std::move(at)), modems(positions.size(), settings), states(positions.size()) {
    water.water.temperature_c = 10.0;
  }
  ModemChannel channel() const { return {water, modems, seed}; }
  bool say(std::size_t from, std::uint64_t to, std::uint64_t bytes, double now_s) {
    ModemMessage message;
    message.to = to;
    message.bytes = bytes;
    message.words[0] = 0x1122334455667788ull;
    return send(channel(), states, from, message, now_s, positions[from]);
  }
  void run(double from_s, double to_s, double step_s = 1.0 / 240.0) {
    for (double t = from_s; t < to_s - 1e-9; t += step_s)
      step(channel(), states, positions, t, t + step_s);
  }
  ModemWater water;
  std::vector<Vec3> positions;
  std::vector<ModemSettings> modems;
  std::vector<ModemState> states;
  std::uint64_t seed = 1;
};

SoundSpeedProfile gradient(double top_m_s, double per_m) {
  return SoundSpeedProfile::of_table({{0.0, top_m_s}, {1000.0, top_m_s + 1000.0 * per_m}}).value();
}

// Mackenzie at 10 C, 35 psu, 0 m is 1489.803 m/s (reference values).
TEST(Modem, TravelTakesTheRangeOverTheSpeedOfSound) {
  ModemWater water;
  water.water.temperature_c = 10.0;
  EXPECT_NEAR(modem_travel_s(water, {0, 0, 0}, {1489.803, 0, 0}), 1.0, 2e-6);
  EXPECT_EQ(modem_travel_s(water, {1, 2, 3}, {1, 2, 3}), 0.0);
}

// In a constant gradient the time between two places at one depth is 2/g asinh(g r / 2 c) along the
// ray's arc, less than along the straight line; straight down it is ln(c1/c0)/g.
TEST(Modem, BentRaysTakeTheClosedFormsTime) {
  ModemWater water;
  const double g = 0.05, c0 = 1480.0, r = 2000.0;
  water.profile = gradient(c0, g);
  const double c = c0 + 500.0 * g;
  water.path = ModemPath::kBent;
  EXPECT_NEAR(modem_travel_s(water, {0, 0, 500}, {r, 0, 500}),
              2.0 / g * std::asinh(g * r / (2.0 * c)), 1e-9);
  water.path = ModemPath::kStraight;
  EXPECT_NEAR(modem_travel_s(water, {0, 0, 500}, {r, 0, 500}), r / c, 1e-12);
  for (const ModemPath path : {ModemPath::kStraight, ModemPath::kBent}) {
    water.path = path;
    EXPECT_NEAR(modem_travel_s(water, {0, 0, 0}, {0, 0, 1000}), std::log(1.0 + 1000.0 * g / c0) / g,
                1e-9);
    // There and back alike.
    EXPECT_NEAR(modem_travel_s(water, {0, 0, 10}, {900, 300, 600}),
                modem_travel_s(water, {900, 300, 600}, {0, 0, 10}), 1e-9);
  }
}

// In a constant gradient the ray between two places at one depth arrives with the angle whose
// tangent is g r / 2 c, from below where the speed grows with the depth.
TEST(Modem, ABentRayArrivesFromWhereItBends) {
  ModemWater water;
  const double g = 0.05, c = 1480.0 + 500.0 * g, r = 2000.0;
  water.profile = gradient(1480.0, g);
  const Vec3 from(1200, 1600, 500), to(0, 0, 500);
  const Vec3 straight = modem_arrival(water, from, to);
  EXPECT_NEAR(glm::length(straight - Vec3(0.6, 0.8, 0.0)), 0.0, 1e-12);
  water.path = ModemPath::kBent;
  const Vec3 bent = modem_arrival(water, from, to);
  EXPECT_NEAR(glm::length(bent), 1.0, 1e-12);
  EXPECT_NEAR(bent.z / std::hypot(bent.x, bent.y), g * r / (2.0 * c), 1e-6);
  EXPECT_NEAR(bent.y / bent.x, 4.0 / 3.0, 1e-12);
  EXPECT_EQ(modem_arrival(water, Vec3(0, 0, 900), to), Vec3(0, 0, 1));
  EXPECT_EQ(modem_arrival(water, to, to), Vec3(0, 0, 1));
}

// Spheres: 60 dB at 1 km, and 33.40 dB/km at 100 kHz, 10 C, 35 psu, pH 8, 50 m (reference values).
TEST(Modem, LossIsSpreadingAndAbsorption) {
  ModemWater water;
  water.water.temperature_c = 10.0;
  EXPECT_NEAR(modem_loss_db(water, 100e3, {0, 0, 50}, {1000, 0, 50}), 60.0 + 33.40, 0.01);
  water.spreading = 1.5;
  EXPECT_NEAR(modem_loss_db(water, 100e3, {0, 0, 50}, {1000, 0, 50}), 45.0 + 33.40, 0.01);
}

// 10 dB in the band, 16 times as wide as the bits: g = 160 without coding.
TEST(Modem, BitErrorsFollowTheBooksFormulas) {
  ModemSettings modem;
  modem.coding_gain_db = 0.0;
  modem.bandwidth_hz = 8000.0, modem.bit_rate_hz = 500.0;
  EXPECT_NEAR(modem_bit_error(modem, modem, 10.0), 1.0 / 162.0, 1e-12);
  modem.fading = false;
  EXPECT_NEAR(modem_bit_error(modem, modem, 0.0), 0.5 * std::exp(-8.0), 1e-15);
  EXPECT_EQ(modem_success(modem, modem, 0.0, 0), 1.0);
  EXPECT_NEAR(modem_success(modem, modem, 0.0, 10), std::pow(1.0 - 0.5 * std::exp(-8.0), 80.0),
              1e-12);
}

TEST(Modem, AMessageComesAfterItsTravelAndItsBits) {
  Sea sea({{0, 0, 5}, {300, 0, 5}});
  ASSERT_TRUE(sea.say(0, 1, 10, 0.0));
  const double travel_s = modem_travel_s(sea.water, sea.positions[0], sea.positions[1]);
  const double bits_s = modem_duration_s(sea.modems[0], 10);
  EXPECT_NEAR(bits_s, 0.05 + 80.0 / 500.0, 1e-12);
  sea.run(0.0, travel_s + bits_s - 0.01);
  EXPECT_EQ(sea.states[1].counts.received, 0u);
  sea.run(travel_s + bits_s - 0.01, travel_s + bits_s + 0.01);
  ASSERT_EQ(sea.states[1].counts.received, 1u);
  const ModemReport& got = sea.states[1].reports[0];
  EXPECT_EQ(got.event, ModemEvent::kReceived);
  EXPECT_EQ(got.message.words[0], 0x1122334455667788ull);
  EXPECT_EQ(got.message.from, 0u);
  EXPECT_NEAR(got.heard_s - got.sent_s, travel_s, 1e-12);  // of a range, whatever the step
  EXPECT_EQ(sea.states[0].counts.received, 0u);            // none hears itself
  EXPECT_EQ(sea.states[0].flights[0].flying, 0u);
}

TEST(Modem, TwoAtOnceCollideAndAMuchNearerOneIsHeard) {
  Sea sea({{0, 0, 5}, {300, 0, 5}, {600, 0, 5}});
  sea.say(0, 1, 20, 0.0);
  sea.say(2, 1, 20, 0.0);
  sea.run(0.0, 2.0);
  EXPECT_EQ(sea.states[1].counts.received, 0u);
  EXPECT_EQ(sea.states[1].counts.collided, 2u);
  // 15 m against 300 m: 26 dB apart.
  Sea near({{285, 0, 5}, {300, 0, 5}, {600, 0, 5}});
  near.say(0, 1, 20, 0.0);
  near.say(2, 1, 20, 0.0);
  near.run(0.0, 2.0);
  EXPECT_EQ(near.states[1].counts.received, 1u);
  EXPECT_EQ(near.states[1].counts.collided, 1u);
}

// Eight bytes every 0.3 s over 3.5 km: each is whole before the next one, and eight travel at once.
TEST(Modem, AFarModemSendsOneMessageAfterTheOther) {
  Sea sea({{0, 0, 5}, {3500, 0, 5}});
  for (ModemSettings& modem : sea.modems) modem.source_level_db = 200.0, modem.fading = false;
  const double travel_s = modem_travel_s(sea.water, sea.positions[0], sea.positions[1]);
  EXPECT_GT(travel_s, 7 * 0.3);
  for (int i = 0; i < 16; ++i) {
    EXPECT_TRUE(sea.say(0, 1, 8, 0.3 * i)) << i;
    sea.run(0.3 * i, 0.3 * (i + 1));
  }
  EXPECT_EQ(sea.states[0].counts.refused, 0u);
  sea.run(16 * 0.3, 10.0);
  EXPECT_EQ(sea.states[1].counts.received, 16u);
}

// Beyond the sound's longest way for which there is room it refuses, until a message is over.
TEST(Modem, NoMoreTravelAtOnceThanThereIsRoomFor) {
  Sea sea({{0, 0, 5}, {30000, 0, 5}});
  const double travel_s = modem_travel_s(sea.water, sea.positions[0], sea.positions[1]);
  ASSERT_GT(travel_s, 34 * 0.3);
  for (std::size_t i = 0; i < ModemState::kFlying + 2; ++i) {
    const double now_s = 0.3 * static_cast<double>(i);
    EXPECT_EQ(sea.say(0, 1, 8, now_s), i < ModemState::kFlying) << i;
    sea.run(now_s, now_s + 0.3);
  }
  EXPECT_EQ(sea.states[0].counts.refused, 2u);
  sea.run(0.3 * (ModemState::kFlying + 2), travel_s + 0.4);
  EXPECT_TRUE(sea.say(0, 1, 8, travel_s + 0.4));
}

TEST(Modem, WhileItSendsItIsDeafAndCannotSendAgain) {
  Sea sea({{0, 0, 5}, {300, 0, 5}});
  ASSERT_TRUE(sea.say(0, 1, 20, 0.0));
  EXPECT_FALSE(sea.say(0, 1, 20, 0.1));
  EXPECT_FALSE(sea.say(1, 0, 65, 0.0));
  sea.run(0.0, 0.3);  // it has begun to arrive
  ASSERT_TRUE(sea.say(1, 0, 20, 0.3));
  sea.run(0.3, 2.0);
  EXPECT_EQ(sea.states[1].counts.was_sending, 1u);
  EXPECT_EQ(sea.states[1].counts.received, 0u);
  EXPECT_EQ(sea.states[0].counts.received, 1u);
  EXPECT_EQ(sea.states[0].counts.refused, 1u);
  EXPECT_EQ(sea.states[1].counts.refused, 1u);
}

TEST(Modem, FartherIsLostMoreOftenAndTheShareIsTheFormulas) {
  ModemSettings fading;
  int lost_before = -1;
  for (const double range_m : {100.0, 3000.0, 6000.0}) {
    Sea sea({{0, 0, 50}, {range_m, 0, 50}}, fading);
    const int messages = 400;
    for (int i = 0; i < messages; ++i) {
      const double t = 10.0 * i;
      sea.say(0, 1, 8, t);
      step(sea.channel(), sea.states, sea.positions, t, t + 5.0);
      step(sea.channel(), sea.states, sea.positions, t + 5.0, t + 10.0);
    }
    const double snr_db =
        fading.source_level_db -
        modem_loss_db(sea.water, fading.frequency_hz, sea.positions[0], sea.positions[1]) -
        modem_noise_db(sea.water, fading);
    const double share =
        snr_db >= fading.detection_db ? modem_success(fading, fading, snr_db, 8) : 0.0;
    const auto got = static_cast<double>(sea.states[1].counts.received);
    EXPECT_NEAR(got / messages, share, 0.08) << range_m << " m, " << snr_db << " dB";
    const ModemCounts& counts = sea.states[1].counts;
    EXPECT_EQ(counts.received + counts.noisy + counts.too_weak, 400u);
    const int lost = messages - static_cast<int>(got);
    EXPECT_GE(lost, lost_before);
    lost_before = lost;
  }
  EXPECT_EQ(lost_before, 400);
}

// A message's bits are as long as its sender makes them: slow ones are read by quick modems too.
TEST(Modem, TheSendersBitRateAndCodeDecideWhatIsReceived) {
  const auto received = [](const ModemSettings& sender, const ModemSettings& receiver) {
    Sea sea({{0, 0, 50}, {3000, 0, 50}});
    sea.modems = {sender, receiver};
    for (int i = 0; i < 60; ++i) {
      sea.say(0, 1, 8, 10.0 * i);
      step(sea.channel(), sea.states, sea.positions, 10.0 * i, 10.0 * i + 5.0);
      step(sea.channel(), sea.states, sea.positions, 10.0 * i + 5.0, 10.0 * (i + 1));
    }
    return sea.states[1].counts.received;
  };
  ModemSettings slow, quick;
  slow.source_level_db = quick.source_level_db = 155.0;
  slow.detection_db = quick.detection_db = -20.0;
  slow.fading = quick.fading = false;
  slow.bit_rate_hz = 50.0, quick.bit_rate_hz = 8000.0;
  EXPECT_EQ(received(slow, slow), 60u);
  EXPECT_EQ(received(slow, quick), 60u);
  EXPECT_EQ(received(quick, slow), received(quick, quick));
  EXPECT_LT(received(quick, quick), 20u);
  ModemSettings coded = quick;
  coded.coding_gain_db = 30.0;
  EXPECT_EQ(received(coded, quick), 60u);
  EXPECT_LT(received(quick, coded), 20u);
  // Noise is the receiver's, level the sender's.
  ModemSettings noisy = slow;
  noisy.self_noise_db = 120.0;
  EXPECT_EQ(received(noisy, slow), 60u);
  EXPECT_EQ(received(slow, noisy), 0u);
  // A path fades alike both ways, of whichever modem it is said.
  ModemSettings fading = slow;
  fading.fading = true;
  EXPECT_EQ(modem_bit_error(fading, slow, 3.0), modem_bit_error(slow, fading, 3.0));
  EXPECT_GT(modem_bit_error(fading, slow, 3.0), modem_bit_error(slow, slow, 3.0));
}

TEST(Modem, OnlyWhatLiesInTheReceiversBandIsHeard) {
  ModemSettings narrow = plain(), wide = plain(), apart = plain();
  narrow.frequency_hz = 24e3, narrow.bandwidth_hz = 2e3;  // within the wide one's 21 to 29 kHz
  apart.frequency_hz = 40e3, apart.bandwidth_hz = 10e3;
  EXPECT_EQ(modem_band(narrow, wide).share, 1.0);
  EXPECT_EQ(modem_band(narrow, wide).frequency_hz, 24e3);
  EXPECT_EQ(modem_band(wide, narrow).share, 0.25);
  EXPECT_EQ(modem_band(wide, wide).share, 1.0);
  EXPECT_EQ(modem_band(wide, apart).share, 0.0);
  // 21 to 29 kHz in 28 to 52.
  ModemSettings above = apart;
  above.bandwidth_hz = 24e3;
  EXPECT_DOUBLE_EQ(modem_band(wide, above).share, 0.125);
  EXPECT_EQ(modem_band(wide, above).frequency_hz, 28.5e3);
  // The energy of a bit over the noise density knows no width of the receiver's band.
  ModemSettings wider = wide;
  wider.bandwidth_hz = 16e3;
  EXPECT_NEAR(modem_bit_error(wide, wide, 0.0), modem_bit_error(wide, wider, -3.0103), 1e-9);

  // Of another band: too weak at the one that it was for, and no disturbance, however near and
  // many.
  Sea sea(std::vector<Vec3>(12, Vec3(1, 0, 5)));
  sea.positions[0] = {300, 0, 5}, sea.positions[1] = {0, 0, 5};
  for (std::size_t i = 2; i < 12; ++i) sea.modems[i] = apart;
  for (std::size_t i = 2; i < 12; ++i) sea.say(i, 0, 20, 0.0);
  sea.say(1, 0, 20, 0.0);
  sea.run(0.0, 2.0);
  EXPECT_EQ(sea.states[0].counts.received, 1u);
  EXPECT_EQ(sea.states[0].counts.too_weak, 10u);
  EXPECT_EQ(sea.states[0].counts.collided, 0u);
  // A louder neighbour disturbs by the share of its power that lies in the band: an eighth, a half.
  const auto snr_db = [](double share) {
    Sea near({{0, 0, 5}, {300, 0, 5}, {600, 0, 5}});
    near.modems[2].frequency_hz += (1.0 - share) * near.modems[2].bandwidth_hz;
    near.modems[2].source_level_db -= 5.0;
    near.say(2, kToAll, 60, 0.0);
    near.say(0, 1, 4, 0.2);
    near.run(0.0, 2.0);
    const auto got = std::ranges::find(near.states[1].reports, 0u,
                                       [](const ModemReport& said) { return said.message.from; });
    EXPECT_EQ(got->event, ModemEvent::kReceived) << share;
    return got->snr_db;
  };
  EXPECT_NEAR(snr_db(0.125) - snr_db(0.5), 10.0 * std::log10(4.0), 0.5);
}

TEST(Modem, SameSeedSameBitsAndStatesAreWholeAndPlain) {
  const auto run = [](std::uint64_t seed) {
    Sea sea({{0, 0, 5}, {900, 0, 5}, {0, 1200, 30}}, ModemSettings{});
    sea.seed = seed;
    for (int i = 0; i < 50; ++i) {
      sea.say(static_cast<std::size_t>(i % 3), kToAll, 16, 2.0 * i);
      sea.run(2.0 * i, 2.0 * i + 2.0, 0.01);
    }
    return sea.states;
  };
  const auto a = run(1), b = run(1), c = run(2);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_TRUE(sim::same_bits(a[i], b[i]));
    sim::check_fields_cover(a[i]);
    EXPECT_TRUE(sim::all_finite(a[i]));
  }
  EXPECT_FALSE(sim::same_bits(a[1].counts, c[1].counts) &&
               sim::same_bits(a[2].counts, c[2].counts));
}

TEST(Modem, ExtremesStayWhole) {
  for (const Vec3& far :
       {Vec3(0, 0, 0), Vec3(4e7, 0, 12000), Vec3(1e-320, 0, 0), Vec3(0, 0, -1e6)}) {
    Sea sea({{0, 0, 0}, far});
    sea.water.profile = gradient(1480.0, 0.016);
    sea.water.path = ModemPath::kBent;
    EXPECT_TRUE(sea.say(0, kToAll, 64, 0.0));
    step(sea.channel(), sea.states, sea.positions, 0.0, 1e6);
    EXPECT_TRUE(sim::all_finite(sea.states[0]) && sim::all_finite(sea.states[1]));
  }
  // A flood: each modem says something each step, for more than their memory holds.
  Sea sea(std::vector<Vec3>(kMostModems, Vec3(10, 0, 10)));
  for (int i = 0; i < 200; ++i) {
    for (std::size_t m = 0; m < sea.states.size(); ++m) sea.say(m, kToAll, 1, 0.01 * i);
    step(sea.channel(), sea.states, sea.positions, 0.01 * i, 0.01 * (i + 1));
  }
  std::uint64_t said = 0;
  for (const ModemState& state : sea.states) said += state.counts.sent + state.counts.refused;
  EXPECT_EQ(said, 200u * kMostModems);
}

// The knob, of a summer profile, in metres of range against the bent ray. Steep paths: the straight
// line is nearly exact. Grazing ones: the quickest way runs along the warm water, and a straight
// line errs by metres.
TEST(Modem, StraightPathsAreNearlyExactWhereTheyAreSteep) {
  ModemWater water;
  water.profile =
      SoundSpeedProfile::of_table({{0.0, 1520.0}, {20.0, 1518.0}, {60.0, 1492.0}, {300.0, 1488.0}})
          .value();
  const auto worst_m = [&](double level_m, double depth_m) {
    std::array<double, 3> worst{};
    for (int i = 0; i < 60; ++i) {
      const Vec3 from(0, 0, 2.0 + 0.2 * i), to(level_m * (1.0 + i / 60.0), 0, depth_m);
      std::array<double, 3> times{};
      for (std::uint32_t path = 0; path < 3; ++path) {
        water.path = static_cast<ModemPath>(path);
        times[path] = modem_travel_s(water, from, to);
      }
      for (std::size_t path = 0; path < 3; ++path)
        worst[path] = std::max(worst[path], std::abs(times[path] - times[2]) * 1500.0);
      // No path is quicker than the ray (Fermat).
      EXPECT_LE(times[2], times[1] + 1e-12);
    }
    return worst;
  };
  const auto steep = worst_m(50.0, 200.0), grazing = worst_m(700.0, 60.0);
  EXPECT_GT(steep[0], 0.5);
  EXPECT_LT(steep[1], 0.05);
  EXPECT_LT(grazing[0], 20.0);
  EXPECT_LT(grazing[1], 20.0);
  fmt::print("steep {:.3f} {:.3f} m, grazing {:.3f} {:.3f} m\n", steep[0], steep[1], grazing[0],
             grazing[1]);
}

}  // namespace
}  // namespace neritic::sonar
