#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::signal {

/// How values between samples are found.
enum class ResampleMethod {
  sinc,     ///< band-limited, with a filter against aliases where the rate goes down
  linear,   ///< a straight line from sample to sample
  cubic,    ///< the polynomial through the two samples on either side
  nearest,  ///< the sample that is next in time
  mean,     ///< of the samples within half a new step: only to lower rates
};
/// "sinc", "linear", …; nullopt for any other word.
[[nodiscard]] std::optional<ResampleMethod> parse_resample_method(std::string_view word);
[[nodiscard]] std::string_view name_of(ResampleMethod method);

struct ResampleOptions {
  double target_hz = 0.0;  ///< 0: the recording's own rate; of several the highest
  ResampleMethod method = ResampleMethod::sinc;
};

/// The recording on an even grid of its first sample's time on: method and rate are told in a note.
/// What is missing stays missing: NaN in gaps (signal/even_grid.hpp) and beside samples that are no
/// number. A sample counter is always taken from the nearest sample. Lines of the file no longer
/// hold: first_line is 0.
/// Errors: invalid_argument (a rate that is none, mean to a higher rate, more than 2^31 samples, no
/// rate known), corrupt (stamps that go back; gaps of more than four times the samples).
/// Cost: O(N); sinc 64 products a sample of the higher rate.
[[nodiscard]] Result<Recording> resample(const Recording& recording,
                                         const ResampleOptions& options);

/// Several recordings of one clock on one grid, where they overlap, as one: where channels' names
/// clash they are preceded by the recording's source ("gyro.x"). A recording that does not say when
/// it began is taken to begin with the earliest, with a note of Severity::warning.
/// Errors: as resample(), naming the recording; too_few_samples (no overlap). Expects one at least.
[[nodiscard]] Result<Recording> join(std::span<const Recording> recordings,
                                     const ResampleOptions& options);

}  // namespace proofmass::signal
