#include "proofmass/fleet/noise_sums.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>

#include "proofmass/core/state_bytes.hpp"

namespace proofmass::fleet {
namespace {

constexpr std::string_view sums_magic = "proofmass-noise-sums 4 ";
// Read as another number on a machine with another byte order.
constexpr std::uint64_t byte_order = 0x0102030405060708;
constexpr std::string_view base64_digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// FNV-1a of 64 bits. Source: draft-eastlake-fnv, section 5.
std::uint64_t checksum(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

// Source: RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const auto byte = [&](std::size_t j) {
      return k + j < bytes.size() ? static_cast<unsigned char>(bytes[k + j]) : 0U;
    };
    const std::uint32_t three = byte(0) << 16U | byte(1) << 8U | byte(2);
    text += base64_digits[three >> 18U];
    text += base64_digits[three >> 12U & 63U];
    text += k + 1 < bytes.size() ? base64_digits[three >> 6U & 63U] : '=';
    text += k + 2 < bytes.size() ? base64_digits[three & 63U] : '=';
  }
  return text;
}

std::optional<std::string> bytes_of_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::array<int, 256> value{};
  value.fill(-1);
  for (std::size_t k = 0; k < base64_digits.size(); ++k)
    value[static_cast<unsigned char>(base64_digits[k])] = static_cast<int>(k);
  std::size_t padding = 0;
  while (padding < 2 && text.ends_with('=')) {
    text.remove_suffix(1);
    ++padding;
  }
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t collected = 0, bits = 0;
  for (const char c : text) {
    const int digit = value[static_cast<unsigned char>(c)];
    if (digit < 0) return std::nullopt;
    collected = (collected << 6U | static_cast<std::uint32_t>(digit)) & 0xffffffU;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(collected >> bits & 255U);
  }
  return bytes;
}

std::optional<std::size_t> whole_number(std::string_view text) {
  std::size_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

// The words of "a b c".
std::vector<std::string_view> words_of(std::string_view text, char separator) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t at = text.find(separator);
    words.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return words;
    text.remove_prefix(at + 1);
  }
}

void exchange(StateBytes& bytes, Unit& unit) {
  auto quantity = static_cast<std::int32_t>(unit.quantity);
  bytes(quantity);
  if (quantity < 0 || quantity > static_cast<std::int32_t>(Quantity::magnetic_field)) {
    bytes.fail();
    quantity = 0;
  }
  unit.quantity = static_cast<Quantity>(quantity);
  bytes(unit.to_si);
  bytes(unit.offset_si);
  bytes(unit.symbol);
}

void exchange(StateBytes& bytes, SummedChannel& channel) {
  bytes(channel.name);
  exchange(bytes, channel.unit);
  bytes(channel.refused);
  bytes(channel.lsb);
  bytes(channel.first_valid);
  bytes(channel.sums);
}

void exchange(StateBytes& bytes, Note& note) {
  auto severity = static_cast<std::int32_t>(note.severity);
  bytes(severity);
  if (severity < 0 || severity > static_cast<std::int32_t>(Severity::bad)) {
    bytes.fail();
    severity = 0;
  }
  note.severity = static_cast<Severity>(severity);
  bytes(note.text);
  constexpr std::size_t least_bytes = 16;
  note.advice.resize(bytes.size(note.advice.size(), least_bytes));
  for (Advice& one : note.advice) {
    bytes(one.option);
    bytes(one.value);
  }
}

void exchange(StateBytes& bytes, RecordingSums& sums) {
  std::uint64_t order = byte_order;
  bytes(order);
  if (order != byte_order) bytes.fail();
  bytes(sums.file);
  bytes(sums.bytes);
  bytes(sums.options);
  bytes(sums.rate_hz);
  bytes(sums.clock_s);
  bytes(sums.samples);
  if (!(sums.rate_hz > 0.0 && sums.rate_hz < 1e12)) bytes.fail();
  constexpr std::size_t least_bytes = 8;
  sums.channels.resize(bytes.size(sums.channels.size(), least_bytes));
  for (SummedChannel& channel : sums.channels) exchange(bytes, channel);
  sums.notes.resize(bytes.size(sums.notes.size(), least_bytes));
  for (Note& note : sums.notes) exchange(bytes, note);
}

Error corrupt_sums(const char* what) {
  return {Errc::corrupt, fmt::format("sums of noise: {}: delete it and run the fleet again", what)};
}

