#include "proofmass/characterise/drift_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/characterise/drift/evidence.hpp"
#include "proofmass/characterise/drift/fit.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::characterise {
namespace {

constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();

Status check(View<double> series, const DriftOptions& options) {
  constexpr double slowest_hz = 1e-20, fastest_hz = 1e20;
  if (std::isnan(options.rate_hz) || options.rate_hz < slowest_hz || options.rate_hz > fastest_hz)
    return Error{
        Errc::invalid_argument,
        fmt::format("rate_hz must be positive, between {:g} and {:g}", slowest_hz, fastest_hz)};
  if (!std::isfinite(options.since_switch_on_s) || options.since_switch_on_s < 0.0)
    return Error{Errc::invalid_argument,
                 "since_switch_on_s must be a time in seconds, zero or more"};
  if (series.size() < DriftEvidence::fewest_blocks)
    return Error{Errc::too_few_samples, fmt::format("{} samples, expected at least {}",
                                                    series.size(), DriftEvidence::fewest_blocks)};
  const double* first = nullptr;
  for (const double& sample : series) {
    if (!std::isfinite(sample)) continue;
    if (first == nullptr) first = &sample;
    if (sample != *first) return Done{};
  }
  if (first == nullptr) return Error{Errc::not_finite, "no sample is a number"};
  return Error{Errc::not_observable, "the samples do not vary"};
}

void report_progress(const DriftOptions& options, double fraction) {
  if (options.progress) options.progress("drift", fraction);
}

struct BlockMean {
  double mean = missing_value;
  double off_middle = 0.0;  // mean position of the available samples, in blocks
};

// NaN if half of a block or more is missing.
BlockMean mean_of(View<double> block) {
  // Relative to its first value, so that a level far from zero costs no digits.
  double first = 0.0, sum = 0.0, places = 0.0, count = 0.0;
  for (std::size_t k = 0; k < block.size(); ++k) {
    if (!std::isfinite(block[k])) continue;
    if (count == 0.0) first = block[k];
    sum += block[k] - first;
    places += static_cast<double>(k) + 0.5;
    count += 1.0;
  }
  const auto size = static_cast<double>(block.size());
  if (2.0 * count <= size && count < size) return {};
  return {first + sum / count, places / (count * size) - 0.5};
}

// Means of `size` samples each; an incomplete block at the end is dropped. With missing samples the
// mean is moved to the middle of its block along the slope between its neighbours, since the start
// of a warm-up is steep; if only a few blocks are affected they are dropped instead, which is
// exact.
std::vector<double> means_of(View<double> series, std::size_t block) {
  std::vector<BlockMean> found(series.size() / block);
  for (std::size_t j = 0; j < found.size(); ++j)
    found[j] = mean_of(series.subspan(j * block, block));
  const auto neighbour = [&](std::size_t of, std::size_t at) {
    return at < found.size() && std::isfinite(found[at].mean) ? at : of;
  };
  const auto middle = [&](std::size_t j) { return static_cast<double>(j) + found[j].off_middle; };
  const auto few = static_cast<std::ptrdiff_t>(found.size() / 128);
  const auto partial =
      std::ranges::count_if(found, [](const BlockMean& b) { return b.off_middle != 0.0; });
  std::vector<double> means(found.size());
  for (std::size_t j = 0; j < found.size(); ++j) {
    means[j] = found[j].mean;
    if (found[j].off_middle == 0.0) continue;
    if (partial <= few) {
      means[j] = missing_value;
      continue;
    }
    const std::size_t before = j > 0 ? neighbour(j, j - 1) : j, after = neighbour(j, j + 1);
    if (before == after) continue;
    means[j] -= found[j].off_middle * (found[after].mean - found[before].mean) /
                (middle(after) - middle(before));
  }
  return means;
}

// The fit uses fourth powers of the means: they must vary, within the numerical range.
Status check_means(View<double> means) {
  constexpr double least = 1e-60, most = 1e60;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double mean : means) {
    if (std::isnan(mean)) continue;
    low = std::min(low, mean);
    high = std::max(high, mean);
  }
  if (low == high) return Error{Errc::not_observable, "the means over blocks do not vary"};
  if (std::max(std::abs(low), std::abs(high)) > most || high - low < least)
    return Error{Errc::unsupported,
                 fmt::format("means over blocks from {:.3g} to {:.3g}, expected some that vary by "
                             "{:g} or more and are not above {:g}",
                             low, high, least, most)};
  return Done{};
}

