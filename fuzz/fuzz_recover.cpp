#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "proofmass/io/mcap/salvage.hpp"

namespace {

struct Saved {
  proofmass::Result<proofmass::Recovery> recovery;
  std::string bytes{};
};

Saved salvaged(std::span<const std::byte> file) {
  std::string made;
  auto recovery = proofmass::io::mcap::salvage(file, [&](const std::string& bytes) {
    made += bytes;
    return proofmass::Status(proofmass::Done{});
  });
  return {std::move(recovery), std::move(made)};
}

}  // namespace

// A file recovered from arbitrary bytes must be intact, and recovering it again must keep
// everything.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto require = [](bool kept) {
    if (!kept) std::abort();
  };
  std::vector<std::uint8_t> file{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
  file.insert(file.end(), data, data + size);
  const Saved saved = salvaged(std::as_bytes(std::span(file)));
  if (!saved.recovery) {
    require(!saved.recovery.error().message.empty());
    return 0;
  }
  require(saved.recovery->bytes_lost <= file.size());
  const Saved again = salvaged(std::as_bytes(std::span(saved.bytes)));
  require(again.recovery && again.recovery->bytes_lost == 0);
  require(again.recovery->messages == saved.recovery->messages);
  require(again.recovery->samples == saved.recovery->samples);
  return 0;
}
