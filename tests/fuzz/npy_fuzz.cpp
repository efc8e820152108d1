// Any bytes as a .npy file: an Error in one line, or an array whose bytes fit its shape.
#include "engine/core/check.hpp"
#include "engine/core/npy.hpp"
#include "tests/fuzz/replay.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace neritic;
  const auto array = parse_npy(fuzz::as_bytes(data, size), "fuzz.npy");
  if (!array.ok()) {
    const std::string& message = array.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.npy") && message.find('\n') == message.npos, "{}",
                  message);
    return 0;
  }
  NERITIC_CHECK(array->bytes.size() == array->count() * npy_type_size(array->type),
                "{} bytes for {} elements", array->bytes.size(), array->count());
  NERITIC_CHECK(array->to_doubles().size() == array->count(), "{} elements", array->count());
  return 0;
}
