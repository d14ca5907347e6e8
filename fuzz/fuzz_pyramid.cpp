#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/pyramid/file.hpp"

namespace {

using proofmass::io::ArchiveEntry;

constexpr std::array<std::string_view, 13> names{
    "names.txt",      "source.npy", "samples.npy",     "end_s.npy",        "bin_samples.npy",
    "00_start_s.npy", "00_min.npy", "00_max.npy",      "00_nonfinite.npy", "01_start_s.npy",
    "01_min.npy",     "01_max.npy", "01_nonfinite.npy"};

/// Concatenated entries: one byte for the name, two for the length, then the data. Replaces the zip
/// archive, whose checksums would reject nearly all mutations.
class PlainArchive final : public proofmass::io::Archive {
 public:
  explicit PlainArchive(std::string_view rest) {
    while (rest.size() >= 3) {
      const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(rest[i]); };
      const std::size_t length = std::min<std::size_t>(byte(1) + 256U * byte(2), rest.size() - 3);
      entries_.push_back({std::string(names[byte(0) % names.size()]), length});
      bytes_.push_back(rest.substr(3, length));
      rest.remove_prefix(3 + length);
    }
  }
  std::span<const ArchiveEntry> entries() const override { return entries_; }
  proofmass::Result<std::unique_ptr<proofmass::io::PeekSource>> open(std::size_t entry) override {
    return std::make_unique<proofmass::io::PeekSource>(
        proofmass::io::open_memory(std::as_bytes(std::span(bytes_[entry]))));
  }

 private:
  std::vector<ArchiveEntry> entries_;
  std::vector<std::string_view> bytes_;
};

void require(bool kept) {
  if (!kept) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto read =
      proofmass::io::read_pyramid(std::make_unique<PlainArchive>(bytes), size, {8, 1});
  if (!read) {
    require(!read.error().message.empty());
    return 0;
  }
  require(!read->levels.empty());
  for (const auto& level : read->levels) {
    require(level.channels.size() == read->names.size());
    for (const auto& channel : level.channels)
      require(channel.min.size() == level.bins() && channel.max.size() == level.bins() &&
              channel.nonfinite.size() == level.bins());
  }
  require(read->level_for(0.0, 1.0, 100).bins() > 0);
  return 0;
}
