#include "engine/core/npy.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

TEST(Npy, WhatIsWrittenReadsBack) {
  const test::ScratchFolder folder;
  const std::vector<float> values{1.5f, -2.0f, 3.25f, 0.0f, 1e30f, -1e-30f};
  ASSERT_TRUE(write_npy(folder / "a.npy", values, {2, 3}).ok());
  const auto array = read_npy(folder / "a.npy");
  ASSERT_TRUE(array.ok()) << array.error().message;
  EXPECT_EQ(array->shape, (std::vector<std::size_t>{2, 3}));
  const auto doubles = array->to_doubles();
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(doubles[i], double(values[i]));
}

TEST(Npy, DataStartsOnAMultipleOf64Bytes) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_npy(folder / "a.npy", std::vector<std::uint16_t>(7, 1), {7}).ok());
  const auto bytes = read_file(folder / "a.npy");
  ASSERT_TRUE(bytes.ok());
  EXPECT_EQ((bytes->size() - 14) % 64, 0u);
}

TEST(Npy, AnElementTypeThatIsNotReadIsQuotedAlone) {
  std::string text = "\x93NUMPY\x01";
  text += '\0';
  const std::string header = "{'descr': '>f4', 'fortran_order': False, 'shape': (1,), }\n";
  text += static_cast<char>(header.size());
  text += '\0';
  text += header + "1234";
  const auto array = parse_npy(std::as_bytes(std::span(text.data(), text.size())), "a.npy");
  ASSERT_FALSE(array.ok());
  EXPECT_NE(array.error().message.find("element type >f4;"), std::string::npos)
      << array.error().message;
}

TEST(Npy, EveryTruncationIsRefusedWithTheFileName) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_npy(folder / "a.npy", std::vector<double>(4, 2.0), {2, 2}).ok());
  const auto bytes = read_file(folder / "a.npy");
  ASSERT_TRUE(bytes.ok());
  for (std::size_t n = 0; n < bytes->size(); ++n) {
    const auto array = parse_npy(std::span(*bytes).first(n), "cut.npy");
    ASSERT_FALSE(array.ok()) << n;
    EXPECT_NE(array.error().message.find("cut.npy"), std::string::npos);
  }
}

}  // namespace
}  // namespace neritic
