// A heart strap over Bluetooth LE, through BlueZ on the system's D-Bus (by libsystemd's sd-bus):
// connects, subscribes to the heart rate and, where there is one, to Polar's ECG, which it starts.
// A strap that goes away or falls silent is looked for again.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "engine/core/text.hpp"
#include "testbed/devices/adapter.hpp"
#include "testbed/devices/feed.hpp"
#include "testbed/devices/shared_library.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kBluez = "org.bluez";
constexpr const char* kCharacteristic = "org.bluez.GattCharacteristic1";
// Heart Rate Service 1.0; Polar's measurement data service: its control point and data.
constexpr std::string_view kRateUuid = "00002a37-0000-1000-8000-00805f9b34fb",
                           kPmdControlUuid = "fb005c81-02e7-f387-1cad-8acd2d8df0c8",
                           kPmdDataUuid = "fb005c82-02e7-f387-1cad-8acd2d8df0c8";
constexpr std::uint64_t kCall_us = 5'000'000;
constexpr TimeNs kTryEvery_ns = 5 * kSecond_ns;
// A strap sends each second. This feed hears PropertiesChanged alone, which need not come if an
// adapter is pulled out or BlueZ ends.
constexpr TimeNs kSilent_ns = 5 * kSecond_ns;
constexpr const char* kSilent = "the strap is silent";

struct BusError {
  const char* name = nullptr;
  const char* message = nullptr;
  int need_free = 0;
};
using BusHandler = int (*)(void* message, void* user, BusError* error);

// For sd-bus (systemd/sd-bus.h), version 240 and later.
struct SdBus {
  int (*open_system)(void** bus) = nullptr;
  void* (*unref)(void* bus) = nullptr;
  int (*timeout)(void* bus, std::uint64_t us) = nullptr;
  int (*call)(void* bus, const char* to, const char* path, const char* interface,
              const char* member, BusError* error, void** reply, const char* types, ...) = nullptr;
  int (*add_match)(void* bus, void** slot, const char* match, BusHandler handler,
                   void* user) = nullptr;
  int (*process)(void* bus, void** message) = nullptr;
  int (*wait)(void* bus, std::uint64_t us) = nullptr;
  void* (*drop)(void* message) = nullptr;
  int (*enter)(void* message, char type, const char* contents) = nullptr;
  int (*exit)(void* message) = nullptr;
  int (*read)(void* message, const char* types, ...) = nullptr;
  int (*read_array)(void* message, char type, const void** data, std::size_t* size) = nullptr;
  int (*skip)(void* message, const char* types) = nullptr;
  const char* (*path)(void* message) = nullptr;
  void (*free_error)(BusError* error) = nullptr;
};

// An object of BlueZ, as far as it matters here.
struct BluezObject {
  std::string path, uuid, address, name;
  bool resolved = false;
};

class BluetoothFeed final : public Feed {
 public:
  static Result<std::unique_ptr<Feed>> open(const scene::DeviceSource& source) {
    NERITIC_TRY(SharedLibrary library, SharedLibrary::load("libsystemd.so.0", "libsystemd0"));
    auto feed = std::unique_ptr<BluetoothFeed>(new BluetoothFeed(std::move(library), source.port));
    NERITIC_TRY_STATUS(feed->find_functions());
    if (const int error = feed->bus_of_.open_system(&feed->bus_); error < 0)
      return failure(ErrorCode::kIo, "Bluetooth: no system D-Bus: {}", std::strerror(-error));
    (void)feed->bus_of_.timeout(feed->bus_, kCall_us);
    if (feed->bus_of_.add_match(feed->bus_, nullptr,
                                "type='signal',sender='org.bluez',"
                                "interface='org.freedesktop.DBus.Properties',"
                                "member='PropertiesChanged'",
                                &BluetoothFeed::on_signal, feed.get()) < 0)
      return failure(ErrorCode::kIo, "Bluetooth: D-Bus lets nobody listen");
    return std::unique_ptr<Feed>(std::move(feed));
  }
  ~BluetoothFeed() override {
    if (bus_) bus_of_.unref(bus_);
  }

