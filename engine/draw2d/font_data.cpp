// The font files, taken into the program as they are (CMake says where they lie).
#include "engine/draw2d/font.hpp"

#define NERITIC_EMBED(symbol, file)                                             \
  asm(".pushsection .rodata, \"a\"\n"                                           \
      ".balign 16\n"                                                            \
      ".global " #symbol "\n.hidden " #symbol "\n" #symbol ":\n.incbin \"" file \
      "\"\n"                                                                    \
      ".global " #symbol "_end\n.hidden " #symbol "_end\n" #symbol              \
      "_end:\n"                                                                 \
      ".byte 0\n"                                                               \
      ".popsection\n")

NERITIC_EMBED(neritic_font_regular, NERITIC_FONT_REGULAR);
NERITIC_EMBED(neritic_font_bold, NERITIC_FONT_BOLD);

extern "C" {
extern const std::byte neritic_font_regular[], neritic_font_regular_end[];
extern const std::byte neritic_font_bold[], neritic_font_bold_end[];
}

namespace neritic::draw2d {

std::span<const std::byte> font_file(Face face) {
  return face == Face::kBold ? std::span(neritic_font_bold, neritic_font_bold_end)
                             : std::span(neritic_font_regular, neritic_font_regular_end);
}

}  // namespace neritic::draw2d
