#include "proofmass/io/positions/text_lines.hpp"

#include <fmt/format.h>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/cell.hpp"
#include "proofmass/io/csv/layout.hpp"

namespace proofmass::io {
namespace {

constexpr std::size_t longest_text = std::size_t{16} << 20;

std::vector<TextLine> lines_in(std::string_view text) {
  const char line_end = text.find('\n') == std::string_view::npos ? '\r' : '\n';
  std::vector<TextLine> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find(line_end), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    // A semicolon may be a separator after an empty field.
    if (!trimmed(line).empty() && !is_remark(line, ';'))
      lines.push_back({number, std::string(line)});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// The whole text, or more than the maximum length.
Result<std::string_view> peek_all(PeekSource& source) {
  for (std::size_t wanted = std::size_t{64} << 10;; wanted *= 4) {
    auto text = source.peek(wanted);
    if (!text || text->size() < wanted || wanted > longest_text) return text;
  }
}

Result<std::vector<TextLine>> read_from(std::unique_ptr<ByteSource> bytes) {
  auto source = unwrap(std::move(bytes));
  if (!source) return source.error();
  const std::unique_ptr<PeekSource> opened = std::move(source).value();
  const auto whole = peek_all(*opened);
  if (!whole) return whole.error();
  if (whole->size() > longest_text)
    return Error{Errc::corrupt,
                 fmt::format("is longer than {} MiB: a recording, not a list", longest_text >> 20)};
  std::string_view text = *whole;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  auto lines = lines_in(text);
  if (lines.empty()) return Error{Errc::too_few_samples, "is empty"};
  return lines;
}

}  // namespace

Result<std::vector<TextLine>> read_lines(const std::string& path) {
  auto file = open_file(path);
  if (!file) return file.error();
  return read_from(std::move(file).value());
}

Result<std::vector<TextLine>> read_lines(std::span<const std::byte> bytes) {
  return read_from(open_memory(bytes));
}

}  // namespace proofmass::io
