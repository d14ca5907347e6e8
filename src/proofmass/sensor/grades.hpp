#pragma once

#include <array>
#include <string_view>

#include "proofmass/core/units.hpp"

namespace proofmass::sensor {

/// A class of accelerometers by the residual bias after calibration.
struct Grade {
  std::string_view name;
  double bias_mps2;
};

/// Source: M. A. Lele, Evaluation of Solid State Accelerometer Sensor for Effective Position
/// Estimation, M.A.Sc. thesis, Dalhousie University (2010), table 2.1.
inline constexpr std::array<Grade, 4> grades{{
    {"Navigation", 0.025e-3 * standard_gravity_mps2},
    {"Tactical", 0.3e-3 * standard_gravity_mps2},
    {"Industrial", 3e-3 * standard_gravity_mps2},
    {"Automotive", 125e-3 * standard_gravity_mps2},
}};

/// The times of that table: 1 s, 10 s, 1 min, 1 h.
inline constexpr std::array<double, 4> grade_times_s{1.0, 10.0, 60.0, 3600.0};

}  // namespace proofmass::sensor
