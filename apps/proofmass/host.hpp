#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::app {

/// Replaces files and terminal if a verb runs within another program: InputFlags::host provides its
/// recordings, OutputFlags::host receives its results.
struct Host {
  std::map<std::string, Recording> recordings{};      ///< by name, instead of files
  std::map<std::string, std::string> sensor_files{};  ///< text by name, instead of files
  Progress progress{};                                ///< instead of the progress bar; may be
                                                      ///< empty
  bool may_be_read_again = false;  ///< false: a recording is moved to its first reader
  bool wants_page = true;

  std::vector<Note> notes{};  ///< otherwise shown on standard error
  std::string text{}, json{}, html{};
  /// Series that would be written to a file: --output and its companions.
  std::vector<std::pair<std::string, Recording>> series{};
  std::vector<std::pair<std::string, std::string>> texts{};
};

}  // namespace proofmass::app
