#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/serve/bench_parts.hpp"
#include "proofmass/serve/live/arguments.hpp"
#include "proofmass/serve/live/source.hpp"

namespace proofmass::serve {

/// The live sources of a Bench.
class LiveBench {
 public:
  explicit LiveBench(BenchShared& shared) : shared_(shared) {}

  [[nodiscard]] Response list();
  /// What `record --list` finds: looked for anew at each call, within some seconds.
  [[nodiscard]] Response find();
  [[nodiscard]] Response begin(const std::string& body);
  /// Starts a recorder of the source, file and options asked for; returns its number. Errors: those
  /// of live_arguments(), device (too many are running, or no process can be started).
  [[nodiscard]] Result<std::uint64_t> start(const nlohmann::json& asked);
  /// `path` is what follows /api/live/: "ID" or "ID/WORD".
  [[nodiscard]] Response one(const std::string& method, const std::string& path);
  /// A browser's message. Errors: invalid_argument.
  [[nodiscard]] Status take(const std::shared_ptr<LiveListener>& from, std::string_view message);
  /// See Bench::end_live().
  void end_all();

 private:
  struct Entry {
    std::uint64_t id = 0;
    LiveArguments asked;
    Json options;
    std::shared_ptr<LiveSource> source;
  };
  [[nodiscard]] Json describe(const Entry& entry) const;
  [[nodiscard]] Response end(const Entry& entry);
  void forget_ended();

  BenchShared& shared_;
  std::mutex mutex_;
  std::vector<Entry> entries_;
  std::uint64_t last_ = 0;
};

}  // namespace proofmass::serve
