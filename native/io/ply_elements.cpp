// Reads a PLY file's header, and its values whatever their format.
#include "io/ply_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "io/number.h"

namespace mesograin::io::ply {

namespace {

static_assert(std::endian::native == std::endian::little, "binary values are copied as they are");

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr std::array<TypeName, 16> type_names{{{"char", Type::int8},
                                               {"int8", Type::int8},
                                               {"uchar", Type::uint8},
                                               {"uint8", Type::uint8},
                                               {"short", Type::int16},
                                               {"int16", Type::int16},
                                               {"ushort", Type::uint16},
                                               {"uint16", Type::uint16},
                                               {"int", Type::int32},
                                               {"int32", Type::int32},
                                               {"uint", Type::uint32},
                                               {"uint32", Type::uint32},
                                               {"float", Type::float32},
                                               {"float32", Type::float32},
                                               {"double", Type::float64},
                                               {"float64", Type::float64}}};

/// Takes words and lines off a text and remembers where it is.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::string_view line() {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view line = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    ++line_number_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  /// The next word of any line; empty at the end.
  std::string_view word() {
    constexpr std::string_view blanks = " \t\r\n";
    while (position_ < text_.size() && blanks.find(text_[position_]) != std::string_view::npos)
      if (text_[position_++] == '\n') ++line_number_;
    const std::size_t end = std::min(text_.find_first_of(blanks, position_), text_.size());
    const std::string_view word = text_.substr(position_, end - position_);
    position_ = end;
    return word;
  }

  bool at_end() const { return position_ == text_.size(); }
  std::size_t position() const { return position_; }
  int line_number() const { return line_number_; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  int line_number_ = 0;
};

class AsciiValues : public Values {
 public:
  AsciiValues(std::string_view text, int header_lines)
      : size_(text.size()), words_(text), first_line_(header_lines + 1) {}

  double next(Type) override {
    const std::string_view word = words_.word();
    if (word.empty()) throw Error("{}: the file ends before all of its elements.", place());
    const auto value = parse_float(word);
    const auto whole = parse_integer(word);  // float would round large indices
    if (!value && !whole) throw Error("{}: a finite number is needed; got '{}'.", place(), word.substr(0, 40));
    return whole ? static_cast<double>(*whole) : static_cast<double>(*value);
  }
  std::string place() const override { return fmt::format("line {}", first_line_ + words_.line_number()); }
  std::size_t bytes_left() const override { return size_ - words_.position(); }

 private:
  std::size_t size_;
  Words words_;
  int first_line_;
};

class BinaryValues : public Values {
 public:
  BinaryValues(std::string_view bytes, std::size_t position) : bytes_(bytes), position_(position) {}

  double next(Type type) override {
    switch (type) {
      case Type::int8:
        return take<std::int8_t>();
      case Type::uint8:
        return take<std::uint8_t>();
      case Type::int16:
        return take<std::int16_t>();
      case Type::uint16:
        return take<std::uint16_t>();
      case Type::int32:
        return take<std::int32_t>();
      case Type::uint32:
        return take<std::uint32_t>();
      case Type::float32:
        return take<float>();
      case Type::float64:
        return take<double>();
    }
    return 0.0;
  }
  std::string place() const override { return fmt::format("byte {}", position_); }
  std::size_t bytes_left() const override { return bytes_.size() - position_; }

 private:
  template <typename Value>
  Value take() {
    if (bytes_left() < sizeof(Value)) throw Error("{}: the file ends before all of its elements.", place());
    Value value;
    std::memcpy(&value, bytes_.data() + position_, sizeof(Value));
    position_ += sizeof(Value);
    return value;
  }

  std::string_view bytes_;
  std::size_t position_;
};

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : bytes_(bytes), header_(bytes) {}

  File read() {
    read_header();
    File file{std::move(elements_), nullptr};
    if (binary_)
      file.values = std::make_unique<BinaryValues>(bytes_, header_.position());
    else
      file.values = std::make_unique<AsciiValues>(bytes_.substr(header_.position()), header_.line_number());
    return file;
  }

