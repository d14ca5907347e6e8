#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

// Flags common to several verbs.
namespace proofmass::app {

struct Host;

/// Flags of every verb that reads recordings.
struct InputFlags {
  std::optional<double> rate_hz;
  std::string unit;
  std::vector<std::string> channels, variables;
  std::string time;
  std::optional<double> from_s, to_s;
  std::vector<std::string> sensors;
  std::optional<double> supply_v;
  std::optional<double> resample_hz, skew_s;
  std::string resample_method = "sinc";
  double memory_mb = 1024.0;  ///< for verbs that read larger tables in pieces
  std::optional<double> gravity_mps2, latitude_deg, height_m;
  /// Time between power-on and the file's first sample; for verbs with a warm-up model.
  std::optional<double> since_switch_on_s;
  std::shared_ptr<Host> host{};  ///< null: recordings are files
};

class Invocation;

/// Flags of every verb.
struct OutputFlags {
  std::string json, report, page, output;
  bool quiet = false, verbose = false, strict = false;
  std::shared_ptr<Invocation> invocation{};  ///< present if a document or a page was requested
  std::shared_ptr<Host> host{};              ///< null: results go to files and the terminal
};

}  // namespace proofmass::app
