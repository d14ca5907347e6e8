#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/tilt.hpp"
#include "proofmass/signal/rests.hpp"

// Content of a record, and whether tilt is observable from it.
namespace proofmass::estimate {

/// Whether all three channels of the gyroscope are present.
[[nodiscard]] bool has_rates(const TiltRecord& record);

/// Three axes at one sample; NaN for a missing or non-finite axis.
[[nodiscard]] Mat<3> vector_at(const std::array<std::vector<double>, 3>& axes, std::size_t k);

/// A copy of the record in which measurements outside any sensor's range, and rates at the end of
/// the gyroscope's, are NaN, and notes with their numbers. nullopt if there are none. If most
/// forces are outside, the unit is wrong, which check_record() reports.
[[nodiscard]] std::optional<TiltRecord> without_unusable(const TiltRecord& record,
                                                         std::vector<Note>& notes);

/// Sets samples, axes and unusable, and notes the latter. Errors: as for estimate_tilt;
/// not_observable if the median force cannot be gravity's.
[[nodiscard]] Status check_record(const TiltRecord& record,
                                  const TiltOptions& options,
                                  TiltSolution& solution);

/// Whether the base moves. Errors: not_observable, too_few_samples if it does but cannot be
/// estimated.
[[nodiscard]] Result<bool> is_moving(const TiltRecord& record,
                                     const TiltOptions& options,
                                     const signal::RestSearch& found,
                                     const TiltSolution& solution);

/// A number with this many decimals, for sentences.
[[nodiscard]] std::string decimal(double value, int decimals = 2);

}  // namespace proofmass::estimate
