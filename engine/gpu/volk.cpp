// The one translation unit that holds volk's function pointers.
//
// Pointers are loaded per instance, not per device: each then goes through the loader's trampoline,
// which dispatches on the handle. That costs a few nanoseconds a call and lets devices with and
// without validation live in one process, as the tests need.
#define VOLK_IMPLEMENTATION
#include <volk.h>
