#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"

namespace proofmass::app {

inline constexpr const char* fleet_name = "fleet";

/// Runs a verb on many recordings, or, as "summary", summarises their results.
struct FleetCommand {
  std::string verb;
  std::string manifest;            ///< a table or a folder of recordings; for `summary` the
                                   ///< results
  std::vector<std::string> flags;  ///< of the verb, as typed
  std::string into;
  std::optional<std::size_t> processes;
  std::optional<double> memory_mb, timeout_s;
  bool force = false, reports = false;
  std::string by;                   ///< column: recordings with one value are analysed as one
  std::string shard;                ///< "2/4"; empty: from the environment
  std::string dask, program;        ///< the scheduler's address; Proofmass on its workers
  std::vector<std::string> limits;  ///< for `summary`: "white<2e-3"
  double false_share = 0.05;        ///< for `summary`: expected fraction of false alarms among the
                                    ///< sensors reported as out of family
  OutputFlags output;
};

}  // namespace proofmass::app
