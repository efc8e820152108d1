#include "sonar/stroke_font.hpp"

namespace neritic::sonar {
namespace {

// '!' (33) to '~' (126).
constexpr const char* kAscii[] = {
    "0i0e 0c0c",                         // !
    "0i0g 2i2g",                         // "
    "1c1i 3c3i 0e4e 0g4g",               // #
    "4h3i1i0h0g1f3f4e4d3c1c0d 2b2j",     // $
    "0c4i 0i1i1h0h0i 3c4c4d3d3c",        // %
    "4c1h1i2i2h0e0d1c2c4e",              // &
    "0i0g",                              // '
    "1i0g0d1b",                          // (
    "0i1g1d0b",                          // )
    "0f4d 0d4f 2g2c",                    // *
    "0e4e 2c2g",                         // +
    "0c0b",                              // ,
    "0e3e",                              // -
    "0c0c",                              // .
    "0b3i",                              // /
    "1c3c4d4h3i1i0h0d1c",                // 0
    "1h2i2c 1c3c",                       // 1
    "0h1i3i4h4g0d0c4c",                  // 2
    "0h1i3i4h4g3f1f 3f4e4d3c1c0d",       // 3
    "3c3i0e4e",                          // 4
    "4i0i0f3f4e4d3c1c0d",                // 5
    "4h3i1i0h0d1c3c4d4e3f0f",            // 6
    "0i4i1c",                            // 7
    "1f0g0h1i3i4h4g3f1f0e0d1c3c4d4e3f",  // 8
    "0d1c3c4d4h3i1i0h0g1f4f",            // 9
    "0d0d 0f0f",                         // :
    "0d0b 0f0f",                         // ;
    "3g0e3c",                            // <
    "0d3d 0f3f",                         // =
    "0g3e0c",                            // >
    "0h1i3i4h4g2f2e 2c2c",               // ?
    "3e2f1e2d3e4e4h3i1i0h0d1c3c",        // @
    "0c2i4c 1e3e",                       // A
    "0c0i3i4h4g3f0f 3f4e4d3c0c",         // B
    "4h3i1i0h0d1c3c4d",                  // C
    "0c0i2i4g4e2c0c",                    // D
    "4i0i0c4c 0f3f",                     // E
    "4i0i0c 0f3f",                       // F
    "4h3i1i0h0d1c3c4d4f2f",              // G
    "0c0i 4c4i 0f4f",                    // H
    "0c0i",                              // I
    "3i3d2c1c0d",                        // J
    "0c0i 4i0e 1f4c",                    // K
    "0i0c4c",                            // L
    "0c0i2f4i4c",                        // M
    "0c0i4c4i",                          // N
    "1c3c4d4h3i1i0h0d1c",                // O
    "0c0i3i4h4g3f0f",                    // P
    "1c3c4d4h3i1i0h0d1c 2e4c",           // Q
    "0c0i3i4h4g3f0f 2f4c",               // R
    "4h3i1i0h0g1f3f4e4d3c1c0d",          // S
    "0i4i 2i2c",                         // T
    "0i0d1c3c4d4i",                      // U
    "0i2c4i",                            // V
    "0i1c2g3c4i",                        // W
    "0i4c 4i0c",                         // X
    "0i2f4i 2f2c",                       // Y
    "0i4i0c4c",                          // Z
    "1i0i0b1b",                          // [
    "0i3b",                              // backslash
    "0i1i1b0b",                          // ]
    "0g1i2g",                            // ^
    "0b4b",                              // _
    "0i1h",                              // `
    "3g3c 3f2g1g0f0d1c2c3d",             // a
    "0i0c 0f1g2g3f3d2c1c0d",             // b
    "3f2g1g0f0d1c2c3d",                  // c
    "3i3c 3f2g1g0f0d1c2c3d",             // d
    "0e3e3f2g1g0f0d1c3c",                // e
    "2i1h1c 0g2g",                       // f
    "3g3b2a1a0b 3f2g1g0f0d1c2c3d",       // g
    "0i0c 0f1g2g3f3c",                   // h
    "0c0g 0i0i",                         // i
    "1g1b0a 1i1i",                       // j
    "0i0c 3g0e 1f3c",                    // k
    "0i0d1c",                            // l
    "0g0c 0f1g2f2c 2f3g4f4c",            // m
    "0g0c 0f1g2g3f3c",                   // n
    "1c2c3d3f2g1g0f0d1c",                // o
    "0g0a 0f1g2g3f3d2c1c0d",             // p
    "3g3a 3f2g1g0f0d1c2c3d",             // q
    "0g0c 0f1g2g",                       // r
    "3f2g1g0f1e2e3d2c1c0d",              // s
    "1i1d2c 0g2g",                       // t
    "0g0d1c2c3d 3g3c",                   // u
    "0g2c4g",                            // v
    "0g1c2f3c4g",                        // w
    "0g3c 3g0c",                         // x
    "0g2c 4g1a",                         // y
    "0g3g0c3c",                          // z
    "2i1h1f0e1d1c2b",                    // {
    "0b0i",                              // |
    "0i1h1f2e1d1c0b",                    // }
    "0e1f3d4e",                          // ~
};
static_assert(sizeof kAscii / sizeof kAscii[0] == 126 - 33 + 1);

}  // namespace

std::string_view strokes_of(std::uint32_t code_point) {
  if (code_point >= 33 && code_point <= 126) return kAscii[code_point - 33];
  if (code_point == 0xb0) return "0h1i2h1g0h";      // degree sign
  if (code_point == 0xb1) return "0f4f 2d2h 0c4c";  // plus-minus
  if (code_point == 0xd7) return "0c3f 3c0f";       // multiplication sign
  return {};
}

}  // namespace neritic::sonar
