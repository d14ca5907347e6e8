#include "proofmass/acquire/framing/fields.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/acquire/framing/words.hpp"
#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::size_t longest_frame = 4096;

struct FieldType {
  std::string_view name;
  FrameField::Kind kind;
  std::size_t bytes;
};

const FieldType* type_called(std::string_view name) {
  using enum FrameField::Kind;
  static constexpr std::array<FieldType, 12> types{{{"u8", whole_unsigned, 1},
                                                    {"i8", whole_signed, 1},
                                                    {"u16", whole_unsigned, 2},
                                                    {"i16", whole_signed, 2},
                                                    {"u24", whole_unsigned, 3},
                                                    {"i24", whole_signed, 3},
                                                    {"u32", whole_unsigned, 4},
                                                    {"i32", whole_signed, 4},
                                                    {"u64", whole_unsigned, 8},
                                                    {"i64", whole_signed, 8},
                                                    {"f32", floating, 4},
                                                    {"f64", floating, 8}}};
  const auto* const found = std::ranges::find(types, name, &FieldType::name);
  return found == types.end() ? nullptr : found;
}

/// Parses the groups in order.
class LayoutReader {
 public:
  explicit LayoutReader(bool big_endian) : big_endian_(big_endian) {}

  Status add(std::string_view group) {
    std::vector<std::string_view> words = words_of(group, " \t");
    bool big_endian = big_endian_;
    if (!words.empty() && (words.front() == "be" || words.front() == "le")) {
      big_endian = words.front() == "be";
      words.erase(words.begin());
    }
    if (words.empty())
      return invalid("fields=: a group is empty; expected as in u32 t_us, i16 x y z");
    const std::string_view type = words.front();
    words.erase(words.begin());
    if (type == "pad") return add_pad(words);
    if (const auto check = check_called(type)) return add_check(*check, words, big_endian);
    return add_fields(type, words, big_endian);
  }
  Result<FrameLayout> finish() {
    if (layout_.fields.empty())
      return invalid("fields=: expected fields, as in u32 t_us, i16 x y z");
    if (layout_.bytes > longest_frame)
      return invalid(
          fmt::format("fields=: {} bytes a frame; {} are the most", layout_.bytes, longest_frame));
    return std::move(layout_);
  }

 private:
  Status add_pad(const std::vector<std::string_view>& words) {
    std::size_t bytes = 0;
    const std::string_view count = words.size() == 1 ? words.front() : "";
    const auto [end, problem] = std::from_chars(count.data(), count.data() + count.size(), bytes);
    if (problem != std::errc{} || end != count.data() + count.size() || bytes == 0 ||
        bytes > longest_frame)
      return invalid(fmt::format("fields=: pad {}: expected a number of bytes", count));
    layout_.bytes += bytes;
    return Done{};
  }
  Status add_check(Check check, const std::vector<std::string_view>& words, bool big_endian) {
    if (layout_.check) return invalid("fields=: one checksum is the most");
    if (!words.empty())
      return invalid(fmt::format("fields=: {}: a checksum has no name", words[0]));
    layout_.check = check;
    layout_.check_offset = layout_.bytes;
    layout_.check_big_endian = big_endian;
    layout_.bytes += bytes_of(check);
    return Done{};
  }
  Status add_fields(std::string_view type,
                    const std::vector<std::string_view>& names,
                    bool big_endian) {
    const FieldType* const found = type_called(type);
    if (found == nullptr)
      return invalid(
          fmt::format("fields=: {}: expected a type: u8 i8 u16 i16 u24 i24 u32 i32 u64 i64 "
                      "f32 f64 pad crc8 crc16 crc16-modbus crc32",
                      type));
    if (names.empty()) return invalid(fmt::format("fields=: {}: expected names after it", type));
    for (const std::string_view name : names) {
      layout_.fields.push_back(
          {std::string(name), found->kind, layout_.bytes, found->bytes, big_endian});
      layout_.bytes += found->bytes;
    }
    return Done{};
  }

  FrameLayout layout_;
  bool big_endian_;
};

std::uint64_t load(std::string_view bytes, bool big_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t at = big_endian ? i : bytes.size() - 1 - i;
    value = value << 8 | static_cast<unsigned char>(bytes[at]);
  }
  return value;
}

std::int64_t signed_of(std::uint64_t value, std::size_t bytes) {
  const auto unused = static_cast<unsigned>(64 - 8 * bytes);
  return static_cast<std::int64_t>(value << unused) >> unused;
}

double floating_of(std::uint64_t value, std::size_t bytes) {
  if (bytes == 8) return std::bit_cast<double>(value);
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(value)));
}

}  // namespace

Result<FrameLayout> FrameLayout::parse(std::string_view text, bool big_endian) {
  LayoutReader reader(big_endian);
  for (const std::string_view group : words_of(text, ","))
    if (const Status added = reader.add(group); !added) return added.error();
  return reader.finish();
}

bool FrameLayout::is_sound(std::string_view frame) const {
  PM_EXPECTS(frame.size() == bytes);
  if (!check) return true;
  const std::string_view sum = frame.substr(check_offset, bytes_of(*check));
  return load(sum, check_big_endian) == checksum(*check, frame.substr(0, check_offset));
}

void FrameLayout::read(std::string_view frame, std::span<double> values) const {
  PM_EXPECTS(frame.size() == bytes && values.size() == fields.size());
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const FrameField& field = fields[f];
    const std::uint64_t bits = load(frame.substr(field.offset, field.bytes), field.big_endian);
    values[f] = field.kind == FrameField::Kind::floating ? floating_of(bits, field.bytes)
                : field.kind == FrameField::Kind::whole_signed
                    ? static_cast<double>(signed_of(bits, field.bytes))
                    : static_cast<double>(bits);
  }
}

std::optional<Tick> read_tick(std::string_view frame, const FrameField& field) {
  const std::uint64_t bits = load(frame.substr(field.offset, field.bytes), field.big_endian);
  if (field.kind == FrameField::Kind::whole_signed) return Tick{signed_of(bits, field.bytes), 0};
  if (field.kind == FrameField::Kind::whole_unsigned)
    return Tick{static_cast<std::int64_t>(bits), 0};
  return tick_of(floating_of(bits, field.bytes));
}

}  // namespace proofmass::acquire
