// Warm-up of a sensor: from a recording at rest to a sensor file, and its removal from the next
// recording:
//
//   example_07_warm_up sensor.toml
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "proofmass/characterise/drift_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/sensor/drift_update.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "proofmass/sensor/warm_up.hpp"

namespace pm = proofmass;

namespace {

constexpr double rate_hz = 20.0;

/// An x axis at rest from power-up: 0.05 m/s² with a time constant of 200 s, on 0.01 m/s², in white
/// noise.
pm::Recording powered_up(unsigned seed, double duration_s) {
  std::mt19937_64 bits(seed);
  std::normal_distribution<double> normal(0.0, 0.005);
  pm::Recording recording;
  recording.time.source = pm::TimeSource::given_rate;
  recording.time.rate_hz = rate_hz;
  recording.channels.push_back({"acc_x", pm::parse_unit("m/s^2").value(), {}});
  std::vector<double>& values = recording.channels[0].values.edit();
  for (double t_s = 0.0; t_s < duration_s; t_s += 1.0 / rate_hz)
    values.push_back(0.01 - 0.05 * std::expm1(-t_s / 200.0) + normal(bits));
  return recording;
}

double mean(pm::View<double> values, double from_s, double to_s) {
  double sum = 0.0, count = 0.0;
  for (double k = std::ceil(from_s * rate_hz); k < to_s * rate_hz; k += 1.0, count += 1.0)
    sum += values[static_cast<std::size_t>(k)];
  return sum / count;
}

pm::Uncertain plain(const pm::characterise::Interval95& figure) {
  return {figure.value, figure.std};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s SENSOR.toml\n", argv[0]);
    return 2;
  }
  const pm::Recording first = powered_up(1, 1800.0);
  const auto analysis =
      pm::characterise::analyse_drift(first.channels[0].values, {.rate_hz = rate_hz});
  if (!analysis) {
    std::fprintf(stderr, "%s\n", analysis.error().message.c_str());
    return 1;
  }
  const auto& fit = analysis->fit;
  if (!fit.identified) {
    std::printf("no warm-up can be told: %s\n", fit.reason.c_str());
    return 1;
  }
  std::printf("a1 %.4f +- %.4f m/s^2, T %.0f +- %.0f s", fit.a1->value, fit.a1->std,
              fit.time_constant_s->value, fit.time_constant_s->std);
  if (fit.time_constant_s->lower_95 && fit.time_constant_s->upper_95)
    std::printf(" (95 %%: %.0f ... %.0f s)", *fit.time_constant_s->lower_95,
                *fit.time_constant_s->upper_95);
  std::printf("\n");

  const std::vector<pm::sensor::MeasuredDrift> measured{
      {.axis = 0,
       .a1_mps2 = plain(*fit.a1),
       .a2_mps2 = plain(fit.a2),
       .time_constant_s = plain(*fit.time_constant_s),
       .origin = "example 07, 30 min at 20 Hz"}};
  if (const auto status = pm::sensor::update_sensor_file(argv[1], measured); !status) {
    std::fprintf(stderr, "%s\n", status.error().message.c_str());
    return 1;
  }

  // Another power-up, of which the first two minutes are of interest.
  const auto file = pm::sensor::read_sensor_file(argv[1]).value();
  pm::Recording second = powered_up(2, 600.0);
  const double before =
      mean(second.channels[0].values, 110.0, 120.0) - mean(second.channels[0].values, 0.0, 10.0);
  const pm::Triad axes{.name = "acc", .x = 0, .y = {}, .z = {}};
  if (const auto status =
          pm::sensor::remove_warm_up(file.model.drift, axes, {.since_switch_on_s = 0.0}, second);
      !status) {
    std::fprintf(stderr, "%s\n", status.error().message.c_str());
    return 1;
  }
  const double after =
      mean(second.channels[0].values, 110.0, 120.0) - mean(second.channels[0].values, 0.0, 10.0);
  std::printf("over two minutes the bias moves by %.4f m/s^2, with the warm-up taken out by %.4f\n",
              before, after);
  return std::abs(before) > 0.02 && std::abs(after) < 0.002 ? 0 : 1;
}
