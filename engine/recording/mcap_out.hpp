// Where the messages of a recording go: into bytes at once (McapWriter), or to a thread that makes
// them. Writers of messages need no more than this.
#pragma once

#include "engine/recording/mcap.hpp"

namespace neritic::recording {

class McapOut {
 public:
  // Ids are 16 bits; a schema's 0 stands for none.
  static constexpr std::size_t kMostSchemas = 65535, kMostChannels = 65535;

  virtual ~McapOut() = default;
  // Preconditions: fewer than the most of them; a channel's schema is known, or 0.
  virtual std::uint16_t add_schema(McapSchema schema) = 0;
  virtual std::uint16_t add_channel(McapChannel channel) = 0;
  // Precondition: the channel is known.
  virtual void message(const McapMessage& message) = 0;
  virtual void attachment(const McapAttachment& attachment) = 0;
  virtual void metadata(const McapMetadata& metadata) = 0;
};

}  // namespace neritic::recording
