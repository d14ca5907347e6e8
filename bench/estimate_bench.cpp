// Filter and smoother of one recording with four states (position, velocity, acceleration, a bias
// with a time constant of 100 s), one measurement an epoch, one thread: epochs a second, by
// processor time. For comparison, in the same run, a plain Kalman filter with the
// Rauch–Tung–Striebel smoother in Eigen (names with `reference`), and for the means alone the time
// to move as many bytes in memory.
//
//   estimate_bench [--benchmark_filter=...]
#include <Eigen/Cholesky>
#include <algorithm>
#include <benchmark/benchmark.h>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "measure.hpp"
#include "proofmass/estimate/fast/uniform_smoother.hpp"
#include "proofmass/estimate/motion_models.hpp"

namespace {

using namespace proofmass;
using namespace proofmass::estimate;

constexpr std::size_t epochs = 1'000'000;
enum Reads { acceleration, position };

LinearModel<4, 1> model_of(Reads reads) {
  const double tau_s = 100.0, bias_mps2 = 0.05;
  const auto with_input = pva_bias_model(
      {.motion = {.dt_s = 0.005, .jerk_psd_m2ps5 = 1.0, .accel_variance_m2ps4 = 4e-4},
       .time_constant_s = tau_s,
       .bias_psd_m2ps5 = 2.0 * bias_mps2 * bias_mps2 / tau_s});
  LinearModel<4, 1> model{with_input.F, with_input.Q, with_input.H, with_input.R};
  if (reads == position) model.H << 1.0, 0.0, 0.0, 0.0;
  return model;
}

Gaussian<4> prior() {
  Gaussian<4> x;
  x.cov.diagonal() << 0.01, 0.01, 0.01, 0.0025;
  return x;
}

/// A slow oscillation, measured by an accelerometer or a tape.
std::vector<double> record(Reads reads, std::size_t count) {
  std::mt19937_64 bits(1);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<double> z(count);
  for (std::size_t k = 0; k < count; ++k)
    z[k] = std::sin(0.01 * static_cast<double>(k)) * (reads == position ? 0.5 : 2.0) + noise(bits);
  return z;
}

/// Textbook implementation: every state of the filter is stored, and the smoother inverts each
/// predicted covariance.
struct Textbook {
  explicit Textbook(std::size_t count) : predicted(count), filtered(count), smoothed(count) {}
  std::vector<Gaussian<4>> predicted, filtered, smoothed;

  void filter(const LinearModel<4, 1>& m, const std::vector<double>& z) {
    Gaussian<4> x = prior();
    for (std::size_t k = 0; k < z.size(); ++k) {
      if (k > 0) {
        x.mean = (m.F * x.mean).eval();
        x.cov = (m.F * x.cov * m.F.transpose() + m.Q).eval();
      }
      predicted[k] = x;
      const double S = (m.H * x.cov * m.H.transpose())(0) + m.R(0);
      const Mat<4> K = x.cov * m.H.transpose() / S;
      x.mean += K * (z[k] - (m.H * x.mean)(0));
      const Mat<4, 4> rest = Mat<4, 4>::Identity() - K * m.H;
      x.cov = (rest * x.cov * rest.transpose() + m.R(0) * K * K.transpose()).eval();
      filtered[k] = x;
    }
  }

  void smooth(const LinearModel<4, 1>& m) {
    smoothed.back() = filtered.back();
    for (std::size_t k = smoothed.size() - 1; k-- > 0;) {
      const Mat<4, 4> G = predicted[k + 1].cov.ldlt().solve(m.F * filtered[k].cov).transpose();
      smoothed[k].mean = filtered[k].mean + G * (smoothed[k + 1].mean - predicted[k + 1].mean);
      smoothed[k].cov =
          filtered[k].cov + G * (smoothed[k + 1].cov - predicted[k + 1].cov) * G.transpose();
    }
  }
};

void count_epochs(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(epochs));
}

void reference_filter(benchmark::State& state) {
  const auto model = model_of(acceleration);
  const auto z = record(acceleration, epochs);
  Textbook textbook(epochs);
  for (auto _ : state) textbook.filter(model, z);
  count_epochs(state);
}

void reference_filter_and_smoother(benchmark::State& state) {
  const auto model = model_of(acceleration);
  const auto z = record(acceleration, epochs);
  Textbook textbook(epochs);
  for (auto _ : state) {
    textbook.filter(model, z);
    textbook.smooth(model);
  }
  count_epochs(state);
}

/// Ours, into the caller's memory; `missing`: one in this many measurements is missing.
void run(benchmark::State& state,
         Reads reads,
         const UniformOptions<4>& options,
         std::size_t missing = 0) {
  const auto model = model_of(reads);
  auto z = record(reads, epochs);
  for (std::size_t k = 0; missing > 0 && k < z.size(); k += missing) z[k] = std::nan("");
  std::vector<Mat<4>> means(epochs, Mat<4>::Zero());  // already allocated
  std::vector<Symmetric<4>> covariances(options.covariances == Covariances::everywhere ? epochs
                                                                                       : 0);
  for (auto _ : state) {
    auto summary = run_uniform(model, prior(), z, options, {means, covariances});
    benchmark::DoNotOptimize(summary);
  }
  count_epochs(state);
}

