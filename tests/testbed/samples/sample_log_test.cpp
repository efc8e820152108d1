#include "testbed/samples/sample_log.hpp"

#include <limits>

#include "engine/core/files.hpp"
#include "engine/recording/mcap_copy.hpp"
#include "engine/recording/mcap_writer.hpp"
#include "engine/sim/fields.hpp"
#include "testbed/samples/authority.hpp"
#include "testbed/samples/recorded_source.hpp"
#include "tests/support/support.hpp"
#include "tests/testbed/samples/streams.hpp"

namespace neritic::testbed {
namespace {

// One sample of each stream, every number of its payload another one.
SampleLog log_of_every_kind() {
  const StreamTable table = diver_and_rov();
  SampleLog log{0.25, 42, logged_streams(table), {"simulation", "motion_suit"}, {}, {1, 2, 3, 4}};
  double next = 0.5;
  for (StreamId id = 0; id < table.size(); ++id) {
    Payload payload = empty_payload(table[id].kind);
    std::visit(
        [&](auto& value) {
          sim::for_each_scalar(value, [&](auto& scalar) {
            scalar = static_cast<std::remove_reference_t<decltype(scalar)>>(next++);
          });
        },
        payload);
    log.entries.push_back({id / 8u, {{id, 1, 7 + id, -3, 1'000'000'000'000}, payload}});
  }
  return log;
}

// The entries that a replay needs; the readings that leave a run come again by themselves.
std::vector<SampleLog::Entry> inputs(const SampleLog& log) {
  std::vector<SampleLog::Entry> out;
  for (const SampleLog::Entry& entry : log.entries)
    if (enters(entry.sample.kind())) out.push_back(entry);
  return out;
}

TEST(SampleLog, EveryKindReadsBackAsItWasWritten) {
  const test::ScratchFolder folder;
  const SampleLog log = log_of_every_kind();
  ASSERT_TRUE(write_sample_log(folder / "run.log", log).ok());
  const auto read = read_sample_log(folder / "run.log");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->step_s, 0.25);
  EXPECT_EQ(read->seed, 42u);
  EXPECT_EQ(read->streams.size(), inputs(log).size());
  EXPECT_EQ(read->sources, log.sources);
  EXPECT_EQ(read->hashes, log.hashes);
  const auto kept = inputs(log);
  ASSERT_EQ(read->entries.size(), kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(read->entries[i].step, kept[i].step);
    SampleHeader expected = kept[i].sample.header, found = read->entries[i].sample.header;
    EXPECT_EQ(read->streams[found.stream].name, log.streams[expected.stream].name);
    expected.stream = found.stream = 0;
    EXPECT_TRUE(sim::same_bits(found, expected));
    std::visit(
        [&](const auto& value) {
          using T = std::remove_cvref_t<decltype(value)>;
          EXPECT_TRUE(sim::same_bits(value, std::get<T>(kept[i].sample.payload))) << i;
        },
        read->entries[i].sample.payload);
  }
}

TEST(SampleLog, TheSceneAndTheStateThatItBeginsWithAreInIt) {
  SampleLog log = log_of_every_kind();
  log.first_step = 480;
  log.scene_path = "/seas/reef.toml";
  log.scene_text = "[physics]\n";
  log.scene_hash = 0x0123456789abcdefull;
  log.start_state = {std::byte{7}, std::byte{0}, std::byte{9}};
  const std::string bytes = encode_sample_log(log);
  const auto read = parse_sample_log(std::as_bytes(std::span(bytes)), "run.mcap");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->first_step, 480u);
  EXPECT_EQ(read->scene_path, log.scene_path);
  EXPECT_EQ(read->scene_text, log.scene_text);
  EXPECT_EQ(read->scene_hash, log.scene_hash);
  EXPECT_EQ(read->start_state, log.start_state);
}

