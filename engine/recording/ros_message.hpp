// Messages whose layout a `ros2msg` schema says, as columns of a table: nested fields get names
// with "_" between the parts, short arrays a column an item, sequences and long arrays one column
// with a list. Any bytes are safe.
// Plain values; any thread.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/recording/mcap.hpp"

namespace neritic::recording {

// Numbers keep their bits: 64-bit ones are not doubles.
using RosValue =
    std::variant<double, std::int64_t, std::uint64_t, std::string, std::vector<double>>;

class RosMessage {
 public:
  struct Column {
    std::string name;
    bool list = false, text = false;
  };
  // kBadInput for a schema that is none, or too deep, too long or too wide; the schema's name
  // stands in messages.
  static Result<RosMessage> parse(const McapSchema& schema);

  const std::vector<Column>& columns() const { return columns_; }
  std::optional<std::size_t> column(std::string_view name) const;
  // A value a column. Nothing where the bytes are not a whole message.
  std::optional<std::vector<RosValue>> read(std::span<const std::byte> bytes) const;
  // The bytes of a sequence of uint8, such as a picture's `data`; its place is that of the column.
  std::optional<std::vector<std::byte>> read_bytes(std::span<const std::byte> bytes,
                                                   std::size_t column) const;

 private:
  enum class Kind {
    kBool,
    kInt8,
    kUint8,
    kInt16,
    kUint16,
    kInt32,
    kUint32,
    kInt64,
    kUint64,
    kFloat32,
    kFloat64,
    kText,
    kStruct
  };
  struct Field {
    Kind kind = Kind::kFloat64;
    std::size_t type = 0;  // of a struct
    std::string name;
    bool many = false;      // an array or a sequence
    std::size_t count = 0;  // of an array; 0: a sequence
  };
  struct Type {
    std::string name;
    std::vector<Field> fields;
  };
  class Parser;
  class Walk;
  std::vector<Type> types_;  // the message's own first
  std::vector<Column> columns_;
};

// A number for a table of doubles; NaN for text and lists.
double number_of(const RosValue& value);

}  // namespace neritic::recording
