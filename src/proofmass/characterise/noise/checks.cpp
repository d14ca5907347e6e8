#include "proofmass/characterise/noise/checks.hpp"

#include <cmath>
#include <fmt/format.h>

namespace proofmass::characterise {

Status check_options(const NoiseOptions& options) {
  if (!std::isfinite(options.rate_hz) || options.rate_hz <= 0.0)
    return Error{Errc::invalid_argument, "rate_hz must be positive and finite"};
  if (std::isnan(options.confidence) || options.confidence <= 0.0 || options.confidence >= 1.0)
    return Error{Errc::invalid_argument, "confidence must be between 0 and 1"};
  if (options.noise_type == NoiseTypeSource::fixed && (options.alpha > 2 || options.alpha < -4))
    return Error{Errc::invalid_argument, "the noise type must be one of 2, 1, 0, -1, -2, -3, -4"};
  return Done{};
}

Error too_few_samples(std::size_t samples) {
  return {Errc::too_few_samples,
          fmt::format("{} samples, expected at least {}", samples, fewest_noise_samples)};
}

Error no_time_fits(const NoiseOptions& options, std::size_t samples) {
  return {
      options.taus.kind == TauGrid::Kind::given ? Errc::invalid_argument : Errc::too_few_samples,
      fmt::format("no averaging time fits: {} samples of {:.6g} s, of which the {} needs "
                  "two or three times τ",
                  samples, 1.0 / options.rate_hz, title_of(options.statistic))};
}

}  // namespace proofmass::characterise
