#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/serve/folder.hpp"
#include "proofmass/serve/http/request.hpp"
#include "proofmass/serve/live/frame.hpp"

namespace proofmass::serve {

struct BenchOptions {
  Folder folder;
  std::string program;                   ///< path of the proofmass that runs the verbs
  std::vector<std::string> environment;  ///< it has
  std::string work_folder;               ///< for results and views, until this goes
  std::string verbs_json;                ///< the table of verbs and their flags
  std::size_t jobs_at_a_time = 2;
};

/// What stands behind the page: the recordings of a folder, views of them, and analyses. Everything
/// that reads a file of unknown origin runs in a process of its own.
///
///     GET    /api/info                       {version, folder, only, source}
///     GET    /api/verbs                      verbs_json
///     GET    /api/recordings                 {recordings: [...], sensor_files: [...], left}
///     GET    /api/recording?file=            {json, page}: what `inspect` says
///     PUT    /api/files/NAME                 {name}: adds a file, never over another
///     GET    /api/files/NAME                 a file of up to 64 MiB
///     GET    /api/view?file=                 {state, fraction, stage, head}; opens it
///     GET    /api/view/window?file=&from=&to=&pixels=
///     GET    /api/view/figures?file=&from=&to=
///     GET    /api/view/noise?file=&from=&to=&channel=   the page of `noise` for this stretch
///     GET    /api/analyses                   {analyses: [...]}
///     POST   /api/analyses                   {verb, files, options} → {id}
///     GET    /api/analyses/ID                its state
///     DELETE /api/analyses/ID                cancels it
///     GET    /api/analyses/ID/result.json, page.json, report.html, series.csv, sensor.toml
///
///     GET    /api/live                       {sources: [...], free_bytes}
///     GET    /api/live/found                 what `record --list` finds
///     POST   /api/live                       {source, file, options} → {id}: starts a recorder
///     GET    /api/live/ID                    its state
///     DELETE /api/live/ID                    ends it; one that has ended is forgotten
///     POST   /api/live/ID/skip, repeat, quit answers to a procedure
///
/// Everything else is 404. Errors are {"error": text}.
class Bench {
 public:
  explicit Bench(BenchOptions options);
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  ~Bench();

  /// Starts a source that is watched and not recorded, and shown first on the page; `estimate` as
  /// of `record`, or empty. Errors: those of live_arguments(), device.
  [[nodiscard]] Status watch(const std::string& source, const std::string& estimate);
  /// May be called from several threads at once.
  [[nodiscard]] Response answer(const Request& request);
  /// A message of a WebSocket: which source it wants to see. Errors: invalid_argument.
  [[nodiscard]] Status take(const std::shared_ptr<LiveListener>& from, std::string_view message);
  /// Ends all recorders and waits until their files are closed; no listener is called afterwards.
  void end_live();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace proofmass::serve
