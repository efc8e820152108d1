// Text: extents against FreeType's own metrics of the same file, kerning, UTF-8, missing glyphs.
#include "engine/draw2d/font.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "engine/draw2d/utf8.hpp"
#include "tests/support/support.hpp"

namespace neritic::draw2d {
namespace {

constexpr PixelBox kPage{0, 0, 400, 100};

std::size_t inked(const Mask& mask) {
  return static_cast<std::size_t>(
      std::count_if(mask.coverage.begin(), mask.coverage.end(), [](auto c) { return c > 64; }));
}

// The ink of a text drawn at (20, 60), as bytes.
std::vector<std::uint8_t> drawn(const std::string& text, double size_px = 20) {
  return Font().rasterize(20, 60, size_px, text, kPage).coverage;
}

// FreeType's unhinted advance of a text at an em in pixels, in 16.16 and 26.6 fixed point.
double freetype_width(Face which, double em_px, const std::u32string& text) {
  FT_Library library;
  FT_Face face;
  const auto file = font_file(which);
  EXPECT_EQ(FT_Init_FreeType(&library), 0);
  EXPECT_EQ(FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(file.data()),
                               static_cast<FT_Long>(file.size()), 0, &face),
            0);
  EXPECT_EQ(FT_Set_Char_Size(face, 0, std::lround(em_px * 64), 72, 72), 0);
  double width = 0.0;
  FT_UInt before = 0;
  for (const char32_t code : text) {
    const FT_UInt glyph = FT_Get_Char_Index(face, code);
    FT_Vector kerning{};
    if (before) FT_Get_Kerning(face, before, glyph, FT_KERNING_UNFITTED, &kerning);
    EXPECT_EQ(FT_Load_Glyph(face, glyph, FT_LOAD_NO_HINTING), 0);
    width += static_cast<double>(kerning.x) / 64.0 +
             static_cast<double>(face->glyph->linearHoriAdvance) / 65536.0;
    before = glyph;
  }
  FT_Done_Face(face);
  FT_Done_FreeType(library);
  return width;
}

TEST(Font, WidthsAreFreeTypesOwn) {
  // The capitals of DejaVu Sans are 1493 of 2048 units high.
  constexpr double kEmPerCapital = 2048.0 / 1493.0;
  const std::string text = "Range 12.5 m, AVATo \u00b0\u03b8";
  for (const Face face : {Face::kRegular, Face::kBold})
    for (const double em : {10.0, 12.0, 14.0, 18.0, 61.5, 300.0})
      EXPECT_NEAR(Font(face).width(em / kEmPerCapital, text),
                  freetype_width(face, em, U"Range 12.5 m, AVATo \u00b0\u03b8"), 0.05)
          << em;
}

TEST(Font, SizeIsTheHeightOfCapitals) {
  for (const Face face : {Face::kRegular, Face::kBold}) {
    const InkBox box = Font(face).ink(100, "HIE");
    EXPECT_NEAR(box.top, -100, 0.5);
    EXPECT_NEAR(box.bottom, 0, 0.5);
  }
}

TEST(Font, DrawnInkLiesWithinAPixelOfTheInkBox) {
  Font font;
  for (const double size : {8.0, 10.5, 24.0, 61.0})
    for (const std::string text : {"12.5 m", "gjpqy|", "\u03b8\u00b0\u00b2"}) {
      const InkBox box = font.ink(size, text);
      const Mask mask = font.rasterize(20, 70, size, text, {0, 0, 600, 200});
      InkBox seen{1e9, 1e9, -1e9, -1e9};
      for (int y = mask.box.top; y < mask.box.bottom; ++y)
        for (int x = mask.box.left; x < mask.box.right; ++x)
          if (mask.at(x, y) > 0)
            seen = {std::min<double>(seen.left, x), std::min<double>(seen.top, y),
                    std::max<double>(seen.right, x + 1), std::max<double>(seen.bottom, y + 1)};
      EXPECT_NEAR(seen.left, 20 + box.left, 1.5) << text << size;
      EXPECT_NEAR(seen.right, 20 + box.right, 1.5) << text << size;
      EXPECT_NEAR(seen.top, 70 + box.top, 1.5) << text << size;
      EXPECT_NEAR(seen.bottom, 70 + box.bottom, 1.5) << text << size;
    }
}

TEST(Font, KerningPullsAVTogether) {
  const Font font;
  EXPECT_LT(font.width(20, "AV"), font.width(20, "A") + font.width(20, "V") - 0.5);
  EXPECT_DOUBLE_EQ(font.width(20, "HH"), 2 * font.width(20, "H"));
}

TEST(Font, FiguresHaveOneWidthSoThatNumbersDoNotJump) {
  for (const Face face : {Face::kRegular, Face::kBold})
    for (char digit = '1'; digit <= '9'; ++digit)
      EXPECT_DOUBLE_EQ(Font(face).width(20, std::string(1, digit)), Font(face).width(20, "0"));
}

TEST(Font, HasWhatLabelsNeed) {
  const std::u32string needed =
      U"\u00b0\u00b1\u00b2\u00b3\u00b5\u00b7\u00d7\u2070\u2074\u2075\u2076\u2077\u2078\u2079\u207b"
      U"\u2080\u2081\u2082\u2212\u2026\u2190\u2191\u2192\u2193\u2264\u2265\u221a\u2248\u2013\u2014"
      U"\u0391\u0394\u03a3\u03a6\u03a8\u03a9\u03b1\u03b2\u03b3\u03b4\u03b5\u03b7\u03b8\u03bb\u03bc"
      U"\u03be\u03c0\u03c1\u03c3\u03c4\u03c6\u03c8\u03c9";
  for (const Face face : {Face::kRegular, Face::kBold}) {
    const Font font(face);
    for (const char32_t code : needed) EXPECT_TRUE(font.has(code)) << std::uint32_t(code);
    for (char32_t code = U' '; code <= U'~'; ++code) EXPECT_TRUE(font.has(code));
  }
  // Each looks like itself, and like nothing else.
  EXPECT_GT(inked(Font().rasterize(20, 60, 20, "\u00b0", kPage)), 10u);
  EXPECT_NE(drawn("\u03b8"), drawn("0"));
  EXPECT_NE(drawn("\u00b5"), drawn("u"));
}

TEST(Font, MissingGlyphIsDrawnAsABox) {
  const std::string hieroglyph = "\U00013080";
  ASSERT_FALSE(Font().has(U'\U00013080'));
  EXPECT_GT(inked(Font().rasterize(20, 60, 20, hieroglyph, kPage)), 40u);
  EXPECT_EQ(drawn(hieroglyph), drawn("\U0001F93F"));  // the same box for every missing glyph
  EXPECT_GT(Font().width(20, hieroglyph), 5.0);
}

TEST(Font, BytesThatAreNotUtf8AreDrawnAsTheReplacementCharacter) {
  const std::string replacement = "\uFFFD";
  EXPECT_GT(inked(Font().rasterize(20, 60, 20, replacement, kPage)), 40u);
  for (const std::string broken : {"\xff", "\x80", "\xc0", "\xe2", "\xf5"})
    EXPECT_EQ(drawn("a" + broken + "b"), drawn("a" + replacement + "b"));
  EXPECT_EQ(drawn("5\xb0"), drawn("5" + replacement));  // a degree sign in Latin-1
  EXPECT_EQ(drawn("\xe2\x82"), drawn(replacement + replacement));
}

TEST(Utf8, EveryCodePointComesBackAndNothingElsePasses) {
  const auto encode = [](char32_t c) {
    std::string out;
    if (c < 0x80)
      out += static_cast<char>(c);
    else if (c < 0x800)
      out += {static_cast<char>(0xC0 | c >> 6), static_cast<char>(0x80 | (c & 63))};
    else if (c < 0x10000)
      out += {static_cast<char>(0xE0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 63)),
              static_cast<char>(0x80 | (c & 63))};
    else
      out += {static_cast<char>(0xF0 | c >> 18), static_cast<char>(0x80 | (c >> 12 & 63)),
              static_cast<char>(0x80 | (c >> 6 & 63)), static_cast<char>(0x80 | (c & 63))};
    return out;
  };
  for (char32_t c = 0; c <= 0x110010; ++c) {
    const bool valid = c <= 0x10FFFF && !(c >= 0xD800 && c <= 0xDFFF);
    const std::string bytes = encode(c);
    std::string_view text = bytes;
    ASSERT_EQ(take_code_point(text), valid ? c : kReplacement) << std::uint32_t(c);
    ASSERT_EQ(text.size(), valid ? 0 : bytes.size() - 1) << std::uint32_t(c);
  }
  for (const std::string_view overlong : {"\xc0\xaf", "\xe0\x80\xaf", "\xf0\x80\x80\xaf"}) {
    std::string_view text = overlong;
    EXPECT_EQ(take_code_point(text), kReplacement);
  }
}

