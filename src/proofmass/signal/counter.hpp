#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Whether a column of this name counts samples or packets: "PacketCounter", "Packet number",
/// "n_samples", "sample", "index", "seq", …
[[nodiscard]] bool is_counter_name(std::string_view name);

/// Follows a column that may be the counter of the recording's samples, as its values come.
class RunningCounter {
 public:
  void add(View<double> values);

  /// Whether it counts the rows: steps of one nearly always, and never back but where a counter of
  /// 8, 16, 24 or 32 bits runs over.
  [[nodiscard]] bool counts_rows() const;
  /// As count_lost_rows.
  [[nodiscard]] std::size_t lost_rows() const { return static_cast<std::size_t>(lost_); }

 private:
  std::size_t rows_ = 0, ones_ = 0, rows_since_ = 0;
  bool went_back_ = false, started_ = false;
  double last_ = 0.0, lost_ = 0.0;
};

/// The channel that counts the recording's samples: by its name, with steps of one nearly always,
/// and never back but where a counter of 8, 16, 24 or 32 bits runs over. nullopt if there is none.
[[nodiscard]] std::optional<std::size_t> find_counter(const Recording& recording);

/// Rows that a counter says are missing: what its steps above one leave out. Steps that are no
/// whole number or beyond a million are passed over, and so are those back (a counter of 8 or
/// 16 bits that ran over, a restart).
[[nodiscard]] std::size_t count_lost_rows(View<double> counter);

}  // namespace proofmass::signal
