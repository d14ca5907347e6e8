// Samples a second of processor time of the wheel's filter and smoother, compared with a textbook
// extended Kalman filter with the Rauch–Tung–Striebel smoother: dense F over all states, all
// channels of an epoch at once, every state stored, the inverse by LDLᵀ. Both run the same
// WheelModel over the same measurements; the largest difference of their smoothed angles is printed
// to show that they compute the same result. Then the whole estimate_wheel() in units of one filter
// and smoother, of a tenth of the epochs at most.
//
//   wheel_bench [most epochs, 1e6 if not given]
#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <sys/resource.h>
#include <vector>

#include "proofmass/estimate/wheel.hpp"
#include "proofmass/estimate/wheel/model.hpp"

namespace {

using namespace proofmass::estimate;

constexpr double rate_hz = 200.0, gravity_mps2 = 9.80665, radius_m = 0.1;
constexpr double noise_mps2 = 0.02, speed_radps = 1.5;

/// Sensors at opposite positions of a wheel whose speed oscillates by a fifth.
struct Recording {
  std::vector<WheelEpoch> epochs;
  std::array<PlanarReadings, 2> sensors;
};

Recording record(std::size_t count) {
  using namespace std::complex_literals;
  std::mt19937_64 bits(1);
  std::normal_distribution<double> noise(0.0, noise_mps2);
  Recording recording;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / rate_hz, swing = 0.3;
    const double angle = speed_radps * t - 0.2 * speed_radps / swing * (std::cos(swing * t) - 1.0);
    const double speed = speed_radps * (1.0 + 0.2 * std::sin(swing * t));
    const double accel = speed_radps * 0.2 * swing * std::cos(swing * t);
    for (std::size_t s = 0; s < 2; ++s) {
      const double place = s == 0 ? radius_m : -radius_m;
      const std::complex<double> f =
          (1i * accel - speed * speed) * place + 1i * gravity_mps2 * std::polar(1.0, -angle);
      recording.sensors[s].u_mps2.push_back(f.real() + noise(bits));
      recording.sensors[s].v_mps2.push_back(f.imag() + noise(bits));
      recording.sensors[s].variance_m2ps4.push_back(noise_mps2 * noise_mps2);
    }
    const auto row = static_cast<std::int64_t>(k);
    recording.epochs.push_back({k == 0 ? 0.0 : 1.0 / rate_hz, {row, row}});
  }
  return recording;
}

template <int S>
WheelModel<S> model_of(const Recording& recording) {
  WheelModel<S> model;
  model.gravity_mps2 = gravity_mps2;
  model.noise = {.jerk_psd = 0.1, .snap_psd = 0.1, .bias_walk_psd = 1e-9};
  model.places_held = true;  // as in the fit's last passes
  model.epochs = &recording.epochs;
  for (std::size_t s = 0; s < S; ++s) model.readings[s] = &recording.sensors[s];
  return model;
}

template <int S>
FilterState<wheel::states(S)> start() {
  FilterState<wheel::states(S)> state;
  auto& [mean, cov] = state.x;
  mean(wheel::speed) = speed_radps;
  cov.diagonal().setConstant(1e-4);
  cov(wheel::angle, wheel::start) = cov(wheel::start, wheel::angle) = 1e-4;
  for (int s = 0; s < S; ++s) mean(wheel::places(S) + 2 * s) = s == 0 ? radius_m : -radius_m;
  cov.diagonal().template tail<2 * S>().setZero();
  return state;
}

/// Textbook implementation with only one optimisation, reserve().
template <int S>
std::vector<double> textbook_smoother(const WheelModel<S>& model) {
  constexpr int N = wheel::states(S), M = 2 * S, D = wheel::moving;
  struct Kept {
    Gaussian<N> predicted, filtered;
    Mat<N, N> F;
  };
  std::vector<Kept> run;
  run.reserve(model.size());
  Gaussian<N> x = start<S>().x;
  for (std::size_t k = 0; k < model.size(); ++k) {
    Kept& kept = run.emplace_back();
    kept.F.setIdentity();
    if (k > 0) {
      const auto step = model.transition(x.mean, k);
      kept.F.template topLeftCorner<D, D>() = step.F;
      Mat<N, N> Q = step.walk.asDiagonal();
      Q.template topLeftCorner<D, D>() = step.Q;
      x.mean.template head<D>() = step.mean;
      x.cov = (kept.F * x.cov * kept.F.transpose() + Q).eval();
    }
    kept.predicted = x;
    Readings<N, WheelModel<S>::channels> readings;  // M rows: no gyroscope, nothing static
    model.measure(x.mean, k, readings);
    Mat<M, N> H;
    Mat<M> y;
    Mat<M, M> R = Mat<M, M>::Zero();
    for (int i = 0; i < M; ++i) {
      const auto& reading = readings.rows[static_cast<std::size_t>(i)];
      H.row(i) = reading.h.transpose();
      y(i) = reading.value - reading.predicted;
      R(i, i) = reading.variance;
    }
    const Mat<M, M> innovation_cov = H * x.cov * H.transpose() + R;
    const Mat<N, M> K = innovation_cov.ldlt().solve(H * x.cov).transpose();
    const Mat<N, N> rest = Mat<N, N>::Identity() - K * H;
    x.mean += K * y;
    x.cov = (rest * x.cov * rest.transpose() + K * R * K.transpose()).eval();
    kept.filtered = x;
  }
  std::vector<double> angle(run.size());
  angle.back() = x.mean(wheel::angle);
  for (std::size_t k = run.size() - 1; k-- > 0;) {
    const Kept &now = run[k], &next = run[k + 1];
    const Mat<N, N> G = next.predicted.cov.ldlt().solve(next.F * now.filtered.cov).transpose();
    x.mean = now.filtered.mean + G * (x.mean - next.predicted.mean);
    x.cov = (now.filtered.cov + G * (x.cov - next.predicted.cov) * G.transpose()).eval();
    angle[k] = x.mean(wheel::angle);
  }
  return angle;
}

