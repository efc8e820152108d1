// Arrays as files, as they are (.npy) or compressed (.npz: a ZIP archive that numpy.load reads;
// PKWARE's APPNOTE 6.3, deflate of RFC 1951 by zlib). Lossless; the same values give the same
// bytes. Any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/npy.hpp"

namespace neritic {

enum class ArrayFormat { kNpy, kNpz };
inline constexpr const char* kArrayEndings[] = {".npy", ".npz"};  // of ArrayFormat, in its order

// One array in an archive, by the file's name without its ending: numpy.load("depth.npz")["depth"].
Status write_npz(const std::filesystem::path& path, NpyType type,
                 std::span<const std::size_t> shape, std::span<const std::byte> bytes);

// The only array of an archive, or the first of those names (without .npy) that it has. Stored and
// deflated arrays are read, those over 4 GB too. kBadInput with the path.
Result<NpyArray> read_npz(const std::filesystem::path& path,
                          std::span<const std::string_view> wanted);
// The same from bytes already in memory; name stands in messages.
Result<NpyArray> parse_npz(std::span<const std::byte> bytes, const std::string& name,
                           std::span<const std::string_view> wanted);

// FOLDER/NAME.npy or FOLDER/NAME.npz.
Status write_array(const std::filesystem::path& folder, const std::string& name, ArrayFormat format,
                   NpyType type, std::span<const std::size_t> shape,
                   std::span<const std::byte> bytes);

template <class T>
Status write_array(const std::filesystem::path& folder, const std::string& name, ArrayFormat format,
                   std::span<const T> values, std::span<const std::size_t> shape) {
  return write_array(folder, name, format, npy_type_of<T>(), shape, std::as_bytes(values));
}

}  // namespace neritic
