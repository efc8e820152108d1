#include "engine/xr/desktop/shared_pictures.hpp"

#include <sys/ipc.h>
#include <sys/shm.h>
#include <sys/uio.h>
#include <xcb/xcb.h>
#include <xcb/xcbext.h>

#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "engine/core/check.hpp"

namespace neritic::xr {
namespace {

// The protocol of MIT-SHM 1.1 as the X Consortium's "MIT-SHM: The MIT Shared Memory Extension"
// gives it, in the encoding of X11/extensions/shmproto.h. The first four bytes of a request are
// xcb's to fill.
xcb_extension_t shm_extension{"MIT-SHM", 0};
constexpr std::uint8_t kAttach = 1, kDetach = 2, kPutImage = 3;  // requests
constexpr std::uint8_t kZPixmap = 2;

struct AttachRequest {
  std::uint32_t head = 0, segment, memory;
  std::uint8_t read_only = 1, pad[3]{};
};
struct DetachRequest {
  std::uint32_t head = 0, segment;
};
struct PutImageRequest {
  std::uint32_t head = 0, drawable, context;
  std::uint16_t total_width, total_height, from_x = 0, from_y = 0, width, height;
  std::int16_t to_x = 0, to_y = 0;
  std::uint8_t depth, format = kZPixmap, send_event = 1, pad = 0;
  std::uint32_t segment, offset = 0;
};
static_assert(sizeof(AttachRequest) == 16 && sizeof(DetachRequest) == 8 &&
              sizeof(PutImageRequest) == 40);
struct CompletionEvent {
  std::uint8_t type, pad;
  std::uint16_t sequence;
  std::uint32_t drawable;
  std::uint16_t minor;
  std::uint8_t major, pad1;
  std::uint32_t segment, offset;
};

template <class T>
struct Freed {
  void operator()(T* memory) const { std::free(memory); }
};
template <class T>
using Reply = std::unique_ptr<T, Freed<T>>;

// flags: XCB_REQUEST_CHECKED where answer() reads the error; 0: it comes as an event.
template <class Request>
xcb_void_cookie_t send(xcb_connection_t* connection, int flags, std::uint8_t code,
                       Request request) {
  const xcb_protocol_request_t kind{1, &shm_extension, code, 1};
  iovec parts[3]{};  // xcb writes into the two before the first
  parts[2] = {&request, sizeof(request)};
  return {xcb_send_request(connection, flags, parts + 2, &kind)};
}

Status answer(xcb_connection_t* connection, xcb_void_cookie_t cookie, const char* what) {
  const Reply<xcb_generic_error_t> error(xcb_request_check(connection, cookie));
  if (error)
    return failure(ErrorCode::kUnsupported, "the X server refuses {} (error {})", what,
                   error->error_code);
  if (xcb_connection_has_error(connection) != 0)
    return failure(ErrorCode::kUnsupported, "the X server is gone");
  return {};
}

const xcb_visualtype_t* find_visual(const xcb_setup_t* setup, xcb_visualid_t id) {
  for (auto screen = xcb_setup_roots_iterator(setup); screen.rem > 0; xcb_screen_next(&screen))
    for (auto depth = xcb_screen_allowed_depths_iterator(screen.data); depth.rem > 0;
         xcb_depth_next(&depth))
      for (auto visual = xcb_depth_visuals_iterator(depth.data); visual.rem > 0;
           xcb_visualtype_next(&visual))
        if (visual.data->visual_id == id) return visual.data;
  return nullptr;
}

std::uint8_t bits_per_texel(const xcb_setup_t* setup, std::uint8_t depth) {
  for (auto format = xcb_setup_pixmap_formats_iterator(setup); format.rem > 0;
       xcb_format_next(&format))
    if (format.data->depth == depth) return format.data->bits_per_pixel;
  return 0;
}

}  // namespace

void SharedPictures::Connection::operator()(xcb_connection_t* connection) const {
  xcb_disconnect(connection);
}

Result<std::unique_ptr<SharedPictures>> SharedPictures::connect(std::uint32_t window) {
  std::unique_ptr<SharedPictures> made(new SharedPictures(window));
  made->connection_.reset(xcb_connect(nullptr, nullptr));
  xcb_connection_t* const connection = made->connection_.get();
  if (xcb_connection_has_error(connection) != 0)
    return failure(ErrorCode::kUnsupported, "no X server of $DISPLAY");
  const xcb_query_extension_reply_t* const shm = xcb_get_extension_data(connection, &shm_extension);
  if (!shm || !shm->present)
    return failure(ErrorCode::kUnsupported, "the X server shares no memory");
  made->completion_ = shm->first_event;
  constexpr std::string_view kDri3 = "DRI3";
  const Reply<xcb_query_extension_reply_t> dri3(xcb_query_extension_reply(
      connection, xcb_query_extension(connection, kDri3.size(), kDri3.data()), nullptr));
  if (dri3 && dri3->present)
    return failure(ErrorCode::kUnsupported, "Vulkan's own windows share memory with this server");
  NERITIC_TRY_STATUS(made->check_window());
  made->context_ = xcb_generate_id(connection);
  NERITIC_TRY_STATUS(answer(
      connection, xcb_create_gc_checked(connection, made->context_, made->window_, 0, nullptr),
      "to draw in the window"));
  // Whether it is on this machine, only an attached segment tells.
  NERITIC_TRY_STATUS(made->resize(1, 1));
  return made;
}

SharedPictures::~SharedPictures() {
  if (connection_ && xcb_connection_has_error(connection_.get()) == 0) drop_all();
}

Status SharedPictures::check_window() {
  xcb_connection_t* const connection = connection_.get();
  const xcb_setup_t* const setup = xcb_get_setup(connection);
  const Reply<xcb_get_geometry_reply_t> geometry(
      xcb_get_geometry_reply(connection, xcb_get_geometry(connection, window_), nullptr));
  const Reply<xcb_get_window_attributes_reply_t> attributes(xcb_get_window_attributes_reply(
      connection, xcb_get_window_attributes(connection, window_), nullptr));
  if (!geometry || !attributes)
    return failure(ErrorCode::kUnsupported, "the X server of $DISPLAY does not know the window");
  depth_ = geometry->depth;
  const xcb_visualtype_t* const visual = find_visual(setup, attributes->visual);
  const bool bgrx = visual && visual->red_mask == 0xff0000 && visual->green_mask == 0xff00 &&
                    visual->blue_mask == 0xff;
  if (!bgrx || bits_per_texel(setup, depth_) != 32 ||
      setup->image_byte_order != XCB_IMAGE_ORDER_LSB_FIRST ||
      std::endian::native != std::endian::little)
    return failure(ErrorCode::kUnsupported, "the window's texels are not BGRX of 32 bits");
  return {};
}

Status SharedPictures::attach(Segment& segment, std::size_t bytes) {
  const int memory = shmget(IPC_PRIVATE, bytes, IPC_CREAT | 0600);
  if (memory < 0)
    return failure(ErrorCode::kUnsupported, "no {} bytes of shared memory ({})", bytes,
                   std::strerror(errno));
  void* const mapped = shmat(memory, nullptr, 0);
  Status attached;
  if (mapped == reinterpret_cast<void*>(-1)) {
    attached = failure(ErrorCode::kUnsupported, "shared memory cannot be attached ({})",
                       std::strerror(errno));
  } else {
    segment.bytes = static_cast<std::byte*>(mapped);
    segment.number = xcb_generate_id(connection_.get());
    attached = answer(connection_.get(),
                      send(connection_.get(), XCB_REQUEST_CHECKED, kAttach,
                           AttachRequest{.segment = segment.number,
                                         .memory = static_cast<std::uint32_t>(memory)}),
                      "shared memory");
    if (!attached.ok()) segment.number = 0;
  }
  // It goes with the last that has it attached, however the program ends.
  shmctl(memory, IPC_RMID, nullptr);
  return attached;
}

void SharedPictures::drop(Segment& segment) {
  if (segment.number != 0)
    (void)answer(connection_.get(),
                 send(connection_.get(), XCB_REQUEST_CHECKED, kDetach,
                      DetachRequest{.segment = segment.number}),
                 "to let go of memory");
  if (segment.bytes) shmdt(segment.bytes);
  segment = {};
}

void SharedPictures::drop_all() {
  for (Segment& segment : segments_) drop(segment);
}

Status SharedPictures::resize(std::uint32_t width, std::uint32_t height) {
  constexpr std::uint32_t kMost = 32767;  // of the protocol's sides
  if (width == 0 || height == 0 || width > kMost || height > kMost)
    return failure(ErrorCode::kUnsupported, "a window of {} x {}", width, height);
  drop_all();
  width_ = width;
  height_ = height;
  for (Segment& segment : segments_)
    NERITIC_TRY_STATUS(attach(segment, std::size_t{4} * width * height));
  return {};
}

Status SharedPictures::await(Segment& segment) {
  while (segment.shown) {
    const Reply<xcb_generic_event_t> event(xcb_wait_for_event(connection_.get()));
    if (!event) return failure(ErrorCode::kUnsupported, "the X server is gone");
    if (event->response_type == 0)
      return failure(ErrorCode::kUnsupported, "the X server does not show the picture (error {})",
                     reinterpret_cast<const xcb_generic_error_t*>(event.get())->error_code);
    // The highest bit marks events that other programs sent.
    if ((event->response_type & 0x7f) != completion_) continue;
    CompletionEvent done;
    std::memcpy(&done, event.get(), sizeof(done));
    for (Segment& other : segments_)
      if (other.number == done.segment) other.shown = false;
  }
  return {};
}

Result<std::span<std::byte>> SharedPictures::next() {
  Segment& segment = segments_[at_];
  NERITIC_TRY_STATUS(await(segment));
  return std::span(segment.bytes, std::size_t{4} * width_ * height_);
}

Status SharedPictures::show() {
  Segment& segment = segments_[at_];
  NERITIC_CHECK(!segment.shown, "a picture is shown twice");
  const auto width = static_cast<std::uint16_t>(width_);
  const auto height = static_cast<std::uint16_t>(height_);
  send(connection_.get(), 0, kPutImage,
       PutImageRequest{.drawable = window_,
                       .context = context_,
                       .total_width = width,
                       .total_height = height,
                       .width = width,
                       .height = height,
                       .depth = depth_,
                       .segment = segment.number});
  if (xcb_flush(connection_.get()) <= 0)
    return failure(ErrorCode::kUnsupported, "the X server is gone");
  segment.shown = true;
  at_ = (at_ + 1) % segments_.size();
  return {};
}

}  // namespace neritic::xr
