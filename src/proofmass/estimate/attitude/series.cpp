#include "proofmass/estimate/attitude/series.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::estimate {
namespace {

using Axes = std::array<std::vector<double>, 3>;

Mat<3> at(const Axes& axes, std::size_t k) {
  return {axes[0][k], axes[1][k], axes[2][k]};
}

Status check_times(const InertialSeries& series) {
  const std::size_t size = series.time_s.size();
  for (const Axes* axes : {&series.rate_radps, &series.accel_mps2})
    for (const std::vector<double>& axis : *axes)
      if (axis.size() != size)
        return Error{Errc::invalid_argument, "the axes and the time have different lengths"};
  for (std::size_t k = 0; k < size; ++k)
    if (!std::isfinite(series.time_s[k]) || (k > 0 && series.time_s[k] <= series.time_s[k - 1]))
      return Error{Errc::invalid_argument, "time must be finite and ascend"}.at("sample " +
                                                                                std::to_string(k));
  return Done{};
}

Status check_rests(const std::vector<signal::Rest>& rests, std::size_t size) {
  for (std::size_t r = 0; r < rests.size(); ++r)
    if (rests[r].last < rests[r].first || rests[r].last >= size ||
        (r > 0 && rests[r].first <= rests[r - 1].last))
      return Error{Errc::invalid_argument, "rest " + std::to_string(r) +
                                               " is outside the recording or overlaps another one"};
  return Done{};
}

bool read(const InertialSeries& series, std::size_t k) {
  return at(series.rate_radps, k).allFinite() && at(series.accel_mps2, k).allFinite();
}

/// Mean square of a sensor's departure from its own mean over the recording.
double motion_variance(const Axes& axes, const std::vector<std::size_t>& rows) {
  Mat<3> sum = Mat<3>::Zero(), squares = Mat<3>::Zero();
  const Mat<3> first = at(axes, rows.front());
  for (const std::size_t k : rows) {
    const Mat<3> x = at(axes, k) - first;
    sum += x;
    squares += x.cwiseAbs2();
  }
  const double n = static_cast<double>(rows.size());
  return (squares - sum.cwiseAbs2() / n).sum() / (3.0 * n);
}

/// Inserts the interpolated rows between two measured ones.
class Filler {
 public:
  Filler(const InertialSeries& series, const std::vector<std::size_t>& rows)
      : series_(series),
        rate_variance_(motion_variance(series.rate_radps, rows)),
        force_variance_(motion_variance(series.accel_mps2, rows)) {}

  void between(std::size_t a, std::size_t b, PreparedSeries& out) const {
    const double span_s = series_.time_s[b] - series_.time_s[a];
    const std::size_t first = out.samples.size();
    for (std::size_t row = a + 1; row <= b; ++row) {
      const double part = (series_.time_s[row] - series_.time_s[a]) / span_s;
      InertialSample sample;
      sample.row = row;
      sample.dt_s = series_.time_s[row] - series_.time_s[row - 1];
      sample.rate = mixed(series_.rate_radps, {a, b}, part);
      sample.force = mixed(series_.accel_mps2, {a, b}, part);
      out.samples.push_back(sample);
    }
    out.interpolated += b - a - 1;
    if (b == a + 1) return;
    for (std::size_t i = first; i < out.samples.size(); ++i) {
      // A constant error over the whole span T rotates by its std times T: density variance · T.
      out.samples[i].rate_doubt = rate_variance_ * span_s;
      out.samples[i].force_doubt = force_variance_ * span_s;
    }
  }

 private:
  static Mat<3> mixed(const Axes& axes, std::array<std::size_t, 2> ends, double part) {
    // At part = 1 the measurement itself, exactly.
    if (part >= 1.0) return at(axes, ends[1]);
    return (1.0 - part) * at(axes, ends[0]) + part * at(axes, ends[1]);
  }

