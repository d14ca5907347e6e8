#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "check_reading.hpp"
#include "proofmass/io/tdms/group_reader.hpp"

namespace {

/// Reads every table of the file in blocks of a few rows.
void read_all_tables(std::span<const std::byte> bytes) {
  using namespace proofmass::io;
  auto source = std::make_unique<PeekSource>(open_memory(bytes));
  auto random = random_bytes_of(std::move(source), {});
  if (!random) return;
  const auto contents = tdms::read_contents(std::move(random).value());
  if (!contents) return;
  constexpr std::size_t rows_at_once = 37;
  for (std::size_t group = 0; group < (*contents)->groups.size(); ++group) {
    const auto table = tdms::open_table(*contents, group);
    if (!table) continue;
    const std::size_t columns = (*table)->head().columns;
    std::vector<std::vector<double>> block(columns, std::vector<double>(rows_at_once));
    const std::vector<std::span<double>> into(block.begin(), block.end());
    std::uint64_t rows = 0;
    while (true) {
      const auto count = (*table)->read(into);
      if (!count || *count == 0) break;
      rows += *count;
    }
    if (rows > bytes.size()) std::abort();
  }
}

}  // namespace

// Prepends the magic number, which the fuzzer would rarely find.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> file{'T', 'D', 'S', 'm'};
  file.insert(file.end(), data, data + size);
  const auto bytes = std::as_bytes(std::span(file));
  read_all_tables(bytes);
  check_reading(bytes);
  return 0;
}
