// D-Bus's wire format (the D-Bus specification 0.38, "Message Protocol"), little endian, as far as
// a client of BlueZ's GATT interface (BlueZ 5, doc/gatt-api.txt) needs it.
#include "tests/fakes/bluez/fake_bluez.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>

namespace neritic::test {
namespace {

constexpr char kReply = 2, kError = 3, kSignal = 4;
constexpr char kPath = 1, kInterface = 2, kMember = 3, kErrorName = 4, kReplyTo = 5, kTo = 6,
               kSender = 7, kSignature = 8;
const std::string kStrap = "/org/bluez/hci0/dev_AA_BB_CC_DD_EE_FF";

struct Place {
  const char* name;
  std::string path;
  const char* uuid;
};
const Place kPlaces[] = {
    {"rate", kStrap + "/service0010/char0011", "00002A37-0000-1000-8000-00805F9B34FB"},
    {"control", kStrap + "/service0020/char0021", "fb005c81-02e7-f387-1cad-8acd2d8df0c8"},
    {"ecg", kStrap + "/service0020/char0023", "fb005c82-02e7-f387-1cad-8acd2d8df0c8"}};

// Bytes of D-Bus: each call appends a value at its alignment.
std::string& aligned(std::string& out, std::size_t to) {
  out.resize((out.size() + to - 1) / to * to, '\0');
  return out;
}
void number(std::string& out, std::uint32_t value) {
  aligned(out, 4).append(reinterpret_cast<const char*>(&value), 4);
}
void text(std::string& out, const std::string& value) {
  number(out, static_cast<std::uint32_t>(value.size()));
  out += value + '\0';
}
void signature(std::string& out, const std::string& value) {
  out += static_cast<char>(value.size());
  out += value + '\0';
}
// An array: its length counts from its first item.
template <class Items>
void array(std::string& out, std::size_t alignment, const Items& items) {
  number(out, 0);
  const std::size_t length_at = out.size() - 4, begun = aligned(out, alignment).size();
  items();
  const auto length = static_cast<std::uint32_t>(out.size() - begun);
  std::memcpy(out.data() + length_at, &length, 4);
}
void text_property(std::string& out, const std::string& key, const std::string& value) {
  text(aligned(out, 8), key);
  signature(out, "s");
  text(out, value);
}
void yes_or_no(std::string& out, const std::string& key, bool value) {
  text(aligned(out, 8), key);
  signature(out, "b");
  number(out, value ? 1 : 0);
}
void field(std::string& out, char code, const std::string& type, const std::string& value) {
  aligned(out, 8) += code;
  signature(out, type);
  if (type == "g")
    signature(out, value);
  else
    text(out, value);
}

}  // namespace

struct FakeBluez::Call {
  std::uint32_t serial = 0;
  std::string path, member, body;
};

FakeBluez::FakeBluez(bool connected)
    : listener_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)), connected_(connected) {
  const std::string at = folder_ / "bus";
  sockaddr_un where{};
  where.sun_family = AF_UNIX;
  EXPECT_LT(at.size(), sizeof where.sun_path);
  at.copy(where.sun_path, sizeof where.sun_path - 1);
  EXPECT_EQ(::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where), 0);
  EXPECT_EQ(::listen(listener_.get(), 1), 0);
  ::setenv("DBUS_SYSTEM_BUS_ADDRESS", ("unix:path=" + at).c_str(), 1);
  thread_ = std::thread([this] { serve(); });
}

FakeBluez::~FakeBluez() {
  ::unsetenv("DBUS_SYSTEM_BUS_ADDRESS");
  stop_ = true;
  thread_.join();
}

std::vector<std::string> FakeBluez::calls() {
  const std::lock_guard lock(mutex_);
  return calls_;
}

void FakeBluez::serve() {
  pollfd wanted{listener_.get(), POLLIN, 0};
  while (!stop_ && ::poll(&wanted, 1, 10) == 0) {
  }
  if (stop_) return;
  client_ = net::Descriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  if (!greet()) return;
  there_ = true;
  while (answer()) {
  }
  there_ = false;
}

// Reads so many bytes; false: the client or the test has ended.
bool FakeBluez::read(char* to, std::size_t size) {
  for (std::size_t done = 0; done < size;) {
    pollfd wanted{client_.get(), POLLIN, 0};
    if (stop_) return false;
    if (::poll(&wanted, 1, 10) == 0) continue;
    const ssize_t got = ::recv(client_.get(), to + done, size - done, 0);
    if (got <= 0) return false;
    done += static_cast<std::size_t>(got);
  }
  return true;
}

// SASL's EXTERNAL, a line each, until BEGIN.
bool FakeBluez::greet() {
  char byte = 0;
  if (!read(&byte, 1)) return false;  // the first one is 0
  for (std::string line; read(&byte, 1);) {
    if (byte != '\n') {
      line += byte;
      continue;
    }
    if (line == "BEGIN\r") return true;
    const bool unknown_yet = line == "AUTH EXTERNAL\r";
    const std::string word = unknown_yet ? "DATA\r\n"
                             : line == "NEGOTIATE_UNIX_FD\r"
                                 ? "AGREE_UNIX_FD\r\n"
                                 : "OK " + std::string(32, 'a') + "\r\n";
    (void)::send(client_.get(), word.data(), word.size(), MSG_NOSIGNAL);
    line.clear();
  }
  return false;
}

