#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose_guide.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "record/command.hpp"

namespace proofmass::app {

/// Guides the user through `record --procedure`, then evaluates the recording by its verb.
class RecordGuide {
 public:
  /// Throws Failure for incompatible flags.
  explicit RecordGuide(const RecordCommand& command);

  /// Called once the channels are known; calls after a reconnection have no effect.
  void opened(const Recording& head);
  /// Instructions for the person who places the sensor.
  [[nodiscard]] std::vector<std::string> samples(const Block& block);
  /// Current state, for a line that is redrawn.
  [[nodiscard]] std::string live() const;
  /// The state of the procedure as JSON, for `record --stream`.
  [[nodiscard]] std::string picture() const;
  /// True if the recording can end.
  [[nodiscard]] bool done() const;
  /// Writes the list of rests beside the recording, "run.rests.csv" beside "run.mcap". Returns the
  /// command that evaluates it. Throws Failure, also if the channels are not suitable for the
  /// procedure.
  [[nodiscard]] std::string write_rests(const std::string& file) const;
  void run_verb(const std::string& file) const;

 private:
  [[nodiscard]] std::vector<std::string> keys();
  void report(const calibrate::GuideStep& step, std::vector<std::string>& lines);

  RecordCommand command_;
  std::optional<calibrate::PoseGuide> guide_;
  std::string why_not_, said_;
  std::string typed_;             ///< up to a line's end
  std::vector<double> errors_g_;  ///< after each pose; NaN where unknown
  bool ended_ = false;            ///< by the user
};

}  // namespace proofmass::app
