#include "proofmass/io/bytes/library_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <span>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

#include "proofmass/io/unnamed_file.hpp"

namespace proofmass::io {
namespace {

/// Copies the bytes of a stream to a file in memory.
Status spool(PeekSource& source, int into, const Progress& progress) {
  constexpr std::uint64_t most_unpacked = std::uint64_t{4} << 30;
  std::vector<char> piece(std::size_t{1} << 20);
  for (std::uint64_t total = 0;;) {
    const auto count = source.read(piece);
    if (!count) return count.error();
    if (*count == 0) return Done{};
    total += *count;
    if (total > most_unpacked)
      return Error{Errc::unsupported, "is larger than 4 GiB: unpack it into a file first"};
    if (!write_all(into, std::span(piece).first(*count)))
      return system_failure("does not fit into memory");
    if (progress) progress("reading", source.fraction_read());
  }
}

}  // namespace

LibraryFile::~LibraryFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string LibraryFile::path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

std::uint64_t LibraryFile::size() const {
  struct stat status{};
  return ::fstat(descriptor_, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

Result<LibraryFile> library_file_of(PeekSource& source, const Progress& progress) {
  // Above the standard streams, which a child process does not have.
  if (const auto there = source.descriptor()) {
    LibraryFile file(::fcntl(*there, F_DUPFD_CLOEXEC, 3), false);
    if (file.descriptor() < 0) return system_failure("cannot be opened again");
    return file;
  }
  const LibraryFile first(::memfd_create("proofmass", MFD_CLOEXEC), true);
  LibraryFile file(::fcntl(first.descriptor(), F_DUPFD_CLOEXEC, 3), true);
  if (file.descriptor() < 0) return system_failure("no memory for what is unpacked");
  if (const Status spooled = spool(source, file.descriptor(), progress); !spooled)
    return spooled.error();
  return file;
}

}  // namespace proofmass::io
