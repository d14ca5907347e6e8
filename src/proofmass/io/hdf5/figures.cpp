#include <algorithm>
#include <fmt/format.h>
#include <limits>

#include "proofmass/io/hdf5/fields.hpp"
#include "proofmass/io/hdf5/handle.hpp"
#include "proofmass/io/hdf5/library.hpp"

namespace proofmass::io::hdf5 {
namespace {

using Shape = std::vector<hsize_t>;

Shape shape_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  Shape shape(static_cast<std::size_t>(std::max(rank, 0)));
  if (!shape.empty()) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

/// Cache required by a dataset so that no chunk is decompressed twice while blocks are read.
struct ChunkNeed {
  std::size_t bytes = 0;  ///< 0 for a dataset without chunks
  std::size_t chunks = 0;
};

/// The chunks that contain a sample, doubled if some end before a block does.
ChunkNeed need_of(hid_t dataset) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const Shape shape = shape_of(space);
  Shape chunk(shape.size());
  if (shape.empty() || H5Pget_layout(creation) != H5D_CHUNKED ||
      H5Pget_chunk(creation, static_cast<int>(chunk.size()), chunk.data()) < 0)
    return {};
  const std::size_t time = shape.front() >= shape.back() ? 0 : shape.size() - 1;
  ChunkNeed need{H5Tget_size(type), 1};
  for (std::size_t d = 0; d < shape.size(); ++d) {
    const hsize_t all = chunk[d] == 0 ? 0 : (shape[d] + chunk[d] - 1) / chunk[d];
    const hsize_t abreast = d == time ? std::min<hsize_t>(all, 2) : all;
    if (__builtin_mul_overflow(need.bytes, chunk[d], &need.bytes) ||
        __builtin_mul_overflow(need.bytes, abreast, &need.bytes) ||
        __builtin_mul_overflow(need.chunks, abreast, &need.chunks))
      return {std::numeric_limits<std::size_t>::max(), 0};
  }
  return need;
}

/// Opens datasets with cache for their chunks while the budget lasts; the others are slower to
/// read.
class DatasetOpener {
 public:
  Handle open(hid_t file, const std::string& address) {
    constexpr std::size_t fewest_slots = 101;
    constexpr std::size_t most_slots = 100'003;
    ChunkNeed need;
    {
      // Closed before it is opened again: an open dataset keeps its cache.
      const Handle plain(H5Dopen2(file, address.c_str(), H5P_DEFAULT), H5Dclose);
      if (plain) need = need_of(plain);
    }
    const std::size_t kept = need.bytes <= room_ ? need.bytes : 0;
    room_ -= kept;
    const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    const std::size_t slots = need.chunks < most_slots / 10 ? 10 * need.chunks + 1 : most_slots;
    H5Pset_chunk_cache(access, std::max(slots, fewest_slots), kept, 1.0);
    return {H5Dopen2(file, address.c_str(), access), H5Dclose};
  }

