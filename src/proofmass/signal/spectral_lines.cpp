#include "proofmass/signal/spectral_lines.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/signal/spectrum/background.hpp"
#include "proofmass/signal/spectrum/floor.hpp"

namespace proofmass::signal {
namespace {

constexpr double false_alarm_probability = 1e-3;  ///< for a whole spectrum
constexpr double least_excess = 1.259;            ///< 1 dB
constexpr double least_skirt = 1.06;              ///< the background is accurate to about 3 %
constexpr std::size_t smoothed_bins = 5;
constexpr std::size_t fewest_bins = 33;
constexpr std::size_t wide_bins = 12;
constexpr double least_prominence = 1.12;  ///< 0.5 dB
constexpr std::size_t half_lobe = 2;       ///< bins from a line's centre to its first zero

/// Bins [first, last).
struct Region {
  std::size_t first, last;
};

/// A spectrum and the background it is compared with.
struct Judged {
  const Spectrum& spectrum;
  const std::vector<double>& background;

  [[nodiscard]] double excess(std::size_t k) const {
    return spectrum.one_sided_psd[k] - background[k];
  }
  [[nodiscard]] double ratio(std::size_t k) const {
    return spectrum.one_sided_psd[k] / background[k];
  }
  [[nodiscard]] std::size_t end() const { return end_of_judged_bins(spectrum); }
  [[nodiscard]] double bin_hz() const {
    return spectrum.rate_hz / static_cast<double>(spectrum.segment);
  }

  /// Mean ratio over the bins about k.
  [[nodiscard]] double smoothed_ratio(std::size_t k) const {
    const std::size_t first = std::max(k, first_judged_bin + half_lobe) - half_lobe;
    const std::size_t last = std::min(k + half_lobe + 1, end());
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) sum += ratio(i);
    return sum / static_cast<double>(last - first);
  }

  [[nodiscard]] std::size_t peak(Region region) const {
    std::size_t best = region.first;
    for (std::size_t k = region.first; k < region.last; ++k)
      if (ratio(k) > ratio(best)) best = k;
    return best;
  }

