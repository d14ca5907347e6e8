#pragma once

#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/rows.hpp"

namespace proofmass {

/// Online estimator that runs alongside a recording; its estimates are recorded with the samples.
class LiveAnalysis {
 public:
  LiveAnalysis() = default;
  LiveAnalysis(const LiveAnalysis&) = delete;
  LiveAnalysis& operator=(const LiveAnalysis&) = delete;
  virtual ~LiveAnalysis() = default;

  /// The output columns: names and units, without values. They do not change.
  [[nodiscard]] virtual const std::vector<Channel>& columns() const = 0;
  /// Takes the next samples with their stamps and appends to `out` the rows that are final by now,
  /// each with its own time on the recording's clock. There may be no row yet, or fewer rows than
  /// samples. A fault in the data is reported as a note, not as an error, and the analysis
  /// continues.
  /// Errors: only those that make all later output meaningless.
  [[nodiscard]] virtual Status add(const Block& samples, Rows& out) = 0;
  /// Ends the input: appends the rows that are still pending.
  [[nodiscard]] virtual Status finish(Rows& out) = 0;
  /// Notes since the last call.
  [[nodiscard]] virtual std::vector<Note> take_notes() = 0;
};

}  // namespace proofmass