// "proofmass-noise-sums 4 KEY SHA256 PLACE CHARACTERS CHECKSUM\n"
struct HeadLine {
  SumsHead head;
  std::size_t length = 0;      // with the end of the line
  std::size_t characters = 0;  // of what follows it, with its end of line
  std::string_view checksum;
};

std::optional<HeadLine> head_line(std::string_view text) {
  const std::size_t end = text.find('\n');
  if (!is_sums(text) || end == std::string_view::npos) return std::nullopt;
  const auto words = words_of(text.substr(0, end), ' ');
  constexpr std::size_t expected = 7;
  if (words.size() != expected) return std::nullopt;
  const auto characters = whole_number(words[5]);
  if (!characters) return std::nullopt;
  const auto none_of = [](std::string_view word) { return std::string(word == "-" ? "" : word); };
  return HeadLine{{none_of(words[2]), none_of(words[3]), std::string(words[4])},
                  end + 1,
                  *characters,
                  words[6]};
}

}  // namespace

std::string SumsPlace::word() const {
  if (as_samples) return fmt::format("samples:{}", first);
  return fmt::format("{}:{}:{}", first, digits, fmt::join(origins, ","));
}

std::optional<SumsPlace> SumsPlace::parse(std::string_view word) {
  const auto parts = words_of(word, ':');
  SumsPlace place;
  if (parts.size() == 2 && parts[0] == "samples") {
    place.as_samples = true;
    const auto first = whole_number(parts[1]);
    if (!first) return std::nullopt;
    place.first = *first;
    return place;
  }
  if (parts.size() != 3) return std::nullopt;
  const auto first = whole_number(parts[0]), digits = whole_number(parts[1]);
  constexpr std::size_t most_digits = 48;
  if (!first || !digits || *digits == 0 || *digits > most_digits || *first >> most_digits != 0)
    return std::nullopt;
  place.first = *first;
  place.digits = *digits;
  for (const std::string_view origin : words_of(parts[2], ',')) {
    const auto at = whole_number(origin);
    if (!at || *at >> most_digits != 0) return std::nullopt;
    place.origins.push_back(*at);
  }
  return place;
}

characterise::PartPlace SumsPlace::of_channel(std::size_t channel) const {
  return {.first = first,
          .origin = channel < origins.size() ? origins[channel] : 0,
          .total = (std::size_t{1} << digits) - 1};
}

std::string text_of(RecordingSums sums) {
  StateBytes bytes;
  exchange(bytes, sums);
  const std::string rest = base64(std::move(bytes).bytes()) + '\n';
  const auto word = [](const std::string& text) { return text.empty() ? "-" : text; };
  const std::string head =
      fmt::format("{}{} {} {} {}", sums_magic, word(sums.key), word(sums.sha256),
                  sums.place ? sums.place->word() : "none", rest.size());
  return fmt::format("{} {:016x}\n{}", head, checksum(head + rest), rest);
}

bool is_sums(std::string_view beginning) {
  return beginning.starts_with(sums_magic);
}

Result<RecordingSums> sums_of_text(std::string_view text) {
  const auto line = head_line(text);
  if (!line) return corrupt_sums("its head line is not that of this version");
  const std::string_view rest = text.substr(line->length);
  if (rest.size() != line->characters)
    return corrupt_sums(rest.size() < line->characters ? "it is cut off" : "it is too long");
  const std::string_view head = text.substr(0, line->length - line->checksum.size() - 2);
  if (fmt::format("{:016x}", checksum(std::string(head) + std::string(rest))) != line->checksum)
    return corrupt_sums("its checksum does not match");
  RecordingSums sums;
  sums.key = line->head.key;
  sums.sha256 = line->head.sha256;
  if (line->head.place != "none") {
    sums.place = SumsPlace::parse(line->head.place);
    if (!sums.place) return corrupt_sums("its place is not one");
  }
  const auto decoded = bytes_of_base64(rest.substr(0, rest.empty() ? 0 : rest.size() - 1));
  if (!decoded) return corrupt_sums("its text is not base64");
  StateBytes bytes(*decoded);
  exchange(bytes, sums);
  if (!bytes.complete()) return corrupt_sums("its content is not that of this version");
  return sums;
}

std::optional<SumsHead> head_of_sums(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  if (!std::getline(file, text)) return std::nullopt;
  const auto line = head_line(text + '\n');
  std::error_code problem;
  const std::uintmax_t size = std::filesystem::file_size(path, problem);
  if (!line || problem || size != line->length + line->characters) return std::nullopt;
  return line->head;
}

}  // namespace proofmass::fleet
