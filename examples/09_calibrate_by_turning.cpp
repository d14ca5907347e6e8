// A three-axis accelerometer set down by hand in many orientations: from the recording to bias,
// scale and misalignment in a sensor file, and from there into the next recording.
//
//   example_09_calibrate_by_turning sensor.toml
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/sensor/calibration.hpp"
#include "proofmass/sensor/calibration_update.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "proofmass/signal/rests.hpp"
#include "proofmass/simulate/procedure.hpp"

namespace pm = proofmass;
namespace cal = proofmass::calibrate;

namespace {

constexpr double g = 9.8123;  // local gravity, known to 1e-4 m/s²

/// A rest of 20 s and 24 positions by hand; another session is another day with the same sensor.
pm::Recording turned_by_hand(std::uint64_t session) {
  auto options = pm::simulate::default_options(pm::simulate::Procedure::multi_position);
  options.session = session;
  options.gravity_mps2 = g;
  return pm::simulate::simulate_procedure(options).value().recording;
}

/// The rests, and the mean output in each.
cal::PoseMeans at_rest(const pm::Recording& recording) {
  const std::array<pm::View<double>, 3> axes{recording.find("acc_x")->values,
                                             recording.find("acc_y")->values,
                                             recording.find("acc_z")->values};
  std::vector<cal::Dwell> dwells;
  for (const auto& rest : pm::signal::find_rests(axes, {.rate_hz = recording.time.rate_hz}).rests)
    dwells.push_back({rest.first, rest.last});
  return cal::pose_means(axes, dwells).value();
}

/// Root mean square of |reading| − g over the rests.
double error_mps2(const cal::PoseMeans& means) {
  double squares = 0.0;
  for (const cal::Pose& pose : means.poses) squares += std::pow(pose.mean.norm() - g, 2);
  return std::sqrt(squares / static_cast<double>(means.poses.size()));
}

void print(const cal::MultiPosition& fit) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::printf("%c: bias %8.4f +- %.4f m/s^2, scale %.5f +- %.5f\n", "xyz"[k], fit.bias[k]->value,
                fit.bias[k]->std, fit.scale[k]->value, fit.scale[k]->std);
  }
  constexpr std::array names{"yz", "zy", "zx"};
  for (std::size_t k = 0; k < 3; ++k) {
    if (const auto& angle = fit.misalignment_rad[k])
      std::printf("angle %s: %6.2f +- %.2f mrad\n", names[k], 1e3 * angle->value, 1e3 * angle->std);
  }
  std::printf("%zu positions, residual %.2f mm/s^2 rms\n", fit.poses.size(),
              1e3 * fit.residual_rms_mps2);
  if (fit.lack_of_fit) std::printf("noise explains so much with p = %.2f\n", fit.lack_of_fit->p);
  for (std::size_t k = 0; k < fit.poses.size(); ++k)
    if (fit.poses[k].suspect) std::printf("position %zu contradicts the others\n", k + 1);
  if (fit.next_pose) std::printf("to know more: %s\n", fit.next_pose->words.c_str());
}

/// From measurements in m/s², whose scale is a ratio.
pm::sensor::MeasuredCalibration measured(const cal::MultiPosition& fit) {
  pm::sensor::MeasuredCalibration out;
  out.bias = fit.bias;
  out.scale = fit.scale;
  out.misalignment = fit.misalignment_rad;
  if (fit.misalignment_rad[0]) {
    auto& covariance = out.covariance.emplace();
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t j = 0; j < 9; ++j)
        covariance[i][j] =
            fit.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  if (fit.dof > 0.0) out.dof = fit.dof;
  out.gravity_mps2 = pm::Uncertain{g, 1e-4};
  out.origin = "example 09";
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s SENSOR.toml\n", argv[0]);
    return 2;
  }
  const cal::PoseMeans means = at_rest(turned_by_hand(0));
  const auto fit = cal::calibrate_positions(
      means.poses, {.gravity_mps2 = g, .gravity_std_mps2 = 1e-4, .noise_dof = means.noise_dof});
  if (!fit) {
    std::fprintf(stderr, "%s\n", fit.error().message.c_str());
    return 1;
  }
  print(*fit);
  if (const auto notes = pm::sensor::update_calibration(argv[1], measured(*fit)); !notes) {
    std::fprintf(stderr, "%s\n", notes.error().message.c_str());
    return 1;
  }

  // Another day: the sensor's output at rest, raw and calibrated by the file.
  const auto file = pm::sensor::read_sensor_file(argv[1]).value();
  pm::Recording next = turned_by_hand(1);
  const double before = error_mps2(at_rest(next));
  if (const auto status = pm::sensor::apply(file.model, next); !status) {
    std::fprintf(stderr, "%s\n", status.error().message.c_str());
    return 1;
  }
  const double after = error_mps2(at_rest(next));
  std::printf("another day the norm is off by %.4f m/s^2, calibrated by %.4f\n", before, after);
  return before > 0.05 && after < 0.01 ? 0 : 1;
}
