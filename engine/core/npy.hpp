// NumPy's .npy files (format 1.0 to 3.0). Writing: any of the element types below, little-endian,
// C order. Reading: those of either byte order, in C or Fortran order (which a transposed array is
// saved in), converted to C order and to what the caller asks for; other element types are refused
// by name. Source: NumPy Enhancement Proposal 1.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic {

enum class NpyType {
  kFloat16,
  kFloat32,
  kFloat64,
  kUint8,
  kUint16,
  kUint32,
  kInt16,
  kInt32,
  kInt64,
  kBool
};

struct NpyArray {
  NpyType type = NpyType::kFloat32;
  std::vector<std::size_t> shape;
  std::vector<std::byte> bytes;  // C order, little-endian

  std::size_t count() const;
  // Every element converted to double (exact for all types but large int64).
  std::vector<double> to_doubles() const;
};

template <class T>
constexpr NpyType npy_type_of() {
  if constexpr (std::is_same_v<T, float>) return NpyType::kFloat32;
  if constexpr (std::is_same_v<T, double>) return NpyType::kFloat64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return NpyType::kUint8;
  if constexpr (std::is_same_v<T, std::uint16_t>) return NpyType::kUint16;
}

std::size_t npy_type_size(NpyType type);
bool is_float(NpyType type);
// "<f4" and so on.
std::string npy_type_name(NpyType type);

// kBadInput with path and reason.
Result<NpyArray> read_npy(const std::filesystem::path& path);
// The same from bytes already in memory; name stands in messages. For fuzzing and archives.
Result<NpyArray> parse_npy(std::span<const std::byte> bytes, const std::string& name);

// The file's bytes.
std::vector<std::byte> npy_bytes(NpyType type, std::span<const std::size_t> shape,
                                 std::span<const std::byte> bytes);
Status write_npy(const std::filesystem::path& path, NpyType type,
                 std::span<const std::size_t> shape, std::span<const std::byte> bytes);
Status write_npy(const std::filesystem::path& path, std::span<const float> values,
                 std::initializer_list<std::size_t> shape);
Status write_npy(const std::filesystem::path& path, std::span<const double> values,
                 std::initializer_list<std::size_t> shape);
Status write_npy(const std::filesystem::path& path, std::span<const std::uint16_t> values,
                 std::initializer_list<std::size_t> shape);
Status write_npy(const std::filesystem::path& path, std::span<const std::uint8_t> values,
                 std::initializer_list<std::size_t> shape);

}  // namespace neritic
