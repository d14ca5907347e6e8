#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/report/provenance.hpp"

namespace proofmass::app {

/// How the program was called, and the sums of the files that were named, which are taken on a
/// thread of their own while the files are read: each comes from the disk once.
class Invocation {
 public:
  Invocation(std::string command,
             std::vector<std::pair<std::string, std::string>> options,
             std::vector<std::string> files);
  Invocation(const Invocation&) = delete;
  Invocation& operator=(const Invocation&) = delete;
  ~Invocation();

  /// Waits for the sums.
  [[nodiscard]] const report::Provenance& provenance();

 private:
  struct Sums;
  report::Provenance provenance_;
  std::unique_ptr<Sums> sums_;
};

/// Commit of the source that the program was built from; empty if unknown.
[[nodiscard]] std::string program_commit();

/// SHA-256 of a regular file in hexadecimal; empty where it cannot be read, and of anything else.
[[nodiscard]] std::string sha256_of(const std::string& path);

/// Words as a shell takes them.
[[nodiscard]] std::string quoted(const std::vector<std::string>& words);

}  // namespace proofmass::app
