#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/io/bytes/deflate_test_support.hpp"

// Writes MAT files, intact and damaged ones, for tests.
namespace proofmass::io::specimen {

enum class Order { little, big };

template <class T>
std::string bytes_of(const std::vector<T>& values, Order order = Order::little) {
  std::string out;
  for (const T value : values) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if ((order == Order::big) == (std::endian::native == std::endian::little))
      std::ranges::reverse(bytes);
    out.append(bytes.data(), bytes.size());
  }
  return out;
}

/// The first 128 bytes of version 5.
inline std::string mat5_header(Order order = Order::little) {
  std::string header = "MATLAB 5.0 MAT-file, made by a test";
  header.resize(124, ' ');
  return header + (order == Order::big ? std::string("\1\0MI", 4) : std::string("\0\1IM", 4));
}

/// A data element, with the data in its tag if they fit.
inline std::string element(std::uint32_t type, const std::string& data, Order order) {
  const auto size = static_cast<std::uint32_t>(data.size());
  if (size > 0 && size <= 4) {
    std::string out = bytes_of<std::uint32_t>({size << 16 | type}, order) + data;
    out.resize(8, '\0');
    return out;
  }
  std::string out = bytes_of<std::uint32_t>({type, size}, order) + data;
  out.resize((out.size() + 7) / 8 * 8, '\0');
  return out;
}

/// An array of version 5 before its content is added.
struct Array {
  std::uint32_t array_class = 6;  ///< 6 double, 2 struct, 1 cell, …
  std::vector<std::int32_t> shape{1, 1};
  std::string name{};
  std::uint32_t flags = 0;  ///< 0x800 complex, 0x200 logical
  Order order = Order::little;
};

inline std::string matrix(const Array& array, const std::string& content) {
  const std::string body =
      element(6, bytes_of<std::uint32_t>({array.array_class | array.flags, 0}, array.order),
              array.order) +
      element(5, bytes_of(array.shape, array.order), array.order) +
      element(1, array.name, array.order) + content;
  return bytes_of<std::uint32_t>({14, static_cast<std::uint32_t>(body.size())}, array.order) + body;
}

/// A matrix of doubles, column by column.
inline std::string doubles(const std::string& name,
                           std::int32_t rows,
                           const std::vector<double>& values,
                           Order order = Order::little) {
  const auto columns = static_cast<std::int32_t>(values.size()) / rows;
  return matrix({6, {rows, columns}, name, 0, order}, element(9, bytes_of(values, order), order));
}

struct Field {
  std::string name;
  std::string value;
};
inline std::string structure(const std::string& name, const std::vector<Field>& fields) {
  constexpr std::size_t length = 16;
  std::string names;
  std::string values;
  for (const Field& field : fields) {
    names += field.name;
    names.resize((names.size() + length - 1) / length * length, '\0');
    values += field.value;
  }
  return matrix({2, {1, 1}, name}, element(5, bytes_of<std::int32_t>({length}), Order::little) +
                                       element(1, names, Order::little) + values);
}

/// A variable as written by MATLAB's version 7.
inline std::string packed(const std::string& variable, Order order = Order::little) {
  const std::string data = deflated(variable, 15);
  return bytes_of<std::uint32_t>({15, static_cast<std::uint32_t>(data.size())}, order) + data;
}

/// A variable of version 4. `kind` is P and T of its first number: 0 double, 10 single, … + 1 text.
inline std::string mat4(const std::string& name,
                        std::array<std::int32_t, 2> shape,
                        std::int32_t kind,
                        const std::string& figures,
                        Order order = Order::little) {
  const std::int32_t machine = order == Order::big ? 1000 : 0;
  const auto name_bytes = static_cast<std::int32_t>(name.size() + 1);
  return bytes_of<std::int32_t>({machine + kind, shape[0], shape[1], 0, name_bytes}, order) + name +
         '\0' + figures;
}

}  // namespace proofmass::io::specimen
