#include "proofmass/characterise/runs/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;

constexpr std::size_t fewest_samples = 256, shortest_block = 4, most_in_group = 32;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double duration_of(const Run& run) {
  return static_cast<double>(run.series.size()) / run.rate_hz;
}

Status check(View<Run> runs) {
  if (runs.size() < 3) {
    return Error{Errc::too_few_samples,
                 fmt::format("{} runs make no set, expected at least 3", runs.size())};
  }
  std::vector<double> rates, durations;
  for (const Run& run : runs) {
    if (!std::isfinite(run.rate_hz) || !(run.rate_hz > 0.0))
      return Error{Errc::invalid_argument, "rate_hz must be positive and finite"}.at(run.name);
    rates.push_back(run.rate_hz);
    durations.push_back(duration_of(run));
  }
  const double rate_hz = *median(rates), duration_s = *median(durations);
  for (const Run& run : runs) {
    if (std::abs(run.rate_hz / rate_hz - 1.0) > 0.05) {
      return Error{
          Errc::invalid_argument,
          fmt::format("{}: sampled at {:.6g} Hz, the others at {:.6g} Hz: runs of a set are "
                      "within a twentieth",
                      run.name, run.rate_hz, rate_hz)};
    }
    if (run.series.size() < fewest_samples) {
      return Error{Errc::too_few_samples,
                   fmt::format("{}: {} samples, expected at least {}: leave this run out", run.name,
                               run.series.size(), fewest_samples)};
    }
    if (duration_of(run) < 0.1 * duration_s) {
      return Error{
          Errc::too_few_samples,
          fmt::format("{}: {:.4g} s, less than a tenth of the others' {:.4g} s: leave this "
                      "run out",
                      run.name, duration_of(run), duration_s)};
    }
  }
  return Done{};
}

// Samples k with from_s <= k / rate < to_s.
struct Range {
  std::size_t begin, end;
};

Range range_of(const Run& run, double from_s, double to_s) {
  // An end on a sample must not depend on the last digit of the product.
  const auto index = [&](double t_s) {
    const double k = std::ceil(t_s * run.rate_hz - 1e-6);
    return std::min(static_cast<std::size_t>(std::max(k, 0.0)), run.series.size());
  };
  return {index(from_s), index(to_s)};
}

double mean_of_finite(const Eigen::VectorXd& values) {
  Moments m;
  for (const double x : values) m.add(x);
  return m.count > 0 ? m.mean : nothing;
}

// Alternating means: exact after one step without missing values.
void fit_two_ways(RunBlocks& of) {
  of.common = Eigen::VectorXd::Zero(of.means.rows());
  of.level = Eigen::VectorXd::Zero(of.means.cols());
  for (int round = 0; round < 8; ++round) {
    for (Index i = 0; i < of.means.cols(); ++i)
      of.level(i) = mean_of_finite(of.means.col(i) - of.common);
    for (Index b = 0; b < of.means.rows(); ++b) {
      const double shared = mean_of_finite(of.means.row(b).transpose() - of.level);
      of.common(b) = std::isfinite(shared) ? shared : 0.0;
    }
    of.common.array() -= of.common.mean();
  }
}

// In place, along straight lines; ends keep the nearest value.
void fill(Eigen::Ref<Eigen::VectorXd> y) {
  Index last = -1;
  for (Index k = 0; k < y.size(); ++k) {
    if (!std::isfinite(y(k))) continue;
    for (Index j = last + 1; j < k; ++j) {
      y(j) = last < 0 ? y(k)
                      : std::lerp(y(last), y(k),
                                  static_cast<double>(j - last) / static_cast<double>(k - last));
    }
    last = k;
  }
  for (Index j = last + 1; j < y.size(); ++j) y(j) = last < 0 ? 0.0 : y(last);
}

}  // namespace

double mean_between(const Run& run, double from_s, double to_s) {
  const Range range = range_of(run, from_s, to_s);
  Moments m;
  for (std::size_t k = range.begin; k < range.end; ++k) m.add(run.series[k]);
  return m.count > 0 ? m.mean : nothing;
}

Result<RunBlocks> run_blocks(View<Run> runs) {
  if (const Status sound = check(runs); !sound) return sound.error();
  RunBlocks of;
  of.duration_s = duration_of(*std::ranges::min_element(runs, {}, duration_of));
  double slowest_hz = runs.front().rate_hz;
  for (const Run& run : runs) slowest_hz = std::min(slowest_hz, run.rate_hz);
  const auto samples = static_cast<std::size_t>(of.duration_s * slowest_hz + 0.5);
  const std::size_t group = std::clamp<std::size_t>(
      samples / (shortest_block * static_cast<std::size_t>(noise_blocks)), 1, most_in_group);
  const Index blocks = noise_blocks * static_cast<Index>(group);
  of.block_s = of.duration_s / static_cast<double>(blocks);
  of.means.resize(blocks, static_cast<Index>(runs.size()));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    auto column = of.means.col(static_cast<Index>(i));
    for (Index b = 0; b < blocks; ++b) {
      const double from_s = static_cast<double>(b) * of.block_s;
      const Range range = range_of(runs[i], from_s, from_s + of.block_s);
      Moments m;
      for (std::size_t k = range.begin; k < range.end; ++k) m.add(runs[i].series[k]);
      column(b) = 2 * m.count >= range.end - range.begin && m.count > 0 ? m.mean : nothing;
    }
    if (2 * column.array().isFinite().count() < blocks) {
      return Error{Errc::too_few_samples,
                   fmt::format("{}: more than half is missing: leave this run "
                               "out",
                               runs[i].name)};
    }
  }
  fit_two_ways(of);
  return of;
}

Eigen::MatrixXd residuals(const RunBlocks& of) {
  const Index group = of.means.rows() / noise_blocks;
  Eigen::MatrixXd left(noise_blocks, of.means.cols());
  for (Index i = 0; i < of.means.cols(); ++i) {
    const Eigen::VectorXd fine = (of.means.col(i) - of.common).array() - of.level(i);
    for (Index b = 0; b < noise_blocks; ++b)
      left(b, i) = mean_of_finite(fine.segment(b * group, group));
    fill(left.col(i));
  }
  return left;
}

}  // namespace proofmass::characterise
