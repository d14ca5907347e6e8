// Runs the verbs on COUNT random short recordings from number FIRST on, by the fuzz target of the
// verbs (fuzz/fuzz_verbs.cpp): without a fuzzer, and as fast as the build is. A violated contract,
// an exception that escapes or a document that is not JSON ends it with the number of the
// recording:
//
//   random_recordings [COUNT [FIRST]]
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <utility>
#include <vector>

extern "C" int LLVMFuzzerInitialize(int*, char***);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t*, std::size_t);

namespace {

using Bytes = std::vector<std::uint8_t>;

volatile std::sig_atomic_t current = 0;

extern "C" void say_which(int signal) {
  // Not safe in a signal handler in general; the process is lost anyway.
  std::fprintf(stderr, "recording %d ended by signal %d\n", static_cast<int>(current), signal);
  std::_Exit(EXIT_FAILURE);
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  /// 0 to count − 1
  unsigned below(unsigned count) { return static_cast<unsigned>((bits_() >> 32) * count >> 32); }
  bool one_in(unsigned count) { return below(count) == 0; }

 private:
  std::mt19937_64 bits_;
};

/// Verb, rows, scale, rate and the row of an odd stamp, as fuzz_verbs reads them; then the samples.
Bytes recording(std::uint64_t number) {
  Draw draw(number);
  const auto byte = [&draw] { return static_cast<std::uint8_t>(draw.below(256)); };
  const auto around = [&draw](unsigned middle, unsigned spread) {
    return static_cast<std::uint8_t>(middle - spread + draw.below(2 * spread + 1));
  };
  Bytes bytes{byte(), byte()};
  bytes.push_back(draw.one_in(2) ? std::uint8_t{128} : byte());   // m/s² as they are
  bytes.push_back(draw.one_in(2) ? around(160, 16) : byte());     // about 100 Hz
  bytes.push_back(draw.one_in(2) ? std::uint8_t{255} : byte());   // no odd stamp
  const unsigned samples = draw.one_in(4) ? 0 : draw.below(600);  // then a wheel's
  const unsigned spread = std::min(120u, 1u << draw.below(8));
  const unsigned hold = 1u << draw.below(6);  // steps, or noise
  const bool odd = draw.one_in(3);
  for (unsigned k = 0; k < samples; ++k) {
    const bool repeats = k >= 3 && k % hold != 0;
    const auto sample = repeats ? bytes[bytes.size() - 3] : around(125, spread);
    bytes.push_back(odd && draw.one_in(50) ? byte() : sample);
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int at, long otherwise) {
    return argc > at ? std::strtol(argv[at], nullptr, 10) : otherwise;
  };
  const long count = argument(1, 1000);
  const long first = argument(2, 0);
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL})
    std::signal(signal, say_which);
  LLVMFuzzerInitialize(&argc, &argv);
  std::vector<std::pair<double, long>> seconds;
  for (long number = first; number < first + count; ++number) {
    current = static_cast<std::sig_atomic_t>(number);
    const Bytes bytes = recording(static_cast<std::uint64_t>(number));
    const auto begun = std::chrono::steady_clock::now();
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begun;
    seconds.emplace_back(taken.count(), number);
  }
  std::ranges::sort(seconds, std::greater{});
  std::fprintf(stderr, "%ld recordings; the slowest:", count);
  for (std::size_t k = 0; k < std::min<std::size_t>(seconds.size(), 5); ++k)
    std::fprintf(stderr, " %ld (%.2f s)", seconds[k].second, seconds[k].first);
  std::fprintf(stderr, "\n");
  return EXIT_SUCCESS;
}