TEST(SampleLog, TopicsHaveNamesThatRosAccepts) {
  EXPECT_EQ(topic_of("rov/imu"), "/rov/imu");
  EXPECT_EQ(topic_of("2 divers/joints"), "/_2_divers/joints");
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// A copy without the messages from one to before another.
class CopyWithout final : public recording::McapCopy {
 public:
  CopyWithout(recording::McapOut& out, int from, int to) : McapCopy(out), from_(from), to_(to) {}
  Status message(const recording::McapMessage& message) override {
    const int index = index_++;
    return index >= from_ && index < to_ ? Status() : McapCopy::message(message);
  }

 private:
  int index_ = 0, from_, to_;
};

// As a repaired recording is, of which a chunk was damaged.
TEST(SampleLog, ItEndsBeforeStepsThatAreMissing) {
  const SampleLog whole = log_of_every_kind();
  const auto kept = inputs(whole);
  recording::McapWriter file("ros2", "test");
  SampleLogWriter out(file, whole);
  out.source(whole.sources[0]);
  for (std::uint64_t step = 0; step < 4; ++step) {
    if (step == 1) out.source(whole.sources[1]);
    if (step > 0) out.sample(kept[0].sample);
    out.step(step, 0.25 * static_cast<double>(step), 0, whole.hashes[step]);
  }
  file.finish();
  const std::string bytes = file.take();
  const auto without = [&](int from, int to) {
    recording::McapWriter writer("ros2", "test");
    CopyWithout copy(writer, from, to);
    EXPECT_TRUE(recording::read_mcap(*recording::mcap_of(bytes_of(bytes)), "", copy).ok());
    writer.finish();
    return parse_sample_log(bytes_of(writer.take()), "run.mcap");
  };
  const auto all = without(0, 0);
  ASSERT_TRUE(all.ok()) << all.error().message;
  EXPECT_TRUE(all->whole);
  EXPECT_EQ(all->steps(), 3u);
  // Steps 1 and 2, with their samples.
  const auto middle = without(3, 7);
  ASSERT_TRUE(middle.ok()) << middle.error().message;
  EXPECT_FALSE(middle->whole);
  EXPECT_EQ(middle->damage, "steps 1 to 2 are missing");
  EXPECT_EQ(middle->steps(), 0u);
  // Step 1 with the name of the source whose samples come next.
  const auto named = without(2, 5);
  ASSERT_TRUE(named.ok()) << named.error().message;
  EXPECT_EQ(named->damage, "step 1 is missing");
  EXPECT_TRUE(named->entries.empty());
  const auto start = without(0, 2);
  ASSERT_FALSE(start.ok());
  EXPECT_EQ(start.error().message, "run.mcap: step 0 is missing: it cannot be replayed");
  // The name alone is no damage, but a wrong recording.
  const auto nameless = without(2, 3);
  ASSERT_FALSE(nameless.ok());
  EXPECT_EQ(
      nameless.error().message,
      "run.mcap: found sample 0 of source 1; accepted: that of a source named before it, 1 so far");
}

// A run that was killed, wherever in the file (tests/recording tries every byte): the whole steps
// of its whole chunks, with their samples.
TEST(SampleLog, ACutOffLogReadsUpToItsLastWholeChunk) {
  const SampleLog whole = log_of_every_kind();
  recording::McapWriter file("ros2", "test");
  SampleLogWriter out(file, whole);
  for (const std::string& source : whole.sources) out.source(source);
  std::size_t next = 0;
  for (std::uint64_t step = 0; step < whole.hashes.size(); ++step) {
    out.step(step, 0.25 * static_cast<double>(step), 0, whole.hashes[step]);
    for (; next < whole.entries.size() && whole.entries[next].step == step; ++next)
      out.sample(whole.entries[next].sample);
    file.end_chunk();
  }
  file.finish();
  const std::string bytes = file.take();
  std::uint64_t steps = 0;
  for (std::size_t n = 0; n < bytes.size(); n += 97) {
    const auto log = parse_sample_log(bytes_of(bytes.substr(0, n)), "cut.mcap");
    if (!log.ok()) {
      EXPECT_EQ(steps, 0u);
      EXPECT_TRUE(log.error().message.starts_with("cut.mcap: ")) << log.error().message;
      EXPECT_EQ(log.error().message.find('\n'), std::string::npos);
      continue;
    }
    EXPECT_FALSE(log->whole);
    EXPECT_GE(log->steps(), steps);
    steps = log->steps();
    const auto kept = inputs(whole);
    const auto used = std::ranges::count_if(
        kept, [&](const SampleLog::Entry& entry) { return entry.step < steps; });
    ASSERT_EQ(log->entries.size(), static_cast<std::size_t>(used)) << n;
    ASSERT_TRUE(std::equal(log->hashes.begin(), log->hashes.end(), whole.hashes.begin())) << n;
  }
  EXPECT_EQ(steps, 3u);
  const auto longer = parse_sample_log(bytes_of(bytes + "x"), "long.mcap");
  ASSERT_TRUE(longer.ok());
  EXPECT_FALSE(longer->whole);
  EXPECT_NE(longer->damage.find("other bytes than the end of a file"), std::string::npos);
}

// Its run failed after samples were drained: they have no step.
TEST(SampleLog, SamplesOfAStepThatDidNotEndAreLeftOut) {
  const SampleLog log = log_of_every_kind();
  recording::McapWriter file("ros2", "test");
  SampleLogWriter out(file, log);
  for (const std::string& source : log.sources) out.source(source);
  out.step(0, 0.0, 0, 1);
  out.sample(log.entries[0].sample);
  out.step(1, 0.25, 0, 2);
  out.sample(log.entries[1].sample);
  file.finish();
  const std::string bytes = file.take();
  const auto read = parse_sample_log(bytes_of(bytes), "run.mcap");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_TRUE(read->whole);
  EXPECT_EQ(read->steps(), 1u);
  EXPECT_EQ(read->entries.size(), 1u);
}

struct BadLog {
  const char* says;
  void (*spoil)(SampleLog&);
};
void PrintTo(const BadLog& bad, std::ostream* out) {
  *out << bad.says;
}
class BadSampleLog : public testing::TestWithParam<BadLog> {};

TEST_P(BadSampleLog, IsTheDocumentedLine) {
  SampleLog log = log_of_every_kind();
  GetParam().spoil(log);
  const auto read = parse_sample_log(bytes_of(encode_sample_log(log)), "bad.log");
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().message, GetParam().says);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadSampleLog,
    testing::Values(BadLog{"bad.log: found a step of 0 s; accepted: over 0 to 1 s",
                           [](SampleLog& log) { log.step_s = 0.0; }},
                    BadLog{"bad.log: found a number that is not finite in sample 0, of "
                           "diver/joints at step 0; accepted: finite numbers",
                           [](SampleLog& log) {
                             std::get<BodyJoints>(log.entries[0].sample.payload).joints[2].y =
                                 std::numeric_limits<double>::quiet_NaN();
                           }},
                    BadLog{"bad.log: source 1: found '?'; accepted: 1 to 64 printable ASCII "
                           "characters without spaces, but autopilot, nobody, recording, "
                           "simulation",
                           [](SampleLog& log) { log.sources[1] = "\n"; }}));

