#include "proofmass/characterise/noise/spectral_groups.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace proofmass::characterise {
namespace {

// Number of a transform's first coefficients kept single, which contain the ramp.
constexpr std::size_t single = 48;
// Width of a group over its frequency: the density of f^−2 noise is linear in it to 0.1 %.
constexpr double relative_width = 0.03;
// The averaged spectrum is used where it is smooth within its window: from its eighth bin.
constexpr double first_bin = 8.0;
// Below, its bins have too few degrees of freedom to be better than the transform's.
constexpr std::size_t least_averaged = 12;
// With shorter segments the last bins, which are not used, and the ends of the record, which the
// window attenuates, are too large a share: quantisation noise is most visible at the highest
// frequencies.
constexpr std::size_t shortest_averaged = 512;
// Neighbouring bins of a Hann window correlate by 4/9, next ones by 1/36: a bin's share of
// independent degrees of freedom. Source: Percival & Walden (1993), section 6.10.
constexpr double bin_share = 1.0 / (1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0));

// Collects neighbours until they are a group.
class Grouping {
 public:
  explicit Grouping(std::vector<SpectralGroup>& groups) : groups_(groups) {}

  void add(double frequency_hz, double density, double dof, double wide_enough_hz) {
    if (count_ == 0) first_hz_ = frequency_hz;
    frequency_sum_ += frequency_hz;
    density_sum_ += density;
    dof_ += dof;
    ++count_;
    if (frequency_hz - first_hz_ >= wide_enough_hz) close();
  }
  void close() {
    if (count_ == 0) return;
    const auto n = static_cast<double>(count_);
    groups_.push_back({frequency_sum_ / n, density_sum_ / n, dof_});
    frequency_sum_ = density_sum_ = dof_ = 0.0;
    count_ = 0;
  }

 private:
  std::vector<SpectralGroup>& groups_;
  double first_hz_ = 0.0, frequency_sum_ = 0.0, density_sum_ = 0.0, dof_ = 0.0;
  std::size_t count_ = 0;
};

bool in_any(const std::vector<signal::SpectralLine>& lines, double frequency_hz, double margin_hz) {
  return std::any_of(lines.begin(), lines.end(), [&](const signal::SpectralLine& line) {
    return frequency_hz >= line.low_hz - margin_hz && frequency_hz <= line.high_hz + margin_hz;
  });
}

// By plain least squares: beyond the coefficients that contain the ramp, where it falls with the
// square of their number, the remaining error is below the noise.
double rough_slope(const std::vector<CosineOrdinate>& ordinates) {
  double cross = 0.0, own = 0.0;
  for (const CosineOrdinate& ordinate : ordinates) {
    cross += ordinate.amplitude * ordinate.of_ramp;
    own += ordinate.of_ramp * ordinate.of_ramp;
  }
  return own > 0.0 ? cross / own : 0.0;
}

void group_transform(const NoiseEvidence& evidence, double below_hz, GroupedEvidence& grouped) {
  const std::vector<CosineOrdinate> ordinates = evidence.slow.ordinates(evidence.slow_wave);
  const double slope = rough_slope(ordinates);
  const double margin_hz = 0.5 * grouped.bin_hz;
  std::vector<SpectralGroup> rest;
  Grouping grouping(rest);
  std::size_t k = 0;
  double last_hz = 0.0;
  for (const CosineOrdinate& ordinate : ordinates) {
    const double f = ordinate.frequency_hz, p = ordinate.amplitude * ordinate.amplitude;
    if (f < last_hz) {  // the next stretch
      grouping.close();
      k = 0;
    }
    last_hz = f;
    ++k;
    if (f >= below_hz || in_any(evidence.lines.lines, f, margin_hz)) continue;
    if (k <= single) {
      grouped.groups.push_back({f, p, 1.0, ordinate.amplitude, ordinate.of_ramp, ordinate.vector});
    } else {
      const double level = ordinate.amplitude - slope * ordinate.of_ramp;
      grouping.add(f, level * level, 1.0, relative_width * f);
    }
  }
  grouping.close();
  grouped.groups.insert(grouped.groups.end(), rest.begin(), rest.end());
  grouped.slow = grouped.groups.size();
}

void group_averaged(const NoiseEvidence& evidence, double from_hz, GroupedEvidence& grouped) {
  const signal::Spectrum& spectrum = evidence.spectrum;
  Grouping grouping(grouped.groups);
  // The last bin has half the degrees of freedom, and its neighbour's window extends beyond it.
  for (std::size_t k = 0; k + 2 < spectrum.frequency_hz.size(); ++k) {
    const double f = spectrum.frequency_hz[k];
    if (f < from_hz) continue;
    if (evidence.lines.in_line[k]) {
      grouping.close();
      continue;
    }
    grouping.add(f, 0.5 * spectrum.one_sided_psd[k], bin_share * spectrum.edf_per_bin,
                 relative_width * f);
  }
  grouping.close();
}

}  // namespace

GroupedEvidence group_evidence(const NoiseEvidence& evidence) {
  const signal::Spectrum& spectrum = evidence.spectrum;
  GroupedEvidence grouped;
  grouped.slow_sampling = {spectrum.rate_hz, evidence.slow.block()};
  grouped.fast_sampling = {spectrum.rate_hz, 1};
  grouped.bin_hz = spectrum.rate_hz / static_cast<double>(spectrum.segment);
  // The transform reaches half the rate where its blocks are samples.
  const bool transform_reaches_all = evidence.slow.block() == 1;
  const bool averaged = spectrum.averaged >= least_averaged &&
                        (spectrum.segment >= shortest_averaged || !transform_reaches_all);
  const double seam_hz =
      averaged ? first_bin * grouped.bin_hz : std::numeric_limits<double>::infinity();
  group_transform(evidence, seam_hz, grouped);
  if (averaged) group_averaged(evidence, seam_hz, grouped);
  return grouped;
}

}  // namespace proofmass::characterise
