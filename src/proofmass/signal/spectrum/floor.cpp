#include "proofmass/signal/spectrum/floor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/signal/spectrum/background.hpp"

namespace proofmass::signal {
namespace {

// The upper fifth of the band is reserved for anti-aliasing filters.
constexpr double used_share = 0.8;
// Half the attenuation of one pole over the octave above its corner.
constexpr double even_db = 2.0;
constexpr double steps_per_octave = 8.0;

/// Bins [first, last), and the PSD read in them.
struct Octave {
  std::size_t first, last;
  double level, std, unevenness_db;
};

std::optional<Octave> read_octave(const Spectrum& spectrum,
                                  const std::vector<double>& background,
                                  const std::vector<bool>& in_line,
                                  std::size_t last) {
  const std::size_t first = last / 2;
  std::vector<double> psd;
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (std::size_t k = first; k < last; ++k) {
    if (in_line[k]) continue;
    psd.push_back(spectrum.one_sided_psd[k]);
    low = std::min(low, background[k]);
    high = std::max(high, background[k]);
  }
  if (2 * psd.size() < last - first) return std::nullopt;
  const double edf = spectrum.edf_per_bin;
  const double level = *median(psd) * edf / chi_square_quantile(0.5, edf);
  // π/2: variance of a median relative to a mean.
  const double relative =
      std::sqrt(2.0 / edf * bins_per_independent_bin * 1.5708 / static_cast<double>(psd.size()));
  return Octave{first, last, level, level * relative, 10.0 * std::log10(high / low)};
}

// Lower is better, but flat octaves precede the others. If the difference may be due to chance, it
// has to exceed four standard deviations.
bool is_better(const Octave& a, const Octave& b) {
  const bool a_even = a.unevenness_db <= even_db, b_even = b.unevenness_db <= even_db;
  if (a_even != b_even) return a_even;
  return a_even ? a.level + 4.0 * a.std < b.level : a.unevenness_db < b.unevenness_db;
}

}  // namespace

SpectralFloor measure_floor(const Spectrum& spectrum,
                            const std::vector<double>& background,
                            const std::vector<bool>& in_line) {
  const auto bins = static_cast<double>(end_of_judged_bins(spectrum));
  std::optional<Octave> best;
  for (double last = used_share * bins; last >= 2.0 * first_judged_bin;
       last *= std::exp2(-1.0 / steps_per_octave)) {
    const auto octave = read_octave(spectrum, background, in_line, static_cast<std::size_t>(last));
    if (octave && (!best || is_better(*octave, *best))) best = octave;
  }
  if (!best) return {};
  const double bin_hz = spectrum.rate_hz / static_cast<double>(spectrum.segment);
  SpectralFloor floor;
  floor.one_sided_density = std::sqrt(best->level);
  floor.std = 0.5 * best->std / floor.one_sided_density;
  floor.low_hz = static_cast<double>(best->first) * bin_hz;
  floor.high_hz = static_cast<double>(best->last - 1) * bin_hz;
  return floor;
}

}  // namespace proofmass::signal
