#include "proofmass/serve/live/bench.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <thread>
#include <utility>

#include "proofmass/serve/live/request.hpp"

namespace proofmass::serve {
namespace {

constexpr std::size_t most_running = 8, most_listed_sources = 24;

const char* state_of(const LiveSource::Status& status) {
  if (!status.end)
    return status.stops ? "ending" : status.latest.contains("head") ? "running" : "opening";
  const bool was_stopped = status.end->signal == 0 && (status.end->status == 0 || status.stops);
  return was_stopped ? "ended" : "failed";
}

}  // namespace

Json LiveBench::describe(const Entry& entry) const {
  const LiveSource::Status status = entry.source->status();
  const std::string state = state_of(status);
  Json json{{"id", entry.id},
            {"source", entry.asked.source},
            {"file", entry.asked.file.empty() ? Json() : Json(entry.asked.file)},
            {"sensor_file", nullptr},
            {"certificate", nullptr},
            {"options", entry.options},
            {"state", state},
            {"error", nullptr},
            {"messages", status.messages}};
  const auto if_made = [&](const char* key, const std::string& name) {
    if (!name.empty() && shared_.options.folder.existing(name)) json[key] = name;
  };
  if (status.end) if_made("sensor_file", entry.asked.sensor_file);
  if (status.end) if_made("certificate", entry.asked.certificate);
  if (state == "failed")
    json["error"] = why_it_failed({.messages = status.messages, .end = *status.end});
  for (const char* kind : {"head", "state", "audit", "guide", "end"}) {
    const auto found = status.latest.find(kind);
    const std::string key = std::string("last_") + kind;
    json[key] = found == status.latest.end() ? Json() : Json::parse(found->second)[kind];
  }
  return json;
}

Response LiveBench::list() {
  const std::lock_guard lock(mutex_);
  Json all = Json::array();
  for (const Entry& entry : entries_) all.push_back(describe(entry));
  std::error_code failed;
  const auto space = std::filesystem::space(shared_.options.folder.path(), failed);
  return json_response({{"sources", all}, {"free_bytes", failed ? Json() : Json(space.available)}});
}

Response LiveBench::find() {
  constexpr std::chrono::milliseconds step{50};
  auto folder = shared_.make_folder(fmt::format("sources-{}", [&] {
    const std::lock_guard lock(mutex_);
    return ++last_;
  }()));
  if (!folder) return error_response(507, folder.error().message);
  const std::string file = *folder + "/sources.json";
  const auto job =
      shared_.jobs.add(shared_.command({"record", "--list", "--json=" + file}), JobUrgency::asked);
  auto status = shared_.jobs.status(job);
  while (status && (status->state == JobState::waiting || status->state == JobState::running)) {
    std::this_thread::sleep_for(step);
    status = shared_.jobs.status(job);
  }
  std::ifstream in(file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const std::string why = status ? why_it_failed(*status) : "it was cancelled";
  shared_.jobs.forget(job);
  std::error_code ignored;
  std::filesystem::remove_all(*folder, ignored);
  if (text.empty()) return error_response(500, "record --list: " + why);
  return {200, text};
}

Response LiveBench::begin(const std::string& body) {
  const nlohmann::json asked = nlohmann::json::parse(body, nullptr, false);
  if (asked.is_discarded()) return error_response(400, "expected JSON");
  const auto id = start(asked);
  if (!id) return error_response(id.error().code == Errc::device ? 409 : 400, id.error().message);
  return json_response({{"id", *id}}, 201);
}

Result<std::uint64_t> LiveBench::start(const nlohmann::json& asked) {
  auto checked = live_arguments(asked, shared_.options.folder);
  if (!checked) return checked.error();
  const std::lock_guard lock(mutex_);
  forget_ended();
  const auto running = std::ranges::count_if(
      entries_, [](const Entry& one) { return !one.source->status().end.has_value(); });
  if (running >= static_cast<std::ptrdiff_t>(most_running))
    return Error{Errc::device, fmt::format("{} sources are running: stop one", most_running)};
  std::vector<std::string> arguments = checked->arguments;
  arguments.emplace_back("--stream");
  ChildCommand command = shared_.command(std::move(arguments));
  // Closing a long recording, or the calibration at the end of a procedure.
  constexpr std::chrono::minutes patience{5};
  command.patience = patience;
  auto source = LiveSource::start(++last_, std::move(command));
  if (!source) return Error{Errc::device, source.error().message};
  entries_.push_back({last_, std::move(checked).value(),
                      asked.value("options", nlohmann::json::object()), std::move(source).value()});
  return last_;
}

/// The oldest of the sources that have ended.
void LiveBench::forget_ended() {
  while (entries_.size() >= most_listed_sources) {
    const auto oldest = std::ranges::find_if(
        entries_, [](const Entry& one) { return one.source->status().end.has_value(); });
    if (oldest == entries_.end()) return;
    entries_.erase(oldest);
  }
}

Response LiveBench::end(const Entry& entry) {
  if (entry.source->status().end) {
    std::erase_if(entries_, [id = entry.id](const Entry& one) { return one.id == id; });
    return json_response({{"forgotten", true}});
  }
  entry.source->stop();
  return json_response(describe(entry));
}

Response LiveBench::one(const std::string& method, const std::string& path) {
  std::uint64_t id = 0;
  const auto [stop, failed] = std::from_chars(path.data(), path.data() + path.size(), id);
  const std::string_view rest(stop, static_cast<std::size_t>(path.data() + path.size() - stop));
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(entries_, id, &Entry::id);
  if (failed != std::errc() || found == entries_.end())
    return error_response(404, "no such source");
  if (rest.empty() && method == "GET") return json_response(describe(*found));
  if (rest.empty() && method == "DELETE") return end(*found);
  // Answers to a procedure: leave this position out; once more the one that contradicts; end it.
  if (method == "POST" && (rest == "/skip" || rest == "/repeat" || rest == "/quit")) {
    if (!found->source->say(rest.substr(1))) return error_response(409, "the source has ended");
    return json_response(describe(*found));
  }
  return error_response(404, "no such thing");
}

Status LiveBench::take(const std::shared_ptr<LiveListener>& from, std::string_view message) {
  const auto request = parse_live_request(message);
  if (!request) return request.error();
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) entry.source->forget(from.get());
  const auto found = std::ranges::find(entries_, request->watch, &Entry::id);
  if (found != entries_.end()) found->source->listen(from);
  return Done{};
}

void LiveBench::end_all() {
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) entry.source->stop();
  entries_.clear();
}

}  // namespace proofmass::serve