 private:
  std::size_t room_ = std::size_t{768} << 20;
};

/// The memory type of the values.
Handle memory_type(hid_t stored, Figures figures) {
  if (figures == Figures::int64) return {H5Tcopy(H5T_NATIVE_INT64), H5Tclose};
  if (figures == Figures::uint64) return {H5Tcopy(H5T_NATIVE_UINT64), H5Tclose};
  const std::string part = real_part(stored);
  if (!part.empty()) {
    Handle type(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
    if (type) H5Tinsert(type, part.c_str(), 0, H5T_NATIVE_DOUBLE);
    return type;
  }
  if (H5Tget_class(stored) == H5T_COMPOUND) return memory_type_of(fields_of(stored));
  return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
}

/// Converts consecutive samples to consecutive columns.
void turn(const std::vector<double>& from,
          std::uint64_t rows,
          std::uint64_t width,
          std::vector<double>& to) {
  for (std::uint64_t row = 0; row < rows; ++row)
    for (std::uint64_t column = 0; column < width; ++column)
      to[column * rows + row] = from[row * width + column];
}

class DatasetReader {
 public:
  DatasetReader(DatasetOpener& opener, hid_t file, const Request& request)
      : request_(request),
        dataset_(opener.open(file, request.address)),
        space_(dataset_ ? H5Dget_space(dataset_) : -1, H5Sclose),
        stored_(dataset_ ? H5Dget_type(dataset_) : -1, H5Tclose),
        type_(stored_ ? memory_type(stored_, request.figures) : Handle(-1, H5Tclose)) {}

  /// True if the dataset still has the requested shape.
  [[nodiscard]] bool fits() const {
    Shape shape = space_ ? shape_of(space_) : Shape{};
    if (shape.empty() || !type_) return false;
    const hsize_t rows = request_.is_by_row ? shape.front() : shape.back();
    hsize_t figures = H5Tget_size(type_) / sizeof(double);
    for (const hsize_t length : shape)
      if (__builtin_mul_overflow(figures, length, &figures)) return false;
    return rows == request_.rows && figures == request_.rows * request_.width;
  }

  /// Passes on samples, column by column. `block` and `turned` are buffers of that size.
  Status read(std::uint64_t row,
              std::uint64_t rows,
              std::vector<double>& block,
              std::vector<double>& turned,
              const ByteSink& sink) {
    if (!read_rows(row, rows, block.data()))
      return Error{Errc::corrupt,
                   fmt::format("{}: sample {}: cannot be unpacked: the HDF5 library says \"{}\"",
                               request_.name, row, failure_reason())};
    const bool is_turned = request_.is_by_row && request_.width > 1;
    if (is_turned) turn(block, rows, request_.width, turned);
    const auto& columns = is_turned ? turned : block;
    const auto bytes = std::as_bytes(std::span(columns).first(rows * request_.width));
    if (!sink({reinterpret_cast<const char*>(bytes.data()), bytes.size()}))
      return Error{Errc::unreadable, "nobody listens"};
    return Done{};
  }

 private:
  bool read_rows(std::uint64_t row, std::uint64_t rows, void* into) {
    Shape start(shape_of(space_).size(), 0);
    Shape count = shape_of(space_);
    const std::size_t time = request_.is_by_row ? 0 : start.size() - 1;
    start[time] = row;
    count[time] = rows;
    // With the rank of the file: if the two differ, the library processes values one by one.
    const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                        H5Sclose);
    return H5Sselect_hyperslab(space_, H5S_SELECT_SET, start.data(), nullptr, count.data(),
                               nullptr) >= 0 &&
           H5Dread(dataset_, type_, memory, space_, H5P_DEFAULT, into) >= 0;
  }

  const Request& request_;
  Handle dataset_, space_, stored_, type_;
};

}  // namespace

Status read_values(const Source& source,
                   const std::vector<Request>& requests,
                   const ByteSink& sink) {
  const auto file = open_source(source);
  if (!file) return file.error();
  DatasetOpener opener;
  std::vector<DatasetReader> readers;
  readers.reserve(requests.size());
  std::uint64_t widest = 1;
  for (const Request& request : requests) {
    readers.emplace_back(opener, *file, request);
    widest = std::max(widest, request.width);
    if (!readers.back().fits() || request.rows != requests.front().rows)
      return Error{Errc::corrupt, fmt::format("{}: is not what it was", request.name)};
  }
  const std::uint64_t all = requests.empty() ? 0 : requests.front().rows;
  const std::uint64_t most = std::min(rows_a_block(requests), all);
  std::vector<double> block(most * widest);
  std::vector<double> turned(most * widest);
  for (std::uint64_t row = 0; row < all; row += most)
    for (DatasetReader& reader : readers)
      if (const Status read = reader.read(row, std::min(most, all - row), block, turned, sink);
          !read)
        return read;
  return Done{};
}

}  // namespace proofmass::io::hdf5