TEST(SampleLog, AnOlderVersionsLogAndOtherStreamsAreRefusedInOneLine) {
  const std::string old = "NRTCLOG3 and so on";
  EXPECT_EQ(parse_sample_log(bytes_of(old), "old.log").error().message,
            "old.log: found no MCAP file; accepted: a recording of this program, or another MCAP "
            "file");
  const SampleLog log = log_of_every_kind();
  EXPECT_TRUE(check_streams(log, diver_and_rov(), "run.log").ok());
  StreamTable other;
  other.add_diver("buddy");
  EXPECT_EQ(check_streams(log, other, "run.log").error().message,
            "run.log: samples of diver/joints found; accepted: of the scene's streams");
  StreamTable more = diver_and_rov();
  more.add_diver("buddy");
  EXPECT_TRUE(check_streams(log, more, "run.log").ok());
}

TEST(SampleLog, AnEventOfASourceThatTheLogDoesNotNameIsRefusedInOneLine) {
  const StreamTable table = diver_and_rov();
  for (const SourceId named : {0u, 1u, 2u}) {
    SampleLog log{1.0 / 240.0, 0, logged_streams(table), {"simulation", "suit"}, {}, {1, 2}};
    const Event event{EventKind::kSetAuthority, 0, static_cast<std::uint64_t>(Authority::kLive),
                      named};
    log.entries.push_back({0, sample_of(table, "diver/event", 1, 0, event)});
    SampleInbox inbox(table, 8);
    ASSERT_TRUE(inbox.open("pad").ok());  // has the number 1 here
    auto source = RecordedSource::create(log, table, "run.log");
    const Status polled = source->poll(inbox, 0.0);
    if (named == 2) {
      EXPECT_EQ(polled.error().message,
                "run.log: diver/event at step 0: an event of source 2 found; accepted: of the "
                "log's 2");
      continue;
    }
    ASSERT_TRUE(polled.ok()) << polled.error().message;
    EXPECT_EQ(std::get<Event>(inbox.drain()[0].payload).source, named == 0 ? 0u : 2u);
  }
}

}  // namespace
}  // namespace neritic::testbed
