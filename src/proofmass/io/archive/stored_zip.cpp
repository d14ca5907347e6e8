#include "proofmass/io/archive/stored_zip.hpp"

#include "proofmass/io/bytes/crc32.hpp"

namespace proofmass::io {
namespace {

void put(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xFF);
}

constexpr std::uint64_t version = 20;
constexpr std::uint64_t first_of_1980 = 0x0021;  // the earliest date in a zip file
constexpr std::uint64_t most_bytes = 0xFFFF'FFFF;

/// The common part of the local header and the directory entry.
void put_common(std::string& out, std::uint32_t crc, std::uint32_t size, std::size_t name) {
  put(out, version, 2);
  put(out, 0x0800, 2);  // names are UTF-8
  put(out, 0, 2);       // stored
  put(out, 0, 2);
  put(out, first_of_1980, 2);
  put(out, crc, 4);
  put(out, size, 4);
  put(out, size, 4);
  put(out, name, 2);
  put(out, 0, 2);
}

}  // namespace

Status StoredZipWriter::add(const std::string& name,
                            std::string_view head,
                            std::string_view bytes) {
  constexpr std::uint64_t spare = std::uint64_t{1} << 20;  // headers and directory
  const std::uint64_t size = std::uint64_t{head.size()} + bytes.size();
  if (file_->size() + size + spare > most_bytes || entries_.size() >= 0xFFFF)
    return Error{Errc::unsupported, "would be larger than 4 GiB, which a plain zip cannot be"};
  Entry entry{name, static_cast<std::uint32_t>(file_->size()), crc32(crc32(0, head), bytes),
              static_cast<std::uint32_t>(size)};
  std::string local;
  put(local, 0x0403'4B50, 4);
  put_common(local, entry.crc, entry.size, name.size());
  local += name;
  for (const std::string_view part : {std::string_view(local), head, bytes})
    if (const Status written = file_->append(part); !written) return written.error();
  entries_.push_back(std::move(entry));
  return Done{};
}

Status StoredZipWriter::finish() {
  const std::uint64_t begin = file_->size();
  std::string directory;
  for (const Entry& entry : entries_) {
    put(directory, 0x0201'4B50, 4);
    put(directory, version, 2);
    put_common(directory, entry.crc, entry.size, entry.name.size());
    put(directory, 0, 2);  // comment
    put(directory, 0, 2);  // disk
    put(directory, 0, 2);
    put(directory, 0, 4);
    put(directory, entry.offset, 4);
    directory += entry.name;
  }
  const std::uint64_t size = directory.size();
  put(directory, 0x0605'4B50, 4);
  put(directory, 0, 4);
  put(directory, entries_.size(), 2);
  put(directory, entries_.size(), 2);
  put(directory, size, 4);
  put(directory, begin, 4);
  put(directory, 0, 2);
  if (const Status written = file_->append(directory); !written) return written.error();
  return file_->keep();
}

}  // namespace proofmass::io
