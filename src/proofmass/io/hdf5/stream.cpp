#include "proofmass/io/hdf5/stream.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "proofmass/core/contract.hpp"

namespace proofmass::io::hdf5 {
namespace {

Source source_of(const LibraryFile& file) {
  return {file.path(), file.is_nameless()};
}

/// Time to decompress this many bytes at a twentieth of the usual speed, and memory for the file.
ChildLimits limits_for(const LibraryFile& file, std::uint64_t bytes) {
  constexpr std::uint64_t bytes_a_second = 8'000'000;
  constexpr std::uint64_t longest_s = 360'000;
  ChildLimits limits{.cpu_s = 5};
  limits.cpu_s += static_cast<unsigned>(std::min(bytes / bytes_a_second, longest_s));
  if (file.is_nameless()) limits.memory_bytes += file.size();
  return limits;
}

/// Values take space in the file, at least a thousandth if compressed; more than 4 GiB of doubles
/// are never compressed that well.
Status check_room(std::span<const Request> requests, std::uint64_t file_bytes) {
  constexpr std::uint64_t most_packed = 1040;  // deflate's limit is 1032
  constexpr std::uint64_t usual_packed = 64;
  constexpr std::uint64_t few = std::uint64_t{1} << 29;
  std::uint64_t figures = 0;
  for (const Request& request : requests) figures += request.rows * request.width;
  const std::uint64_t room =
      std::max(std::min(file_bytes * most_packed, few), file_bytes * usual_packed);
  if (figures <= room) return Done{};
  return Error{Errc::unsupported,
               fmt::format("claims {} figures in {} bytes: it is damaged, or nearly empty; copy "
                           "what is wanted into a file of its own",
                           figures, file_bytes)};
}

Error broken() {
  return {Errc::corrupt, "is damaged: what was unpacked of it breaks off"};
}

}  // namespace

Result<Catalogue> list_in_child(const LibraryFile& file, bool is_matlab) {
  std::string bytes;
  const auto work = [&](const ByteSink& sink) -> Status {
    const auto catalogue = list_datasets(source_of(file), is_matlab);
    if (!catalogue) return catalogue.error();
    const std::string encoded = encode(*catalogue);
    if (encoded.size() > most_catalogue_bytes)
      return Error{Errc::unsupported, "has more names and attributes than are read"};
    sink(encoded);
    return Done{};
  };
  const auto take = [&](std::span<const char> piece) -> Status {
    if (bytes.size() + piece.size() > most_catalogue_bytes)
      return Error{Errc::corrupt, "is damaged: its contents cannot be listed"};
    bytes.append(piece.data(), piece.size());
    return Done{};
  };
  if (const Status done = run_in_child(work, take, limits_for(file, 0)); !done) return done.error();
  return decode(bytes);
}

FigureStream::FigureStream(std::vector<Request> requests, BytePump said)
    : requests_(std::move(requests)),
      message_(std::in_place, std::move(said)),
      block_(requests_.size()),
      origins_(requests_.size(), 0) {}

FigureStream::FigureStream(std::vector<Request> requests, Subprocess child)
    : requests_(std::move(requests)),
      child_(std::move(child)),
      block_(requests_.size()),
      origins_(requests_.size(), 0) {}

Result<FigureStream> FigureStream::start(const LibraryFile& file, std::vector<Request> requests) {
  if (const Status fits = check_room(requests, file.size()); !fits) return fits.error();
  std::uint64_t bytes = file.size();
  for (const Request& request : requests) bytes += request.rows * request.width * 8;
  const auto work = [&](const ByteSink& sink) {
    return read_values(source_of(file), requests, sink);
  };
  auto child = Subprocess::start(work, limits_for(file, bytes));
  if (!child) return child.error();
  return FigureStream(std::move(requests), std::move(child).value());
}

Result<std::span<const char>> FigureStream::hear() {
  return child_ ? child_->next() : message_->next();
}

Result<std::size_t> FigureStream::next() {
  rows_ = 0;
  const std::uint64_t all = requests_.empty() ? 0 : requests_.front().rows;
  if (rows_taken_ == all) return std::size_t{0};
  const std::uint64_t rows = std::min(rows_a_block(requests_), all - rows_taken_);
  for (std::size_t i = 0; i < requests_.size(); ++i)
    if (const Status taken = take(i, rows); !taken) return taken.error();
  rows_taken_ += rows;
  rows_ = static_cast<std::size_t>(rows);
  return rows_;
}

Status FigureStream::take(std::size_t request, std::uint64_t rows) {
  const auto bytes = hear();
  if (!bytes) return bytes.error();
  const std::uint64_t figures = rows * requests_[request].width;
  if (bytes->size() != figures * sizeof(double)) return broken();
  block_[request].resize(figures);
  std::memcpy(block_[request].data(), bytes->data(), bytes->size());
  return Done{};
}

void FigureStream::copy(std::size_t request,
                        std::size_t column,
                        std::size_t row,
                        std::span<double> into) const {
  PM_EXPECTS(row + into.size() <= rows_);
  const auto from = std::span(block_[request]).subspan(column * rows_ + row, into.size());
  const Figures figures = requests_[request].figures;
  if (figures == Figures::doubles) {
    std::memcpy(into.data(), from.data(), from.size_bytes());
    return;
  }
  const Int128 origin = origins_[request];
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Int128 value =
        figures == Figures::int64 ? Int128{std::bit_cast<std::int64_t>(from[i])} : Int128{from[i]};
    into[i] = static_cast<double>(value - origin);
  }
}

Int128 FigureStream::put_origin_at_first(std::size_t request) {
  PM_EXPECTS(rows_ > 0 && requests_[request].figures != Figures::doubles);
  const std::uint64_t first = block_[request].front();
  origins_[request] = requests_[request].figures == Figures::int64
                          ? Int128{std::bit_cast<std::int64_t>(first)}
                          : Int128{first};
  return origins_[request];
}

double FigureStream::fraction_read() const {
  const std::uint64_t all = requests_.empty() ? 0 : requests_.front().rows;
  return all == 0 ? 1.0 : static_cast<double>(rows_taken_) / static_cast<double>(all);
}

}  // namespace proofmass::io::hdf5
