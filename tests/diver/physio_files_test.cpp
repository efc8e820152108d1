// Readers of recordings: every kind of .wav, WFDB, .csv; and what they say of files that are none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "diver/heart_detector.hpp"
#include "diver/physio_csv.hpp"
#include "diver/physio_wav.hpp"
#include "diver/physio_wfdb.hpp"
#include "engine/core/files.hpp"
#include "tests/diver/physio_signals.hpp"
#include "tests/support/support.hpp"

namespace neritic::diver {
namespace {

using ::testing::HasSubstr;

std::vector<std::byte> bytes_of(const std::string& text) {
  std::vector<std::byte> out(text.size());
  std::memcpy(out.data(), text.data(), text.size());
  return out;
}

std::string number(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i));
  return out;
}

std::string wav_of(int kind, int channels, int bits, const std::string& data) {
  const std::string format = number(static_cast<std::uint64_t>(kind), 2) +
                             number(static_cast<std::uint64_t>(channels), 2) + number(8000, 4) +
                             number(0, 6) + number(static_cast<std::uint64_t>(bits), 2);
  return "RIFF" + number(0, 4) + "WAVE" + "junk" + number(3, 4) + std::string("abc\0", 4) + "fmt " +
         number(16, 4) + format + "data" + number(data.size(), 4) + data;
}

TEST(WavFile, EveryWidthGivesTheSameSignal) {
  struct Kind {
    int kind, bits;
    std::string data;  // half, minus half, minus one
  };
  const auto bits_of = [](auto value) {
    std::string out(sizeof value, '\0');
    std::memcpy(out.data(), &value, sizeof value);
    return out;
  };
  const Kind kinds[] = {
      {1, 8, number(192, 1) + number(64, 1) + number(0, 1)},
      {1, 16, number(0x4000, 2) + number(0xC000, 2) + number(0x8000, 2)},
      {1, 24, number(0x400000, 3) + number(0xC00000, 3) + number(0x800000, 3)},
      {1, 32, number(0x40000000, 4) + number(0xC0000000, 4) + number(0x80000000, 4)},
      {3, 32, bits_of(0.5f) + bits_of(-0.5f) + bits_of(-1.0f)},
      {3, 64, bits_of(0.5) + bits_of(-0.5) + bits_of(-1.0)}};
  for (const Kind& kind : kinds) {
    const auto wav = parse_wav(bytes_of(wav_of(kind.kind, 1, kind.bits, kind.data)), "a.wav", 0);
    ASSERT_TRUE(wav.ok()) << wav.error().message;
    EXPECT_EQ(wav->rate_hz, 8000.0);
    EXPECT_EQ(wav->samples, (std::vector{0.5, -0.5, -1.0})) << kind.kind << " " << kind.bits;
  }
}

TEST(WavFile, ChannelsAreToldApart) {
  const auto bytes = bytes_of(
      wav_of(1, 2, 16, number(0x4000, 2) + number(0, 2) + number(0x2000, 2) + number(0x1000, 2)));
  EXPECT_EQ(parse_wav(bytes, "a.wav", 0)->samples, (std::vector{0.5, 0.25}));
  EXPECT_EQ(parse_wav(bytes, "a.wav", 1)->samples, (std::vector{0.0, 0.125}));
  EXPECT_THAT(parse_wav(bytes, "a.wav", 2).error().message, HasSubstr("accepted: 0 to 1"));
}

// A recorder that was cut off has left both lengths as it wrote them at first: 0, the heading's, or
// all ones. An empty recording that says so is empty, whatever follows it.
TEST(WavFile, ARecorderThatWasCutOffGivesWhatIsThere) {
  const std::string data = number(0x4000, 2) + number(0xC000, 2);
  std::string file = wav_of(1, 1, 16, data);
  const std::size_t length_at = file.size() - data.size() - 4;
  for (const std::uint64_t riff : {0u, 36u, 0xFFFFFFFFu})
    for (const std::uint64_t length : {0u, 0xFFFFFFFFu}) {
      if (riff == 0xFFFFFFFFu && length == 0) continue;  // no recorder
      file.replace(4, 4, number(riff, 4));
      file.replace(length_at, 4, number(length, 4));
      const auto wav = parse_wav(bytes_of(file), "a.wav", 0);
      ASSERT_TRUE(wav.ok()) << riff << " " << length << wav.error().message;
      EXPECT_EQ(wav->samples, (std::vector{0.5, -0.5}));
    }
  std::string empty = wav_of(1, 1, 16, "") + "LIST" + number(4, 4) + "INFO";
  empty.replace(4, 4, number(empty.size() - 8, 4));
  EXPECT_THAT(parse_wav(bytes_of(empty), "a.wav", 0).error().message, HasSubstr("no samples"));
}