// As many blocks as the fit can use; fewer if many of them are missing, each of which costs a
// column.
std::size_t block_length(View<double> series) {
  constexpr std::size_t most_blocks = 2048, few_blocks = 512, many_missing = 48;
  const auto length = [&](std::size_t blocks) {
    return std::max<std::size_t>(1, (series.size() + blocks - 1) / blocks);
  };
  const std::vector<double> means = means_of(series, length(most_blocks));
  const auto missing = static_cast<std::size_t>(
      std::ranges::count_if(means, [](double mean) { return std::isnan(mean); }));
  return length(missing > many_missing ? few_blocks : most_blocks);
}

// Minimum and maximum mean of `size` samples in each of up to 1000 stretches.
Envelope envelope_of(View<double> series, std::size_t scale, const DriftOptions& options) {
  constexpr std::size_t buckets = 1000;
  const std::vector<double> averaged = scale > 1 ? means_of(series, scale) : std::vector<double>();
  const View<double> means = scale > 1 ? View<double>(averaged) : series;
  const double step_s = static_cast<double>(scale) / options.rate_hz;
  const std::size_t width = std::max<std::size_t>(1, (means.size() + buckets - 1) / buckets);
  Envelope envelope;
  envelope.scale_s = step_s;
  const std::size_t count = (means.size() + width - 1) / width;
  envelope.t_s.reserve(count);
  envelope.lower.reserve(count);
  envelope.upper.reserve(count);
  for (std::size_t from = 0; from < means.size(); from += width) {
    const std::size_t to = std::min(means.size(), from + width);
    double low = missing_value, high = missing_value;
    for (std::size_t k = from; k < to; ++k) {
      if (!std::isfinite(means[k])) continue;
      low = std::isnan(low) ? means[k] : std::min(low, means[k]);
      high = std::isnan(high) ? means[k] : std::max(high, means[k]);
    }
    envelope.t_s.push_back(options.since_switch_on_s +
                           0.5 * static_cast<double>(from + to) * step_s - 0.5 / options.rate_hz);
    envelope.lower.push_back(low);
    envelope.upper.push_back(high);
  }
  return envelope;
}

double take_curve_out(std::vector<double>& series,
                      const DriftCurve& curve,
                      const DriftOptions& options) {
  double squares = 0.0, count = 0.0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (!std::isfinite(series[k])) continue;
    const double t_s = options.since_switch_on_s + static_cast<double>(k) / options.rate_hz;
    series[k] -= curve.value(t_s);
    squares += series[k] * series[k];
    count += 1.0;
  }
  return std::sqrt(squares / count);
}

// Shocks are marked missing; steps stay, as they are drift.
std::vector<double> without_outliers(View<double> series, DriftAnalysis& analysis) {
  std::vector<double> kept(series.begin(), series.end());
  analysis.outliers = signal::find_events(series, {analysis.rate_hz});
  std::erase_if(analysis.outliers,
                [](const signal::Event& event) { return event.kind == signal::EventKind::step; });
  signal::drop_events(kept, analysis.outliers, analysis.rate_hz);
  analysis.missing = static_cast<std::size_t>(
      std::ranges::count_if(kept, [](double sample) { return !std::isfinite(sample); }));
  return kept;
}

std::size_t fitted_parameters(const DriftCurve& curve) {
  return static_cast<std::size_t>(curve.covariance.rows());
}