template <int S>
std::vector<double> our_smoother(const WheelModel<S>& model) {
  std::vector<double> angle(model.size());
  double std_sum = 0.0;
  smooth(
      model, start<S>(), Gate{}, [](std::size_t, const auto&) {},
      [&](std::size_t k, const auto& step, const auto& later) {
        angle[k] = later.mean(step.filtered)(wheel::angle);
        std_sum += later.template cov<wheel::jerk>(step.filtered)(0, 0);
      });
  if (!(std_sum > 0.0)) std::puts("the smoother gave no variance");
  return angle;
}

template <class Work>
double seconds(Work&& work) {
  const std::clock_t began = std::clock();  // processor time: other processes do not count
  work();
  return static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
}

long peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// Memory of smooth(): the state at every chunk's start, and one chunk of steps.
template <int S>
double working_bytes_per_sample(std::size_t count) {
  constexpr int N = wheel::states(S);
  constexpr double chunk = N > 12 ? 64.0 : 128.0;
  return sizeof(FilterState<N>) / chunk +
         chunk * sizeof(StepOf<WheelModel<S>>) / static_cast<double>(count);
}

template <int S>
void compare(std::size_t most) {
  std::printf("%d sensor%s, %d states (%d places held), %d channels\n", S, S > 1 ? "s" : "",
              wheel::states(S), 2 * S, 2 * S);
  std::printf("%10s %14s %16s %14s %14s %18s\n", "samples", "filter /s", "and smoother /s",
              "bytes/sample", "peak RSS MB", "textbook /s");
  for (std::size_t count = 10'000; count <= most; count *= 10) {
    const Recording recording = record(count);
    const auto model = model_of<S>(recording);
    const auto n = static_cast<double>(count);
    auto state = start<S>();
    const double filter_s =
        seconds([&] { filter(model, {0, count}, Gate{}, state, [](std::size_t, const auto&) {}); });
    std::vector<double> ours;
    const double smoother_s = seconds([&] { ours = our_smoother(model); });
    std::printf("%10zu %14.0f %16.0f %14.1f %14ld", count, n / filter_s, n / smoother_s,
                working_bytes_per_sample<S>(count), peak_rss_mb());
    // The textbook's states of a longer recording would not fit in memory: 9 kB a sample.
    if (count <= 10'000) {
      std::vector<double> textbook;
      const double textbook_s = seconds([&] { textbook = textbook_smoother(model); });
      double difference = 0.0;
      for (std::size_t k = 0; k < count; ++k)
        difference = std::max(difference, std::abs(ours[k] - textbook[k]));
      std::printf(" %18.0f   (smoothed angles differ by %.1e rad at most)", n / textbook_s,
                  difference);
    }
    std::printf("\n");
  }
}

/// The whole estimate, with its search, noise and lever arms, in units of one filter and smoother.
void compare_estimate(std::size_t most) {
  std::printf("estimate_wheel() of two sensors at %.0f Hz\n", rate_hz);
  std::printf("%10s %14s %14s %18s %14s\n", "samples", "wall s", "processor s", "filter+smoother",
              "peak RSS MB");
  for (std::size_t count = 10'000; count <= most; count *= 10) {
    const Recording recording = record(count);
    std::vector<WheelSensor> sensors;
    for (const PlanarReadings& readings : recording.sensors) {
      WheelSensor& sensor = sensors.emplace_back();
      sensor.accel_mps2 = {readings.u_mps2, readings.v_mps2, {}};
      for (std::size_t k = 0; k < count; ++k)
        sensor.time_s.push_back(static_cast<double>(k) / rate_hz);
    }
    const double one_s = seconds([&] { our_smoother(model_of<2>(recording)); });
    const auto began = std::chrono::steady_clock::now();
    std::string failure;
    const double whole_s = seconds([&] {
      const auto solution = estimate_wheel(sensors, {});
      if (!solution) failure = solution.error().message;
    });
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began;
    std::printf("%10zu %14.1f %14.1f %18.1f %14ld %s\n", count, wall.count(), whole_s,
                whole_s / one_s, peak_rss_mb(), failure.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto most = static_cast<std::size_t>(argc > 1 ? std::strtod(argv[1], nullptr) : 1e6);
  compare<2>(most);
  compare<1>(most);
  compare_estimate(most / 10);
}
