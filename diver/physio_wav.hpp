// Sound and signals from .wav files: PCM of 8, 16, 24 and 32 bit, and float of 32 and 64. Pure
// functions of the bytes; any thread.
#pragma once

#include "diver/physio_recording.hpp"

namespace neritic::diver {

// One channel, from 0; samples from -1 to 1 (of floats: as they are). A file whose length field was
// never filled in (a recorder that was cut off) gives what is there. kBadInput names the file.
Result<Recording> parse_wav(std::span<const std::byte> bytes, const std::string& name,
                            std::uint32_t channel);

}  // namespace neritic::diver