void examine_residuals(DriftAnalysis& analysis,
                       View<double> residuals,
                       const DriftOptions& options) {
  analysis.whiteness = signal::test_whiteness_at_scales(residuals, analysis.rate_hz,
                                                        fitted_parameters(analysis.fit.curve));
  // At the sampling interval, and where the tests are most informative: at the longest scales but
  // one.
  std::vector<double> scales{1.0 / analysis.rate_hz};
  for (const signal::WhitenessTest& test : analysis.whiteness)
    if (test.scale_s > 1.5 / analysis.rate_hz) scales.push_back(test.scale_s);
  constexpr std::size_t shown = 3;
  while (scales.size() > shown) scales.erase(scales.begin() + 1);
  for (const double scale_s : scales) {
    const auto scale = static_cast<std::size_t>(std::llround(scale_s * analysis.rate_hz));
    analysis.residuals.push_back(envelope_of(residuals, std::max<std::size_t>(1, scale), options));
  }
}

void note_whitened(DriftAnalysis& analysis, signal::WhitenessTest test) {
  constexpr double improbable = 0.001;
  analysis.noise_explained =
      std::min({test.ljung_box_p, test.periodogram_p, test.runs_p}) >= improbable;
  analysis.whitened = std::move(test);
}

void add_notes(DriftAnalysis& analysis) {
  if (!analysis.outliers.empty())
    analysis.notes.push_back(
        {Severity::info, fmt::format("{} outlier{} excluded", analysis.outliers.size(),
                                     analysis.outliers.size() == 1 ? "" : "s")});
  const auto blank = static_cast<std::size_t>(
      std::ranges::count_if(analysis.block_mean, [](double mean) { return std::isnan(mean); }));
  if (blank > 0)
    analysis.notes.push_back(
        {100 * blank > analysis.block_mean.size() ? Severity::warning : Severity::info,
         fmt::format("{} of {} blocks of {:.3g} s are missing: the fit ignores "
                     "them",
                     blank, analysis.block_mean.size(), analysis.block_s)});
  if (!analysis.noise_explained)
    analysis.notes.push_back({Severity::warning,
                              "the noise model does not explain the residuals completely: the "
                              "intervals may be too narrow"});
}

}  // namespace

Result<DriftAnalysis> analyse_drift(View<double> series, const DriftOptions& options) {
  if (const Status status = check(series, options); !status) return status.error();
  DriftAnalysis analysis;
  analysis.rate_hz = options.rate_hz;
  analysis.samples = series.size();
  analysis.start_s = options.since_switch_on_s;
  analysis.duration_s = static_cast<double>(series.size()) / options.rate_hz;
  report_progress(options, 0.0);
  std::vector<double> kept = without_outliers(series, analysis);
  if (analysis.missing == kept.size())
    return Error{Errc::not_finite, "nothing but outliers and missing samples"};
  const std::size_t block = block_length(kept);
  analysis.block_mean = means_of(kept, block);
  const Sampling sampling{options.rate_hz, block};
  analysis.block_s = sampling.step_s();
  // The mean of samples covers a time that begins half a step before the first of them.
  constexpr double half_a_sample = 0.5;
  const auto evidence = DriftEvidence::make(
      analysis.block_mean, sampling, options.since_switch_on_s - half_a_sample / options.rate_hz);
  if (!evidence) return evidence.error();
  if (const Status status = check_means(analysis.block_mean); !status) return status.error();
  constexpr double before_fit = 0.2, after_fit = 0.8;
  report_progress(options, before_fit);
  FittedDrift fitted = fit_drift(*evidence);
  analysis.fit = std::move(fitted.fit);
  analysis.block_bias = std::move(fitted.bias);
  report_progress(options, after_fit);
  analysis.data = envelope_of(kept, 1, options);
  analysis.residual_rms = take_curve_out(kept, analysis.fit.curve, options);
  examine_residuals(analysis, kept, options);
  if (auto test = signal::test_whiteness(fitted.whitened, {1.0 / analysis.block_s, analysis.block_s,
                                                           fitted_parameters(analysis.fit.curve)}))
    note_whitened(analysis, std::move(test).value());
  add_notes(analysis);
  report_progress(options, 1.0);
  return analysis;
}

}  // namespace proofmass::characterise
