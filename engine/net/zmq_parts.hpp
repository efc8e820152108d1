// Shared by the sockets over ZeroMQ: owners of its objects. Included by their sources alone. One
// thread each.
#pragma once

#include <zmq.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/net/wire_bytes.hpp"

namespace neritic::net {

struct CloseZmqSocket {
  void operator()(void* socket) const { zmq_close(socket); }
};
using ZmqSocket = std::unique_ptr<void, CloseZmqSocket>;
struct EndZmqContext {
  void operator()(void* context) const { zmq_ctx_term(context); }
};
using ZmqContext = std::unique_ptr<void, EndZmqContext>;

class ZmqMessage {
 public:
  ZmqMessage() { zmq_msg_init(&message_); }
  explicit ZmqMessage(Bytes bytes) {
    NERITIC_CHECK(zmq_msg_init_size(&message_, bytes.size()) == 0, "{} bytes", bytes.size());
    if (!bytes.empty()) std::memcpy(zmq_msg_data(&message_), bytes.data(), bytes.size());
  }
  ZmqMessage(const ZmqMessage&) = delete;
  ZmqMessage& operator=(const ZmqMessage&) = delete;
  ~ZmqMessage() { zmq_msg_close(&message_); }
  zmq_msg_t* get() { return &message_; }
  bool receive(void* socket) { return zmq_msg_recv(&message_, socket, ZMQ_DONTWAIT) >= 0; }
  bool more() const { return zmq_msg_more(&message_) != 0; }
  Bytes bytes() {
    return {static_cast<const std::byte*>(zmq_msg_data(&message_)), zmq_msg_size(&message_)};
  }
  std::string_view text() {
    return {static_cast<const char*>(zmq_msg_data(&message_)), zmq_msg_size(&message_)};
  }

 private:
  zmq_msg_t message_;
};

inline void set_option(void* socket, int option, int value) {
  NERITIC_CHECK(zmq_setsockopt(socket, option, &value, sizeof value) == 0, "option {}: {}", option,
                zmq_strerror(errno));
}
inline void set_option(void* socket, int option, const std::string& text) {
  NERITIC_CHECK(zmq_setsockopt(socket, option, text.c_str(), text.size() + 1) == 0, "option {}: {}",
                option, zmq_strerror(errno));
}

// All frames but the last are sent with more to come. Only the first can fail: the library takes or
// leaves a message as a whole.
inline bool send_frames(void* socket, const std::vector<Bytes>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ZmqMessage frame(frames[i]);
    const int more = i + 1 < frames.size() ? ZMQ_SNDMORE : 0;
    if (zmq_msg_send(frame.get(), socket, more | ZMQ_DONTWAIT) < 0) return false;
  }
  return true;
}

}  // namespace neritic::net
