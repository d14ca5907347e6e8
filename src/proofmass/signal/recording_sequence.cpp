#include "proofmass/signal/recording_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace proofmass::signal {

Result<std::size_t> RecordingSequence::append(double start_s, std::size_t samples) {
  constexpr double longest_overlap_s = 1.0;
  if (samples_ == 0) first_start_s_ = start_s;
  const double gap = std::round((start_s - first_start_s_) * rate_hz_) - end_;
  if (gap < -1.0 && gap < -longest_overlap_s * rate_hz_)
    return Error{
        Errc::invalid_argument,
        fmt::format("starts {:.6g} s before the end of the recording before it", -gap / rate_hz_)};
  end_ += std::fmax(0.0, gap) + static_cast<double>(samples);
  const auto missing =
      static_cast<std::size_t>(std::clamp(gap, 0.0, static_cast<double>(longest_gap_)));
  samples_ += missing + samples;
  return missing;
}

}  // namespace proofmass::signal