  /// The bins about the peak in which the excess is at least half of the peak's.
  [[nodiscard]] Region half_height(Region region) const {
    const std::size_t top = peak(region);
    Region half{top, top + 1};
    while (half.first > region.first && excess(half.first - 1) >= 0.5 * excess(top)) --half.first;
    while (half.last < region.last && excess(half.last) >= 0.5 * excess(top)) ++half.last;
    return half;
  }
};

/// Minimum ratios to the background of a line's peak and its skirt.
struct Thresholds {
  double peak, skirt;
};

Thresholds thresholds_of(const Judged& judged) {
  const double edf = judged.spectrum.edf_per_bin;
  const auto bins = static_cast<double>(judged.end() - first_judged_bin);
  const double smoothed_edf = edf * smoothed_bins / bins_per_independent_bin;
  return {
      std::max(least_excess, chi_square_quantile(1.0 - false_alarm_probability / bins, edf) / edf),
      std::max(least_skirt, chi_square_quantile(0.95, smoothed_edf) / smoothed_edf)};
}

/// Bins above the threshold, each extended until it meets the background, adjacent regions joined.
std::vector<Region> regions_above(const Judged& judged, const Thresholds& thresholds) {
  std::vector<Region> regions;
  for (std::size_t k = first_judged_bin; k < judged.end(); ++k) {
    if (judged.ratio(k) <= thresholds.peak) continue;
    Region region{std::max(k, first_judged_bin + half_lobe) - half_lobe,
                  std::min(k + half_lobe + 1, judged.end())};
    while (region.first > first_judged_bin &&
           judged.smoothed_ratio(region.first - 1) > thresholds.skirt)
      --region.first;
    while (region.last < judged.end() && judged.smoothed_ratio(region.last) > thresholds.skirt)
      ++region.last;
    if (!regions.empty() && region.first <= regions.back().last + half_lobe)
      regions.back().last = std::max(regions.back().last, region.last);
    else
      regions.push_back(region);
    k = std::max(k, regions.back().last - 1);
  }
  return regions;
}

/// Narrower than an octave at half its height; a few bins near zero always satisfy this.
bool is_narrow(const Judged& judged, Region region) {
  const Region half = judged.half_height(region);
  return half.last - half.first <= 2 * half_lobe || half.last < 2 * half.first;
}

/// The nearest `count` bins next to a region that are in no region themselves.
std::vector<std::size_t> flank(const Judged& judged,
                               const std::vector<Region>& regions,
                               std::size_t from,
                               int step) {
  const std::size_t count = 12;
  std::vector<std::size_t> bins;
  for (std::size_t k = from; bins.size() < count; k += static_cast<std::size_t>(step)) {
    if (k < first_judged_bin || k >= judged.end()) break;
    if (std::ranges::none_of(regions, [k](Region r) { return r.first <= k && k < r.last; }))
      bins.push_back(k);
  }
  return bins;
}

/// Distinguishes a line from the shoulder of a filter, which the background underestimates: a wide
/// one must be higher than the spectrum on both sides, a narrow one must also exceed its
/// neighbours.
bool is_peak(const Judged& judged,
             const std::vector<Region>& regions,
             const Thresholds& thresholds,
             Region region) {
  const std::vector<std::size_t> left = flank(judged, regions, region.first - 1, -1),
                                 right = flank(judged, regions, region.last, 1);
  const bool is_wide = region.last - region.first > wide_bins;
  if (is_wide && (left.empty() || right.empty())) return false;
  const std::size_t top = judged.peak(region);
  if (is_wide) {
    const auto mean_psd = [&](const std::vector<std::size_t>& bins) {
      double sum = 0.0;
      for (const std::size_t k : bins) sum += judged.spectrum.one_sided_psd[k];
      return sum / static_cast<double>(bins.size());
    };
    const double smooth = judged.smoothed_ratio(top) * judged.background[top];
    return smooth > least_prominence * std::max(mean_psd(left), mean_psd(right));
  }
  double sum = 0.0;
  for (const std::size_t k : left) sum += judged.ratio(k);
  for (const std::size_t k : right) sum += judged.ratio(k);
  const auto count = static_cast<double>(left.size() + right.size());
  return judged.ratio(top) > thresholds.peak * std::max(1.0, sum / std::max(count, 1.0));
}

std::vector<Region> find_regions(const Judged& judged) {
  const Thresholds thresholds = thresholds_of(judged);
  const std::vector<Region> all = regions_above(judged, thresholds);
  std::vector<Region> found;
  std::ranges::copy_if(all, std::back_inserter(found), [&](Region region) {
    return is_narrow(judged, region) && is_peak(judged, all, thresholds, region);
  });
  return found;
}

SpectralLine measure_line(const Judged& judged, Region region) {
  const double bin_hz = judged.bin_hz(), edf = judged.spectrum.edf_per_bin;
  const Region half = judged.half_height(region);
  const bool is_tone = half.last - half.first <= 3;
  double power = 0.0, variance = 0.0;
  for (std::size_t k = region.first; k < region.last; ++k) {
    const double psd = judged.spectrum.one_sided_psd[k], excess = std::max(judged.excess(k), 0.0);
    power += judged.excess(k);
    // A steady tone does not fluctuate, only its noise does: non-central chi-square.
    variance += (psd * psd - (is_tone ? excess * excess : 0.0)) * 2.0 / edf;
  }
  power = std::max(power, 0.0) * bin_hz;
  const double power_std = std::sqrt(variance * bins_per_independent_bin) * bin_hz;

  double weights = 0.0, moment = 0.0;
  const std::size_t last = std::min(half.last + 1, judged.end());
  for (std::size_t k = std::max(half.first, first_judged_bin) - 1; k < last; ++k) {
    const double weight = std::max(judged.excess(k), 0.0);
    weights += weight;
    moment += weight * static_cast<double>(k);
  }
  SpectralLine line;
  line.frequency_hz = moment / weights * bin_hz;
  line.low_hz = (static_cast<double>(region.first) - 0.5) * bin_hz;
  line.high_hz = (static_cast<double>(region.last) - 0.5) * bin_hz;
  line.amplitude = std::sqrt(2.0 * power);
  line.amplitude_std = power > 0.0 ? power_std / line.amplitude : std::sqrt(2.0 * power_std);
  line.excess_db = 10.0 * std::log10(judged.ratio(judged.peak(region)));
  return line;
}

}  // namespace

LineReport find_lines(const Spectrum& spectrum) {
  LineReport report;
  const std::size_t bins = spectrum.one_sided_psd.size();
  report.in_line.assign(bins, false);
  report.background = spectrum.one_sided_psd;
  const bool is_silent =
      std::ranges::all_of(spectrum.one_sided_psd, [](double p) { return p <= 0.0; });
  if (bins < fewest_bins || is_silent) return report;

  std::vector<Region> found;
  // Lines raise a background that is fitted with them included; without them, more of each is
  // visible.
  for (int pass = 0; pass < 4; ++pass) {
    report.background = spectral_background(spectrum, report.in_line);
    const Judged judged{spectrum, report.background};
    found = find_regions(judged);
    std::vector<bool> in_line(bins, false);
    for (const Region& region : found)
      for (std::size_t k = region.first; k < region.last; ++k) in_line[k] = true;
    const bool settled = in_line == report.in_line;
    report.in_line = std::move(in_line);
    if (settled) break;
  }
  const Judged judged{spectrum, report.background};
  for (const Region& region : found) report.lines.push_back(measure_line(judged, region));
  report.floor = measure_floor(spectrum, report.background, report.in_line);
  return report;
}

}  // namespace proofmass::signal
