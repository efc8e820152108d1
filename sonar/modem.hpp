// Sound that carries messages between agents: travel time by the water's sound speed, spreading and
// absorption against ambient noise and other senders, half duplex, bit rate, loss by the
// signal-to-noise ratio. Depths are positive, positions north, east, down, metres; times seconds.
// Pure functions; any thread. Not modelled: echoes of surface and bottom as signals of
// their own (their fading is, statistically), Doppler, shadows of what lies between.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/core/math.hpp"
#include "sonar/acoustics.hpp"
#include "sonar/sound_speed_profile.hpp"

namespace neritic::sonar {

// How the paths' travel times are found: the knob of this model, from cheap to exact.
enum class ModemPath : std::uint32_t {
  kConstant,  // the sound speed half way between the two depths
  kStraight,  // the integral of 1 / c along the straight line
  kBent,      // along the ray that bends from one to the other (Snell)
};

struct ModemWater {
  Water water{.temperature_c = 10.0};
  std::optional<SoundSpeedProfile> profile;  // absent: Mackenzie's speed at the depth
  ModemPath path = ModemPath::kStraight;
  double spreading = 2.0;  // 2: spheres; 1: cylinders (shallow ducts); 1.5: between ("practical")
  double wind_m_s = 5.0, shipping = 0.5;  // of the ambient noise
};

// A device, in the manner of small commercial modems.
struct ModemSettings {
  double source_level_db = 170.0;  // re 1 uPa at 1 m
  double frequency_hz = 25e3, bandwidth_hz = 8e3;
  double bit_rate_hz = 500.0;
  double preamble_s = 0.05;  // before the bits
  double coding_gain_db = 3.0;
  double detection_db = 3.0;   // least signal-to-noise ratio in the band that starts a reception
  double self_noise_db = 0.0;  // spectrum level of the carrier's own noise, re 1 uPa^2/Hz; 0: none
  bool fading = true;          // Rayleigh: many echoes; false: a single steady path
};

// ---- Links ------------------------------------------------------------------------------------
// The sender decides a message's level, band, bit rate, preamble and code; the receiver decides its
// own band, its noise and what it detects. A path fades alike both ways.

// One way. NaN gives NaN; nothing to travel takes no time.
double modem_travel_s(const ModemWater& water, const Vec3& from_ned_m, const Vec3& to_ned_m);
// The unit vector from a receiver towards where sound comes from: along the straight line, or with
// kBent along the ray as it arrives. At the sender's own place: straight down.
Vec3 modem_arrival(const ModemWater& water, const Vec3& from_ned_m, const Vec3& to_ned_m);
// 10 k log10 r + alpha r, dB re 1 m, r from kNearestRange_m on.
double modem_loss_db(const ModemWater& water, double frequency_hz, const Vec3& from_ned_m,
                     const Vec3& to_ned_m);
// The part of the sender's power, spread evenly over its band, that lies in the receiver's band.
struct ModemBand {
  double share = 0.0;         // 0: the bands have nothing in common; 1: the receiver covers all
  double frequency_hz = 0.0;  // the middle of what they have in common
};
ModemBand modem_band(const ModemSettings& sender, const ModemSettings& receiver);
// The level in the receiver's band, dB re 1 uPa, of what the sender sends from another place; none:
// their bands have nothing in common. NED places, metres, in water.
std::optional<double> modem_level_db(const ModemWater& water, const ModemSettings& sender,
                                     const ModemSettings& receiver, const Vec3& from_ned_m,
                                     const Vec3& to_ned_m);
// In a receiver's band, dB re 1 uPa^2: ambient and its own.
double modem_noise_db(const ModemWater& water, const ModemSettings& receiver);
double modem_duration_s(const ModemSettings& sender, std::size_t bytes);
// Errors of non-coherent frequency keying in noise (Proakis, Digital Communications, 4th ed., eq.
// 5.2-69: exp(-g / 2) / 2), or with Rayleigh fading (eq. 14.3-12: 1 / (2 + g)), if either modem's
// paths fade; g: energy of a bit, of the sender's rate and code, over the noise density. snr_db: in
// the receiver's band.
double modem_bit_error(const ModemSettings& sender, const ModemSettings& receiver, double snr_db);
// For all bits, by independent errors.
double modem_success(const ModemSettings& sender, const ModemSettings& receiver, double snr_db,
                     std::size_t bytes);

// ---- A channel --------------------------------------------------------------------------------
inline constexpr std::size_t kModemWords = 8;  // of a message: 64 bytes
inline constexpr std::uint64_t kToAll = ~std::uint64_t{0};

enum class ModemKind : std::uint64_t {
  kMessage,
  kRequest,  // for an answer, from which the sender finds its range
  kAnswer,
};

struct ModemMessage {
  ModemKind kind = ModemKind::kMessage;
  std::uint64_t from = 0, to = kToAll;             // numbers of modems
  std::uint64_t sequence = 0;                      // of its sender
  std::uint64_t bytes = 0;                         // up to 8 kModemWords
  std::array<std::uint64_t, kModemWords> words{};  // little-endian

