#include "proofmass/io/layouts/zip_reader.hpp"

#include "proofmass/io/archive/archive.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/layouts/tables.hpp"

namespace proofmass::io {

bool claims_zip(std::string_view head, std::string_view) {
  return head.starts_with("PK\x03\x04") || head.starts_with("PK\x05\x06");
}

Result<std::unique_ptr<TableFile>> open_zip_tables(std::unique_ptr<PeekSource> source,
                                                   const ReadOptions& options) {
  auto bytes = random_bytes_of(std::move(source), options.progress);
  if (!bytes) return bytes.error();
  auto archive = open_zip(std::move(bytes).value());
  if (!archive) return archive.error();
  return open_tables_in(std::move(archive).value(), options);
}

}  // namespace proofmass::io
