#include <algorithm>
#include <fmt/format.h>
#include <limits>

#include "proofmass/io/hdf5_handle.hpp"
#include "proofmass/io/hdf5_library.hpp"

namespace proofmass::io {
namespace {

using Shape = std::vector<hsize_t>;

Shape shape_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  Shape shape(static_cast<std::size_t>(std::max(rank, 0)));
  if (!shape.empty()) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

/// Bytes of the chunks that lie abreast of a sample, twice as they may end before a block does; 0
/// for a dataset without chunks.
std::size_t bytes_abreast(hid_t dataset) {
  const Hdf5Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  const Shape shape = shape_of(space);
  Shape chunk(shape.size());
  if (shape.empty() || H5Pget_layout(creation) != H5D_CHUNKED ||
      H5Pget_chunk(creation, static_cast<int>(chunk.size()), chunk.data()) < 0)
    return 0;
  std::size_t bytes = 2 * H5Tget_size(type);
  const std::size_t time = shape.front() >= shape.back() ? 0 : shape.size() - 1;
  for (std::size_t d = 0; d < shape.size(); ++d) {
    const std::size_t count = d == time ? 1 : (shape[d] + chunk[d] - 1) / chunk[d];
    if (__builtin_mul_overflow(bytes, chunk[d], &bytes) ||
        __builtin_mul_overflow(bytes, count, &bytes))
      return std::numeric_limits<std::size_t>::max();
  }
  return bytes;
}

/// Opens a dataset so that no chunk is unpacked twice while blocks go by: those abreast are kept.
Hdf5Handle open_dataset(hid_t file, const std::string& address) {
  constexpr std::size_t least_kept = std::size_t{1} << 20;
  constexpr std::size_t most_kept = std::size_t{768} << 20;
  constexpr std::size_t slots = 12'421;
  std::size_t kept = 0;
  {
    // Closed before it is opened again: what is open already keeps the cache it has.
    const Hdf5Handle plain(H5Dopen2(file, address.c_str(), H5P_DEFAULT), H5Dclose);
    if (plain) kept = bytes_abreast(plain);
  }
  const Hdf5Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access, slots, std::clamp(kept, least_kept, most_kept), 1.0);
  return {H5Dopen2(file, address.c_str(), access), H5Dclose};
}

/// The type that figures have in memory: a double, of complex numbers the real one.
Hdf5Handle memory_type(hid_t stored) {
  const std::string part = real_part(stored);
  if (part.empty()) return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
  Hdf5Handle type(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
  if (type) H5Tinsert(type, part.c_str(), 0, H5T_NATIVE_DOUBLE);
  return type;
}

/// Columns one after another from samples one after another.
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
  DatasetReader(hid_t file, const Hdf5Request& request)
      : request_(request),
        dataset_(open_dataset(file, request.address)),
        space_(dataset_ ? H5Dget_space(dataset_) : -1, H5Sclose),
        stored_(dataset_ ? H5Dget_type(dataset_) : -1, H5Tclose) {}

  Status run(const ByteSink& sink) {
    if (!fits()) return Error{Errc::corrupt, fmt::format("{}: is not what it was", request_.name)};
    const Hdf5Handle type = memory_type(stored_);
    const std::uint64_t most = rows_a_block(request_.width);
    std::vector<double> block(std::min(most, request_.rows) * request_.width);
    std::vector<double> turned(request_.is_by_row ? block.size() : 0);
    for (std::uint64_t row = 0; row < request_.rows; row += most) {
      const std::uint64_t rows = std::min(most, request_.rows - row);
      if (!read_rows(row, rows, type, block))
        return Error{Errc::corrupt,
                     fmt::format("{}: sample {}: cannot be unpacked: the HDF5 library says \"{}\"",
                                 request_.name, row, hdf5_reason())};
      if (request_.is_by_row) turn(block, rows, request_.width, turned);
      const auto& columns = request_.is_by_row ? turned : block;
      const auto bytes = std::as_bytes(std::span(columns).first(rows * request_.width));
      if (!sink({reinterpret_cast<const char*>(bytes.data()), bytes.size()}))
        return Error{Errc::unreadable, "nobody listens"};
    }
    return Done{};
  }

 private:
  [[nodiscard]] bool fits() const {
    const Shape shape = space_ ? shape_of(space_) : Shape{};
    if (shape.empty()) return false;
    const hsize_t rows = request_.is_by_row ? shape.front() : shape.back();
    hsize_t figures = 1;
    for (const hsize_t length : shape) figures *= length;
    return rows == request_.rows && figures == request_.rows * request_.width;
  }

  bool read_rows(std::uint64_t row, std::uint64_t rows, hid_t type, std::vector<double>& into) {
    Shape start(shape_of(space_).size(), 0);
    Shape count = shape_of(space_);
    const std::size_t time = request_.is_by_row ? 0 : start.size() - 1;
    start[time] = row;
    count[time] = rows;
    // Of the file's rank: where the two differ, the library goes through figures one by one.
    const Hdf5Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                            H5Sclose);
    return H5Sselect_hyperslab(space_, H5S_SELECT_SET, start.data(), nullptr, count.data(),
                               nullptr) >= 0 &&
           H5Dread(dataset_, type, memory, space_, H5P_DEFAULT, into.data()) >= 0;
  }

  const Hdf5Request& request_;
  Hdf5Handle dataset_, space_, stored_;
};

}  // namespace

Status read_hdf5(const Hdf5Source& source,
                 const std::vector<Hdf5Request>& requests,
                 const ByteSink& sink) {
  const auto file = open_hdf5(source);
  if (!file) return file.error();
  for (const Hdf5Request& request : requests) {
    DatasetReader reader(*file, request);
    if (const Status read = reader.run(sink); !read) return read;
  }
  return Done{};
}

}  // namespace proofmass::io
