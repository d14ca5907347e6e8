#include "proofmass/io/tdms/layout.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

namespace proofmass::io::tdms {
namespace {

constexpr std::size_t most_pieces = std::size_t{1} << 20;

/// Sums and products with detection of 64-bit overflow.
struct Checked {
  std::uint64_t value = 0;
  bool overflow = false;

  void add(std::uint64_t term) { overflow |= __builtin_add_overflow(value, term, &value); }
  void add_product(std::uint64_t a, std::uint64_t b) {
    std::uint64_t product = 0;
    overflow |= __builtin_mul_overflow(a, b, &product);
    add(product);
  }
};

Error too_large() {
  return {Errc::corrupt, "claims more values than any file can hold"};
}

std::uint64_t value_bytes(const Index& index, const RawDataOrder& order) {
  if (index.kind != Kind::other) return bytes_per_value(index.kind);
  const std::size_t known = bytes_of_other(index.type);
  return known != 0 ? known : order.other_bytes;
}

Entry entry_of(const Part& part, const Layout& layout) {
  Entry entry;
  entry.channel = part.channel;
  entry.kind = part.index->kind;
  entry.first_piece = static_cast<std::uint32_t>(layout.pieces.size());
  entry.values = part.index->values;
  return entry;
}

Result<Layout> lay_out_contiguous(std::span<const Part> parts, const RawDataOrder& order) {
  Layout layout;
  layout.is_contiguous = true;
  Checked at;
  for (const Part& part : parts) {
    const Index& index = *part.index;
    Entry entry = entry_of(part, layout);
    if (index.kind == Kind::text) {
      layout.is_contiguous = false;
      at.add(index.bytes);
    } else {
      const std::uint64_t size = value_bytes(index, order);
      if (index.kind != Kind::other) {
        layout.pieces.push_back({at.value, size, index.values});
        entry.pieces = 1;
      }
      at.add_product(index.values, size);
    }
    layout.entries.push_back(entry);
  }
  if (at.overflow) return too_large();
  layout.chunk_bytes = at.value;
  return layout;
}

/// Rows with values of the same channels.
struct Band {
  std::uint64_t offset = 0;  ///< offset of the first row, then of the next channel's value in it
  std::uint64_t width = 0;
  std::uint64_t from = 0;  ///< first row
  std::uint64_t to = 0;
};

std::uint64_t width_of_row(std::span<const Part> parts,
                           const RawDataOrder& order,
                           std::uint64_t row) {
  std::uint64_t width = 0;
  for (const Part& part : parts)
    if (part.index->values > row) width += value_bytes(*part.index, order);
  return width;
}

/// If channels differ in length, those that have ended are omitted from the following rows.
Result<std::vector<Band>> bands_of(std::span<const Part> parts, const RawDataOrder& order) {
  std::vector<std::uint64_t> ends;
  for (const Part& part : parts) ends.push_back(part.index->values);
  std::ranges::sort(ends);
  ends.erase(std::ranges::unique(ends).begin(), ends.end());
  if (ends.size() > most_pieces / parts.size())
    return Error{Errc::unsupported, "interleaves channels of too many lengths"};
  std::vector<Band> bands;
  Checked at;
  std::uint64_t from = 0;
  for (const std::uint64_t end : ends) {
    if (end == from) continue;
    bands.push_back({at.value, width_of_row(parts, order, from), from, end});
    at.add_product(end - from, bands.back().width);
    from = end;
  }
  bands.push_back({at.value, 0, from, from});
  return at.overflow ? Result<std::vector<Band>>(too_large()) : bands;
}

/// Rows of one value per channel.
Result<Layout> lay_out_interleaved(std::span<const Part> parts, const RawDataOrder& order) {
  const bool has_text =
      std::ranges::any_of(parts, [](const Part& part) { return part.index->kind == Kind::text; });
  if (has_text) return Error{Errc::corrupt, "has interleaved text, which cannot be"};
  auto found = bands_of(parts, order);
  if (!found) return found.error();
  std::vector<Band> bands = std::move(found).value();
  Layout layout;
  layout.chunk_bytes = bands.back().offset;
  for (const Part& part : parts) {
    Entry entry = entry_of(part, layout);
    for (Band& band : bands) {
      if (part.index->values <= band.from) break;
      if (part.index->kind != Kind::other) {
        layout.pieces.push_back({band.offset, band.width, band.to - band.from});
        ++entry.pieces;
      }
      band.offset += value_bytes(*part.index, order);
    }
    layout.entries.push_back(entry);
  }
  return layout;
}

/// Checks that a channel of DAQmx raw data fits buffers of these widths.
Status check_scalers(const Index& index, const std::vector<std::uint32_t>& widths) {
  if (index.scalers.empty())
    return Error{Errc::unsupported, "mixes DAQmx raw data with other data"};
  if (index.widths != widths)
    return Error{Errc::corrupt, "has channels that disagree on the width of DAQmx raw data"};
  for (const Scaler& scaler : index.scalers)
    if (scaler.buffer >= widths.size() ||
        std::uint64_t{scaler.offset} + bytes_per_value(scaler.kind) > widths[scaler.buffer])
      return Error{Errc::corrupt, "has a DAQmx scaler that lies outside its buffer"};
  return Done{};
}

/// Consecutive buffers of rows, which contain values of several channels at fixed positions.
Result<Layout> lay_out_daqmx(std::span<const Part> parts) {
  const std::vector<std::uint32_t>& widths = parts.front().index->widths;
  std::vector<std::uint64_t> rows(widths.size());
  for (const Part& part : parts) {
    if (const Status fits = check_scalers(*part.index, widths); !fits) return fits.error();
    for (const Scaler& scaler : part.index->scalers)
      rows[scaler.buffer] = std::max(rows[scaler.buffer], part.index->values);
  }
  Checked at;
  std::vector<std::uint64_t> fronts;
  for (std::size_t b = 0; b < widths.size(); ++b) {
    fronts.push_back(at.value);
    at.add_product(rows[b], widths[b]);
  }
  if (at.overflow) return too_large();
  Layout layout;
  layout.is_daqmx = true;
  layout.chunk_bytes = at.value;
  for (const Part& part : parts) {
    for (const Scaler& scaler : part.index->scalers) {
      Entry entry = entry_of(part, layout);
      entry.scaler = scaler.id;
      entry.kind = scaler.kind;
      entry.bit = scaler.bit;
      entry.pieces = 1;
      layout.pieces.push_back(
          {fronts[scaler.buffer] + scaler.offset, widths[scaler.buffer], part.index->values});
      layout.entries.push_back(entry);
    }
  }
  return layout;
}

}  // namespace

std::span<const Entry> Layout::of(std::uint32_t channel) const {
  const auto found = std::ranges::equal_range(entries, channel, {}, &Entry::channel);
  return {found.begin(), found.end()};
}

Result<Layout> lay_out(std::span<const Part> parts, const RawDataOrder& order) {
  if (parts.empty()) return Layout{};
  for (const Part& part : parts)
    if (part.index->kind == Kind::other && part.index->scalers.empty() &&
        value_bytes(*part.index, order) == 0)
      return Error{Errc::unsupported, fmt::format("has {}, whose size is not known",
                                                  words_for_type(part.index->type))};
  const bool is_daqmx =
      std::ranges::any_of(parts, [](const Part& part) { return !part.index->scalers.empty(); });
  auto made = is_daqmx            ? lay_out_daqmx(parts)
              : order.interleaved ? lay_out_interleaved(parts, order)
                                  : lay_out_contiguous(parts, order);
  if (!made) return made;
  Layout layout = std::move(made).value();
  layout.big_endian = order.big_endian;
  std::ranges::sort(layout.entries, {}, [](const Entry& entry) {
    return std::tuple(entry.channel, entry.scaler, entry.first_piece);
  });
  return layout;
}

std::uint64_t infer_other_bytes(std::span<const Part> parts, std::uint64_t data_bytes) {
  Checked known;
  Checked unknown;
  for (const Part& part : parts) {
    const Index& index = *part.index;
    const std::uint64_t size = value_bytes(index, {});
    known.add(index.bytes);
    known.add_product(index.values, size);
    if (size == 0 && index.kind == Kind::other) unknown.add(index.values);
  }
  for (const std::uint64_t size : {16, 10, 12, 8, 4, 2, 1}) {
    Checked chunk = known;
    chunk.add_product(unknown.value, size);
    if (!chunk.overflow && !unknown.overflow && chunk.value > 0 && chunk.value <= data_bytes &&
        data_bytes % chunk.value == 0)
      return size;
  }
  return 0;
}

}  // namespace proofmass::io::tdms
