#include "proofmass/io/wav/header.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>

namespace proofmass::io::wav {
namespace {

constexpr std::uint32_t unknown_size = 0xFFFF'FFFF;
constexpr std::size_t chunk_head_bytes = 8;

std::uint64_t number(std::string_view bytes, bool big_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[big_endian ? i : bytes.size() - 1 - i]);
  return value;
}

bool is_name(std::string_view four) {
  return std::ranges::all_of(four, [](char c) { return c >= ' ' && c <= '~'; });
}

std::string_view name_of(std::uint64_t encoding) {
  switch (encoding) {
    case 2:
    case 17:
      return "ADPCM";
    case 6:
      return "A-law";
    case 7:
      return "mu-law";
    case 80:
    case 85:
      return "MPEG";
    default:
      return "not known";
  }
}

/// Iterates over the chunks of a file.
class ChunkReader {
 public:
  explicit ChunkReader(const RandomBytes& file) : file_(file) {}

  Result<Header> run() {
    const auto front = text_at(0, 12);
    if (!front) return front.error();
    if (front->size() < 12) return breaks_off("the header");
    const std::string_view form = std::string_view(*front).substr(0, 4);
    big_endian_ = form == "RIFX";
    is_long_ = form == "RF64" || form == "BW64";
    if (std::string_view(*front).substr(8) != "WAVE")
      return Error{Errc::unsupported,
                   "is a RIFF file, though not of sound: expected WAVE at byte 8"};
    if (const Status read = read_chunks(); !read) return read.error();
    if (!has_format_)
      return Error{Errc::corrupt, at("no chunk \"fmt \" says how samples are kept")};
    if (!has_data_) return Error{Errc::corrupt, at("no chunk \"data\" holds samples")};
    if (header_.rows() == 0)
      return Error{Errc::too_few_samples, fmt::format("byte {}: holds no sample", header_.begin)};
    return std::move(header_);
  }

 private:
  struct Chunk {
    std::string name;
    std::uint64_t begin = 0;  ///< offset of its content
    std::uint64_t size = 0;
    std::uint64_t left = 0;  ///< bytes of the file from there
  };

  [[nodiscard]] std::string at(std::string_view what) const {
    return fmt::format("byte {}: {}", position_, what);
  }
  [[nodiscard]] Error breaks_off(std::string_view where) const {
    return {Errc::corrupt, fmt::format("byte {}: breaks off within {}", file_.size(), where)};
  }

  /// At most as many bytes as there are.
  Result<std::string> text_at(std::uint64_t offset, std::size_t size) const {
    std::string text(size, '\0');
    const auto count = file_.read_at(offset, text);
    if (!count) return count.error();
    text.resize(*count);
    return text;
  }

  Status read_chunks() {
    constexpr std::size_t most_chunks = 10'000;
    position_ = 12;
    for (std::size_t k = 0; k < most_chunks && position_ + chunk_head_bytes <= file_.size(); ++k) {
      const auto head = text_at(position_, chunk_head_bytes);
      if (!head) return head.error();
      Chunk chunk{head->substr(0, 4), position_ + chunk_head_bytes,
                  number(std::string_view(*head).substr(4), big_endian_), 0};
      chunk.left = file_.size() - chunk.begin;
      if (const Status read = read_chunk(chunk); !read) return read.error();
      if (chunk.size > chunk.left) break;
      position_ = chunk.begin + chunk.size + chunk.size % 2;
    }
    return Done{};
  }

  Status read_chunk(Chunk& chunk) {
    if (chunk.name == "fmt ") return read_format(chunk);
    if (chunk.name == "ds64") return read_long_sizes(chunk);
    if (chunk.name == "LIST") return read_texts(chunk);
    if (chunk.name == "data" && !has_data_) return place_data(chunk);
    return Done{};
  }

  Status read_format(const Chunk& chunk) {
    constexpr std::size_t short_form = 16;
    constexpr std::size_t long_form = 40;
    if (has_format_) return Done{};
    if (chunk.left < short_form) return breaks_off("the chunk \"fmt \"");
    const auto bytes =
        text_at(chunk.begin, std::min<std::uint64_t>(std::min(chunk.size, chunk.left), long_form));
    if (!bytes) return bytes.error();
    if (bytes->size() < short_form)
      return Error{Errc::corrupt, at("the chunk \"fmt \" is too short")};
    const auto field = [&](std::size_t offset, std::size_t size) {
      return number(std::string_view(*bytes).substr(offset, size), big_endian_);
    };
    std::uint64_t encoding = field(0, 2);
    header_.channels = static_cast<std::size_t>(field(2, 2));
    header_.rate_hz = static_cast<std::uint32_t>(field(4, 4));
    const auto row_bytes = static_cast<std::size_t>(field(12, 2));
    header_.valid_bits = static_cast<std::size_t>(field(14, 2));
    const std::size_t bits = header_.valid_bits;
    constexpr std::uint64_t extensible = 0xFFFE;
    if (encoding == extensible && bytes->size() < long_form)
      return Error{Errc::corrupt, at("the chunk \"fmt \" is too short for its encoding")};
    if (encoding == extensible) {
      encoding = field(24, 2);
      if (const std::uint64_t valid = field(18, 2); valid > 0 && valid < bits)
        header_.valid_bits = static_cast<std::size_t>(valid);
    }
    has_format_ = true;
    return take_format(encoding, bits, row_bytes);
  }

