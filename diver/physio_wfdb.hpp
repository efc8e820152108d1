// PhysioNet's WFDB records: header (.hea), signals (.dat) of formats 8, 16, 24, 32, 61, 80, 160,
// 212, 310 and 311, also of several samples a frame, annotations (.atr). Pure functions of the
// bytes; any thread. Source: WFDB Applications Guide, header(5), signal(5), annot(5) (Moody 2022).
#pragma once

#include "diver/physio_recording.hpp"

namespace neritic::diver {

struct WfdbSignal {
  std::string file, name;
  int format = 212;
  int frame_samples = 1;  // in each frame; the header's rate is that of frames
  int first = 0;          // its first value, from which format 8 counts
  double gain = 200.0;    // units of the converter to a unit of the signal
  double baseline = 0.0;
  std::string unit = "mV";
  std::int64_t offset = 0;  // bytes before the first sample
  bool has_checksum = false;
  int checksum = 0;  // sum of all samples, 16 bit
};

struct WfdbHeader {
  std::string record;
  double rate_hz = 250.0;
  std::uint64_t samples = 0;  // 0: the header does not say
  std::vector<WfdbSignal> signals;
};

Result<WfdbHeader> parse_wfdb_header(std::string_view text, const std::string& name);
// Signal `channel` of the header, from the bytes of its file, in its unit. kBadInput where the file
// is too short for the header, or its checksum is another.
Result<Recording> parse_wfdb_signal(const WfdbHeader& header, std::uint32_t channel,
                                    std::span<const std::byte> bytes, const std::string& name);
// All annotations that are beats, in their order.
Result<std::vector<BeatAnnotation>> parse_wfdb_beats(std::span<const std::byte> bytes,
                                                     double rate_hz, const std::string& name);

}  // namespace neritic::diver
