#include "proofmass/io/bytes/random_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include "proofmass/io/unnamed_file.hpp"

namespace proofmass::io {
namespace {

class FileBytes final : public RandomBytes {
 public:
  FileBytes(int descriptor, std::uint64_t size, std::vector<Note> notes)
      : descriptor_(descriptor), size_(size), notes_(std::move(notes)) {}
  ~FileBytes() override { ::close(descriptor_); }

  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] std::vector<Note> notes() const override { return notes_; }
  [[nodiscard]] Result<std::size_t> read_at(std::uint64_t offset,
                                            std::span<char> into) const override {
    std::size_t filled = 0;
    while (filled < into.size()) {
      const ssize_t count = ::pread(descriptor_, into.data() + filled, into.size() - filled,
                                    static_cast<off_t>(offset + filled));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0)
        return system_failure(fmt::format("reading failed at byte {}", offset + filled));
      if (count == 0) break;
      filled += static_cast<std::size_t>(count);
    }
    return filled;
  }

 private:
  int descriptor_;
  std::uint64_t size_;
  std::vector<Note> notes_;
};

class MemoryBytes final : public RandomBytes {
 public:
  explicit MemoryBytes(std::span<const std::byte> bytes) : bytes_(bytes) {}

  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  [[nodiscard]] Result<std::size_t> read_at(std::uint64_t offset,
                                            std::span<char> into) const override {
    if (offset >= bytes_.size()) return std::size_t{0};
    const std::size_t count = std::min<std::size_t>(into.size(), bytes_.size() - offset);
    if (count > 0) std::memcpy(into.data(), bytes_.data() + offset, count);
    return count;
  }

 private:
  std::span<const std::byte> bytes_;
};

Result<std::uint64_t> unpack(PeekSource& source, int into, const Progress& progress) {
  std::vector<char> piece(std::size_t{1} << 20);
  for (std::uint64_t total = 0;;) {
    const auto count = source.read(piece);
    if (!count) return count.error();
    if (*count == 0) return total;
    if (!write_all(into, std::span(piece).first(*count)))
      return system_failure("no room to unpack it to");
    total += *count;
    if (progress) progress("unpacking", source.fraction_read());
  }
}

}  // namespace

Result<std::unique_ptr<RandomBytes>> random_bytes_of(std::unique_ptr<PeekSource> source,
                                                     const Progress& progress) {
  using Opened = std::unique_ptr<RandomBytes>;
  if (const auto memory = source->memory()) return Opened(std::make_unique<MemoryBytes>(*memory));
  if (const auto there = source->descriptor()) {
    const int own = ::fcntl(*there, F_DUPFD_CLOEXEC, 3);
    if (own < 0) return system_failure("cannot be opened again");
    return Opened(
        std::make_unique<FileBytes>(own, source->size().value_or(0), std::vector<Note>{}));
  }
  const int file = unnamed_file(P_tmpdir);
  if (file < 0) return system_failure("no room to unpack it to");
  const auto size = unpack(*source, file, progress);
  auto bytes = std::make_unique<FileBytes>(file, size ? *size : 0, source->notes());
  if (!size) return size.error();
  return Opened(std::move(bytes));
}

}  // namespace proofmass::io
