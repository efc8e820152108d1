// An MCAP file that grows while a run goes on: whoever has messages hands them over, and a thread
// of its own compresses them and waits for the disk. Bytes handed over are in the file half a
// second later, so that a killed run, a full disk or a removed one leaves a file that reads up to
// there. The memory is bounded: message() waits while much is not written, up to ten seconds; after
// a failure everything is dropped at once. A file of the same name that is there, whole or cut off
// (.part), is kept as NAME_old1.mcap, as LabRecorder does; a warning says so.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <variant>

#include "engine/core/growing_file.hpp"
#include "engine/recording/mcap_out.hpp"

namespace neritic::testbed {

class McapFile final : public recording::McapOut {
 public:
  static constexpr std::size_t kMostWaiting_bytes = std::size_t{64} << 20;
  static constexpr TimeNs kLongestChunk_ns = 500'000'000, kLongestWait_ns = 10'000'000'000;

  explicit McapFile(std::filesystem::path path);
  ~McapFile() override;

  // Any thread.
  std::uint16_t add_schema(recording::McapSchema schema) override;
  std::uint16_t add_channel(recording::McapChannel channel) override;
  void message(const recording::McapMessage& message) override;
  void attachment(const recording::McapAttachment& attachment) override;
  void metadata(const recording::McapMetadata& metadata) override;
  // The first failure: nothing is taken any more.
  bool failed() const { return failed_; }
  Status status() const;
  // Any thread. False: much waits to be written, so that images should be left out.
  bool ready() const;

  // The owner, once: writes all, and gives the file its name.
  Status finish();

 private:
  struct Kept {  // a message; its bytes are the next of Batch::bytes
    recording::McapMessage message;
    std::size_t size = 0;
  };
  struct KeptAttachment {
    recording::McapAttachment attachment;
    std::vector<std::byte> bytes;
  };
  using Item = std::variant<Kept, recording::McapSchema, recording::McapChannel, KeptAttachment,
                            recording::McapMetadata>;
  struct Batch {
    std::vector<Item> items;
    std::vector<std::byte> bytes;
  };
  template <class Add>
  void add(Add&& add);
  void write_all();
  void fail(const Status& status);
  void stop();

  GrowingFile file_;          // the writer's; the owner's before and after it
  mutable std::mutex mutex_;  // guards the next five
  Batch waiting_;
  std::uint16_t schemas_ = 0, channels_ = 0;
  Status status_;
  bool stop_ = false, whole_ = false;
  std::atomic<bool> failed_{false};
  std::condition_variable changed_;
  std::thread writer_;  // last: uses the others
};

}  // namespace neritic::testbed
