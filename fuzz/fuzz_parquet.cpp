#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "proofmass/io/parquet/child.hpp"

// DuckDB decodes the file in a process of its own and is not under test: the input is used as that
// process's list of contents.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  (void)proofmass::io::parquet::head_bytes(bytes);
  const auto head = proofmass::io::parquet::decode(bytes);
  if (!head) return 0;
  (void)head->labels();
  const auto again = proofmass::io::parquet::decode(proofmass::io::parquet::encode(*head));
  if (!again || again->columns.size() != head->columns.size()) std::abort();
  return 0;
}
