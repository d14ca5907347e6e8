#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "proofmass/io/bytes/subprocess.hpp"
#include "proofmass/io/hdf5/catalogue.hpp"
#include "proofmass/io/hdf5/choice.hpp"
#include "proofmass/io/hdf5/labels.hpp"
#include "proofmass/io/hdf5/reader.hpp"
#include "proofmass/io/hdf5/stream.hpp"

namespace {

using namespace proofmass;

void require(bool kept) {
  if (!kept) std::abort();
}

/// Feeds bytes as from a pipe.
io::BytePump feed_of(std::string_view& bytes) {
  return [&bytes](std::span<char> into) -> Result<std::size_t> {
    const std::size_t count = std::min(into.size(), bytes.size());
    std::copy_n(bytes.begin(), count, into.begin());
    bytes.remove_prefix(count);
    return count;
  };
}

// Selects datasets from a list of contents, before any values are read.
void choose_from(std::string_view bytes) {
  const auto catalogue = io::hdf5::decode(bytes);
  if (!catalogue) return;
  const auto arrays = io::hdf5::arrays_of(*catalogue);
  const auto choice = io::hdf5::choose_datasets(*catalogue, arrays, {});
  if (!choice) return;
  std::vector<std::vector<std::vector<double>>> values;
  std::size_t width = 0;
  for (const io::matlab::Table& table : choice->tables) {
    values.push_back({{1.0, 2.0, 3.0}});
    width += table.width;
  }
  std::vector<Note> notes;
  const auto rate_hz = io::hdf5::rate_hz_of(*catalogue, choice->tables, notes);
  const bool is_timed = rate_hz.has_value();
  const auto headings = io::hdf5::headings_of(*catalogue, choice->tables, values, is_timed, notes);
  require(headings.size() == width);
  (void)io::hdf5::start_ns_of(*catalogue, choice->tables.front().array->path);
  io::hdf5::note_texts(*catalogue, choice->tables, notes);
}

// Input as the list of contents from a compromised child process.
void listen_to(std::string_view bytes) {
  std::string said;
  const io::ByteTaker take = [&](std::span<const char> piece) -> Status {
    said.append(piece.data(), piece.size());
    return Done{};
  };
  if (io::take_message(feed_of(bytes), take)) choose_from(said);
}

// Input as the values from a compromised child process.
void take_figures(std::string_view bytes) {
  using enum io::hdf5::Figures;
  std::vector<io::hdf5::Request> requests{{.name = "a", .rows = 20, .width = 3},
                                          {.name = "b", .rows = 20, .width = 1, .figures = int64},
                                          {.name = "c", .rows = 20, .width = 1, .figures = uint64}};
  io::hdf5::FigureStream stream(std::move(requests), feed_of(bytes));
  std::size_t rows = 0;
  for (;;) {
    const auto count = stream.next();
    if (!count || *count == 0) break;
    if (rows == 0) (void)stream.put_origin_at_first(1);
    std::vector<double> column(*count);
    for (std::size_t request = 0; request < 3; ++request) stream.copy(request, 0, 0, column);
    rows += *count;
  }
  require(rows == 0 || rows == 20);
}

}  // namespace

// The library that decodes the file is not under test, and it runs in a process of its own, which
// would limit the fuzzer to a few inputs per second. The input is therefore used as that process's
// messages (contents, values) and as a list of contents. io/hdf5/hdf5_test.cpp checks that
// arbitrary files are read or refused whatever the library does.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  listen_to(bytes);
  take_figures(bytes);
  choose_from(bytes);
  (void)io::hdf5::claims(bytes.substr(0, 4096), "");
  return 0;
}
