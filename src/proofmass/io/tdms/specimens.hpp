#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/io/matlab/mat_specimens.hpp"
#include "proofmass/io/tdms/value.hpp"

// Writes TDMS files, intact and damaged ones, for tests.
namespace proofmass::io::specimen {

inline constexpr std::uint32_t tdms_metadata = 1U << 1;
inline constexpr std::uint32_t tdms_new_list = 1U << 2;
inline constexpr std::uint32_t tdms_raw_data = 1U << 3;
inline constexpr std::uint32_t tdms_interleaved = 1U << 5;
inline constexpr std::uint32_t tdms_big_endian = 1U << 6;
inline constexpr std::uint32_t tdms_daqmx = 1U << 7;
inline constexpr std::uint32_t tdms_whole = tdms_metadata | tdms_new_list | tdms_raw_data;

/// Objects and their properties, as listed in a segment.
class TdmsList {
 public:
  explicit TdmsList(Order order = Order::little) : order_(order) {}

  template <class T>
  [[nodiscard]] std::string number(T value) const {
    return bytes_of(std::vector<T>{value}, order_);
  }
  [[nodiscard]] std::string text(std::string_view words) const {
    return number(static_cast<std::uint32_t>(words.size())) + std::string(words);
  }

  /// Begins an object; `index` is made by number() and similar functions.
  TdmsList& object(std::string_view path, const std::string& index) {
    end_object();
    ++objects_;
    bytes_ += text(path) + index;
    open_ = true;
    return *this;
  }
  TdmsList& no_values(std::string_view path) { return object(path, number(0xFFFFFFFFU)); }
  TdmsList& as_before(std::string_view path) { return object(path, number(0U)); }
  TdmsList& channel(std::string_view path, std::uint32_t type, std::uint64_t values) {
    return object(path, number(20U) + number(type) + number(1U) + number(values));
  }
  TdmsList& texts(std::string_view path, std::uint64_t values, std::uint64_t bytes) {
    return object(path, number(28U) + number(0x20U) + number(1U) + number(values) + number(bytes));
  }
  /// `scalers` are made by scaler() and digital_line().
  TdmsList& daqmx(std::string_view path,
                  std::uint64_t values,
                  const std::vector<std::string>& scalers,
                  const std::vector<std::uint32_t>& widths,
                  std::uint32_t header = 0x1269) {
    std::string index = number(header) + number(0xFFFFFFFFU) + number(1U) + number(values) +
                        number(static_cast<std::uint32_t>(scalers.size()));
    for (const std::string& scaler : scalers) index += scaler;
    return object(
        path, index + number(static_cast<std::uint32_t>(widths.size())) + bytes_of(widths, order_));
  }
  [[nodiscard]] std::string scaler(std::uint32_t type,
                                   std::uint32_t buffer,
                                   std::uint32_t offset,
                                   std::uint32_t id) const {
    return number(type) + number(buffer) + number(offset) + number(0U) + number(id);
  }
  [[nodiscard]] std::string digital_line(std::uint32_t buffer, std::uint32_t bit) const {
    return number(0U) + number(buffer) + number(bit) + std::string(1, '\0') + number(0U);
  }

  TdmsList& property(std::string_view name, double value) {
    return add(name, number(10U) + number(value));
  }
  TdmsList& property(std::string_view name, std::uint32_t value) {
    return add(name, number(7U) + number(value));
  }
  TdmsList& property(std::string_view name, std::string_view value) {
    return add(name, number(0x20U) + text(value));
  }
  TdmsList& property(std::string_view name, const tdms::Instant& value) {
    return add(name, number(0x44U) + instant(value));
  }
  /// Raw bytes with a type given by the caller.
  TdmsList& property(std::string_view name, std::uint32_t type, const std::string& value) {
    return add(name, number(type) + value);
  }
  [[nodiscard]] std::string instant(const tdms::Instant& value) const {
    return order_ == Order::big ? number(value.seconds) + number(value.fraction)
                                : number(value.fraction) + number(value.seconds);
  }

  [[nodiscard]] std::string bytes() {
    end_object();
    return number(objects_) + bytes_;
  }

 private:
  TdmsList& add(std::string_view name, const std::string& typed) {
    ++count_;
    properties_ += text(name) + typed;
    return *this;
  }
  void end_object() {
    if (open_) bytes_ += number(count_) + properties_;
    open_ = false;
    count_ = 0;
    properties_.clear();
  }

  Order order_;
  std::uint32_t objects_ = 0;
  std::string bytes_;
  bool open_ = false;
  std::uint32_t count_ = 0;
  std::string properties_;
};

inline std::string tdms_lead_in(std::uint32_t contents, std::uint64_t next, std::uint64_t raw) {
  const Order order = (contents & tdms_big_endian) != 0 ? Order::big : Order::little;
  return "TDSm" + bytes_of<std::uint32_t>({contents}) + bytes_of<std::uint32_t>({4713}, order) +
         bytes_of<std::uint64_t>({next, raw}, order);
}

/// A segment with correct lengths.
inline std::string tdms_segment(std::uint32_t contents,
                                const std::string& metadata,
                                const std::string& data) {
  return tdms_lead_in(contents, metadata.size() + data.size(), metadata.size()) + metadata + data;
}

/// The last segment of a program that was killed: its length was never written.
inline std::string tdms_unfinished(std::uint32_t contents,
                                   const std::string& metadata,
                                   const std::string& data) {
  return tdms_lead_in(contents, ~std::uint64_t{0}, metadata.size()) + metadata + data;
}

}  // namespace proofmass::io::specimen
