// A drift analysis of two hours at 1 kHz, three axes from an .npy file, compared with two
// references in the same run, one thread, processor time: scipy's curve_fit of all samples
// (scipy_drift.py, if there is a python3 with scipy), and the same fit as a plain C++ loop over the
// samples. The references give a curve with a standard deviation valid for white noise; the
// analysis also gives the noise, the intervals, the model selection, shocks and whiteness.
//
//   drift_bench [samples, 7.2e6 if not given] [folder for the file, /tmp]
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "measure.hpp"
#include "proofmass/characterise/drift_analysis.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/write_recording.hpp"
#include "proofmass/signal/events.hpp"

namespace {

using namespace proofmass;

constexpr double rate_hz = 1000.0;
constexpr std::size_t axes = 3;

// Warm-up in white noise and a random walk, 900 s at two hours.
Recording made_up(std::size_t n) {
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.time.source = TimeSource::given_rate;
  recording.time.rate_hz = rate_hz;
  const double time_constant_s = 0.125 * static_cast<double>(n) / rate_hz;
  for (const char* name : {"acc_x", "acc_y", "acc_z"}) {
    std::vector<double> values(n);
    double walk = 0.0;
    for (std::size_t k = 0; k < n; ++k)
      values[k] = 0.01 - 0.05 * std::expm1(-static_cast<double>(k) / rate_hz / time_constant_s) +
                  0.03 * normal(bits) + (walk += 2e-6 * normal(bits));
    recording.channels.push_back({name, parse_unit("m/s^2").value(), std::move(values)});
  }
  return recording;
}

// Levenberg–Marquardt over all samples; normal equations, one pass a step.
Eigen::Vector3d plain_fit(View<double> y, Eigen::Vector3d p) {
  double lambda = 1e-3, least = HUGE_VAL;
  Eigen::Vector3d best = p, gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (int step = 0; step < 50; ++step) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    double squares = 0.0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double t_s = static_cast<double>(k) / rate_hz;
      const double decay = std::exp(-t_s / p[1]);
      const Eigen::Vector3d row(1.0 - decay, -p[0] * t_s / (p[1] * p[1]) * decay, 1.0);
      const double r = y[k] - p[2] - p[0] * row[0];
      squares += r * r;
      g += r * row;
      A += row * row.transpose();
    }
    if (squares < least) {
      const bool settled = least - squares < 1e-10 * squares;
      least = squares;
      best = p;
      normal = A;
      gradient = g;
      lambda *= 0.1;
      if (settled) break;
    } else {
      lambda *= 10.0;
    }
    Eigen::Matrix3d damped = normal;
    damped.diagonal() *= 1.0 + lambda;
    p = best + damped.ldlt().solve(gradient);
    p[1] = std::max(p[1], 1e-3);
  }
  return best;
}

struct Seconds {
  double read = 0.0, fit = 0.0;
  [[nodiscard]] double all() const { return read + fit; }
};

// Zero without scipy.
Seconds scipy_s(const std::string& file) {
  const std::string command = "python3 '" PROOFMASS_BENCH_DIR "/scipy_drift.py' '" + file + "' " +
                              std::to_string(axes) + " 2>/dev/null";
  Seconds seconds;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return seconds;
  if (std::fscanf(pipe, "%lf %lf", &seconds.read, &seconds.fit) != 2) seconds = {};
  pclose(pipe);
  return seconds;
}

void line(const char* what, double seconds, double reference) {
  std::printf("  %-46s %8.4f s", what, seconds);
  if (reference > 0.0) std::printf("   %6.1f x scipy", reference / seconds);
  std::printf("\n");
}

template <class Work>
double timed(const Work& work) {
  const double from = cpu_s();
  work();
  return cpu_s() - from;
}

}  // namespace

int main(int argc, char** argv) {
  const auto n = static_cast<std::size_t>(argc > 1 ? std::atof(argv[1]) : 7.2e6);
  const std::filesystem::path folder(argc > 2 ? argv[2] : "/tmp");
  const std::string file = (folder / "proofmass_drift_bench.npy").string();
  if (const auto status = io::write_recording(made_up(n), file); !status) {
    std::fprintf(stderr, "%s\n", status.error().message.c_str());
    return 1;
  }
  std::printf("%zu samples of %zu axes, %s\n", n, axes, file.c_str());

  Recording recording;
  const double read = timed([&] { recording = io::read_recording(file, {}).value(); });
  std::vector<characterise::DriftAnalysis> found;
  const double drift = timed([&] {
    for (const Channel& channel : recording.channels)
      found.push_back(characterise::analyse_drift(channel.values, {.rate_hz = rate_hz}).value());
  });
  const double memory =
      peak_mib() / (static_cast<double>(n * axes * sizeof(double)) / (1024.0 * 1024.0));
  volatile double sink = 0.0;
  const double outliers = timed([&] {
    for (const Channel& channel : recording.channels)
      sink = static_cast<double>(signal::find_events(channel.values, {.rate_hz = rate_hz}).size());
  });
  std::vector<Eigen::Vector3d> plain;
  const double loop = timed([&] {
    for (const Channel& channel : recording.channels)
      plain.push_back(plain_fit(
          channel.values, {0.1, 0.2 * static_cast<double>(n) / rate_hz, channel.values.front()}));
  });
  const Seconds scipy = scipy_s(file);
  std::filesystem::remove(file);

  if (scipy.all() > 0.0) {
    line("numpy.load", scipy.read, 0.0);
    line("numpy.load and scipy's curve_fit of all samples", scipy.all(), scipy.all());
  } else {
    std::printf("  no python3 with scipy here\n");
  }
  line("reading, and a plain C++ loop of the same fit", read + loop, scipy.all());
  line("reading", read, 0.0);
  line("of the analysis: knocks and steps", outliers, 0.0);
  line("reading and analysis", read + drift, scipy.all());
  std::printf("  %.2f x the plain loop; memory: %.1f x the data, the data included\n",
              (read + loop) / (read + drift), memory);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto& fit = found[k].fit;
    std::printf("  %s: plain T %.1f s", recording.channels[k].name.c_str(), plain[k][1]);
    if (fit.identified)
      std::printf(", analysed %.1f +- %.1f s\n", fit.time_constant_s->value,
                  fit.time_constant_s->std);
    else
      std::printf(", analysed: %s\n", fit.reason.c_str());
  }
}
