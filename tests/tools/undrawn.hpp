// A program that tests start without matplotlib: it writes the data of its pictures and draws none.
#pragma once

namespace neritic::test {

// Before a command line of a shell. A page takes longer to draw than most programs to compute it.
inline constexpr const char* kUndrawn =
    "PYTHONPATH='" NERITIC_SOURCE_DIR "/tests/tools/no_matplotlib'";

}  // namespace neritic::test