UniformOptions<4> options_of(bool smooth, Covariances covariances) {
  UniformOptions<4> options;
  options.smooth = smooth;
  options.covariances = covariances;
  return options;
}

void filter_all_covariances(benchmark::State& state) {
  run(state, acceleration, options_of(false, Covariances::everywhere));
}
void filter_and_smoother_all_covariances(benchmark::State& state) {
  run(state, acceleration, options_of(true, Covariances::everywhere));
}
void filter_and_smoother_all_covariances_1_percent_missing(benchmark::State& state) {
  run(state, acceleration, options_of(true, Covariances::everywhere), 100);
}
void position_filter_and_smoother_covariances_where_they_change(benchmark::State& state) {
  run(state, position, options_of(true, Covariances::where_they_change));
}

/// Time in seconds to move as many bytes as the passes for the means: the measurements read once
/// for the filter and once more for the smoother, the means written.
double bandwidth_bound_s(const std::vector<double>& z, std::vector<Mat<4>>& means, bool smooth) {
  double best = 1e300;
  for (int again = 0; again < 9; ++again) {
    const double from = cpu_s();
    if (smooth) {
      std::array<double, 8> sums{};
      for (std::size_t k = 0; k + 8 <= z.size(); k += 8)
        for (std::size_t i = 0; i < 8; ++i) sums[i] += z[k + i];
      benchmark::DoNotOptimize(sums);
    }
    for (std::size_t k = 0; k < z.size(); ++k) means[k].setConstant(z[k]);
    benchmark::ClobberMemory();
    best = std::min(best, cpu_s() - from);
  }
  return best;
}

/// `state.range(0)` epochs.
void constant_gain_means(benchmark::State& state, bool smooth) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const auto model = model_of(position);
  const auto z = record(position, count);
  std::vector<Mat<4>> means(count, Mat<4>::Zero());  // already allocated
  double best_s = 1e300;
  for (auto _ : state) {
    const double from = cpu_s();
    auto summary = run_uniform(model, prior(), z, options_of(smooth, Covariances::none), {means});
    benchmark::DoNotOptimize(summary);
    best_s = std::min(best_s, cpu_s() - from);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  const double bound_s = bandwidth_bound_s(z, means, smooth);
  state.counters["bandwidth_bound_per_s"] = static_cast<double>(count) / bound_s;
  state.counters["times_the_bound"] = best_s / bound_s;
}
void constant_gain_filter_means(benchmark::State& state) {
  constant_gain_means(state, false);
}
void constant_gain_filter_and_smoother_means(benchmark::State& state) {
  constant_gain_means(state, true);
}

BENCHMARK(reference_filter)->Unit(benchmark::kMillisecond);
BENCHMARK(filter_all_covariances)->Unit(benchmark::kMillisecond);
BENCHMARK(reference_filter_and_smoother)->Unit(benchmark::kMillisecond);
BENCHMARK(filter_and_smoother_all_covariances)->Unit(benchmark::kMillisecond);
BENCHMARK(filter_and_smoother_all_covariances_1_percent_missing)->Unit(benchmark::kMillisecond);
BENCHMARK(position_filter_and_smoother_covariances_where_they_change)
    ->Unit(benchmark::kMillisecond);
// The longer one does not fit in any cache.
BENCHMARK(constant_gain_filter_means)
    ->Arg(1'000'000)
    ->Arg(8'000'000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(constant_gain_filter_and_smoother_means)
    ->Arg(1'000'000)
    ->Arg(8'000'000)
    ->Unit(benchmark::kMillisecond);

/// Shows that both compute the same result.
void print_difference(Reads reads, const char* what) {
  const auto model = model_of(reads);
  const auto z = record(reads, 100'000);
  Textbook textbook(z.size());
  textbook.filter(model, z);
  textbook.smooth(model);
  const auto ours = smooth_uniform(model, prior(), z);
  double of_mean = 0.0, of_cov = 0.0;
  for (std::size_t k = 0; k < z.size(); ++k) {
    const Mat<4> std = textbook.smoothed[k].cov.diagonal().cwiseSqrt();
    const Mat<4> mean = (ours.value().means[k] - textbook.smoothed[k].mean).cwiseQuotient(std);
    const Mat<4, 4> cov = std.cwiseInverse().asDiagonal() *
                          (ours.value().covariance(k).dense() - textbook.smoothed[k].cov) *
                          std.cwiseInverse().asDiagonal();
    of_mean = std::max(of_mean, mean.cwiseAbs().maxCoeff());
    of_cov = std::max(of_cov, cov.cwiseAbs().maxCoeff());
  }
  std::printf(
      "%s read, %zu epochs: smoothed means differ from the reference's by %.1e standard "
      "deviations at most, covariances by %.1e (%s)\n",
      what, z.size(), of_mean, of_cov, ours.value().summary.passes().c_str());
}

}  // namespace

int main(int argc, char** argv) {
  print_difference(acceleration, "acceleration");
  print_difference(position, "position");
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
