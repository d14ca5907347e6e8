#pragma once

#include <vector>

#include "proofmass/estimate/tilt_rest.hpp"

// A base at rest, and what rests say of the sensor. Private to the module's tilt*.cpp.
namespace proofmass::estimate {

/// Fills the solution's rests with the angles over each.
void find_rests(const TiltRecord& record,
                const TiltOptions& options,
                const std::vector<signal::Rest>& found,
                TiltSolution& solution);

/// The direction of a force as that of the vertical at one sample.
void set_up(TiltSeries& series, std::size_t k, const Mat<3>& force);

/// Notes what the norm of the force at rest says of the calibration. Without one, a norm that is
/// not gravity's shows the size of the sensor's errors; with one, by how much the biases may have
/// changed since (tilt_bias_change.hpp). Returns whether the options' bias_std_mps2 became it.
bool judge_norm(TiltOptions& options, TiltSolution& solution);

/// An empty series of the record's length, with its rests.
void make_series(const TiltRecord& record, TiltSolution& solution);

/// The series of a still base: the mean of the rest so far, and that of the rest.
void fill_still(const TiltRecord& record, const TiltOptions& options, TiltSolution& solution);

}  // namespace proofmass::estimate
