#include "proofmass/serve/bench.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sys/stat.h>

#include "proofmass/core/version.hpp"
#include "proofmass/serve/bench_parts.hpp"
#include "proofmass/serve/live/bench.hpp"

namespace proofmass::serve {

Response json_response(const Json& json, unsigned status) {
  return {status, json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

const char* name_of(JobState state) {
  switch (state) {
    case JobState::waiting:
      return "waiting";
    case JobState::running:
      return "running";
    case JobState::done:
      return "done";
    case JobState::failed:
      return "failed";
    case JobState::cancelled:
      break;
  }
  return "cancelled";
}

std::string why_it_failed(const JobStatus& status) {
  constexpr std::string_view prefix = "proofmass: ";
  if (status.end.signal != 0)
    return fmt::format("it crashed: {} (signal {})", ::strsignal(status.end.signal),
                       status.end.signal);
  if (status.messages.empty()) return fmt::format("it ended with status {}", status.end.status);
  const std::string& last = status.messages.back();
  return last.starts_with(prefix) ? last.substr(prefix.size()) : last;
}

ChildCommand BenchShared::command(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), options.program);
  return {std::move(arguments), options.folder.path(), options.environment};
}

Result<std::string> BenchShared::make_folder(const std::string& name) const {
  std::string path = options.work_folder + "/" + name;
  constexpr mode_t for_me_alone = 0700;
  if (::mkdir(path.c_str(), for_me_alone) != 0)
    return Error{Errc::unwritable, fmt::format("{}: {}", path, std::strerror(errno))};
  return path;
}

struct Bench::State {
  explicit State(BenchOptions options)
      : shared(std::move(options)),
        recordings(shared),
        views(shared),
        analyses(shared),
        live(shared) {}

  [[nodiscard]] Response get(const Request& request) {
    const std::string& path = request.target.path;
    const std::string file = request.target.find("file").value_or("");
    if (path == "/api/info") return info();
    if (path == "/api/verbs") return {200, shared.options.verbs_json};
    if (path == "/api/recordings") return recordings.list();
    if (path == "/api/recording") return recordings.details(file);
    if (path == "/api/view") return views.state(file);
    if (path == "/api/view/window") return views.window(file, request.target);
    if (path == "/api/view/figures") return views.figures(file, request.target);
    if (path == "/api/view/noise") return views.noise(file, request.target);
    if (path == "/api/analyses") return analyses.list();
    if (path == "/api/live") return live.list();
    if (path == "/api/live/found") return live.find();
    constexpr std::string_view files = "/api/files/";
    if (path.starts_with(files)) return whole_file(path.substr(files.size()));
    return error_response(404, "no such thing");
  }

  /// For the browser to save, never to show.
  [[nodiscard]] Response whole_file(const std::string& asked) const {
    constexpr std::uintmax_t most_bytes = std::uintmax_t{64} << 20;
    const Folder& folder = shared.options.folder;
    const auto name = folder.existing(asked);
    if (!name) return error_response(404, name.error().message);
    const std::filesystem::path path = std::filesystem::path(folder.path()) / *name;
    std::error_code failed;
    if (std::filesystem::file_size(path, failed) > most_bytes || failed)
      return error_response(413, *name + ": too large to be handed out here");
    std::ifstream in(path, std::ios::binary);
    return {200, std::string(std::istreambuf_iterator<char>(in), {}), "application/octet-stream",
            path.filename().string()};
  }

  [[nodiscard]] Response info() const {
    const Folder& folder = shared.options.folder;
    return json_response({{"version", std::string(version())},
                          {"folder", folder.path()},
                          {"only", folder.only()},
                          {"source", watched ? Json(*watched) : Json()}});
  }

  [[nodiscard]] Response add_file(const Request& request, std::string_view prefix) const {
    const std::string name = request.target.path.substr(prefix.size());
    constexpr mode_t as_others = 0644;  // a temporary file is for its owner alone
    ::chmod(request.body_path.c_str(), as_others);
    const auto adopted = shared.options.folder.adopt(request.body_path, name);
    if (!adopted) return error_response(400, adopted.error().message);
    return json_response({{"name", *adopted}}, 201);
  }

  BenchShared shared;
  RecordingList recordings;
  OpenViews views;
  Analyses analyses;
  LiveBench live;
  std::optional<std::uint64_t> watched{};  ///< number of the source of watch()
};

Bench::Bench(BenchOptions options) : state_(std::make_unique<State>(std::move(options))) {}
Bench::~Bench() = default;

Status Bench::watch(const std::string& source, const std::string& estimate) {
  nlohmann::json options = nlohmann::json::object();
  if (!estimate.empty()) options["estimate"] = estimate;
  const auto id = state_->live.start({{"source", source}, {"file", nullptr}, {"options", options}});
  if (!id) return id.error();
  state_->watched = *id;
  return Done{};
}

Response Bench::answer(const Request& request) {
  constexpr std::string_view analyses = "/api/analyses", files = "/api/files/", live = "/api/live";
  const std::string& path = request.target.path;
  if (path.starts_with(fmt::format("{}/", analyses)))
    return state_->analyses.one(request.method, path.substr(analyses.size() + 1));
  if (path.starts_with(fmt::format("{}/", live)) && path != "/api/live/found")
    return state_->live.one(request.method, path.substr(live.size() + 1));
  if (request.method == "GET") return state_->get(request);
  if (request.method == "POST" && path == live) return state_->live.begin(request.body);
  if (request.method == "POST" && path == analyses) return state_->analyses.begin(request.body);
  if (request.method == "PUT" && path.starts_with(files)) return state_->add_file(request, files);
  return error_response(404, "no such thing");
}

Status Bench::take(const std::shared_ptr<LiveListener>& from, std::string_view message) {
  return state_->live.take(from, message);
}

void Bench::end_live() {
  state_->live.end_all();
}

}  // namespace proofmass::serve