 private:
  void read_header() {
    if (header_.line() != "ply") throw Error("line 1: a PLY file begins with 'ply'.");
    bool has_format = false;
    while (true) {
      if (header_.at_end()) throw Error("line {}: the header has no 'end_header'.", header_.line_number());
      Words line(header_.line());
      const std::string_view statement = line.word();
      if (statement == "end_header") break;
      if (statement == "format") {
        const std::string_view format = line.word();
        if (format != "ascii" && format != "binary_little_endian")
          throw Error("line {}: the format must be ascii or binary_little_endian; got '{}'.", header_.line_number(),
                      format.substr(0, 40));
        binary_ = format != "ascii";
        has_format = true;
      } else if (statement == "element") {
        read_element(line);
      } else if (statement == "property") {
        read_property(line);
      }
    }
    if (!has_format) throw Error("line {}: the header names no format.", header_.line_number());
  }

  void read_element(Words& line) {
    const std::string name(line.word());
    const std::string_view count_word = line.word();
    const auto count = parse_integer(count_word);
    if (!count || *count < 0 || *count > std::numeric_limits<std::int32_t>::max())
      throw Error("line {}: the element '{}' needs a count from 0 to 2147483647; got '{}'.", header_.line_number(),
                  name.substr(0, 40), count_word.substr(0, 40));
    elements_.push_back({name, static_cast<std::size_t>(*count), {}});
  }

  void read_property(Words& line) {
    if (elements_.empty()) throw Error("line {}: a property needs an element before it.", header_.line_number());
    const std::string_view first = line.word();
    Property property{};
    if (first == "list") {
      property.count_type = read_type(line.word());
      property.type = read_type(line.word());
    } else {
      property.type = read_type(first);
    }
    property.name = line.word();
    elements_.back().properties.push_back(property);
  }

  Type read_type(std::string_view name) const {
    const auto found =
        std::find_if(type_names.begin(), type_names.end(), [&](const TypeName& t) { return t.name == name; });
    if (found == type_names.end())
      throw Error("line {}: '{}' is not a type of PLY properties.", header_.line_number(), name.substr(0, 40));
    return found->type;
  }

  std::string_view bytes_;
  Words header_;
  bool binary_ = false;
  std::vector<Element> elements_;
};

}  // namespace

File open(std::string_view bytes) { return HeaderReader(bytes).read(); }

void require_elements(const Element& element, const Values& values) {
  if (!element.properties.empty() && element.count > values.bytes_left() / element.properties.size())
    throw Error("{}: {} elements '{}' are announced, but the file ends before.", values.place(), element.count,
                element.name.substr(0, 40));
}

std::optional<std::size_t> find(const Element& element, std::initializer_list<std::string_view> names) {
  for (std::size_t i = 0; i < element.properties.size(); ++i)
    if (std::find(names.begin(), names.end(), element.properties[i].name) != names.end()) return i;
  return std::nullopt;
}

std::size_t read_count(const Property& property, Values& values) {
  const double count = values.next(*property.count_type);
  if (!(count >= 0.0 && count <= static_cast<double>(values.bytes_left())))
    throw Error("{}: the list '{}' announces {} values, but the file ends before.", values.place(),
                property.name.substr(0, 40), count);
  return static_cast<std::size_t>(count);
}

float read_scalar(const Property& property, Values& values) {
  if (property.count_type) {
    skip(property, values);
    return 0.0F;
  }
  const double value = values.next(property.type);
  if (!(std::abs(value) <= std::numeric_limits<float>::max()))
    throw Error("{}: the property '{}' must be finite; got {}.", values.place(), property.name.substr(0, 40), value);
  return static_cast<float>(value);
}

void skip(const Property& property, Values& values) {
  const std::size_t count = property.count_type ? read_count(property, values) : 1;
  for (std::size_t i = 0; i < count; ++i) values.next(property.type);
}

void skip(const Element& element, Values& values) {
  if (element.properties.empty()) return;
  for (std::size_t i = 0; i < element.count; ++i)
    for (const Property& property : element.properties) skip(property, values);
}

}  // namespace mesograin::io::ply
