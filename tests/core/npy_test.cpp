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

Result<NpyArray> with_header(const std::string& header, std::string_view data) {
  std::string text = "\x93NUMPY\x01";
  text += '\0';
  text += static_cast<char>(header.size());
  text += '\0';
  text += header;
  text += data;
  return parse_npy(std::as_bytes(std::span(text.data(), text.size())), "a.npy");
}

Result<NpyArray> parsed(const std::string& type, const std::string& shape, std::string_view data,
                        const std::string& fortran_order = "False") {
  return with_header("{'descr': '" + type + "', 'fortran_order': " + fortran_order +
                         ", 'shape': " + shape + ", }\n",
                     data);
}

TEST(Npy, WhatIsNotReadIsSaidWithWhatIs) {
  const auto message = [](const Result<NpyArray>& array) {
    return array.ok() ? "" : array.error().message;
  };
  const std::string types = "; accepted: f2 f4 f8 u1 u2 u4 i2 i4 i8 b1";
  EXPECT_EQ(message(parsed("<c8", "(1,)", "12345678")), "a.npy: found element type <c8" + types);
  EXPECT_EQ(message(parsed("|i1", "(1,)", "1")), "a.npy: found element type |i1" + types);
  EXPECT_EQ(message(parsed("<u8", "(1,)", "12345678")), "a.npy: found element type <u8" + types);
  EXPECT_EQ(message(parsed("|u1", "(1,)", "1", "'no'")),
            "a.npy: found fortran_order no; accepted: True or False");
  EXPECT_EQ(message(with_header("{'descr': '|u1', 'shape': (1,), 'fortran_order': F\n", "1")),
            "a.npy: found fortran_order F?; accepted: True or False");
}

// numpy.save of numpy.asfortranarray(numpy.arange(24, dtype='<u2').reshape(2, 3, 4)), in bytes.
TEST(Npy, FortranOrderIsReadAsTheArrayThatWasSaved) {
  std::string bytes;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 2; ++i) bytes += {static_cast<char>(12 * i + 4 * j + k), '\0'};
  const auto array = parsed("<u2", "(2, 3, 4)", bytes, "True");
  ASSERT_TRUE(array.ok()) << array.error().message;
  EXPECT_EQ(array->shape, (std::vector<std::size_t>{2, 3, 4}));
  const auto values = array->to_doubles();
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(values[i], double(i));
  EXPECT_EQ(parsed(">u2", "(2, 1)", std::string_view("\0\1\0\2", 4), "True")->to_doubles(),
            (std::vector<double>{1.0, 2.0}));
  EXPECT_TRUE(parsed("<f4", "(0, 3)", "", "True")->to_doubles().empty());
  EXPECT_EQ(parsed("<u2", "()", std::string_view("\7\0", 2), "True")->to_doubles(),
            std::vector<double>{7.0});
}

// Bytes as NumPy writes them.
TEST(Npy, HalvesAndBigEndianNumbersAreRead) {
  using namespace std::string_view_literals;
  const auto halves =
      parsed("<f2", "(7,)", "\x00\x3c\x00\xc1\x55\x35\xff\x7b\x01\x00\x00\x7c\x00\x80"sv);
  ASSERT_TRUE(halves.ok()) << halves.error().message;
  EXPECT_EQ(halves->to_doubles(),
            (std::vector<double>{1.0, -2.5, 0.333251953125, 65504.0, 0x1p-24,
                                 std::numeric_limits<double>::infinity(), -0.0}));
  EXPECT_TRUE(std::isnan(parsed("<f2", "(1,)", "\x01\x7e"sv)->to_doubles()[0]));
  EXPECT_EQ(parsed(">f2", "(1,)", "\xc1\x00"sv)->to_doubles(), std::vector<double>{-2.5});
  EXPECT_EQ(parsed(">f4", "(2,)", "\x3f\x80\x00\x00\xc0\x20\x00\x00"sv)->to_doubles(),
            (std::vector<double>{1.0, -2.5}));
  EXPECT_EQ(parsed(">u2", "(1,)", "\x07\xee"sv)->to_doubles(), std::vector<double>{2030.0});
  EXPECT_EQ(parsed(">i8", "(1,)", "\xff\xff\xff\xff\xff\xff\xff\xfe"sv)->to_doubles(),
            std::vector<double>{-2.0});
  EXPECT_FALSE(parsed("<f2", "(2,)", "\x00\x3c\x00"sv).ok());
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
