#include "proofmass/io/numpy/npy_figures.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>
#include <limits>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/arrays/figure_column.hpp"

namespace proofmass::io {
namespace {

constexpr std::size_t piece_bytes = std::size_t{256} << 10;

class AscendingBytes final : public RandomBytes {
 public:
  explicit AscendingBytes(std::unique_ptr<PeekSource> source) : source_(std::move(source)) {}

  [[nodiscard]] std::uint64_t size() const override {
    return source_->size().value_or(std::numeric_limits<std::uint64_t>::max());
  }
  [[nodiscard]] Result<std::size_t> read_at(std::uint64_t offset,
                                            std::span<char> into) const override {
    PM_EXPECTS(offset >= position_);
    std::array<char, 4096> skipped;
    while (position_ < offset) {
      const auto most = std::min<std::uint64_t>(skipped.size(), offset - position_);
      const auto count = fill(std::span(skipped).first(static_cast<std::size_t>(most)));
      if (!count) return count.error();
      if (*count == 0) return std::size_t{0};
    }
    return fill(into);
  }
  [[nodiscard]] std::vector<Note> notes() const override { return source_->notes(); }

 private:
  Result<std::size_t> fill(std::span<char> into) const {
    std::size_t filled = 0;
    while (filled < into.size()) {
      const auto count = source_->read(into.subspan(filled));
      if (!count) return count.error();
      if (*count == 0) break;
      filled += *count;
    }
    position_ += filled;
    return filled;
  }

  std::unique_ptr<PeekSource> source_;
  mutable std::uint64_t position_ = 0;
};

}  // namespace

std::unique_ptr<RandomBytes> ascending_bytes_of(std::unique_ptr<PeekSource> source) {
  return std::make_unique<AscendingBytes>(std::move(source));
}

Result<NpyFigures> NpyFigures::open(std::unique_ptr<RandomBytes> bytes, NpyLayout layout) {
  constexpr std::size_t longest_row = std::size_t{1} << 20;
  if (layout.row_bytes > longest_row)
    return Error{Errc::unsupported,
                 fmt::format("has {} bytes a sample: too many for a recording", layout.row_bytes)};
  const std::uint64_t there = bytes->size() - std::min(bytes->size(), layout.begin);
  const std::uint64_t wanted = layout.figure_bytes();
  if (wanted > there && (layout.by_column || there < layout.row_bytes))
    return Error{Errc::corrupt,
                 fmt::format("byte {}: the header claims {} bytes of figures, {} are there",
                             layout.begin, wanted, there)};
  return NpyFigures(std::move(bytes), std::move(layout));
}

std::size_t NpyFigures::rows_there() const {
  const std::uint64_t there = bytes_->size() - std::min(bytes_->size(), layout_.begin);
  return static_cast<std::size_t>(std::min<std::uint64_t>(layout_.rows, there / layout_.row_bytes));
}

Result<std::size_t> NpyFigures::read(std::span<const std::span<double>> into) {
  PM_EXPECTS(into.size() == layout_.columns.size() && !into.empty());
  const std::size_t rows = std::min(into[0].size(), layout_.rows - rows_read_);
  if (rows == 0 || is_ended_) return std::size_t{0};
  return layout_.by_column ? read_columns(into, rows) : read_rows(into, rows);
}

Result<std::size_t> NpyFigures::read_rows(std::span<const std::span<double>> into,
                                          std::size_t rows) {
  const std::size_t most = std::clamp<std::size_t>(piece_bytes / layout_.row_bytes, 1, rows);
  piece_.resize(most * layout_.row_bytes);
  std::size_t done = 0;
  while (done < rows) {
    const std::size_t wanted = std::min(most, rows - done);
    const auto count =
        bytes_->read_at(layout_.begin + std::uint64_t{rows_read_} * layout_.row_bytes,
                        std::span(piece_).first(wanted * layout_.row_bytes));
    if (!count) return count.error();
    const std::size_t whole = *count / layout_.row_bytes;
    for (std::size_t c = 0; c < into.size(); ++c) {
      const NpyColumn& column = layout_.columns[c];
      load_figures(piece_.data() + column.offset, layout_.row_bytes, column.type,
                   into[c].subspan(done, whole));
    }
    done += whole;
    rows_read_ += whole;
    is_ended_ = whole < wanted;
    if (is_ended_) break;
  }
  return done;
}

Result<std::size_t> NpyFigures::read_columns(std::span<const std::span<double>> into,
                                             std::size_t rows) {
  const FigureType& type = layout_.columns[0].type;
  rows = std::min(rows, piece_bytes / type.bytes);
  piece_.resize(rows * type.bytes);
  for (std::size_t c = 0; c < into.size(); ++c) {
    const std::uint64_t first = std::uint64_t{c} * layout_.rows + rows_read_;
    const auto count = bytes_->read_at(layout_.begin + first * type.bytes, piece_);
    if (!count) return count.error();
    if (*count < piece_.size())
      return Error{Errc::corrupt, fmt::format("breaks off within column {} of {}", c, into.size())};
    load_figures(piece_.data(), type.bytes, type, into[c].first(rows));
  }
  rows_read_ += rows;
  return rows;
}

std::vector<Note> NpyFigures::notes() const {
  std::vector<Note> notes;
  if (rows_read_ < layout_.rows)
    notes.push_back({Severity::bad, fmt::format("breaks off after {} of {} samples: those are kept",
                                                rows_read_, layout_.rows)});
  std::ranges::move(bytes_->notes(), std::back_inserter(notes));
  return notes;
}

}  // namespace proofmass::io
