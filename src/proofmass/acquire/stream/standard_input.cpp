#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>

#include "proofmass/acquire/source_list.hpp"
#include "proofmass/acquire/stream/byte_pump.hpp"

namespace proofmass::acquire {
namespace {

/// A pipe, a file or a terminal opened and closed by another process.
class InputFeed final : public BytePump {
 public:
  explicit InputFeed(int descriptor) : descriptor_(descriptor) {}
  Result<Fed> read(std::span<char> into, std::chrono::milliseconds patience) override {
    if (!wait_readable(descriptor_, patience)) return Fed{};
    const ssize_t bytes = ::read(descriptor_, into.data(), into.size());
    if (bytes > 0) return Fed{static_cast<std::size_t>(bytes)};
    if (bytes == 0) return Fed{0, true};
    if (errno == EINTR || errno == EAGAIN) return Fed{};
    return Error{Errc::device, fmt::format("standard input: {}", std::strerror(errno))};
  }

 private:
  int descriptor_;
};

}  // namespace

Result<std::unique_ptr<Source>> open_stdin(SourceUri& uri, const OpenOptions& options) {
  const auto framing = framing_options(uri, Carrier::pipe);
  if (!framing) return framing.error();
  if (!uri.place().empty())
    return Error{
        Errc::invalid_argument,
        fmt::format("stdin:{}: expected nothing but settings after the colon", uri.place())};
  if (const Status known = uri.nothing_unknown(); !known) return known.error();
  SourceHead head;
  head.recording.source = uri.text();
  head.recording.format = "standard input";
  head.is_paced = false;
  return open_stream(std::make_unique<InputFeed>(STDIN_FILENO), *framing, std::move(head), options);
}

}  // namespace proofmass::acquire
