// How a test talks to the fake runtime: C functions that it looks up in the library, in the process
// that the loader loaded it into. Another process gets its script by the file that the environment
// variable NERITIC_FAKE_XR names, and writes its faults to the script's `report`.
// Any thread. Returned texts hold until the next call of the same function.
#pragma once

#include <cstdint>

extern "C" {
// Forgets everything: objects, script, time, faults. No call of a client may be under way.
void neritic_fake_xr_reset();
// Applies the lines of a script (README.md). Null, or what is wrong with them.
const char* neritic_fake_xr_script(const char* lines);
// Makes one thing happen now. Null, or what is wrong with the line.
const char* neritic_fake_xr_do(const char* line);
// The faults of the client so far, a sentence a line; "" for none.
const char* neritic_fake_xr_faults();
// One line for each frame that ended (README.md).
const char* neritic_fake_xr_log();
// Counts, from the first call on, the processor's time that the client's threads spend in the
// runtime's functions. Gives what they have spent, nanoseconds. No call may be under way.
std::int64_t neritic_fake_xr_spent_ns();
// XrTime of the simulated now.
std::int64_t neritic_fake_xr_now();
}
