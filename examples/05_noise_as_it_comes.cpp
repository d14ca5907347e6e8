// Noise of a sensor at rest, block by block as from a driver, without storing the recording: a
// deviation curve with limits, and the coefficients with their uncertainties.
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "proofmass/characterise/noise_accumulator.hpp"

namespace pm = proofmass;
using pm::characterise::Coefficient;
using pm::characterise::Verdict;

namespace {

void print(const char* name, const Coefficient& c, const char* unit) {
  if (c.verdict == Verdict::identified) {
    std::printf("%-12s %.3g ± %.1g %s\n", name, c.value, c.std, unit);
  } else {
    std::printf("%-12s 0, below %.2g %s (95 %%)", name, c.upper_95, unit);
    if (c.record_needed_s) std::printf("; %.0f s would show that much", *c.record_needed_s);
    std::printf("\n");
  }
}

}  // namespace

int main() {
  const double rate_hz = 200.0, white = 1e-3;  // m/s^2/sqrt(Hz)
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal(9.81, white * std::sqrt(rate_hz));

  pm::characterise::NoiseAccumulator noise(
      {.rate_hz = rate_hz, .taus = {.kind = pm::characterise::TauGrid::Kind::decade}});
  std::vector<double> block(1000);
  for (int k = 0; k < 200; ++k) {
    for (double& sample : block) sample = normal(bits);
    noise.add(block);
  }

  const auto found = noise.finish();
  for (const auto& point : found.deviation.points)
    std::printf("tau %8.3f s  %.3g  (68 %%: %.3g ... %.3g)\n", point.tau_s, point.value,
                point.lower, point.upper);
  print("white", found.model.white, "m/s^2/sqrt(Hz)");
  print("flicker", found.model.flicker, "m/s^2");
  print("random walk", found.model.random_walk, "m/s^2/sqrt(s)");
  return std::abs(found.model.white.value / white - 1.0) < 0.02 ? 0 : 1;
}
