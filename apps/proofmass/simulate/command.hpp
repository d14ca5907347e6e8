#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/common_flags.hpp"

namespace proofmass::app {

struct SimulateCommand {
  std::string rig;  ///< description of the rig, or with --procedure of the procedure
  std::optional<std::uint64_t> seed;
  std::optional<double> rpm, rate_hz, duration_s, gravity_mps2;
  bool datasheet_errors = false, print_config = false;
  std::optional<int> adc_bits;
  std::string procedure, signal;  ///< empty: the rig, or as in the description
  std::optional<std::uint64_t> session;
  std::optional<int> positions;
  std::optional<double> dwell_s, supply_v;
  std::optional<int> strokes, repetitions;  ///< of a slide
  std::optional<double> length_m, stroke_s, elevation_deg;
  bool gravity_removed = false, gyro = false;
  OutputFlags output;
};

}  // namespace proofmass::app