TEST(WavFile, WhatIsNoneIsAnErrorInWords) {
  EXPECT_THAT(parse_wav({}, "a.wav", 0).error().message, HasSubstr("a.wav: found no RIFF"));
  EXPECT_THAT(parse_wav(bytes_of(wav_of(2, 1, 4, "abcd")), "a.wav", 0).error().message,
              HasSubstr("found format 2 of 4 bit"));
  EXPECT_THAT(parse_wav(bytes_of(wav_of(1, 1, 16, "")), "a.wav", 0).error().message,
              HasSubstr("no samples"));
}

TEST(WfdbFile, SignalsOfFormat212And16AreThoseOfTheirBits) {
  // 100, -100, 2047, missing: low bytes 100, and the high halves in the second byte of three.
  const std::string packed{'\x64', '\xF0', '\x9C', '\xFF', '\x87', '\x00'};
  const std::string text =
      "r 2 360 2\nr.dat 212 200(0)/mV 12 0 100 2147 0 I\nr.dat 212 100 12 0 -100 0 0 II\n";
  auto header = parse_wfdb_header(text, "r.hea");
  ASSERT_TRUE(header.ok()) << header.error().message;
  header->signals[1].has_checksum = false;
  const auto one = parse_wfdb_signal(*header, 0, bytes_of(packed), "r.dat");
  ASSERT_TRUE(one.ok()) << one.error().message;
  EXPECT_EQ(one->samples[0], 0.5);
  EXPECT_EQ(one->samples[1], 2047.0 / 200.0);
  const auto two = parse_wfdb_signal(*header, 1, bytes_of(packed), "r.dat");
  EXPECT_EQ(two->samples[0], -1.0);
  EXPECT_TRUE(std::isnan(two->samples[1]));
  header->signals[0].checksum = 5;
  EXPECT_THAT(parse_wfdb_signal(*header, 0, bytes_of(packed), "r.dat").error().message,
              HasSubstr("checksum of 2147"));
  header->samples = 100;
  EXPECT_THAT(parse_wfdb_signal(*header, 1, bytes_of(packed), "r.dat").error().message,
              HasSubstr("found 2 samples; accepted: 100"));
  const auto plain = parse_wfdb_header("r 1 130.16\nr.dat 16\n", "r.hea");
  ASSERT_TRUE(plain.ok());
  EXPECT_EQ(parse_wfdb_signal(*plain, 0, bytes_of(number(0xFF38, 2)), "r.dat")->samples,
            (std::vector{-1.0}));
}