  const InertialSeries& series_;
  double rate_variance_, force_variance_;
};

void lay_rests(const std::vector<signal::Rest>& rests, PreparedSeries& out) {
  std::size_t r = 0;
  int before = -1;
  for (InertialSample& sample : out.samples) {
    while (r < rests.size() && rests[r].last < sample.row) ++r;
    const bool inside = r < rests.size() && rests[r].first <= sample.row;
    sample.rest = inside ? static_cast<int>(r) : -1;
    sample.enters_rest = inside && (sample.rest != before || sample.starts);
    before = sample.rest;
  }
}

using SampleValue = Mat<3> InertialSample::*;

/// τ σ²(τ) of the Allan variance over m samples at rest, mean over the axes; 0 for fewer than eight
/// differences.
double allan_density(const std::vector<InertialSample>& samples, SampleValue value, std::size_t m) {
  double squares = 0.0, time_s = 0.0, count = 0.0;
  for (std::size_t k = 0; k + 2 * m <= samples.size(); k += m) {
    const InertialSample &first = samples[k], &last = samples[k + 2 * m - 1];
    if (first.rest < 0 || first.rest != last.rest || last.row - first.row != 2 * m - 1) continue;
    Mat<3> difference = Mat<3>::Zero();
    for (std::size_t i = 0; i < m; ++i) {
      difference += samples[k + m + i].*value - samples[k + i].*value;
      time_s += samples[k + i + 1].dt_s;
    }
    squares += difference.squaredNorm() / 6.0 / static_cast<double>(m * m);
    count += 1.0;
  }
  return count < 8.0 ? 0.0 : squares / count * time_s / count;
}

/// Density of white noise from the rests: the largest over 1 … 16 samples, so that the filter in a
/// sensor does not lower it. 0 with too few samples.
double density_at_rest(const std::vector<InertialSample>& samples, SampleValue value) {
  double largest = 0.0;
  for (std::size_t m = 1; m <= 16; m *= 2)
    largest = std::max(largest, allan_density(samples, value, m));
  return std::sqrt(largest);
}

void find_noise(const AttitudeOptions& options, PreparedSeries& out) {
  // A recording without noise still has rounding, and a filter needs a variance.
  constexpr double least_rate = 1e-7, least_accel = 1e-6;
  const double rate = density_at_rest(out.samples, &InertialSample::rate);
  const double accel = density_at_rest(out.samples, &InertialSample::force);
  out.noise_from_rests = rate > 0.0 || accel > 0.0;
  const bool at_rest = std::any_of(out.samples.begin(), out.samples.end(),
                                   [](const InertialSample& sample) { return sample.rest >= 0; });
  out.rate_noise =
      options.rate_noise_radps_rthz.value_or(at_rest ? std::max(rate, least_rate) : 1e-3);
  out.accel_noise =
      options.accel_noise_mps2_rthz.value_or(at_rest ? std::max(accel, least_accel) : 1e-2);
}

}  // namespace

Result<PreparedSeries> prepare(const InertialSeries& series,
                               const std::vector<signal::Rest>& rests,
                               const AttitudeOptions& options) {
  if (const Status status = check_times(series); !status) return status.error();
  if (const Status status = check_rests(rests, series.time_s.size()); !status)
    return status.error();
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < series.time_s.size(); ++k)
    if (read(series, k)) rows.push_back(k);
  if (rows.size() < 2)
    return Error{Errc::too_few_samples, std::to_string(rows.size()) +
                                            " samples with values of both sensors; 2 are needed"};
  PreparedSeries out;
  const Filler filler(series, rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool starts =
        i == 0 || series.time_s[rows[i]] - series.time_s[rows[i - 1]] > options.longest_gap_s;
    if (starts) {
      InertialSample sample;
      sample.row = rows[i];
      sample.starts = true;
      sample.rate = at(series.rate_radps, rows[i]);
      sample.force = at(series.accel_mps2, rows[i]);
      out.samples.push_back(sample);
      out.stretches.push_back({rows[i], rows[i]});
    } else {
      filler.between(rows[i - 1], rows[i], out);
      out.stretches.back().last = rows[i];
    }
  }
  lay_rests(rests, out);
  find_noise(options, out);
  return out;
}

}  // namespace proofmass::estimate
