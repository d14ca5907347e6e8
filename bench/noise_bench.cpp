// A noise analysis compared with two references in the same run, one thread, processor time:
// numpy's formula for the overlapping Allan deviation (numpy_oadev.py, if there is a python3 with
// numpy), and the same as a plain C++ loop. In addition one pass over the data, the memory
// bandwidth limit.
//
//   noise_bench [samples, 7.2e6 if not given]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "measure.hpp"
#include "proofmass/characterise/allan/difference_variance.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/characterise/noise_fit.hpp"

namespace {

using namespace proofmass;
using namespace proofmass::characterise;

constexpr double rate_hz = 1000.0;

template <class Work>
double best_of(int times, const Work& work) {
  double best = 1e300;
  for (int k = 0; k < times; ++k) {
    const double from = cpu_s();
    work();
    best = std::min(best, cpu_s() - from);
  }
  return best;
}

std::vector<double> white_and_random_walk(std::size_t n) {
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal;
  std::vector<double> y(n);
  double walk = 0.0;
  for (double& v : y) v = 9.8 + 0.01 * normal(bits) + (walk += 1e-6 * normal(bits));
  return y;
}

// Every term at every τ, by definition.
double plain_loop(const std::vector<double>& y, const std::vector<std::size_t>& factors) {
  double mean = 0.0, sum_of_all = 0.0;
  for (const double v : y) mean += v / static_cast<double>(y.size());
  std::vector<double> x(y.size() + 1, 0.0);
  for (std::size_t k = 0; k < y.size(); ++k) x[k + 1] = x[k] + (y[k] - mean);
  for (const std::size_t m : factors) {
    double sum = 0.0;
    for (std::size_t k = 0; k + 2 * m < x.size(); ++k) {
      const double z = x[k + 2 * m] - 2.0 * x[k + m] + x[k];
      sum += z * z;
    }
    sum_of_all += sum / static_cast<double>(m * m);
  }
  return sum_of_all;
}

// Seconds of numpy, 0 without it.
double numpy_s(std::size_t samples, std::size_t taus) {
  const std::string command = "python3 '" PROOFMASS_BENCH_DIR "/numpy_oadev.py' " +
                              std::to_string(samples) + " " + std::to_string(taus) + " 2>/dev/null";
  std::FILE* pipe = popen(command.c_str(), "r");
  double seconds = 0.0;
  if (pipe == nullptr) return seconds;
  if (std::fscanf(pipe, "%lf", &seconds) != 1) seconds = 0.0;
  pclose(pipe);
  return seconds;
}

void line(const char* what, double seconds, double reference) {
  std::printf("  %-46s %8.4f s", what, seconds);
  if (reference > 0.0) std::printf("   %6.1f x numpy", reference / seconds);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  const auto n = static_cast<std::size_t>(argc > 1 ? std::atof(argv[1]) : 7.2e6);
  const std::vector<double> y = white_and_random_walk(n);
  const double data_mib = static_cast<double>(n * sizeof(double)) / (1024.0 * 1024.0);
  NoiseOptions options{.rate_hz = rate_hz, .taus = {.per_decade = 18}};
  const auto factors = averaging_factors(options.taus, options.statistic, n, 1.0 / rate_hz);
  std::printf("%zu samples, %zu taus\n", n, factors.size());
  // First, so that no other peak hides it.
  volatile double sink = analyse_noise(y, options).value().deviation.points.back().value;
  const double memory = peak_mib() / data_mib;
  const double numpy = numpy_s(n, factors.size());
  if (numpy > 0.0) {
    line("numpy, cumulative sum, every term", numpy, numpy);
  } else {
    std::printf("  no python3 with numpy here\n");
  }
  line("plain C++ loop, every term", best_of(1, [&] { sink = plain_loop(y, factors); }), numpy);

  const double deviations = best_of(5, [&] {
    DifferenceVariances all(Statistic::oadev, factors, 16);
    all.add(y);
    sink = all.finish().back().variance;
  });
  signal::Spectrum spectrum;
  const double spectra =
      best_of(5, [&] { spectrum = signal::welch(y, {.rate_hz = rate_hz}).value(); });
  signal::LineReport lines;
  const double search = best_of(5, [&] { lines = signal::find_lines(spectrum); });
  const double fit = best_of(5, [&] {
    BlockMeans slow(rate_hz);
    slow.add(y);
    sink = fit_noise_model({slow, spectrum, lines, static_cast<double>(n) / rate_hz})
               .value()
               .white.value;
  });
  const double events = best_of(
      3, [&] { sink = static_cast<double>(signal::find_events(y, {.rate_hz = rate_hz}).size()); });
  line("deviations", deviations, numpy);
  line("spectrum", spectra, numpy);
  line("lines and floor", search, numpy);
  line("coefficients with intervals", fit, numpy);
  line("deviations, spectrum, lines, coefficients", deviations + spectra + search + fit, numpy);
  line("knocks and steps", events, numpy);
  line("all of it, with limits",
       best_of(3, [&] { sink = analyse_noise(y, options).value().deviation.points.back().value; }),
       numpy);
  std::printf("  memory: %.1f x the data, the data themselves included\n", memory);
  const double read = best_of(5, [&] {
    double sums[8] = {};
    for (std::size_t k = 0; k + 8 <= n; k += 8)
      for (std::size_t j = 0; j < 8; ++j) sums[j] += y[k + j];
    sink = sums[0] + sums[1] + sums[2] + sums[3] + sums[4] + sums[5] + sums[6] + sums[7];
  });
  std::printf(
      "  one read of the data takes %.4f s: the deviations take %.0f of them, all but the "
      "events %.0f\n",
      read, deviations / read, (deviations + spectra + search + fit) / read);
}