TEST(Font, BaselineFallsOnAPixelRow) {
  for (const double y : {50.0, 50.4, 49.6}) {
    Font font;
    const Mask mask = font.rasterize(20, y, 9, "HEL", kPage);
    // Row 49 is the last above the baseline: full under the feet, nothing below it.
    int under = 0, below = 0;
    for (int x = mask.box.left; x < mask.box.right; ++x) {
      under = std::max<int>(under, mask.at(x, 49));
      below = std::max<int>(below, mask.at(x, 50));
    }
    EXPECT_GT(under, 200);
    EXPECT_EQ(below, 0);
  }
}

TEST(Font, ZeroAndHugeSizes) {
  Font font;
  EXPECT_EQ(font.width(0, "Range"), 0.0);
  EXPECT_EQ(font.width(-3, "Range"), 0.0);
  EXPECT_TRUE(font.rasterize(20, 60, 0, "Range", kPage).coverage.empty());
  EXPECT_TRUE(font.rasterize(20, 60, 0.2, "Range", kPage).coverage.empty());
  EXPECT_EQ(font.width(20, ""), 0.0);
  EXPECT_TRUE(font.rasterize(20, 60, 20, "", kPage).coverage.size() < 100);
  // A letter larger than the page: inside a stem everything is covered.
  const Mask stem = font.rasterize(-600, 2000, kLargestText_px, "I", kPage);
  ASSERT_EQ(stem.box.width(), kPage.width());
  ASSERT_EQ(stem.box.height(), kPage.height());
  EXPECT_EQ(std::count(stem.coverage.begin(), stem.coverage.end(), 255), std::ptrdiff_t{400} * 100);
  EXPECT_DEATH(font.width(2 * kLargestText_px, "I"), "text of 8192 px");
  EXPECT_DEATH(font.width(std::nan(""), "I"), "text of nan px");
}

