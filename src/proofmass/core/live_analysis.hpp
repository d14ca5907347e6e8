#pragma once

#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/rows.hpp"

namespace proofmass {

/// What is worked out of samples while they come: estimates that are recorded beside them.
class LiveAnalysis {
 public:
  LiveAnalysis() = default;
  LiveAnalysis(const LiveAnalysis&) = delete;
  LiveAnalysis& operator=(const LiveAnalysis&) = delete;
  virtual ~LiveAnalysis() = default;

  /// Its columns: names and units, without values. They do not change.
  [[nodiscard]] virtual const std::vector<Channel>& columns() const = 0;
  /// Takes the samples behind those it had, with their stamps, and appends to `out` the rows that
  /// are settled by now, each with its own time on the recording's clock; there may be none yet, or
  /// fewer than samples. What goes wrong with the data is a note, not an error: it goes on.
  /// Errors: what makes all that follows senseless.
  [[nodiscard]] virtual Status add(const Block& samples, Rows& out) = 0;
  /// No sample follows: the rows that were still waiting.
  [[nodiscard]] virtual Status finish(Rows& out) = 0;
  /// What it has to say since it was asked last.
  [[nodiscard]] virtual std::vector<Note> take_notes() = 0;
};

}  // namespace proofmass
