#include "proofmass/io/hdf5_reader.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <iterator>

#include "proofmass/io/array_recording.hpp"
#include "proofmass/io/columns.hpp"
#include "proofmass/io/hdf5_choice.hpp"
#include "proofmass/io/hdf5_labels.hpp"
#include "proofmass/io/hdf5_library.hpp"
#include "proofmass/io/library_file.hpp"
#include "proofmass/io/mat_headings.hpp"
#include "proofmass/io/watched_child.hpp"

namespace proofmass::io {
namespace {

using Columns = std::vector<std::vector<double>>;

Hdf5Source source_of(const LibraryFile& file) {
  return {file.path(), file.is_nameless()};
}

/// Time enough to unpack so many bytes at a twentieth of what is usual, and room for the file.
ChildLimits limits_for(const LibraryFile& file, std::uint64_t bytes) {
  constexpr std::uint64_t bytes_a_second = 8'000'000;
  ChildLimits limits;
  limits.cpu_s += static_cast<unsigned>(std::min<std::uint64_t>(bytes / bytes_a_second, 36'000));
  if (file.is_nameless()) limits.memory_bytes += file.size();
  return limits;
}

Result<Hdf5Catalogue> list(const LibraryFile& file, bool is_matlab) {
  std::string bytes;
  const auto work = [&](const ByteSink& sink) -> Status {
    const auto catalogue = list_hdf5(source_of(file), is_matlab);
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

/// Takes the samples of one dataset after another as they come.
class FigureTaker {
 public:
  FigureTaker(const std::vector<Hdf5Request>& requests, const Progress& progress)
      : requests_(requests), progress_(progress) {
    for (const Hdf5Request& request : requests) {
      auto& columns = columns_.emplace_back();
      for (std::uint64_t c = 0; c < request.width; ++c) columns.emplace_back(request.rows);
      wanted_ += request.rows * request.width;
    }
  }

  Status take(std::span<const char> bytes) {
    figures_.resize(bytes.size() / sizeof(double));
    std::memcpy(figures_.data(), bytes.data(), figures_.size() * sizeof(double));
    if (table_ == requests_.size()) return broken();
    const Hdf5Request& request = requests_[table_];
    const std::uint64_t rows = std::min(rows_a_block(request.width), request.rows - row_);
    if (bytes.size() != rows * request.width * sizeof(double)) return broken();
    for (std::uint64_t c = 0; c < request.width; ++c)
      columns_[table_][c].append(std::span(figures_).subspan(c * rows, rows));
    row_ += rows;
    taken_ += figures_.size();
    if (row_ == request.rows) {
      ++table_;
      row_ = 0;
    }
    if (progress_) progress_("reading", static_cast<double>(taken_) / static_cast<double>(wanted_));
    return Done{};
  }

  Result<std::vector<Columns>> values() {
    if (table_ < requests_.size()) return broken();
    std::vector<Columns> values;
    for (auto& table : columns_) {
      auto& columns = values.emplace_back();
      for (GrowingColumn& column : table) columns.push_back(column.take());
    }
    return values;
  }

 private:
  static Error broken() {
    return {Errc::corrupt, "is damaged: it gives other figures than it has"};
  }

  const std::vector<Hdf5Request>& requests_;
  const Progress& progress_;
  std::vector<std::vector<GrowingColumn>> columns_;
  std::vector<double> figures_;
  std::size_t table_ = 0;
  std::uint64_t row_ = 0;
  std::uint64_t taken_ = 0;
  std::uint64_t wanted_ = 0;
};

/// Before anything is reserved: figures take room in the file, if a thousandth when compressed.
Status check_room(const std::vector<Hdf5Request>& requests, std::uint64_t file_bytes) {
  constexpr std::uint64_t most_packed = 1040;                      // deflate's limit is 1032
  constexpr std::uint64_t most_unpacked = std::uint64_t{1} << 29;  // 4 GiB as doubles
  std::uint64_t figures = 0;
  for (const Hdf5Request& request : requests) figures += request.rows * request.width;
  const std::uint64_t room = std::min(file_bytes * most_packed, most_unpacked);
  if (figures <= std::max(file_bytes, room)) return Done{};
  return Error{Errc::unsupported,
               fmt::format("claims {} figures in {} bytes: it is damaged, or nearly empty; copy "
                           "what is wanted into a file of its own",
                           figures, file_bytes)};
}

Result<std::vector<Columns>> read_tables(const LibraryFile& file,
                                         const std::vector<Hdf5Request>& requests,
                                         const Progress& progress) {
  if (const Status fits = check_room(requests, file.size()); !fits) return fits.error();
  std::uint64_t bytes = file.size();
  for (const Hdf5Request& request : requests) bytes += request.rows * request.width * 8;
  FigureTaker taker(requests, progress);
  const auto work = [&](const ByteSink& sink) {
    return read_hdf5(source_of(file), requests, sink);
  };
  const auto take = [&](std::span<const char> piece) { return taker.take(piece); };
  if (const Status done = run_in_child(work, take, limits_for(file, bytes)); !done)
    return done.error();
  return taker.values();
}

std::vector<Hdf5Request> requests_of(const Hdf5Catalogue& catalogue,
                                     const std::vector<MatArray>& arrays,
                                     const std::vector<MatTable>& tables) {
  std::vector<Hdf5Request> requests;
  for (const MatTable& table : tables) {
    const auto number = static_cast<std::size_t>(table.array - arrays.data());
    requests.push_back({.name = table.array->path,
                        .address = catalogue.datasets[number].address,
                        .rows = table.rows,
                        .width = table.width,
                        .is_by_row = table.is_turned});
  }
  return requests;
}

Recording begin(std::string format, std::vector<Note> notes, const PeekSource& source) {
  Recording recording;
  recording.format = std::move(format);
  recording.notes = std::move(notes);
  std::ranges::move(source.notes(), std::back_inserter(recording.notes));
  return recording;
}

void join(std::vector<Columns> values, ArrayColumns& columns) {
  for (Columns& some : values) std::ranges::move(some, std::back_inserter(columns.values));
}

Result<Recording> read_plain(const LibraryFile& file,
                             const Hdf5Catalogue& catalogue,
                             const PeekSource& source,
                             const ReadOptions& options) {
  const std::vector<MatArray> arrays = arrays_of(catalogue);
  const auto choice = choose_datasets(catalogue, arrays, options);
  if (!choice) return choice.error();
  auto values = read_tables(file, requests_of(catalogue, arrays, choice->tables), options.progress);
  if (!values) return values.error();
  Recording recording = begin("HDF5", choice->notes, source);
  ArrayColumns columns;
  columns.rate_hz = hdf5_rate_hz(catalogue, choice->tables, recording.notes);
  std::vector<std::string> vectors;
  for (const MatTable& table : choice->tables)
    if (table.width == 1) vectors.push_back(table.name());
  const bool is_timed = columns.rate_hz || time_among(vectors, options);
  columns.headings = hdf5_headings(catalogue, choice->tables, *values, is_timed, recording.notes);
  tell_texts(catalogue, choice->tables, recording.notes);
  join(std::move(values).value(), columns);
  return recording_of(std::move(columns), std::move(recording), options);
}

/// A variable of MATLAB is chosen and called as in the older versions of its files.
Result<Recording> read_variables(const LibraryFile& file,
                                 const Hdf5Catalogue& catalogue,
                                 const PeekSource& source,
                                 const ReadOptions& options) {
  MatCatalogue variables;
  variables.version = "MAT v7.3";
  variables.arrays = arrays_of(catalogue);
  variables.skipped = catalogue.skipped;
  variables.is_cut = catalogue.is_cut;
  const auto choice = choose_tables(variables, options);
  if (!choice) return choice.error();
  auto values =
      read_tables(file, requests_of(catalogue, variables.arrays, choice->tables), options.progress);
  if (!values) return values.error();
  Recording recording = begin("MAT v7.3", choice->notes, source);
  ArrayColumns columns;
  columns.headings = headings_of(choice->tables, *values, options);
  if (choice->rate != nullptr) {
    const auto number = static_cast<std::size_t>(choice->rate - variables.arrays.data());
    const auto figure = catalogue.datasets[number].figure;
    const bool can_be = figure && is_rate(*figure);
    recording.notes.push_back(
        {Severity::info, fmt::format("{}: {}", choice->rate->path,
                                     can_be ? "the rate in Hz" : "is no rate that can be")});
    if (can_be) columns.rate_hz = figure;
  }
  join(std::move(values).value(), columns);
  return recording_of(std::move(columns), std::move(recording), options);
}

bool is_matlab(std::string_view head) {
  return head.starts_with("MATLAB 7.");
}

}  // namespace

bool claims_hdf5(std::string_view head, std::string_view) {
  using namespace std::literals;
  constexpr std::array<std::size_t, 4> places{0, 512, 1024, 2048};
  return is_matlab(head) || std::ranges::any_of(places, [&](std::size_t place) {
           return head.size() > place && head.substr(place).starts_with("\x89HDF\r\n\x1A\n"sv);
         });
}

Result<Recording> read_hdf5_file(PeekSource& source, const ReadOptions& options) {
  const auto head = source.peek(16);
  if (!head) return head.error();
  const bool matlab = is_matlab(*head);
  if (!has_hdf5_library())
    return Error{Errc::unsupported,
                 matlab ? "is a MAT file of version 7.3, and this program was built without the "
                          "HDF5 library: use save(…, '-v7') in MATLAB"
                        : "is HDF5, and this program was built without the HDF5 library: export "
                          "the dataset as CSV"};
  const auto file = library_file_of(source, options.progress);
  if (!file) return file.error();
  const auto catalogue = list(*file, matlab);
  if (!catalogue) return catalogue.error();
  return matlab ? read_variables(*file, *catalogue, source, options)
                : read_plain(*file, *catalogue, source, options);
}

}  // namespace proofmass::io