  Status take_format(std::uint64_t encoding, std::size_t bits, std::size_t row_bytes) {
    constexpr std::uint64_t whole = 1;
    constexpr std::uint64_t floating = 3;
    const std::size_t bytes = (bits + 7) / 8;
    if (encoding != whole && encoding != floating)
      return Error{Errc::unsupported,
                   at(fmt::format("sound of encoding {} ({}), which is not read: save it as PCM",
                                  encoding, name_of(encoding)))};
    const bool is_known = encoding == whole ? bytes >= 1 && bytes <= 4 : bits == 32 || bits == 64;
    if (!is_known)
      return Error{Errc::unsupported,
                   at(fmt::format("samples of {} bits, which are not read: expected 8 to 32, or 32 "
                                  "or 64 of floating point",
                                  bits))};
    if (header_.channels == 0 || row_bytes != header_.channels * bytes)
      return Error{Errc::corrupt,
                   at(fmt::format("{} channels of {} bytes cannot be the {} bytes of a sample",
                                  header_.channels, bytes, row_bytes))};
    const char whole_kind = bytes == 1 ? 'u' : 'i';
    header_.figure = {encoding == whole ? whole_kind : 'f', bytes, big_endian_};
    return Done{};
  }

  /// The sizes that exceed 32 bits.
  Status read_long_sizes(const Chunk& chunk) {
    const auto bytes = text_at(chunk.begin, 16);
    if (!bytes) return bytes.error();
    if (bytes->size() < 16) return breaks_off("the chunk \"ds64\"");
    long_data_bytes_ = number(std::string_view(*bytes).substr(8, 8), big_endian_);
    return Done{};
  }

  Status place_data(Chunk& chunk) {
    if (!has_format_)
      return Error{Errc::corrupt, at("the samples stand before the chunk \"fmt \" that says what "
                                     "they are")};
    if (is_long_ && chunk.size == unknown_size && long_data_bytes_) chunk.size = *long_data_bytes_;
    const bool was_killed =
        chunk.size == unknown_size || (chunk.size == 0 && !is_followed_by_chunk(chunk));
    if (was_killed && chunk.left > 0) {
      chunk.size = chunk.left;
      header_.notes.push_back(
          {Severity::warning,
           at("the length of the samples was never filled in, as when a recorder "
              "is stopped hard: read to the end of the file")});
    }
    if (chunk.size > chunk.left) header_.claimed_bytes = chunk.size;
    header_.begin = chunk.begin;
    header_.bytes = std::min(chunk.size, chunk.left);
    has_data_ = true;
    const std::uint64_t rest = header_.bytes % header_.row_bytes();
    if (rest != 0 && !header_.claimed_bytes)
      header_.notes.push_back(
          {Severity::warning, fmt::format("byte {}: {} bytes after the last sample are less than "
                                          "a sample: skipped",
                                          header_.begin + header_.bytes - rest, rest)});
    return Done{};
  }

  [[nodiscard]] bool is_followed_by_chunk(const Chunk& chunk) const {
    const auto head = text_at(chunk.begin, chunk_head_bytes);
    if (!head || head->size() < chunk_head_bytes || !is_name(head->substr(0, 4))) return false;
    return number(std::string_view(*head).substr(4), big_endian_) <= chunk.left - chunk_head_bytes;
  }

  Status read_texts(const Chunk& chunk) {
    constexpr std::size_t most = std::size_t{1} << 16;
    const auto list =
        text_at(chunk.begin, std::min<std::uint64_t>(std::min(chunk.size, chunk.left), most));
    if (!list) return list.error();
    std::string_view rest(*list);
    if (!rest.starts_with("INFO")) return Done{};
    rest.remove_prefix(4);
    while (rest.size() >= chunk_head_bytes) {
      const std::string name(rest.substr(0, 4));
      const std::uint64_t size = number(rest.substr(4, 4), big_endian_);
      rest.remove_prefix(chunk_head_bytes);
      const std::string_view text = rest.substr(0, std::min<std::uint64_t>(size, rest.size()));
      if (is_name(name)) header_.texts.emplace(name, text.substr(0, text.find('\0')));
      rest.remove_prefix(std::min<std::uint64_t>(size + size % 2, rest.size()));
    }
    return Done{};
  }

  const RandomBytes& file_;
  Header header_;
  std::uint64_t position_ = 0;
  bool big_endian_ = false;
  bool is_long_ = false;
  bool has_format_ = false;
  bool has_data_ = false;
  std::optional<std::uint64_t> long_data_bytes_;
};

}  // namespace

Result<Header> read_header(const RandomBytes& file) {
  return ChunkReader(file).run();
}

}  // namespace proofmass::io::wav