// The same five numbers in every packing of signal(5), and the mark of a missing one.
TEST(WfdbFile, EveryFormatGivesTheSameSignal) {
  const std::vector<std::int64_t> values{5, -7, 120, -120, 33};
  const auto word = [](std::int64_t value, std::size_t bytes) {
    return number(static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << (8 * bytes)) - 1),
                  bytes);
  };
  const auto simple = [&](std::size_t bytes, std::int64_t offset) {
    std::string out;
    for (const std::int64_t value : values) out += word(value + offset, bytes);
    return out + word(offset - (std::int64_t{1} << (8 * bytes - 1)), bytes);
  };
  std::string big_endian, differences, packed310, packed311;
  for (const std::int64_t value : values) {
    const std::string little = word(value, 2);
    big_endian += {little[1], little[0]};
    differences += word(value - (value == 5 ? 0 : values[differences.size() - 1]), 1);
  }
  big_endian += std::string("\x80\0", 2);
  const std::int64_t six[] = {5, -7, 120, -120, 33, -512};
  for (int group = 0; group < 2; ++group) {
    std::uint64_t ten[3];
    for (int k = 0; k < 3; ++k) ten[k] = static_cast<std::uint64_t>(six[3 * group + k]) & 0x3FF;
    packed310 += number(ten[0] << 1 | (ten[2] & 0x1F) << 11, 2) +
                 number(ten[1] << 1 | (ten[2] >> 5) << 11, 2);
    packed311 += number(ten[0] | ten[1] << 10 | ten[2] << 20, 4);
  }
  for (const auto& [format, bytes] : {std::pair{16, simple(2, 0)},
                                      {24, simple(3, 0)},
                                      {32, simple(4, 0)},
                                      {80, simple(1, 128)},
                                      {160, simple(2, 32768)},
                                      {61, big_endian},
                                      {310, packed310},
                                      {311, packed311}}) {
    const auto header = parse_wfdb_header(fmt::format("r 1 100\nr.dat {} 1\n", format), "r.hea");
    ASSERT_TRUE(header.ok()) << header.error().message;
    const auto read = parse_wfdb_signal(*header, 0, bytes_of(bytes), "r.dat");
    ASSERT_TRUE(read.ok()) << read.error().message;
    ASSERT_EQ(read->samples.size(), 6u) << format;
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_EQ(read->samples[i], static_cast<double>(values[i])) << format;
    EXPECT_TRUE(std::isnan(read->samples[5])) << format;
  }
  const auto header = parse_wfdb_header("r 1 100\nr.dat 8 1 8 0 0\n", "r.hea");
  ASSERT_TRUE(header.ok()) << header.error().message;
  const auto counted = parse_wfdb_signal(*header, 0, bytes_of(differences), "r.dat");
  ASSERT_EQ(counted->samples.size(), 5u);
  EXPECT_EQ(counted->samples[1], -7.0);
}

