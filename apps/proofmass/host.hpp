#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::app {

/// Stands in for files and the terminal where a verb runs within another program: InputFlags::host
/// gives its recordings, OutputFlags::host takes its results.
struct Host {
  std::map<std::string, Recording> recordings{};      ///< in place of the files of these names
  std::map<std::string, std::string> sensor_files{};  ///< their text, in place of files
  Progress progress{};                                ///< in place of the bar; may be empty
  bool may_be_read_again = false;  ///< else a recording's memory goes to whoever reads it
  bool wants_page = true;

  std::vector<Note> notes{};  ///< what would be shown on standard error
  std::string text{}, json{}, html{};
  /// What would be written to a file of this name: the series of --output, and what goes with it.
  std::vector<std::pair<std::string, Recording>> series{};
  std::vector<std::pair<std::string, std::string>> texts{};
};

}  // namespace proofmass::app
