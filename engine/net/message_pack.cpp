#include "engine/net/message_pack.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/refusal.hpp"

namespace neritic::net {
namespace {

using nlohmann::json;

// Reads the bytes and keeps nothing; stops at the first limit.
class Scan final : public nlohmann::json_sax<json> {
 public:
  explicit Scan(const PackLimits& limits) : limits_(limits) {}
  const std::string& found() const { return found_; }
  const std::string& accepted() const { return accepted_; }

  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return count(); }
  bool key(string_t&) override { return count(); }
  bool start_object(std::size_t) override { return deeper(); }
  bool start_array(std::size_t) override { return deeper(); }
  bool end_object() override { return --depth_ >= 0; }
  bool end_array() override { return --depth_ >= 0; }
  bool parse_error(std::size_t at, const std::string&,
                   const nlohmann::detail::exception&) override {
    found_ = fmt::format("an end or a wrong byte at byte {}", at);
    return false;
  }

 private:
  bool count() {
    if (++values_ <= limits_.values) return true;
    found_ = fmt::format("more than {} values", limits_.values);
    accepted_ = "up to so many in one message";
    return false;
  }
  bool deeper() {
    if (++depth_ <= limits_.depth) return count();
    found_ = fmt::format("more than {} maps and lists in each other", limits_.depth);
    accepted_ = "up to so many";
    return false;
  }

  const PackLimits& limits_;
  std::size_t values_ = 0;
  int depth_ = 0;
  std::string found_ = "bytes that do not read", accepted_ = "a whole map";
};

// Reads up to the value of a key of the outermost map.
class FindNumber final : public nlohmann::json_sax<json> {
 public:
  FindNumber(std::string_view key, int depth) : key_(key), most_deep_(depth) {}
  std::optional<std::uint64_t> found() const { return found_; }

  bool null() override { return other(); }
  bool boolean(bool) override { return other(); }
  bool number_integer(number_integer_t value) override {
    return value >= 0 ? number_unsigned(static_cast<number_unsigned_t>(value)) : other();
  }
  bool number_unsigned(number_unsigned_t value) override {
    if (is_next_) found_ = value;
    return other();
  }
  bool number_float(number_float_t, const string_t&) override { return other(); }
  bool string(string_t&) override { return other(); }
  bool binary(binary_t&) override { return other(); }
  bool key(string_t& name) override {
    is_next_ = depth_ == 1 && name == key_;
    return true;
  }
  bool start_object(std::size_t) override { return other() && ++depth_ <= most_deep_; }
  // In a list nothing has a name.
  bool start_array(std::size_t) override { return other() && depth_ > 0 && ++depth_ <= most_deep_; }
  bool end_object() override { return --depth_ > 0; }
  bool end_array() override { return --depth_ > 0; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

 private:
  // After the value of the key nothing more is read.
  bool other() { return !std::exchange(is_next_, false); }

  std::string_view key_;
  int most_deep_ = 0, depth_ = 0;
  bool is_next_ = false;
  std::optional<std::uint64_t> found_;
};

}  // namespace

Result<json> unpack(Bytes bytes, const PackLimits& limits) {
  constexpr std::string_view kWhere = "MessagePack", kAccepted = "a whole map";
  if (bytes.size() > limits.bytes)
    return refusal(kWhere, fmt::format("{} bytes", bytes.size()),
                   fmt::format("up to {}", limits.bytes));
  const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const auto* end = begin + bytes.size();
  Scan scan(limits);
  if (!json::sax_parse(begin, end, &scan, json::input_format_t::msgpack, true))
    return refusal(kWhere, scan.found(), scan.accepted());
  json value = json::from_msgpack(begin, end, true, false);
  if (!value.is_object()) return refusal(kWhere, value.type_name(), kAccepted);
  return value;
}

std::optional<std::uint64_t> number_under(Bytes bytes, std::string_view key,
                                          const PackLimits& limits) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  FindNumber find(key, limits.depth);
  (void)json::sax_parse(begin, begin + bytes.size(), &find, json::input_format_t::msgpack, false);
  return find.found();
}

std::vector<std::byte> pack(const json& value) {
  std::vector<std::uint8_t> bytes;
  json::to_msgpack(value, bytes);
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  return {begin, begin + bytes.size()};
}

}  // namespace neritic::net
