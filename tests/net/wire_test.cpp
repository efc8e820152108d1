// The heart strap's, the jacket's and the microphone's bytes.
#include "engine/net/heart_strap.hpp"
#include "engine/net/jacket_wire.hpp"
#include "engine/net/rtp.hpp"
#include "tests/net/vectors.hpp"

namespace neritic::net {
namespace {

using nlohmann::json;

TEST(HeartStrap, HeartRatesHaveTheirVectorsValues) {
  for (const json all = wire_vectors(); const json& vector : all["ble_0x2A37"]["vectors"]) {
    const auto packet = decode_heart_rate(bytes_of(vector));
    const json& says = vector["expected"];
    ASSERT_EQ(packet.ok(), !says.contains("error")) << vector.dump();
    if (!packet.ok()) continue;
    EXPECT_EQ(packet->bpm, says["hr"]);
    ASSERT_EQ(packet->intervals.size(), says["rr_ms"].size());
    for (std::size_t i = 0; i < packet->intervals.size(); ++i)
      EXPECT_EQ(1e3 * kRrUnit_s * packet->intervals[i], says["rr_ms"][i].get<double>());
    if (says.contains("contact")) {
      EXPECT_EQ(packet->contact.has_value(), !says["contact"].is_null());
      if (packet->contact) {
        EXPECT_EQ(*packet->contact, says["contact"].get<bool>());
      }
    }
    if (says.contains("energy_kJ")) {
      EXPECT_EQ(packet->energy_kj, says["energy_kJ"].get<int>());
    }
    const auto again = decode_heart_rate(encode_heart_rate(*packet));
    ASSERT_TRUE(again.ok());
    EXPECT_EQ(again->intervals, packet->intervals);
    EXPECT_EQ(again->bpm, packet->bpm);
    EXPECT_EQ(again->contact, packet->contact);
  }
}

TEST(HeartStrap, EcgFramesHaveTheirVectorsValues) {
  for (const json all = wire_vectors(); const json& vector : all["polar_pmd"]["frames"]) {
    const auto frame = decode_ecg(bytes_of(vector));
    const json& says = vector["expected"];
    ASSERT_EQ(frame.ok(), !says.contains("error")) << vector.dump();
    if (!frame.ok()) continue;
    EXPECT_TRUE(looks_like_ecg(bytes_of(vector)));
    EXPECT_EQ(frame->samples_uv, says["samples_uV"].get<std::vector<std::int32_t>>());
    if (says.contains("timestamp_ns")) {
      EXPECT_EQ(frame->time_ns, says["timestamp_ns"].get<std::uint64_t>());
    }
    EXPECT_EQ(encode_ecg(*frame), bytes_of(vector));
  }
}

TEST(HeartStrap, EcgSamplesAreSpreadBetweenFrames) {
  const json check = wire_vectors()["polar_pmd"]["timestamps"]["check"];
  const std::uint64_t before = check["frame1_last"], last = check["frame2_last"];
  const std::size_t n = check["n"];
  EXPECT_EQ(ecg_time_ns(0, n, last, before), check["first_sample_frame2_ns"].get<std::uint64_t>());
  EXPECT_EQ(ecg_time_ns(n - 1, n, last, before), last);
  EXPECT_EQ(ecg_time_ns(n - 1, n, last, {}), last);
  EXPECT_NEAR(static_cast<double>(last - ecg_time_ns(0, n, last, {})), 72e9 / 130.0, 1.0);
}

TEST(JacketWire, PacketsHaveTheirVectorsValues) {
  const json facts = wire_vectors()["jacket"];
  EXPECT_EQ(crc16(std::as_bytes(std::span("123456789", 9))), 0x29b1);
  for (const json& vector : facts["vectors"]) {
    const auto packet = decode_jacket(bytes_of(vector));
    ASSERT_TRUE(packet.ok()) << packet.error().message;
    ASSERT_TRUE(packet->counters.has_value());
    const json& says = vector["expected"];
    EXPECT_EQ(packet->counters->sequence, says["seq"]);
    if (says.contains("t_us")) {
      EXPECT_EQ(packet->counters->time_us, says["t_us"]);
    }
    EXPECT_EQ(packet->counters->presses, says["presses"]);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string name = std::array{"inflate", "deflate", "dump"}[i];
      EXPECT_EQ(packet->pressed[i], says[name].get<bool>()) << name;
      if (says.contains(name + "_ms")) {
        EXPECT_EQ(packet->counters->pressed_ms[i], says[name + "_ms"]) << name;
      }
    }
    EXPECT_EQ(encode_jacket(*packet), bytes_of(vector));
  }
  for (const json& vector : facts["compat_vectors"]) {
    const auto packet = decode_jacket(bytes_of(vector));
    ASSERT_EQ(packet.ok(), vector["expected"].is_array()) << vector.dump();
    if (packet.ok()) {
      EXPECT_EQ(packet->pressed, (vector["expected"].get<std::array<bool, 3>>()));
    }
  }
}

TEST(JacketWire, AListMayHaveSpacesAnywhereBetweenItsWords) {
  const auto decoded = [](std::string_view text) {
    return decode_jacket(std::as_bytes(std::span(text.data(), text.size())));
  };
  for (const char* text : {" [true,false,false]", "\r\n\t[1 ,0, 0]", "[ true,false,false ] \n"}) {
    const auto packet = decoded(text);
    ASSERT_TRUE(packet.ok()) << text;
    EXPECT_EQ(packet->pressed, (std::array{true, false, false})) << text;
  }
  for (const char* text : {"", " ", "   ", " true", " [tr ue,false,false]"})
    EXPECT_FALSE(decoded(text).ok()) << text;
}

TEST(JacketWire, OneWrongBitIsRefused) {
  const auto bytes = bytes_of(wire_vectors()["jacket"]["vectors"][0]);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto wrong = bytes;
    wrong[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    EXPECT_FALSE(decode_jacket(wrong).ok()) << bit;
  }
}

TEST(Rtp, SamplesComeBackAndExtensionsAreSkipped) {
  const RtpPacket packet{11, 65535, 0xfffffff0U, 7, {0.0F, 0.5F, -1.0F, 0.25F}};
  auto bytes = encode_rtp(packet);
  ASSERT_EQ(bytes.size(), 20u);
  auto again = decode_rtp(bytes).value();
  EXPECT_EQ(again.samples, packet.samples);
  EXPECT_EQ(again.sequence, 65535);
  EXPECT_EQ(again.timestamp, 0xfffffff0U);
  // A source list of one, an extension of one word, two bytes of padding.
  bytes[0] = std::byte{0xb1};
  const std::array<std::byte, 12> more{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4},
                                       std::byte{0}, std::byte{0}, std::byte{0}, std::byte{1}};
  bytes.insert(bytes.begin() + 12, more.begin(), more.end());
  bytes.insert(bytes.end(), {std::byte{0}, std::byte{2}});
  again = decode_rtp(bytes).value();
  EXPECT_EQ(again.samples, packet.samples);
}

