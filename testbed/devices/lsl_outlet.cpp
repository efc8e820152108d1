#include "testbed/devices/lsl_outlet.hpp"

namespace neritic::testbed {
namespace {

constexpr int kTextFormat = 3;  // lsl_c.h, cft_string
constexpr int kMarkersKept_s = 360;

}  // namespace

Result<std::unique_ptr<LslOutlet>> LslOutlet::create(const std::string& stream) {
  NERITIC_TRY(SharedLibrary library, SharedLibrary::load("liblsl.so liblsl.so.2 liblsl64.so",
                                                         "Lab Streaming Layer's liblsl"));
  std::unique_ptr<LslOutlet> out(new LslOutlet(std::move(library)));
  out->library_.find("lsl_create_streaminfo", out->create_info_);
  out->library_.find("lsl_create_outlet", out->create_outlet_);
  out->library_.find("lsl_destroy_outlet", out->destroy_outlet_);
  out->library_.find("lsl_destroy_streaminfo", out->destroy_info_);
  out->library_.find("lsl_push_sample_strt", out->push_);
  out->library_.find("lsl_local_clock", out->clock_);
  NERITIC_TRY_STATUS(out->library_.complete());
  // A source of its own name: a recorder finds the stream again after a restart.
  out->info_ = out->create_info_(stream.c_str(), "Markers", 1, 0.0, kTextFormat, stream.c_str());
  if (out->info_) out->outlet_ = out->create_outlet_(out->info_, 0, kMarkersKept_s);
  if (!out->outlet_) return failure(ErrorCode::kIo, "LSL: no outlet {}", stream);
  return out;
}

LslOutlet::~LslOutlet() {
  if (outlet_) destroy_outlet_(outlet_);
  if (info_) destroy_info_(info_);
}

void LslOutlet::send(const std::string& text, TimeNs ago_ns) {
  const char* data = text.c_str();
  (void)push_(outlet_, &data, clock_() - 1e-9 * static_cast<double>(ago_ns));
}

}  // namespace neritic::testbed
