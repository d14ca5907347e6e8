// How long a recording of 10⁸ samples takes to be shown: opening its view and drawing the whole,
// then any zoom. Writes 800 MB into the folder given (default: the current one) and removes them.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "proofmass/serve/temporary.hpp"
#include "proofmass/serve/view/file.hpp"

namespace {

using namespace proofmass;
using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begun) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

void write_view(const std::string& folder, std::size_t samples) {
  constexpr std::size_t piece = 1'000'000;
  Recording head;
  head.time.source = TimeSource::given_rate;
  head.time.rate_hz = 1000.0;
  head.channels = {{"x", *parse_unit("m/s^2"), {}}};
  auto writer = serve::ViewWriter::create(folder, head, false).value();
  std::mt19937_64 random(1);
  std::vector<double> values(piece);
  for (std::size_t first = 0; first < samples; first += piece) {
    for (double& value : values) value = static_cast<double>(random() >> 11) * 0x1p-53;
    (void)writer.add({.first = first, .channels = {values}}).value();
  }
  (void)writer.finish(head).value();
}

}  // namespace

int main(int argc, char** argv) {
  constexpr std::size_t samples = 100'000'000, pixels = 1000, zooms = 2000;
  const auto folder = serve::TemporaryFolder::make(argc > 1 ? argv[1] : ".").value();
  auto begun = Clock::now();
  write_view(folder.path(), samples);
  std::printf("written once        %8.0f ms\n", ms_since(begun));

  begun = Clock::now();
  const auto view = serve::ViewFile::open(folder.path()).value();
  const double end_s = view.head().end_s;
  (void)view.window({0.0, end_s}, pixels);
  std::printf("opened and drawn    %8.1f ms, target 300 ms\n", ms_since(begun));

  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  std::vector<double> times_ms;
  for (std::size_t k = 0; k < zooms; ++k) {
    const double length_s = end_s * std::pow(10.0, -7.0 * place(random));
    const double from_s = place(random) * (end_s - length_s);
    begun = Clock::now();
    (void)view.window({from_s, from_s + length_s}, pixels);
    times_ms.push_back(ms_since(begun));
  }
  std::ranges::sort(times_ms);
  std::printf("%zu zooms, median  %8.3f ms, 99 %% %.2f ms, slowest %.2f ms, target 50 ms\n", zooms,
              times_ms[zooms / 2], times_ms[zooms * 99 / 100], times_ms.back());
  return 0;
}