  static void fields(auto&& field, auto& self) {
    field("kind", self.kind);
    field("from", self.from);
    field("to", self.to);
    field("sequence", self.sequence);
    field("bytes", self.bytes);
    field("words", self.words);
  }
};

// The fate of a message at a modem: at its sender, or at one that it was for.
enum class ModemEvent : std::uint64_t {
  kSent,
  kRefused,  // the modem was sending, the message was too long, or kFlying travelled already
  kReceived,
  // Lost, by the cause.
  kTooWeak,  // also: in a band that it does not hear, or through the surface
  kNoisy,
  kCollided,
  kWasSending,
};

struct ModemReport {
  ModemEvent event = ModemEvent::kSent;
  ModemMessage message;  // without its words where it was lost
  double at_s = 0.0;     // when the modem knew: as it began to send, or when the last bit had come
  double sent_s = 0.0,
         heard_s = 0.0;  // its first sound, here and there: their difference is the travel
  double snr_db = 0.0;   // of one that came

  static void fields(auto&& field, auto& self) {
    field("event", self.event);
    field("message", self.message);
    field("at_s", self.at_s);
    field("sent_s", self.sent_s);
    field("heard_s", self.heard_s);
    field("snr_db", self.snr_db);
  }
};

// The fate of messages at a modem, counted since the start.
struct ModemCounts {
  std::uint64_t sent = 0, refused = 0;  // refused: see kRefused
  std::uint64_t received = 0;
  std::uint64_t too_weak = 0, noisy = 0, collided = 0, was_sending = 0;  // lost, by their cause

  // As many as there are reports.
  std::uint64_t all() const {
    return sent + refused + received + too_weak + noisy + collided + was_sending;
  }

  static void fields(auto&& field, auto& self) {
    field("sent", self.sent);
    field("refused", self.refused);
    field("received", self.received);
    field("too_weak", self.too_weak);
    field("noisy", self.noisy);
    field("collided", self.collided);
    field("was_sending", self.was_sending);
  }
};

// One modem's part of the channel: plain numbers, which a simulation's state can hold.
struct ModemState {
  // kFlying: that travel at once. A modem of the default settings sends 8 bytes in 0.18 s, so that
  // their sound may travel for 5.7 s, 8.5 km, before one more is refused.
  static constexpr std::size_t kFlying = 32, kHearing = 8, kKept = 24;
  struct Flight {  // a message on its way
    ModemMessage message;
    double sent_s = 0.0, ends_s = 0.0;  // at the sender
    Vec3 from_ned_m{0.0};               // where it was sent
    std::uint64_t flying = 0;           // 1: some modem may still hear it
    std::uint64_t begun = 0;            // bit i: it has reached modem i

    static void fields(auto&& field, auto& self) {
      field("message", self.message);
      field("sent_s", self.sent_s);
      field("ends_s", self.ends_s);
      field("from_ned_m", self.from_ned_m);
      field("flying", self.flying);
      field("begun", self.begun);
    }
  };
  struct Hearing {  // a message that is arriving
    ModemMessage message;
    double sent_s = 0.0, begins_s = 0.0, ends_s = 0.0;
    double power = 0.0, others_power = 0.0;   // uPa^2; the most at once of other messages
    std::uint64_t arriving = 0, sending = 0;  // sending: the modem itself sent meanwhile
    Vec3 from_ned_m{0.0}, to_ned_m{0.0};      // where it was sent, and where its first sound came

    static void fields(auto&& field, auto& self) {
      field("message", self.message);
      field("sent_s", self.sent_s);
      field("begins_s", self.begins_s);
      field("ends_s", self.ends_s);
      field("power", self.power);
      field("others_power", self.others_power);
      field("arriving", self.arriving);
      field("sending", self.sending);
      field("from_ned_m", self.from_ned_m);
      field("to_ned_m", self.to_ned_m);
    }
  };
  std::array<Flight, kFlying> flights{};
  std::array<Hearing, kHearing> hearings{};
  std::array<ModemReport, kKept> reports{};  // a ring: report k of counts.all() is at k % kKept
  ModemCounts counts;

  static void fields(auto&& field, auto& self) {
    field("flights", self.flights);
    field("hearings", self.hearings);
    field("reports", self.reports);
    field("counts", self.counts);
  }
};

inline constexpr std::size_t kMostModems = 64;  // bits of Flight::begun

// The devices of a channel and its water. Preconditions of the functions below: as many states and
// positions as modems, at most kMostModems.
struct ModemChannel {
  const ModemWater& water;
  std::span<const ModemSettings> modems;
  std::uint64_t seed = 0;
};

// Sends a message at now_s, in the step to come or, as an answer to what came in it, in the one
// just stepped: then it arrives as if it had been sent in time. False, and counted: the modem is
// still sending, has kFlying messages on the way, or the message has no bytes or too many. from and
// sequence are filled in. A modem above the surface neither sends nor receives.
bool send(const ModemChannel& channel, std::span<ModemState> states, std::size_t from,
          ModemMessage message, double now_s, const Vec3& from_ned_m);

// Delivers what arrives in (from_s, to_s], with the modems where they are at its end. Messages are
// received when their last bit has come; each modem's newest reports are in its ring.
void step(const ModemChannel& channel, std::span<ModemState> states,
          std::span<const Vec3> positions_ned_m, double from_s, double to_s);

// The hearing that a report of a message received in the newest step ended. The report is of this
// state; null for others.
const ModemState::Hearing* heard_as(const ModemState& state, const ModemReport& report);

// Numbers of a ring's reports that are new since there were `seen`: [first, counts.all()).
std::uint64_t first_kept(const ModemState& state, std::uint64_t seen);

}  // namespace neritic::sonar
