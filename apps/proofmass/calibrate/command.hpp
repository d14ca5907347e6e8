#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"
#include "input/encoder.hpp"

namespace proofmass::app {

/// Static positions on a turntable; by a flag, a rotating wheel or the model equation alone.
struct CalibrateCommand {
  std::vector<std::string> files;
  std::string rests;  ///< --rests: list of intervals
  std::optional<double> shortest_rest_s;
  bool means = false, keep_suspects = false, six_position = false;
  std::optional<int> parameters;  ///< 6, 9 or 12
  std::optional<double> gravity_std_mps2, temperature_c, bias_stability_mg;
  double orthogonality_std_deg = 0.57, placement_std_deg = 1.0;
  std::vector<double> supplies_v;
  std::vector<std::string> type_b, validate;
  std::optional<std::size_t> monte_carlo;  ///< draws; 0: no check
  bool gyro = false;                       ///< calibrate the gyroscope too
  std::string gyro_file;                   ///< its recording, if it has one of its own
  std::string rate_unit = "rad/s";         ///< where the gyroscope's headings have none
  std::vector<std::string> turntable;      ///< START,END,DEG_PER_S[,STD]
  EncoderFlags encoder;                    ///< calibrate the encoder of a wheel instead
  double nonlinearity_percent = 0.02, runout_m = 30e-6;
  std::optional<double> radius_m;
  std::string name, serial, date;
  std::string update_sensor;
  InputFlags input;
  OutputFlags output;
};

/// The verb. Throws Failure.
void run_calibrate(const CalibrateCommand& command);

}  // namespace proofmass::app
