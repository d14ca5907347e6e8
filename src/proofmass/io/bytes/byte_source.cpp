#include "proofmass/io/bytes/byte_source.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "proofmass/io/unnamed_file.hpp"

namespace proofmass::io {
namespace {

class FileSource final : public ByteSource {
 public:
  FileSource(std::FILE* file, bool owned, std::optional<std::uint64_t> size)
      : file_(file), owned_(owned), size_(size) {
    // The readers read large pieces; a second buffer would only add a copy.
    if (owned_) std::setvbuf(file_, nullptr, _IONBF, 0);
  }
  ~FileSource() override {
    if (owned_) std::fclose(file_);
  }

  Result<std::size_t> read(std::span<char> into) override {
    const std::size_t count = std::fread(into.data(), 1, into.size(), file_);
    if (count == 0 && std::ferror(file_) != 0)
      return system_failure("reading failed at byte " + std::to_string(position_));
    position_ += count;
    return count;
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return size_; }
  [[nodiscard]] std::optional<int> descriptor() const override {
    return owned_ && size_ ? std::optional(::fileno(file_)) : std::nullopt;
  }
  [[nodiscard]] double fraction_read() const override {
    if (!size_ || *size_ == 0) return 0.0;
    return std::min(1.0, static_cast<double>(position_) / static_cast<double>(*size_));
  }

 private:
  std::FILE* file_;
  bool owned_;
  std::optional<std::uint64_t> size_;
  std::uint64_t position_ = 0;
};

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::span<const std::byte> bytes) : bytes_(bytes) {}

  Result<std::size_t> read(std::span<char> into) override {
    const std::size_t count = std::min(into.size(), bytes_.size() - position_);
    if (count > 0) std::memcpy(into.data(), bytes_.data() + position_, count);
    position_ += count;
    return count;
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return bytes_.size(); }
  [[nodiscard]] std::optional<std::span<const std::byte>> memory() const override { return bytes_; }
  [[nodiscard]] double fraction_read() const override {
    if (bytes_.empty()) return 0.0;
    return static_cast<double>(position_) / static_cast<double>(bytes_.size());
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

/// Text with two bytes per character without a byte-order mark has a zero in every second byte.
bool zeros_at(std::string_view head, std::size_t parity) {
  if (head.size() < 8) return false;
  std::size_t zeros = 0;
  std::size_t others = 0;
  for (std::size_t i = 0; i < head.size(); ++i)
    if (head[i] == '\0') ++(i % 2 == parity ? zeros : others);
  return others == 0 && zeros > head.size() * 2 / 5;
}

}  // namespace

Result<std::string_view> PeekSource::peek(std::size_t wanted) {
  ahead_.erase(0, taken_);
  taken_ = 0;
  while (ahead_.size() < wanted) {
    const std::size_t had = ahead_.size();
    ahead_.resize(wanted);
    const auto count = source_->read(std::span(ahead_).subspan(had));
    ahead_.resize(count ? had + *count : had);
    if (!count) return count.error();
    if (*count == 0) break;
  }
  return std::string_view(ahead_).substr(0, wanted);
}

Result<std::size_t> PeekSource::read(std::span<char> into) {
  if (taken_ == ahead_.size()) return source_->read(into);
  const std::size_t count = std::min(into.size(), ahead_.size() - taken_);
  std::memcpy(into.data(), ahead_.data() + taken_, count);
  taken_ += count;
  if (taken_ == ahead_.size()) {
    std::string().swap(ahead_);
    taken_ = 0;
  }
  return count;
}

Result<std::unique_ptr<ByteSource>> open_file(const std::string& path) {
  using Opened = std::unique_ptr<ByteSource>;
  if (path == "-") return Opened(std::make_unique<FileSource>(stdin, false, std::nullopt));
  std::error_code problem;
  const auto status = std::filesystem::status(path, problem);
  if (std::filesystem::is_directory(status))
    return Error{Errc::unreadable, "is a directory: name a file in it"};
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return system_failure("cannot be opened");
  std::optional<std::uint64_t> size;
  if (std::filesystem::is_regular_file(status)) size = std::filesystem::file_size(path, problem);
  if (problem) size.reset();
  return Opened(std::make_unique<FileSource>(file, true, size));
}

std::unique_ptr<ByteSource> open_memory(std::span<const std::byte> bytes) {
  return std::make_unique<MemorySource>(bytes);
}

Result<std::unique_ptr<PeekSource>> unwrap(std::unique_ptr<ByteSource> source) {
  using namespace std::literals;
  auto opened = std::make_unique<PeekSource>(std::move(source));
  auto head = opened->peek(6);
  if (!head) return head.error();
  const bool gzip = head->starts_with("\x1F\x8B"sv);
  const bool xz = head->starts_with("\xFD\x37\x7A\x58\x5A\0"sv);
  const bool zstd = head->starts_with("\x28\xB5\x2F\xFD"sv);
  if (gzip) opened = std::make_unique<PeekSource>(gunzip(std::move(opened)));
  if (xz) opened = std::make_unique<PeekSource>(unxz(std::move(opened)));
  if (zstd) opened = std::make_unique<PeekSource>(unzstd(std::move(opened)));
  head = opened->peek(1024);
  if (!head) return head.error();
  const bool little = head->starts_with("\xFF\xFE"sv);
  const bool big = head->starts_with("\xFE\xFF"sv);
  if (little || big) {
    std::array<char, 2> mark;
    if (const auto taken = opened->read(mark); !taken) return taken.error();
  }
  if (little || big || zeros_at(*head, 1) || zeros_at(*head, 0)) {
    const bool big_endian = big || (!little && zeros_at(*head, 0));
    opened = std::make_unique<PeekSource>(utf8_from_utf16(std::move(opened), big_endian));
  }
  return opened;
}

}  // namespace proofmass::io
