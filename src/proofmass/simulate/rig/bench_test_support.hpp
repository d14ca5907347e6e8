#pragma once

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/simulate/procedure.hpp"

// Shared by the tests of the procedures.
namespace proofmass::simulate {

/// A procedure whose sensor has its errors, but no noise or drift.
inline ProcedureOptions noise_free(Procedure procedure) {
  ProcedureOptions options = default_options(procedure);
  options.sensor.noise_rms_mps2 = {};
  options.sensor.flicker_mps2 = {};
  options.sensor.bias_walk_mps2_rts = {};
  return options;
}

inline ProcedureResult simulated(const ProcedureOptions& options) {
  return simulate_procedure(options).value();
}

inline const Samples& column(const Recording& recording, std::string_view name) {
  const Channel* channel = recording.find(name);
  EXPECT_NE(channel, nullptr) << name;
  return channel->values;
}

/// The three channels name_x, name_y, name_z, sample by sample.
struct Triple {
  Triple(const Recording& recording, const std::string& name)
      : x(column(recording, name + "_x")),
        y(column(recording, name + "_y")),
        z(column(recording, name + "_z")) {}
  Eigen::Vector3d operator()(std::size_t k) const { return {x[k], y[k], z[k]}; }
  const Samples &x, &y, &z;
};

/// Output of the true equations for a static force.
inline Eigen::Vector3d expected(const ProcedureTruth& truth, const Eigen::Vector3d& f) {
  Eigen::Vector3d E;
  for (Eigen::Index i = 0; i < 3; ++i)
    E(i) = sensor::output(truth.equations[static_cast<std::size_t>(i)],
                          {.ai_mps2 = f(i), .ap_mps2 = f((i + 1) % 3), .ao_mps2 = f((i + 2) % 3)});
  return E;
}

}  // namespace proofmass::simulate
