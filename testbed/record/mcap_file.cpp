#include "testbed/record/mcap_file.hpp"

#include <chrono>

#include "engine/core/check.hpp"
#include "engine/core/version.hpp"
#include "engine/recording/mcap_writer.hpp"

namespace neritic::testbed {
namespace {

// How often the writer looks whether its chunk is old.
constexpr auto kLook = std::chrono::milliseconds(100);

}  // namespace

McapFile::McapFile(std::filesystem::path path) : file_(std::move(path)) {
  keep_old(file_.path());
  status_ = file_.claim();
  failed_ = !status_.ok();
  writer_ = std::thread([this] { write_all(); });
}

McapFile::~McapFile() {
  stop();
}

template <class Add>
void McapFile::add(Add&& add) {
  if (failed_) return;
  std::unique_lock lock(mutex_);
  const bool room = changed_.wait_for(lock, std::chrono::nanoseconds(kLongestWait_ns), [&] {
    return failed_ || waiting_.bytes.size() < kMostWaiting_bytes;
  });
  if (failed_) return;
  if (!room) {
    status_ = failure(ErrorCode::kIo, "{}: the disk did not write for {} s", file_.path().string(),
                      kLongestWait_ns / 1'000'000'000);
    failed_ = true;
    return;
  }
  const bool wake = waiting_.items.empty();
  waiting_.items.push_back(add(waiting_.bytes));
  lock.unlock();
  if (wake) changed_.notify_all();
}

std::uint16_t McapFile::add_schema(recording::McapSchema schema) {
  const std::lock_guard lock(mutex_);
  NERITIC_CHECK(schemas_ < kMostSchemas, "{} schemas", schemas_);
  waiting_.items.emplace_back(std::move(schema));
  return ++schemas_;
}

std::uint16_t McapFile::add_channel(recording::McapChannel channel) {
  const std::lock_guard lock(mutex_);
  NERITIC_CHECK(channels_ < kMostChannels, "{} channels", channels_);
  waiting_.items.emplace_back(std::move(channel));
  return channels_++;
}

void McapFile::message(const recording::McapMessage& message) {
  add([&](std::vector<std::byte>& bytes) {
    bytes.insert(bytes.end(), message.data.begin(), message.data.end());
    Kept kept{message, message.data.size()};
    kept.message.data = {};
    return Item(std::move(kept));
  });
}

void McapFile::attachment(const recording::McapAttachment& attachment) {
  add([&](std::vector<std::byte>&) {
    KeptAttachment kept{attachment, {attachment.data.begin(), attachment.data.end()}};
    kept.attachment.data = {};
    return Item(std::move(kept));
  });
}

void McapFile::metadata(const recording::McapMetadata& metadata) {
  add([&](std::vector<std::byte>&) { return Item(metadata); });
}

bool McapFile::ready() const {
  const std::lock_guard lock(mutex_);
  return !failed_ && waiting_.bytes.size() < kMostWaiting_bytes / 4;
}

Status McapFile::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void McapFile::fail(const Status& status) {
  {
    const std::lock_guard lock(mutex_);
    if (status_.ok()) status_ = status;
    failed_ = true;
    waiting_ = {};
  }
  changed_.notify_all();
}

void McapFile::write_all() {
  recording::McapWriter mcap("ros2", program_version());
  TimeNs chunk_begun_ns = 0;  // 0: no message is open
  const auto write = [&]() -> Status {
    const std::string bytes = mcap.take();
    if (bytes.empty()) return {};
    NERITIC_TRY_STATUS(file_.append(bytes));
    return file_.flush();
  };
  while (!failed_) {
    Batch batch;
    bool last = false;
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, kLook, [&] { return stop_ || failed_ || !waiting_.items.empty(); });
      batch = std::exchange(waiting_, {});
      last = stop_;
    }
    changed_.notify_all();
    std::span<const std::byte> rest(batch.bytes);
    for (Item& item : batch.items) {
      if (auto* kept = std::get_if<Kept>(&item)) {
        kept->message.data = rest.first(kept->size);
        rest = rest.subspan(kept->size);
        mcap.message(kept->message);
      } else if (auto* attached = std::get_if<KeptAttachment>(&item)) {
        attached->attachment.data = attached->bytes;
        mcap.attachment(attached->attachment);
      } else if (auto* schema = std::get_if<recording::McapSchema>(&item)) {
        mcap.add_schema(std::move(*schema));
      } else if (auto* channel = std::get_if<recording::McapChannel>(&item)) {
        mcap.add_channel(std::move(*channel));
      } else {
        mcap.metadata(std::get<recording::McapMetadata>(item));
      }
    }
    const TimeNs now = now_ns();
    if (mcap.open_bytes() == 0)
      chunk_begun_ns = 0;
    else if (chunk_begun_ns == 0)
      chunk_begun_ns = now;
    if (chunk_begun_ns != 0 && now - chunk_begun_ns >= kLongestChunk_ns) {
      mcap.end_chunk();
      chunk_begun_ns = 0;
    }
    if (last) mcap.finish();
    if (const Status written = write(); !written.ok()) return fail(written);
    if (last) {
      whole_ = true;
      return;
    }
  }
}

void McapFile::stop() {
  if (!writer_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  writer_.join();
}

Status McapFile::finish() {
  stop();
  if (!status_.ok()) return status_;
  NERITIC_CHECK(whole_, "{} is not whole", file_.path().string());
  const Status named = file_.finish();
  if (!named.ok()) status_ = named;
  return named;
}

}  // namespace neritic::testbed
