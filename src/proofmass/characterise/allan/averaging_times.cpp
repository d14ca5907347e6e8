#include "proofmass/characterise/allan/averaging_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "proofmass/core/contract.hpp"

namespace proofmass::characterise {
namespace {

// The longest m with at least one term; samples is one less than the number of phase points.
std::size_t longest(Statistic statistic, std::size_t samples) {
  switch (statistic) {
    case Statistic::totdev:
      return samples == 0 ? 0 : samples - 1;
    case Statistic::adev:
    case Statistic::oadev:
    case Statistic::pdev:
      return samples / 2;
    case Statistic::mdev:
    case Statistic::tdev:
      return (samples + 1) / 3;
    case Statistic::theo1:
      return samples;
    default:
      return samples / 3;
  }
}

// At most five leading bits, so that the remaining factor is left to decimation.
std::size_t with_few_bits(double m) {
  double unit = 1.0;
  while (m >= 32.0 * unit) unit *= 2.0;
  return static_cast<std::size_t>(std::llround(m / unit) * std::llround(unit));
}

std::vector<std::size_t> per_decade(int count, std::size_t last) {
  std::vector<std::size_t> factors;
  for (int j = 0;; ++j) {
    const double m = std::pow(10.0, static_cast<double>(j) / count);
    if (m > static_cast<double>(last) + 0.5) return factors;
    factors.push_back(with_few_bits(m));
  }
}

std::vector<std::size_t> one_two_four(std::size_t last) {
  std::vector<std::size_t> factors;
  for (std::size_t m = 1; m <= last; m *= 10) {
    for (const std::size_t digit : {1U, 2U, 4U}) factors.push_back(digit * m);
  }
  return factors;
}

std::vector<std::size_t> wanted(const TauGrid& grid, std::size_t last, double tau0_s) {
  std::vector<std::size_t> factors;
  switch (grid.kind) {
    case TauGrid::Kind::octave:
      for (std::size_t m = 1; m <= last; m *= 2) factors.push_back(m);
      break;
    case TauGrid::Kind::decade:
      return one_two_four(last);
    case TauGrid::Kind::per_decade:
      return per_decade(grid.per_decade, last);
    case TauGrid::Kind::all:
      for (std::size_t m = 1; m <= last; ++m) factors.push_back(m);
      break;
    case TauGrid::Kind::given:
      for (const double time_s : grid.times_s) {
        const double m = std::round(time_s / tau0_s);
        if (m >= 1.0 && m < 1e15) factors.push_back(static_cast<std::size_t>(m));
      }
      break;
  }
  return factors;
}

}  // namespace

double default_stop_ratio(Statistic statistic) {
  switch (statistic) {
    case Statistic::totdev:
      return 2.0;
    case Statistic::mtotdev:
    case Statistic::ttotdev:
    case Statistic::htotdev:
      return 3.0;
    case Statistic::theo1:
      return 1.0;
    default:
      return 4.0;
  }
}

std::vector<std::size_t> averaging_factors(const TauGrid& grid,
                                           Statistic statistic,
                                           std::size_t samples,
                                           double tau0_s) {
  PM_EXPECTS(grid.per_decade > 0 && tau0_s > 0.0);
  const double ratio = grid.stop_ratio > 0.0 ? grid.stop_ratio : default_stop_ratio(statistic);
  std::size_t last = longest(statistic, samples);
  if (grid.kind != TauGrid::Kind::given) {
    last = std::min(last, static_cast<std::size_t>(static_cast<double>(samples) / ratio));
  }
  std::vector<std::size_t> factors = wanted(grid, last, tau0_s);
  // Theo1 is defined for even factors only, from ten on.
  if (statistic == Statistic::theo1) {
    for (std::size_t& m : factors) m += m % 2;
    std::erase_if(factors, [](std::size_t m) { return m < 10; });
  }
  std::erase_if(factors, [&](std::size_t m) { return m > last; });
  std::sort(factors.begin(), factors.end());
  factors.erase(std::unique(factors.begin(), factors.end()), factors.end());
  return factors;
}

}  // namespace proofmass::characterise
