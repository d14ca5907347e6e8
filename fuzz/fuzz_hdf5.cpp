#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "check_reading.hpp"
#include "proofmass/io/hdf5_catalogue.hpp"
#include "proofmass/io/hdf5_choice.hpp"
#include "proofmass/io/hdf5_labels.hpp"
#include "proofmass/io/hdf5_reader.hpp"
#include "proofmass/io/watched_child.hpp"

namespace {

using namespace proofmass;

// What is made of a list of contents before a figure is read.
void choose_from(std::string_view bytes) {
  const auto catalogue = io::decode(bytes);
  if (!catalogue) return;
  const auto arrays = io::arrays_of(*catalogue);
  const auto choice = io::choose_datasets(*catalogue, arrays, {});
  if (!choice) return;
  std::vector<std::vector<std::vector<double>>> values;
  std::size_t width = 0;
  for (const io::MatTable& table : choice->tables) {
    values.emplace_back(table.width, std::vector<double>{1.0, 2.0, 3.0});
    width += table.width;
  }
  std::vector<Note> notes;
  const auto rate_hz = io::hdf5_rate_hz(*catalogue, choice->tables, notes);
  const bool is_timed = rate_hz.has_value();
  const auto headings = io::hdf5_headings(*catalogue, choice->tables, values, is_timed, notes);
  if (headings.size() != width) std::abort();
  io::tell_texts(*catalogue, choice->tables, notes);
}

// What a child that a file has taken over might say.
void listen_to(std::string_view bytes) {
  std::string said;
  const io::ByteFeed feed = [&](std::span<char> into) -> Result<std::size_t> {
    const std::size_t count = std::min(into.size(), bytes.size());
    std::copy_n(bytes.begin(), count, into.begin());
    bytes.remove_prefix(count);
    return count;
  };
  const io::ByteTaker take = [&](std::span<const char> piece) -> Status {
    said.append(piece.data(), piece.size());
    return Done{};
  };
  if (io::take_message(feed, take)) choose_from(said);
}

}  // namespace

// The bytes are taken for an HDF5 file, which is read in a process of its own, for what such a
// process says, and for the list of contents in it: the library that unpacks the file is not ours
// to mend, its keeper is.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  listen_to(bytes);
  choose_from(bytes);
  if (io::claims_hdf5(bytes.substr(0, 4096), "")) check_reading(std::as_bytes(std::span(bytes)));
  return 0;
}
