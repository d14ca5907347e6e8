#pragma once

#include <optional>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit.hpp"

namespace proofmass::signal {

/// Finite, of a size that a measurement can have, and not denormal.
[[nodiscard]] bool is_plausible(double value);

/// Not zero, but below the smallest normal single-precision number.
[[nodiscard]] bool is_denormal(double value);

/// The step of the converter behind a series, or nullopt if it looks continuous.
[[nodiscard]] std::optional<double> find_lsb(View<double> series);

/// Judges one channel; `time` places the longest run of equal values.
[[nodiscard]] ChannelAudit audit_channel(const Channel& channel, const TimeBase& time);

}  // namespace proofmass::signal
