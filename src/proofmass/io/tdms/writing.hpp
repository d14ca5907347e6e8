#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "proofmass/io/bytes/little_endian.hpp"
#include "proofmass/io/tdms/value.hpp"

namespace proofmass::io::tdms {

inline constexpr std::uint32_t double_type = 10;

/// A length followed by as many bytes.
inline void append_text(std::string& out, std::string_view text) {
  append_value(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

/// Properties of an object, counted as they are added.
class PropertyList {
 public:
  void text(std::string_view name, std::string_view value) {
    constexpr std::uint32_t type = 0x20;
    begin(name, type);
    append_text(bytes_, value);
  }
  void figure(std::string_view name, double value) {
    begin(name, double_type);
    append_value(bytes_, value);
  }
  void whole(std::string_view name, std::int32_t value) {
    constexpr std::uint32_t type = 3;
    begin(name, type);
    append_value(bytes_, value);
  }
  void instant(std::string_view name, const Instant& value) {
    constexpr std::uint32_t type = 0x44;
    begin(name, type);
    append_value(bytes_, value.fraction);
    append_value(bytes_, value.seconds);
  }
  /// In the format of a segment's list.
  void append_to(std::string& out) const {
    append_value(out, count_);
    out += bytes_;
  }

 private:
  void begin(std::string_view name, std::uint32_t type) {
    ++count_;
    append_text(bytes_, name);
    append_value(bytes_, type);
  }

  std::uint32_t count_ = 0;
  std::string bytes_;
};

}  // namespace proofmass::io::tdms
