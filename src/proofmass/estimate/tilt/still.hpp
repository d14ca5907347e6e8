#pragma once

#include <optional>
#include <vector>

#include "proofmass/estimate/tilt/rest.hpp"

// A static base, and the sensor errors shown by rests.
namespace proofmass::estimate {

/// Fills the solution's rests with the angles over each.
void find_rests(const TiltRecord& record,
                const TiltOptions& options,
                const std::vector<signal::Rest>& found,
                TiltSolution& solution);

/// Sets the vertical at one sample from a force.
void set_up(TiltSeries& series, std::size_t k, const Mat<3>& force);

/// Compares the norm of the force at rest with gravity. Without a calibration, the difference shows
/// the size of the sensor's errors; with one, the possible change of the biases since then
/// (tilt/bias_change.hpp). Returns whether it set the options' bias_std_mps2. Sets the solution's
/// norm_std_mps2, too.
bool judge_norm(TiltOptions& options, TiltSolution& solution);

/// That the accuracy of the calibration is unknown, and what is assumed; `off_mps2` is the
/// departure of the norm at rest from gravity, if it is significant.
[[nodiscard]] Note uncalibrated_note(const std::optional<double>& off_mps2,
                                     double bias_std_mps2,
                                     double gravity_mps2);

/// An empty series of the record's length, with its rests.
void make_series(const TiltRecord& record, TiltSolution& solution);

/// The series of a static base: the mean of the rest so far, and that of the whole rest.
void fill_still(const TiltRecord& record, const TiltOptions& options, TiltSolution& solution);

}  // namespace proofmass::estimate
