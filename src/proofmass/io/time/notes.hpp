#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/time/counter_clock.hpp"
#include "proofmass/io/time/stamps.hpp"

namespace proofmass::io {

/// Names used in the notes on a column of stamps.
struct NamedStamps {
  std::string name;
  std::string counter_name;  ///< empty if there is no counter
  double unit_s = 1.0;
  std::size_t first_line = 0;
};

/// Notes on wraps, removed hours, restarts and replacements: position and correction.
[[nodiscard]] std::vector<Note> notes_on_mending(const MendedStamps& done,
                                                 const NamedStamps& stamps);
/// Notes on stamps in bursts, and on a rate in the preamble that differs.
[[nodiscard]] std::vector<Note> notes_on_rate(const TimeBase& base,
                                              const StampSteps& steps,
                                              double unit_s,
                                              std::optional<double> header_rate_hz);
[[nodiscard]] std::vector<Note> notes_on_counter(const std::string& name,
                                                 const CounterClock& clock);

}  // namespace proofmass::io
