#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose_guide.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "record_command.hpp"

namespace proofmass::app {

/// Leads through the procedure of `record --procedure`, then has its verb work on the recording.
class RecordGuide {
 public:
  /// Throws Failure where the command's flags do not go together.
  explicit RecordGuide(const RecordCommand& command);

  /// The channels, once they are known; a source that comes back changes nothing.
  void opened(const Recording& head);
  /// Lines for whoever lays the sensor down.
  [[nodiscard]] std::vector<std::string> samples(const Block& block);
  /// How it stands now, for a line that is drawn anew.
  [[nodiscard]] std::string live() const;
  /// The state of the procedure as JSON, for `record --stream`.
  [[nodiscard]] std::string picture() const;
  /// Whether the recording can end.
  [[nodiscard]] bool done() const;
  /// Writes the list of rests beside the recording, "run.rests.csv" beside "run.mcap", and runs the
  /// verb on it, unless it was broken off. Returns how to run it again. Throws Failure, also where
  /// the channels were none to be guided by.
  [[nodiscard]] std::string write_rests(const std::string& file) const;
  void run_verb(const std::string& file) const;

 private:
  [[nodiscard]] std::vector<std::string> keys();

  RecordCommand command_;
  std::optional<calibrate::PoseGuide> guide_;
  std::string why_not_, said_;
  std::vector<double> errors_g_;  ///< after each pose; NaN where unknown
  bool ended_ = false;            ///< by the person
};

}  // namespace proofmass::app
