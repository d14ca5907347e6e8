#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::signal {

/// Interpolation method.
enum class ResampleMethod {
  sinc,     ///< band-limited, with an anti-aliasing filter if the rate decreases
  linear,   ///< linear between samples
  cubic,    ///< polynomial through the two samples on either side
  nearest,  ///< nearest sample in time
  mean,     ///< mean of the samples within half a new period: only to lower rates
};
/// "sinc", "linear", …; nullopt for any other word.
[[nodiscard]] std::optional<ResampleMethod> parse_resample_method(std::string_view word);
[[nodiscard]] std::string_view name_of(ResampleMethod method);

struct ResampleOptions {
  double target_hz = 0.0;  ///< 0: the recording's own rate; for several recordings the highest
  ResampleMethod method = ResampleMethod::sinc;
};

/// The recording on an even grid that starts at its first sample; method and rate are reported in a
/// note. Missing data stay missing: NaN in gaps (signal/even_grid.hpp) and next to samples that are
/// not finite. A sample counter is always taken from the nearest sample. Line numbers of the file
/// no longer apply: first_line is 0.
/// Errors: invalid_argument (invalid rate, mean to a higher rate, more than 2^31 samples, no rate
/// known), corrupt (stamps that run backwards; gaps of more than four times the samples).
/// Cost: O(N); sinc 64 products per sample of the higher rate.
[[nodiscard]] Result<Recording> resample(const Recording& recording,
                                         const ResampleOptions& options);

/// Joins several recordings of one clock on one grid, over their common interval. Channels with
/// equal names are prefixed with the recording's source ("gyro.x"). A recording without a start
/// time is assumed to start with the earliest, with a note of Severity::warning.
/// Errors: as resample(), with the recording's name; too_few_samples (no overlap). Expects at least
/// one.
[[nodiscard]] Result<Recording> join(std::span<const Recording> recordings,
                                     const ResampleOptions& options);

}  // namespace proofmass::signal
