// Pictures of an X window in memory that the X server reads too (its extension MIT-SHM): showing
// one sends some bytes, where a device that is a processor sends all texels through a socket.
// Rendering thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "engine/core/result.hpp"

struct xcb_connection_t;

namespace neritic::xr {

class SharedPictures {
 public:
  // window: its number at the X server of $DISPLAY. kUnsupported, with the reason: the server is on
  // another machine, has no such extension, or shows a window's texels in another order than blue,
  // green, red and a byte that says nothing.
  static Result<std::unique_ptr<SharedPictures>> connect(std::uint32_t window);
  ~SharedPictures();
  SharedPictures(const SharedPictures&) = delete;
  SharedPictures& operator=(const SharedPictures&) = delete;

  // Makes the pictures anew.
  Status resize(std::uint32_t width, std::uint32_t height);
  // The next picture's bytes, in rows without gaps, once the server is done with what it was.
  Result<std::span<std::byte>> next();
  // Shows what next() gave.
  Status show();

 private:
  struct Connection {
    void operator()(xcb_connection_t* connection) const;
  };
  // A piece of System V shared memory that both have attached.
  struct Segment {
    std::uint32_t number = 0;  // the server's
    std::byte* bytes = nullptr;
    bool shown = false;  // the server may still read it
  };
  explicit SharedPictures(std::uint32_t window) : window_(window) {}
  Status check_window();
  Status attach(Segment& segment, std::size_t bytes);
  void drop(Segment& segment);
  void drop_all();
  Status await(Segment& segment);

  std::unique_ptr<xcb_connection_t, Connection> connection_;
  std::uint32_t window_, context_ = 0;
  std::uint8_t depth_ = 0;       // of the window, bits
  std::uint8_t completion_ = 0;  // number of the event that says that a picture was read
  std::uint32_t width_ = 0, height_ = 0;
  std::array<Segment, 2> segments_;  // one is read while the other is written
  std::size_t at_ = 0;
};

}  // namespace neritic::xr