  void receive(const net::Received& received, int wait_ms) override {
    received_ = &received;
    if (rate_path_.empty() && now_ns() >= next_try_ns_) {
      connect();
      next_try_ns_ = now_ns() + kTryEvery_ns;
    }
    int done = 0;
    for (int i = 0; i < 256 && (done = bus_of_.process(bus_, nullptr)) > 0; ++i) {
    }
    if (done < 0) {
      trouble_ = fmt::format("D-Bus: {}", std::strerror(-done));
      std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
    } else if (done == 0) {
      // All that had come was read.
      if (!rate_path_.empty() && now_ns() - heard_ns_ > kSilent_ns) {
        look_again(kSilent);
        silent_ = true;
      }
      (void)bus_of_.wait(bus_, static_cast<std::uint64_t>(wait_ms) * 1000);
    }
    received_ = nullptr;
  }
  std::string trouble() const override { return trouble_; }

 private:
  BluetoothFeed(SharedLibrary library, std::string device)
      : library_(std::move(library)), wanted_(std::move(device)) {}

  Status find_functions() {
    library_.find("sd_bus_open_system", bus_of_.open_system);
    library_.find("sd_bus_flush_close_unref", bus_of_.unref);
    library_.find("sd_bus_set_method_call_timeout", bus_of_.timeout);
    library_.find("sd_bus_call_method", bus_of_.call);
    library_.find("sd_bus_add_match", bus_of_.add_match);
    library_.find("sd_bus_process", bus_of_.process);
    library_.find("sd_bus_wait", bus_of_.wait);
    library_.find("sd_bus_message_unref", bus_of_.drop);
    library_.find("sd_bus_message_enter_container", bus_of_.enter);
    library_.find("sd_bus_message_exit_container", bus_of_.exit);
    library_.find("sd_bus_message_read", bus_of_.read);
    library_.find("sd_bus_message_read_array", bus_of_.read_array);
    library_.find("sd_bus_message_skip", bus_of_.skip);
    library_.find("sd_bus_message_get_path", bus_of_.path);
    library_.find("sd_bus_error_free", bus_of_.free_error);
    return library_.complete();
  }

  // Whether the call succeeded; else the trouble says why not.
  bool worked(int result, BusError& error, const char* what) {
    if (result >= 0) return true;
    trouble_ = fmt::format("{}: {}", what, error.message ? error.message : std::strerror(-result));
    bus_of_.free_error(&error);
    return false;
  }
  bool call(const std::string& path, const char* interface, const char* member) {
    BusError error;
    return worked(
        bus_of_.call(bus_, kBluez, path.c_str(), interface, member, &error, nullptr, nullptr),
        error, member);
  }

  void connect() {
    const std::vector<BluezObject> objects = managed_objects();
    const auto device = std::ranges::find_if(objects, [&](const BluezObject& object) {
      // An adapter of this machine has an address too.
      return !object.address.empty() && object.path.find("/dev_") != object.path.npos &&
             (lower_case(object.address) == lower_case(wanted_) || object.name == wanted_ ||
              object.name.starts_with(wanted_ + " "));
    });
    if (device == objects.end()) {
      if (trouble_.empty() || !objects.empty())
        trouble_ = fmt::format("no strap {} is known; pair it once with bluetoothctl", wanted_);
      return;
    }
    if (!device->resolved) {
      if (call(device->path, "org.bluez.Device1", "Connect")) trouble_ = "connecting";
      return;  // its services are known at the next try
    }
    device_path_ = device->path;
    const auto characteristic = [&](std::string_view uuid) {
      for (const BluezObject& object : objects)
        if (object.uuid == uuid && object.path.starts_with(device->path)) return object.path;
      return std::string();
    };
    const std::string rate = characteristic(kRateUuid);
    if (rate.empty()) {
      trouble_ = "the device has no heart rate";
      return;
    }
    if (!call(rate, kCharacteristic, "StartNotify")) return;
    pmd_path_ = characteristic(kPmdDataUuid);
    if (const std::string control = characteristic(kPmdControlUuid);
        !pmd_path_.empty() && !control.empty())
      start_ecg(control);
    rate_path_ = rate;
    heard_ns_ = now_ns();
    trouble_ = silent_ ? kSilent : "";  // until it is heard
  }

  void look_again(const char* why) {
    rate_path_.clear();
    trouble_ = why;
  }

  // 130 Hz, 14 bits. A strap that refuses still sends its rate.
  void start_ecg(const std::string& control) {
    if (!call(control, kCharacteristic, "StartNotify") ||
        !call(pmd_path_, kCharacteristic, "StartNotify"))
      return;
    BusError error;
    (void)worked(
        bus_of_.call(bus_, kBluez, control.c_str(), kCharacteristic, "WriteValue", &error, nullptr,
                     "aya{sv}", 10, 0x02, 0x00, 0x00, 0x01, 0x82, 0x00, 0x01, 0x01, 0x0e, 0x00, 0),
        error, "ECG");
  }

