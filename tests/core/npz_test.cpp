// Compressed arrays, read by numpy: the same values, smaller files.
#include "engine/core/npz.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

TEST(Npz, NumpyReadsTheSameValuesFromASmallerFile) {
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
    GTEST_SKIP() << "no numpy";
  const test::ScratchFolder folder;
  std::vector<float> depth(60 * 80);
  for (std::size_t i = 0; i < depth.size(); ++i)
    depth[i] = i % 7 == 0 ? std::numeric_limits<float>::infinity() : 1.0f + 0.01f * float(i / 80);
  const std::vector<std::uint16_t> labels(depth.size(), 65532), none;
  const std::size_t shape[] = {60, 80}, line[] = {depth.size()}, no[] = {0, 3};
  const auto npz = ArrayFormat::kNpz;
  for (const ArrayFormat format : {ArrayFormat::kNpy, npz})
    ASSERT_TRUE(
        write_array(folder.path(), "depth", format, std::span<const float>(depth), shape).ok());
  ASSERT_TRUE(
      write_array(folder.path(), "labels", npz, std::span<const std::uint16_t>(labels), line).ok());
  ASSERT_TRUE(
      write_array(folder.path(), "none", npz, std::span<const std::uint16_t>(none), no).ok());
  EXPECT_LT(2 * std::filesystem::file_size(folder / "depth.npz"),
            std::filesystem::file_size(folder / "depth.npy"));
  ASSERT_TRUE(write_text(folder / "check.py", R"(
import zipfile, numpy as np
assert zipfile.ZipFile("depth.npz").testzip() is None
a, b = np.load("depth.npz")["depth"], np.load("depth.npy")
assert a.dtype == np.float32 and a.shape == (60, 80) and (a == b).all() and np.isinf(a[0, 0])
l = np.load("labels.npz")["labels"]
assert l.dtype == np.uint16 and l.shape == (4800,) and (l == 65532).all()
assert np.load("none.npz")["none"].shape == (0, 3)
)")
                  .ok());
  EXPECT_EQ(
      std::system(
          fmt::format("cd '{}' && /usr/bin/python3 check.py", folder.path().string()).c_str()),
      0);
}

}  // namespace
}  // namespace neritic
