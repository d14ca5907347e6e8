#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "proofmass/serve/analysis_arguments.hpp"
#include "proofmass/serve/bench_parts.hpp"

namespace proofmass::serve {
namespace {

struct ResultFile {
  std::string_view name, type;
};

constexpr std::array<ResultFile, 5> result_files{{{"result.json", "application/json"},
                                                  {"page.json", "application/json"},
                                                  {"report.html", "text/html; charset=utf-8"},
                                                  {"series.csv", "text/csv; charset=utf-8"},
                                                  {"sensor.toml", "application/toml"}}};

bool has_ended(JobState state) {
  return state != JobState::waiting && state != JobState::running;
}

}  // namespace

Analyses::Analyses(BenchShared& shared)
    : shared_(shared), verbs_(nlohmann::json::parse(shared.options.verbs_json)) {}

Response Analyses::list() {
  const std::lock_guard lock(mutex_);
  Json all = Json::array();
  for (const Analysis& analysis : analyses_) all.push_back(describe(analysis));
  return json_response({{"analyses", all}});
}

Response Analyses::begin(const std::string& body) {
  const nlohmann::json asked = nlohmann::json::parse(body, nullptr, false);
  if (asked.is_discarded()) return error_response(400, "expected JSON");
  auto checked = analysis_arguments(verbs_, asked, shared_.options.folder);
  if (!checked) return error_response(400, checked.error().message);
  const std::lock_guard lock(mutex_);
  forget_old();
  Analysis analysis{.id = ++last_,
                    .asked = {{"verb", checked->verb},
                              {"files", asked["files"]},
                              {"options", asked.value("options", nlohmann::json::object())}},
                    .command = shell_command(checked->arguments),
                    .folder = {}};
  auto folder = shared_.make_folder(fmt::format("analysis-{}", analysis.id));
  if (!folder) return error_response(507, folder.error().message);
  analysis.folder = std::move(folder).value();
  std::vector<std::string> arguments = checked->arguments;
  const auto into = [&](const char* flag, const char* name) {
    arguments.push_back(fmt::format("{}={}/{}", flag, analysis.folder, name));
  };
  into("--json", "result.json");
  if (checked->writes_page) {
    into("--page", "page.json");
    into("--report", "report.html");
  }
  if (checked->writes_series) into("--output", "series.csv");
  if (checked->writes_sensor_file) into("--update-sensor", "sensor.toml");
  analysis.job = shared_.jobs.add(shared_.command(std::move(arguments)), JobUrgency::asked);
  analyses_.push_back(std::move(analysis));
  return json_response({{"id", analyses_.back().id}}, 201);
}

void Analyses::forget_old() {
  constexpr std::size_t most = 100;
  while (analyses_.size() >= most) {
    const Analysis& oldest = analyses_.front();
    shared_.jobs.forget(oldest.job);
    std::error_code ignored;
    std::filesystem::remove_all(oldest.folder, ignored);
    analyses_.erase(analyses_.begin());
  }
}

Json Analyses::describe(const Analysis& analysis) const {
  const JobStatus status = shared_.jobs.status(analysis.job).value_or(JobStatus{});
  Json json = analysis.asked;
  json["id"] = analysis.id;
  json["command"] = analysis.command;
  json["state"] = name_of(status.state);
  json["fraction"] = status.fraction;
  json["stage"] = status.stage;
  json["seconds"] = status.seconds;
  json["messages"] = status.messages;
  json["error"] = status.state == JobState::failed ? Json(why_it_failed(status)) : Json();
  json["files_made"] = Json::array();
  if (has_ended(status.state))
    for (const ResultFile& one : result_files)
      if (std::filesystem::exists(analysis.folder + "/" + std::string(one.name)))
        json["files_made"].push_back(std::string(one.name));
  return json;
}

Response Analyses::file(const Analysis& analysis, const std::string& name) const {
  const auto known = std::ranges::find(result_files, name, &ResultFile::name);
  const auto status = shared_.jobs.status(analysis.job);
  if (known == result_files.end() || !status || !has_ended(status->state))
    return error_response(404, "no such result");
  std::ifstream in(analysis.folder + "/" + name, std::ios::binary);
  if (!in) return error_response(404, "no such result");
  return {200, std::string(std::istreambuf_iterator<char>(in), {}), std::string(known->type)};
}

Response Analyses::one(const std::string& method, const std::string& path) {
  std::uint64_t id = 0;
  const auto [stop, failed] = std::from_chars(path.data(), path.data() + path.size(), id);
  const std::string rest(stop, path.data() + path.size());
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(analyses_, id, &Analysis::id);
  if (failed != std::errc() || found == analyses_.end())
    return error_response(404, "no such analysis");
  if (method == "DELETE" && rest.empty()) {
    shared_.jobs.cancel(found->job);
    return json_response(describe(*found));
  }
  if (method != "GET") return error_response(405, "expected GET or DELETE");
  if (rest.empty()) return json_response(describe(*found));
  return file(*found, rest.substr(1));
}

}  // namespace proofmass::serve