  std::vector<BluezObject> managed_objects() {
    std::vector<BluezObject> out;
    BusError error;
    void* reply = nullptr;
    if (!worked(bus_of_.call(bus_, kBluez, "/", "org.freedesktop.DBus.ObjectManager",
                             "GetManagedObjects", &error, &reply, nullptr),
                error, "BlueZ"))
      return out;
    trouble_.clear();
    bus_of_.enter(reply, 'a', "{oa{sa{sv}}}");
    while (bus_of_.enter(reply, 'e', "oa{sa{sv}}") > 0) {
      const char* path = nullptr;
      bus_of_.read(reply, "o", &path);
      BluezObject object{.path = path ? path : ""};
      bus_of_.enter(reply, 'a', "{sa{sv}}");
      while (bus_of_.enter(reply, 'e', "sa{sv}") > 0) {
        const char* interface = nullptr;
        bus_of_.read(reply, "s", &interface);
        read_properties(reply, object);
        bus_of_.exit(reply);
      }
      bus_of_.exit(reply);
      bus_of_.exit(reply);
      out.push_back(std::move(object));
    }
    bus_of_.drop(reply);
    return out;
  }

  void read_properties(void* message, BluezObject& object) {
    bus_of_.enter(message, 'a', "{sv}");
    while (bus_of_.enter(message, 'e', "sv") > 0) {
      const char *key = nullptr, *text = nullptr;
      bus_of_.read(message, "s", &key);
      const std::string_view name = key ? key : "";
      std::string* into = name == "UUID"      ? &object.uuid
                          : name == "Address" ? &object.address
                          : name == "Name"    ? &object.name
                                              : nullptr;
      if (into && bus_of_.read(message, "v", "s", &text) > 0) {
        *into = into == &object.uuid ? lower_case(text) : text;
      } else if (int resolved = 0;
                 name == "ServicesResolved" && bus_of_.read(message, "v", "b", &resolved) > 0) {
        object.resolved = resolved != 0;
      } else if (!into) {
        bus_of_.skip(message, "v");
      }
      bus_of_.exit(message);
    }
    bus_of_.exit(message);
  }

  static int on_signal(void* message, void* user, BusError*) {
    static_cast<BluetoothFeed*>(user)->changed(message);
    return 0;
  }

  // PropertiesChanged: the interface, what changed, what became unknown.
  void changed(void* message) {
    const char* path_text = bus_of_.path(message);
    const std::string path = path_text ? path_text : "";
    const bool value = !rate_path_.empty() && (path == rate_path_ || path == pmd_path_);
    if (!value && path != device_path_) return;
    const char* interface = nullptr;
    if (bus_of_.read(message, "s", &interface) < 0 || bus_of_.enter(message, 'a', "{sv}") < 0)
      return;
    while (bus_of_.enter(message, 'e', "sv") > 0) {
      const char* key = nullptr;
      bus_of_.read(message, "s", &key);
      const std::string_view name = key ? key : "";
      int connected = 1;
      if (value && name == "Value" && bus_of_.enter(message, 'v', "ay") > 0) {
        heard_ns_ = now_ns();
        if (std::exchange(silent_, false)) trouble_.clear();
        const void* data = nullptr;
        std::size_t size = 0;
        if (bus_of_.read_array(message, 'y', &data, &size) >= 0 && received_)
          (*received_)(net::Bytes(static_cast<const std::byte*>(data), size), false);
        bus_of_.exit(message);
      } else if (!value && name == "Connected" && bus_of_.read(message, "v", "b", &connected) > 0) {
        if (connected == 0) look_again("the strap went away");
      } else {
        bus_of_.skip(message, "v");
      }
      bus_of_.exit(message);
    }
  }

  SharedLibrary library_;
  SdBus bus_of_;
  std::string wanted_, device_path_, rate_path_, pmd_path_, trouble_;
  void* bus_ = nullptr;
  TimeNs next_try_ns_ = 0, heard_ns_ = 0;
  bool silent_ = false;  // said nothing for kSilent_ns, and nothing since
  const net::Received* received_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<Feed>> open_bluetooth(const scene::DeviceSource& source) {
  return BluetoothFeed::open(source);
}

}  // namespace neritic::testbed