TEST(Font, WhatLiesOutsideIsLeftOut) {
  Font font;
  const Mask whole = font.rasterize(20, 60, 20, "Range", kPage);
  const Mask part = font.rasterize(20, 60, 20, "Range", {30, 50, 60, 55});
  ASSERT_FALSE(part.coverage.empty());
  for (int y = part.box.top; y < part.box.bottom; ++y)
    for (int x = part.box.left; x < part.box.right; ++x) EXPECT_EQ(part.at(x, y), whole.at(x, y));
  for (const auto& [x, y] : {std::pair{1e12, 60.0}, {-1e12, 60.0}, {20.0, 1e12}, {20.0, -1e12}})
    EXPECT_EQ(inked(font.rasterize(x, y, 20, "Range", kPage)), 0u);
}

TEST(Font, AMissingFontFileNamesItsPackage) {
  const std::string command = "cmake -DNERITIC_FONT_FOLDER=/nonexistent -P " +
                              (test::source_dir() / "engine/draw2d/fonts.cmake").string() + " 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string said;
  for (int c; (c = std::fgetc(pipe)) != EOF;) said += static_cast<char>(c);
  EXPECT_NE(::pclose(pipe), 0);
  EXPECT_NE(said.find("/nonexistent/DejaVuSans.ttf is missing"), said.npos) << said;
  EXPECT_NE(said.find("fonts-dejavu-core"), said.npos) << said;
}

}  // namespace
}  // namespace neritic::draw2d
