// Any bytes as a .npy or .npz file: an Error in one line, or an array whose bytes fit its shape.
#include "engine/core/check.hpp"
#include "engine/core/npz.hpp"
#include "tests/fuzz/replay.hpp"

namespace {
using namespace neritic;

void check(const Result<NpyArray>& array) {
  if (!array.ok()) {
    const std::string& message = array.error().message;
    NERITIC_CHECK(message.starts_with("fuzz.np") && message.find('\n') == message.npos, "{}",
                  message);
    return;
  }
  NERITIC_CHECK(array->bytes.size() == array->count() * npy_type_size(array->type),
                "{} bytes for {} elements", array->bytes.size(), array->count());
  NERITIC_CHECK(array->to_doubles().size() == array->count(), "{} elements", array->count());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = fuzz::as_bytes(data, size);
  constexpr std::string_view kNames[] = {"depth"};
  check(parse_npy(bytes, "fuzz.npy"));
  check(parse_npz(bytes, "fuzz.npz", kNames));
  return 0;
}