// Sends a message. Precondition: the mutex is held.
void FakeBluez::send(char type, const std::string& fields, const std::string& body) {
  std::string out{'l', type, 1, 1};
  number(out, static_cast<std::uint32_t>(body.size()));
  number(out, ++serial_);
  number(out, static_cast<std::uint32_t>(fields.size()));
  aligned(out += fields, 8) += body;
  (void)::send(client_.get(), out.data(), out.size(), MSG_NOSIGNAL);
}

// Reads a call and answers it.
bool FakeBluez::answer() {
  std::array<std::uint32_t, 4> head{};  // kind, length of the body, serial, length of the fields
  if (!read(reinterpret_cast<char*>(head.data()), sizeof head)) return false;
  std::string fields(head[3], '\0');
  Call call{.serial = head[2]};
  call.body.resize(head[1]);
  char padding[8];
  if (!read(fields.data(), fields.size()) || !read(padding, (8 - fields.size() % 8) % 8) ||
      !read(call.body.data(), call.body.size()))
    return false;
  for (std::size_t at = 0; at + 4 < fields.size(); at = (at + 7) / 8 * 8) {
    const char code = fields[at], kind = fields[at + 2];
    at += 4;
    if (kind == 'u') {
      at += 4;
      continue;
    }
    std::uint32_t length = static_cast<unsigned char>(fields[at]);
    if (kind != 'g') std::memcpy(&length, fields.data() + at, 4);
    at += kind == 'g' ? 1 : 4;
    if (code == kPath) call.path = fields.substr(at, length);
    if (code == kMember) call.member = fields.substr(at, length);
    at += length + 1;
  }
  std::string where = call.path, words = call.member;
  for (const Place& place : kPlaces)
    if (place.path == where) words += std::string(" ") + place.name;
  if (call.member == "WriteValue") {
    std::uint32_t length = 0;
    std::memcpy(&length, call.body.data(), 4);
    words += ' ';
    for (const char byte : call.body.substr(4, length))
      words += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  }
  std::string reply, body;
  aligned(reply, 8) += kReplyTo;
  signature(reply, "u");
  number(reply, call.serial);
  field(reply, kTo, "s", ":1.1");
  if (call.member == "Hello") {
    field(reply, kSignature, "g", "s");
    text(body, ":1.1");
  } else if (call.member == "GetManagedObjects") {
    field(reply, kSender, "s", ":1.2");
    field(reply, kSignature, "g", "a{oa{sa{sv}}}");
    body = objects();
  }
  const std::lock_guard lock(mutex_);
  if (call.member == "Connect") connected_ = true;
  if (call.member != "Hello" && call.member != "AddMatch" && call.member != "GetManagedObjects")
    calls_.push_back(words);
  // Characteristics are there while the strap is.
  if (call.path.starts_with(kStrap + "/") && !connected_) {
    field(reply, kErrorName, "s", "org.freedesktop.DBus.Error.UnknownObject");
    send(kError, reply, "");
  } else {
    send(kReply, reply, body);
  }
  return true;
}

// The objects that BlueZ knows: an adapter, which has an address too, a strap, its characteristics.
std::string FakeBluez::objects() const {
  std::string out;
  const auto object = [&](const std::string& path, const std::string& interface, const auto& has) {
    text(aligned(out, 8), path);
    array(out, 8, [&] {
      text(aligned(out, 8), interface);
      array(out, 8, has);
    });
  };
  array(out, 8, [&] {
    object("/org/bluez/hci0", "org.bluez.Adapter1", [&] {
      text_property(out, "Address", "00:11:22:33:44:55");
      text_property(out, "Name", "laboratory");
      yes_or_no(out, "Powered", true);
    });
    object(kStrap, "org.bluez.Device1", [&] {
      text_property(out, "Address", "AA:BB:CC:DD:EE:FF");
      text_property(out, "Name", "Polar H10 1234ABCD");
      yes_or_no(out, "Connected", connected_);
      yes_or_no(out, "ServicesResolved", connected_);
    });
    if (connected_)
      for (const Place& place : kPlaces)
        object(place.path, "org.bluez.GattCharacteristic1", [&] {
          text_property(out, "UUID", place.uuid);
          yes_or_no(out, "Notifying", false);
        });
  });
  return out;
}

// The signal that a property has a value: `property` is a key and its variant.
void FakeBluez::changed(const std::string& path, const std::string& interface,
                        const std::string& property) {
  std::string fields, body;
  field(fields, kPath, "o", path);
  field(fields, kInterface, "s", "org.freedesktop.DBus.Properties");
  field(fields, kMember, "s", "PropertiesChanged");
  field(fields, kSender, "s", ":1.2");
  field(fields, kSignature, "g", "sa{sv}as");
  text(body, interface);
  array(body, 8, [&] { body += property; });
  array(body, 4, [] {});
  send(kSignal, fields, body);
}

void FakeBluez::notify(Characteristic characteristic, net::Bytes value) {
  const std::lock_guard lock(mutex_);
  if (!there_) return;
  std::string property;
  text(property, "Value");
  signature(property, "ay");
  number(property, static_cast<std::uint32_t>(value.size()));
  property.append(reinterpret_cast<const char*>(value.data()), value.size());
  changed(kPlaces[static_cast<std::size_t>(characteristic)].path, "org.bluez.GattCharacteristic1",
          property);
}

void FakeBluez::leave() {
  const std::lock_guard lock(mutex_);
  connected_ = false;
  std::string property;
  yes_or_no(property, "Connected", false);
  changed(kStrap, "org.bluez.Device1", property);
}

}  // namespace neritic::test
