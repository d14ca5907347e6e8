#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "proofmass/io/parquet/child.hpp"

// DuckDB unpacks the file in a process of its own, which is not ours to mend: the bytes are taken
// for what such a process says of the contents.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  (void)proofmass::io::parquet_head_bytes(bytes);
  const auto head = proofmass::io::decode_parquet(bytes);
  if (!head) return 0;
  (void)head->labels();
  const auto again = proofmass::io::decode_parquet(proofmass::io::encode_parquet(*head));
  if (!again || again->columns.size() != head->columns.size()) std::abort();
  return 0;
}
