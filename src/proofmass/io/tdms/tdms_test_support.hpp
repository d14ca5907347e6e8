#pragma once

#include <gtest/gtest.h>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/tdms/group_reader.hpp"
#include "proofmass/io/tdms/specimens.hpp"

namespace proofmass::io::specimen {

using Columns = std::vector<std::vector<double>>;

inline constexpr std::uint32_t f64 = 10;  ///< the format's code for doubles

inline std::string doubles_of(const std::vector<double>& values, Order order = Order::little) {
  return bytes_of(values, order);
}

/// Two channels of three values each.
inline TdmsList two_channels(Order order = Order::little) {
  TdmsList list(order);
  list.no_values("/").no_values("/'g'");
  list.channel("/'g'/'a'", f64, 3).channel("/'g'/'b'", f64, 3);
  return list;
}

}  // namespace proofmass::io::specimen

namespace proofmass::io::tdms {

/// Contents of a table for the tests.
struct Read {
  TableHead head;
  std::vector<std::vector<double>> columns;
  std::vector<Note> notes;

  [[nodiscard]] bool is_noted(std::string_view part) const {
    for (const Note& note : head.notes)
      if (note.text.find(part) != std::string::npos) return true;
    return false;
  }
  [[nodiscard]] std::string all_notes() const {
    std::string all;
    for (const Note& note : head.notes) all += note.text + "\n";
    return all;
  }
  [[nodiscard]] bool is_bad() const {
    for (const Note& note : head.notes)
      if (note.severity == Severity::bad) return true;
    return false;
  }
};

inline Result<std::shared_ptr<const Contents>> tdms_contents(const std::string& bytes) {
  auto source = std::make_unique<PeekSource>(open_memory(std::as_bytes(std::span(bytes))));
  auto random = random_bytes_of(std::move(source), {});
  if (!random) return random.error();
  return read_contents(std::move(random).value());
}

/// Reads a table `rows_at_once` rows at a time.
inline Result<Read> read_tdms(const std::string& bytes,
                              std::size_t group = 0,
                              std::size_t rows_at_once = 7) {
  auto contents = tdms_contents(bytes);
  if (!contents) return contents.error();
  auto table = open_table(*contents, group);
  if (!table) return table.error();
  Read out;
  out.head = (*table)->head();
  out.columns.resize(out.head.columns);
  std::vector<std::vector<double>> block(out.head.columns, std::vector<double>(rows_at_once));
  const std::vector<std::span<double>> into(block.begin(), block.end());
  while (true) {
    const auto rows = (*table)->read(into);
    if (!rows) return rows.error();
    if (*rows == 0) break;
    for (std::size_t c = 0; c < block.size(); ++c)
      out.columns[c].insert(out.columns[c].end(), block[c].begin(),
                            block[c].begin() + static_cast<std::ptrdiff_t>(*rows));
  }
  out.notes = (*table)->notes();
  return out;
}

/// The same; must succeed.
inline Read tdms_or_fail(const std::string& bytes,
                         std::size_t group = 0,
                         std::size_t rows_at_once = 7) {
  auto read = read_tdms(bytes, group, rows_at_once);
  EXPECT_TRUE(read.has_value()) << (read ? "" : read.error().message);
  return read ? std::move(read).value() : Read{};
}

}  // namespace proofmass::io::tdms