TEST(WfdbFile, SignalsOfSeveralSamplesAFrameHaveTheirOwnRate) {
  const auto header = parse_wfdb_header("r 2 100 2\nr.dat 16x3 1\nr.dat 16 1\n", "r.hea");
  ASSERT_TRUE(header.ok()) << header.error().message;
  std::string bytes;
  for (const int value : {1, 2, 3, 10, 4, 5, 6, 20})
    bytes += number(static_cast<std::uint64_t>(value), 2);
  const auto fast = parse_wfdb_signal(*header, 0, bytes_of(bytes), "r.dat");
  const auto slow = parse_wfdb_signal(*header, 1, bytes_of(bytes), "r.dat");
  ASSERT_TRUE(fast.ok() && slow.ok());
  EXPECT_EQ(fast->rate_hz, 300.0);
  EXPECT_EQ(fast->frame_hz, 100.0);
  EXPECT_EQ(fast->samples, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(slow->rate_hz, 100.0);
  EXPECT_EQ(slow->samples, (std::vector<double>{10, 20}));
}

TEST(WfdbFile, HeadersThatAreNoneSayTheLine) {
  const auto message = [](const char* text) {
    return parse_wfdb_header(text, "r.hea").error().message;
  };
  EXPECT_THAT(message(""), HasSubstr("no record line"));
  EXPECT_THAT(message("r 1 nan\nr.dat 16\n"), HasSubstr("r.hea:1: found a rate of 'nan'"));
  EXPECT_THAT(message("r 2 360\nr.dat 16\n"), HasSubstr("1 of 2 signals"));
  EXPECT_THAT(message("# note\nr 1 360\nr.dat 22\n"), HasSubstr("r.hea:3: found format '22'"));
  EXPECT_THAT(message("r 1 360\nr.dat 16x0\n"), HasSubstr("format '16x0'"));
  EXPECT_THAT(message("r 1 360\nr.dat 16:4\n"), HasSubstr("format '16:4'"));
  EXPECT_THAT(message("r/3 1 360\n"), HasSubstr("several segments"));
}

TEST(WfdbFile, AnnotationsSkipNotesAndLeaps) {
  const auto word = [](int code, int value) {
    return number(static_cast<std::uint64_t>(code << 10 | value), 2);
  };
  const std::string atr = word(28, 10) + word(63, 3) + std::string("(N\0\0", 4) + word(1, 90) +
                          word(59, 0) + number(1, 2) + number(2, 2) + word(5, 4) + word(0, 0);
  const auto beats = parse_wfdb_beats(bytes_of(atr), 100.0, "r.atr");
  ASSERT_TRUE(beats.ok()) << beats.error().message;
  ASSERT_EQ(beats->size(), 2u);
  EXPECT_EQ((*beats)[0].time_s, 1.0);
  EXPECT_EQ((*beats)[0].code, 1);
  EXPECT_EQ((*beats)[1].time_s, (100.0 + 65536.0 + 2.0 + 4.0) / 100.0);
  EXPECT_THAT(parse_wfdb_beats(bytes_of("abc"), 100.0, "r.atr").error().message,
              HasSubstr("no end mark"));
}

TEST(SignalCsv, TimeGivesTheRateAndGapsAreMissing) {
  const auto csv = parse_csv("time_ms,note,ecg\n0,a,1\n10,b,2\n20,,\n30,,4\n70,,8\n60,,7\n80,,9\n",
                             "a.csv", {"ecg", 0.0});
  ASSERT_TRUE(csv.ok()) << csv.error().message;
  EXPECT_NEAR(csv->rate_hz, 100.0, 1e-9);
  EXPECT_EQ(csv->refused, 1u);
  ASSERT_EQ(csv->samples.size(), 9u);
  EXPECT_EQ(csv->samples[1], 2.0);
  for (const int missing : {2, 4, 5, 6})
    EXPECT_TRUE(std::isnan(csv->samples[static_cast<std::size_t>(missing)])) << missing;
  EXPECT_EQ(csv->samples[7], 8.0);
}

TEST(SignalCsv, AStrapsClockThatDriftsIsFollowed) {
  std::string text = "t_s,ecg\n";
  for (int i = 0; i < 2000; ++i)
    text += fmt::format("{:.4f},{}\n", i / 130.16 + 0.002 * (i % 3), i);
  const auto csv = parse_csv(text, "a.csv", {});
  ASSERT_TRUE(csv.ok());
  EXPECT_NEAR(csv->rate_hz, 130.16, 0.05);
  EXPECT_EQ(csv->samples.size(), 2000u);
}

// Stamps that are rounded, jitter, miss rows: the rate is that of the clock behind them.
TEST(SignalCsv, TheRateIsThatOfTheClock) {
  const RandomKey key = RandomKey{7};
  const auto read = [&](double rate_hz, const auto& stamp_s, const auto& kept) {
    std::string text = "time_s,ecg\n";
    for (std::uint64_t i = 0; i < 20000; ++i)
      if (kept(i))
        text += fmt::format("{:.6f},{}\n", stamp_s(static_cast<double>(i) / rate_hz, i), i);
    const auto csv = parse_csv(text, "a.csv", {});
    EXPECT_TRUE(csv.ok()) << csv.error().message;
    return csv.ok() ? *csv : Recording{};
  };
  const auto all = [](std::uint64_t) { return true; };
  const auto exact = [](double t, std::uint64_t) { return t; };
  for (const double rate_hz : {50.0, 130.0, 250.0, 360.0, 1000.0, 0.1}) {
    EXPECT_EQ(read(rate_hz, exact, all).rate_hz, rate_hz);
    EXPECT_TRUE(rate_hz < 50.0 || check_ecg_rate(read(rate_hz, exact, all).rate_hz).ok());
  }
  const auto whole_ms = [](double t, std::uint64_t) { return 1e-3 * std::round(1e3 * t); };
  EXPECT_NEAR(read(360.0, whole_ms, all).rate_hz, 360.0, 0.01);
  const auto jitters = [&](double t, std::uint64_t i) { return t + 0.8e-3 * test::gauss(key, i); };
  const Recording jittered = read(360.0, jitters, all);
  EXPECT_NEAR(jittered.rate_hz, 360.0, 0.05);
  EXPECT_LT(jittered.missing, 40u);
  EXPECT_NEAR(static_cast<double>(jittered.samples.size()), 20000.0 - jittered.refused, 40.0);
  const Recording halved =
      read(360.0, exact, [&](std::uint64_t i) { return random_uniform(key, i) < 0.5; });
  EXPECT_NEAR(halved.rate_hz, 360.0, 0.01);
  EXPECT_NEAR(static_cast<double>(halved.missing), 10000.0, 300.0);
  EXPECT_NEAR(static_cast<double>(halved.samples.size()), 20000.0, 20.0);
  EXPECT_EQ(halved.refused, 0u);
}

// As heart straps send: all samples of a packet have one time, and packets come unevenly or not.
TEST(SignalCsv, APacketsSamplesShareATimeWhereTheRateIsKnown) {
  std::string text = "time_s,ecg\n";
  for (int packet = 0; packet < 100; ++packet)
    for (int i = 0; i < 72 && packet != 50; ++i)
      text += fmt::format("{:.3f},{}\n", 0.2 * packet + 0.03 * (packet % 3), 72 * packet + i);
  const auto csv = parse_csv(text, "a.csv", {"", 360.0});
  ASSERT_TRUE(csv.ok());
  EXPECT_EQ(csv->refused, 0u);
  EXPECT_NEAR(static_cast<double>(csv->missing), 72.0, 16.0);
  EXPECT_NEAR(static_cast<double>(csv->samples.size()), 7200.0, 16.0);
  EXPECT_EQ(csv->samples[72 * 49 + 71], 72.0 * 49 + 71);
}

// As spreadsheets and recorders write them.
TEST(SignalCsv, HeadingsAreTakenAsTheyCome) {
  for (const char* text :
       {"\xEF\xBB\xBFtime_s,ecg\n0,5\n0.01,6\n0.02,7\n",
        "time_s\tecg\r\n0\t5\r\n0.01\t6\r\n0.02\t7\r\n", "Time (ms);ECG\n0;5\n10;6\n20;7\n",
        "\"t [ms]\",\"ecg\"\n0,5\n10,6\n20,7\n",
        "sample,Time [us],ecg\n0,0,5\n1,10000,6\n2,20000,7\n",
        ",timestamp_ms,ecg\n0,1700000000000,5\n1,1700000000010,6\n2,1700000000020,7\n"}) {
    const auto csv = parse_csv(text, "a.csv", {});
    ASSERT_TRUE(csv.ok()) << text << csv.error().message;
    EXPECT_NEAR(csv->rate_hz, 100.0, 1e-9) << text;
    EXPECT_EQ(csv->samples, (std::vector<double>{5.0, 6.0, 7.0})) << text;
  }
  // A column that counts rows is no signal, unless it is asked for.
  const char* counted = "index,ecg\n0,5\n1,6\n2,5\n";
  EXPECT_EQ(parse_csv(counted, "a.csv", {"", 100.0})->channel, "ecg");
  EXPECT_EQ(parse_csv(counted, "a.csv", {"index", 100.0})->channel, "index");
  EXPECT_THAT(
      parse_csv("time,ecg\n1700000000000000,1\n1700000000010000,2\n", "a.csv", {}).error().message,
      HasSubstr("found no time in column 'time'"));
}

TEST(SignalCsv, DecimalCommasCountBetweenSemicolons) {
  const auto table =
      parse_sample_table("time_s;ecg_mv;valid\n0,004;-0,25;1\n0.008;1,5e-1;true\n", "e.csv");
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_EQ(table->columns[0], (std::vector<double>{0.004, 0.008}));
  EXPECT_EQ(table->columns[1], (std::vector<double>{-0.25, 0.15}));
  const auto cut = parse_sample_table("time_s,ecg_mv\n0,004,0,25\n", "e.csv");
  ASSERT_FALSE(cut.ok());
  EXPECT_EQ(
      cut.error().message,
      "e.csv:2: found 4 columns; accepted: 2 (commas part cells here; decimal commas are read "
      "where semicolons alone do)");
}

TEST(SignalCsv, WhatIsNoneIsAnErrorInWords) {
  const auto message = [](const char* text) {
    return parse_csv(text, "a.csv", {}).error().message;
  };
  EXPECT_THAT(message(""), HasSubstr("found no row"));
  EXPECT_THAT(message("t,ecg\n"), HasSubstr("found no row"));
  EXPECT_THAT(message("0.1,2\n0.2,3\n"), HasSubstr("a.csv:1: found a number in the heading"));
  EXPECT_THAT(message("ecg\n1\n2\n"), HasSubstr("with fs_hz= or --rate"));
  EXPECT_THAT(message("t,ecg\n0,1\n0.1,2,3\n"), HasSubstr("a.csv:3: found 3 columns"));
  EXPECT_THAT(message("t,ecg\n0,1\n0.001,2\n0.002,2\n1e9,3\n"), HasSubstr("missing samples"));
  EXPECT_TRUE(parse_csv("ecg\n1\n", "a.csv", {"", 360.0}).ok());
}

}  // namespace
}  // namespace neritic::diver
