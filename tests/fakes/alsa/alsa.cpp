// A libasound for tests: the functions that the program loads (alsa/pcm.h), over one sound card
// that a test fills, pulls out and puts back (fake_alsa.hpp). Reads never block.
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <deque>
#include <mutex>

#define FAKE_ALSA extern "C" __attribute__((visibility("default")))

namespace {

struct Card {
  std::mutex mutex;
  std::deque<std::int16_t> samples;
  bool there = true, overrun = false;
  int opened = 0, opens = 0;
  unsigned rate_hz = 0;
};
Card& card() {
  static Card one;
  return one;
}
using Lock = std::lock_guard<std::mutex>;

}  // namespace

FAKE_ALSA int snd_pcm_open(void** pcm, const char*, int stream, int mode) {
  const Lock lock(card().mutex);
  if (!card().there) return -ENOENT;
  if (stream != 1 || mode != 1) return -EINVAL;  // capture, without waiting
  ++card().opened, ++card().opens;
  *pcm = &card();
  return 0;
}
FAKE_ALSA int snd_pcm_set_params(void*, int format, int access, unsigned channels, unsigned rate_hz,
                                 int, unsigned) {
  const Lock lock(card().mutex);
  card().rate_hz = rate_hz;
  return format == 2 && access == 3 && channels == 1 ? 0 : -EINVAL;  // S16_LE, interleaved
}
FAKE_ALSA int snd_pcm_start(void*) {
  return 0;
}
FAKE_ALSA long snd_pcm_readi(void*, void* buffer, unsigned long frames) {
  const Lock lock(card().mutex);
  if (!card().there) return -ENODEV;
  if (card().overrun) return -EPIPE;
  const std::size_t count = std::min<std::size_t>(frames, card().samples.size());
  if (count == 0) return -EAGAIN;
  std::copy_n(card().samples.begin(), count, static_cast<std::int16_t*>(buffer));
  card().samples.erase(card().samples.begin(),
                       card().samples.begin() + static_cast<std::ptrdiff_t>(count));
  return static_cast<long>(count);
}
// As the library: of an overrun alone.
FAKE_ALSA int snd_pcm_recover(void*, int error, int) {
  const Lock lock(card().mutex);
  if (error != -EPIPE) return error;
  card().overrun = false;
  return 0;
}
FAKE_ALSA int snd_pcm_close(void*) {
  const Lock lock(card().mutex);
  --card().opened;
  return 0;
}
FAKE_ALSA const char* snd_strerror(int error) {
  return std::strerror(-error);
}

// The test's side.

FAKE_ALSA void fake_alsa_reset() {
  const Lock lock(card().mutex);
  card().samples.clear();
  card().there = true, card().overrun = false;
  card().opens = 0;
}
FAKE_ALSA void fake_alsa_push(const std::int16_t* samples, std::uint32_t count) {
  const Lock lock(card().mutex);
  card().samples.insert(card().samples.end(), samples, samples + count);
}
FAKE_ALSA void fake_alsa_plug(int there) {
  const Lock lock(card().mutex);
  card().there = there != 0;
  card().samples.clear();
}
FAKE_ALSA void fake_alsa_overrun() {
  const Lock lock(card().mutex);
  card().overrun = true;
}
// How often the card was opened, and how often it is open now.
FAKE_ALSA int fake_alsa_opens() {
  const Lock lock(card().mutex);
  return card().opens;
}
FAKE_ALSA int fake_alsa_opened() {
  const Lock lock(card().mutex);
  return card().opened;
}
FAKE_ALSA unsigned fake_alsa_rate() {
  const Lock lock(card().mutex);
  return card().rate_hz;
}
