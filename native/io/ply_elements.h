// What any PLY file is: a header that names elements and their properties, and their values one after the other, in
// text or binary.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mesograin::io::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
  std::string name;
  Type type;
  std::optional<Type> count_type;  ///< of a list
};

struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;
};

/// Values of the body, whatever its format.
class Values {
 public:
  virtual ~Values() = default;
  virtual double next(Type type) = 0;
  virtual std::string place() const = 0;
  virtual std::size_t bytes_left() const = 0;
};

/// The least that an element takes is a byte for each property, so that a false count can't cost memory.
/// Throws Error if more elements are announced than the file can hold.
void require_elements(const Element& element, const Values& values);

/// Where the first of these properties stands, if it is there.
std::optional<std::size_t> find(const Element& element, std::initializer_list<std::string_view> names);

/// How many values a list has that stands next. Throws Error if the file ends before.
std::size_t read_count(const Property& property, Values& values);

/// A value that a float can hold; a list is read over and counts as 0. Throws Error for another.
float read_scalar(const Property& property, Values& values);

void skip(const Property& property, Values& values);
void skip(const Element& element, Values& values);

/// A file whose header was read: its elements, and where their values begin.
struct File {
  std::vector<Element> elements;
  std::unique_ptr<Values> values;
};

/// Throws Error, with the line, if the header is none. `bytes` must live as long as the values.
File open(std::string_view bytes);

}  // namespace mesograin::io::ply
