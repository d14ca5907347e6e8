#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/report/provenance.hpp"

namespace proofmass::app {

/// The call of the program and the checksums of the named files, which are computed in a separate
/// thread while the files are read, so that each comes from disk once.
class Invocation {
 public:
  Invocation(std::string command,
             std::vector<std::pair<std::string, std::string>> options,
             std::vector<std::string> files);
  Invocation(const Invocation&) = delete;
  Invocation& operator=(const Invocation&) = delete;
  ~Invocation();

  /// Waits for the checksums.
  [[nodiscard]] const report::Provenance& provenance();

  /// Replaces the named files by what they were made from.
  void set_inputs(std::vector<report::ProvenanceInput> inputs);

 private:
  struct Sums;
  report::Provenance provenance_;
  std::unique_ptr<Sums> sums_;
};

/// Commit of the source that the program was built from; empty if unknown.
[[nodiscard]] std::string program_commit();

/// SHA-256 of a regular file in hexadecimal; empty if it is not readable or not a regular file.
[[nodiscard]] std::string sha256_of(const std::string& path);

/// Words quoted for a shell.
[[nodiscard]] std::string quoted(const std::vector<std::string>& words);

}  // namespace proofmass::app
