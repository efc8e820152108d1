#include "engine/net/message_pack.hpp"

#include <nlohmann/json.hpp>

#include "engine/core/refusal.hpp"

namespace neritic::net {
namespace {

using nlohmann::json;

// Reads the bytes and keeps nothing; stops at the first limit.
class Scan final : public nlohmann::json_sax<json> {
 public:
  explicit Scan(const PackLimits& limits) : limits_(limits) {}
  const std::string& found() const { return found_; }

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
    if (found_.empty()) found_ = fmt::format("an end or a wrong byte at byte {}", at);
    return false;
  }

 private:
  bool count() {
    if (++values_ <= limits_.values) return true;
    found_ = fmt::format("more than {} values", limits_.values);
    return false;
  }
  bool deeper() {
    if (++depth_ <= limits_.depth) return count();
    found_ = fmt::format("more than {} maps and lists in each other", limits_.depth);
    return false;
  }

  const PackLimits& limits_;
  std::size_t values_ = 0;
  int depth_ = 0;
  std::string found_;
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
    return refusal(kWhere, scan.found().empty() ? "bytes that do not read" : scan.found(),
                   kAccepted);
  json value = json::from_msgpack(begin, end, true, false);
  if (!value.is_object()) return refusal(kWhere, value.type_name(), kAccepted);
  return value;
}

std::vector<std::byte> pack(const json& value) {
  std::vector<std::uint8_t> bytes;
  json::to_msgpack(value, bytes);
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  return {begin, begin + bytes.size()};
}

}  // namespace neritic::net