// RFC 3551: 0 is PCMU, 8 PCMA, 10 L16 of two channels, 11 of one; a session assigns 96 to 127. 72
// is what a report (RTCP, type 200) looks like.
TEST(Rtp, SoundOfOtherKindsIsRefusedByItsPayloadType) {
  for (int type = 0; type < 128; ++type) {
    const auto packet =
        decode_rtp(encode_rtp({static_cast<std::uint8_t>(type), 1, 2, 3, {0.5F, 0.5F}}));
    EXPECT_EQ(packet.ok(), type == 11 || type >= 96) << type;
    if (packet.ok()) continue;
    EXPECT_EQ(packet.error().code, ErrorCode::kUnsupported);
    EXPECT_EQ(packet.error().message,
              fmt::format("RTP: found payload type {}; accepted: 11 and 96 to 127, 16 bits in one "
                          "channel",
                          type));
  }
}

TEST(Rtp, LengthsThatLieAreRefused) {
  const auto good = encode_rtp({96, 1, 2, 3, {0.5F, 0.5F}});
  for (std::size_t size = 0; size < 14; ++size)
    EXPECT_FALSE(decode_rtp(Bytes(good).first(size)).ok()) << size;
  auto wrong = good;
  wrong[0] = std::byte{0x40};
  EXPECT_FALSE(decode_rtp(wrong).ok());
  wrong = good;
  wrong[0] = std::byte{0xa0}, wrong.back() = std::byte{200};
  EXPECT_FALSE(decode_rtp(wrong).ok());
  wrong = good;
  wrong[0] = std::byte{0x8f};
  EXPECT_FALSE(decode_rtp(wrong).ok());
}

}  // namespace
}  // namespace neritic::net
