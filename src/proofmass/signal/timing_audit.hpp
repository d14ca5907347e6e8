#pragma once

#include "proofmass/core/recording.hpp"
#include "proofmass/signal/audit.hpp"

namespace proofmass::signal {

/// Judges a recording's time base, with its sample counter where it has one.
[[nodiscard]] TimingAudit audit_timing(const Recording& recording);

}  // namespace proofmass::signal
