#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// True if a column of this name counts samples or packets: "PacketCounter", "Packet number",
/// "n_samples", "sample", "index", "seq", …
[[nodiscard]] bool is_counter_name(std::string_view name);

/// Tracks a column that may be the recording's sample counter, value by value.
class RunningCounter {
 public:
  void add(View<double> values);

  /// True if it counts the rows: almost always increments by one, and decreases only where a
  /// counter of 8, 16, 24 or 32 bits wraps.
  [[nodiscard]] bool counts_rows() const;
  /// As count_lost_rows.
  [[nodiscard]] std::size_t lost_rows() const { return static_cast<std::size_t>(lost_); }

 private:
  std::size_t rows_ = 0, ones_ = 0, rows_since_ = 0;
  bool went_back_ = false, started_ = false;
  double last_ = 0.0, lost_ = 0.0;
};

/// The channel that counts the recording's samples: selected by name, almost always increments by
/// one, and decreases only where a counter of 8, 16, 24 or 32 bits wraps. nullopt if there is none.
[[nodiscard]] std::optional<std::size_t> find_counter(const Recording& recording);

/// Number of missing rows according to a counter: the excess of its increments over one. Ignored
/// are increments that are not whole or exceed a million, and decreases (a counter of 8 or 16 bits
/// that wrapped, a restart).
[[nodiscard]] std::size_t count_lost_rows(View<double> counter);

}  // namespace proofmass::signal
