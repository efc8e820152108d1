#include "testbed/sensors/validation.hpp"

#include "engine/core/log.hpp"

namespace neritic::testbed {

Status check_validation(const gpu::Device& device) {
  device.wait_idle();
  const auto& messages = device.validation_log().messages;
  for (const std::string& message : messages) log_warn("validation: {}", message);
  if (messages.empty()) return {};
  return failure(ErrorCode::kUnsupported, "validation reported {} messages", messages.size());
}

}  // namespace neritic::testbed
