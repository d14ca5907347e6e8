#include "proofmass/characterise/noise/parts.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "proofmass/characterise/noise/strength_intervals.hpp"
#include "proofmass/characterise/noise_accumulator.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

constexpr std::size_t fewest_samples_of_part = 200;
constexpr double differs_p = 0.001;

// Whether the coefficient differs between the parts.
bool differs(const std::vector<NoisePart>& parts, Coefficient NoiseModelFit::* which) {
  double weights = 0.0, sum = 0.0, count = 0.0;
  for (const NoisePart& part : parts) {
    const Coefficient& found = part.model.*which;
    if (found.verdict != Verdict::identified) continue;
    const double weight = 1.0 / square(found.std);
    weights += weight;
    sum += weight * found.value;
    count += 1.0;
  }
  if (count == 0.0) return false;
  const double mean = sum / weights;
  double squares = 0.0;
  bool absent = false;
  for (const NoisePart& part : parts) {
    const Coefficient& found = part.model.*which;
    if (found.verdict == Verdict::identified)
      squares += square((found.value - mean) / found.std);
    else
      absent = absent || found.upper_two_sided_95 < 0.5 * mean;
  }
  return absent || (count > 1.0 && chi_square_p(squares, count - 1.0) < differs_p);
}

constexpr std::array terms = {&NoiseModelFit::white, &NoiseModelFit::quantisation,
                              &NoiseModelFit::flicker, &NoiseModelFit::random_walk};

void span(const Coefficient& other, Coefficient& whole) {
  whole.lower_95 = std::min(whole.lower_95, other.lower_95);
  if (other.verdict != Verdict::identified) return;
  whole.upper_95 = std::max(whole.upper_95, other.upper_95);
  whole.upper_two_sided_95 = std::max(whole.upper_two_sided_95, other.upper_two_sided_95);
}

}  // namespace

std::vector<NoisePart> noise_of_parts(View<double> series, const NoiseOptions& options) {
  std::vector<NoisePart> parts;
  std::size_t count = 8;
  if (series.size() < count * fewest_samples_of_part) count = 4;
  if (series.size() < count * fewest_samples_of_part) return parts;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = k * series.size() / count, end = (k + 1) * series.size() / count;
    NoiseAccumulator accumulator(options, end - first);
    accumulator.add(series.subspan(first, end - first));
    NoiseAnalysis found = accumulator.finish_spectrum();
    if (found.model.ordinates == 0) continue;
    parts.push_back({static_cast<double>(first) / options.rate_hz,
                     static_cast<double>(end) / options.rate_hz, found.model});
  }
  return parts;
}

void widen_to_parts(const std::vector<NoisePart>& parts, NoiseModelFit& model) {
  for (const auto which : terms) {
    if (!differs(parts, which)) continue;
    for (const NoisePart& part : parts) span(part.model.*which, model.*which);
    set_std_of_longer_side(model.*which);
  }
}

void widen_to_fit_without_events(const NoiseModelFit& without, NoiseModelFit& model) {
  for (const auto which : terms) {
    const Coefficient& other = without.*which;
    Coefficient& whole = model.*which;
    // A term that is not observable may be as large as its bound.
    const bool identified = other.verdict == Verdict::identified;
    const double least = identified ? other.value : other.lower_95;
    const double most = identified ? other.value : other.upper_two_sided_95;
    if (least <= whole.upper_two_sided_95 && most >= whole.lower_95) continue;
    span(other, whole);
    set_std_of_longer_side(whole);
  }
}

}  // namespace proofmass::characterise
