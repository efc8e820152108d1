// The fuzz targets' contract is libFuzzer's: LLVMFuzzerTestOneInput reads any bytes, returns 0, and
// aborts where a promise is broken. replay.cpp turns a target into a plain program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace neritic::fuzz {
inline std::span<const std::byte> as_bytes(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span(data, size));
}
}  // namespace neritic::fuzz
