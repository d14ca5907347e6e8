#include "proofmass/fleet/entry_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace proofmass::fleet {
namespace {

using Json = nlohmann::ordered_json;

Json columns_json(const ManifestFields& columns) {
  Json object = Json::object();
  for (const auto& [name, value] : columns) object[name] = value;
  return object;
}

Json rows_json(const std::vector<Row>& rows) {
  Json list = Json::array();
  for (const Row& row : rows) {
    Json object = Json::object();
    for (const auto& [name, cell] : row) {
      if (const auto* figure = std::get_if<double>(&cell)) object[name] = *figure;
      if (const auto* text = std::get_if<std::string>(&cell)) object[name] = *text;
    }
    list.push_back(std::move(object));
  }
  return list;
}

std::vector<Row> rows_of(const Json& list) {
  std::vector<Row> rows;
  for (const Json& object : list) {
    Row& row = rows.emplace_back();
    for (const auto& [name, value] : object.items()) {
      if (value.is_number()) row.emplace_back(name, value.get<double>());
      if (value.is_string()) row.emplace_back(name, value.get<std::string>());
    }
  }
  return rows;
}

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string line_of(const Entry& entry) {
  Json inputs = Json::array();
  for (const InputSum& input : entry.inputs)
    inputs.push_back({{"path", input.path}, {"sha256", input.sha256}});
  // The first two are what id_of_line() and ended_of_line() look for.
  return dumped(Json{{"id", entry.id()},
                     {"ended_s", entry.ended_s},
                     {"verb", entry.verb},
                     {"path", entry.path},
                     {"own_flags", entry.own_flags},
                     {"flags", entry.flags},
                     {"columns", columns_json(entry.columns)},
                     {"parts", entry.parts},
                     {"inputs", std::move(inputs)},
                     {"version", entry.version},
                     {"commit", entry.commit},
                     {"seconds", entry.seconds},
                     {"document", entry.document},
                     {"report", entry.report},
                     {"failure", entry.failure},
                     {"is_lasting", entry.is_lasting},
                     {"rows", rows_json(entry.rows)}});
}

std::optional<Entry> entry_of_line(std::string_view line) {
  try {
    const Json json = Json::parse(line);
    Entry entry;
    json.at("verb").get_to(entry.verb);
    json.at("path").get_to(entry.path);
    json.at("own_flags").get_to(entry.own_flags);
    json.at("flags").get_to(entry.flags);
    for (const auto& [name, value] : json.at("columns").items())
      entry.columns.emplace_back(name, value.get<std::string>());
    json.at("parts").get_to(entry.parts);
    for (const Json& input : json.at("inputs"))
      entry.inputs.push_back({input.at("path"), input.at("sha256")});
    json.at("version").get_to(entry.version);
    json.at("commit").get_to(entry.commit);
    json.at("ended_s").get_to(entry.ended_s);
    json.at("seconds").get_to(entry.seconds);
    json.at("document").get_to(entry.document);
    json.at("report").get_to(entry.report);
    json.at("failure").get_to(entry.failure);
    json.at("is_lasting").get_to(entry.is_lasting);
    entry.rows = rows_of(json.at("rows"));
    return entry;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

// The line begins {"id":"…","ended_s":…,
std::optional<std::string> id_of_line(std::string_view line) {
  constexpr std::string_view begin = "{\"id\":", end = ",\"ended_s\":";
  const std::size_t at = line.find(end);
  if (!line.starts_with(begin) || at == std::string_view::npos || !line.ends_with('}'))
    return std::nullopt;
  const Json id = Json::parse(line.substr(begin.size(), at - begin.size()), nullptr, false);
  return id.is_string() ? std::optional(id.get<std::string>()) : std::nullopt;
}

double ended_of_line(std::string_view line) {
  constexpr std::string_view key = ",\"ended_s\":";
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return 0.0;
  const std::string_view rest = line.substr(at + key.size());
  const Json figure = Json::parse(rest.substr(0, rest.find(',')), nullptr, false);
  return figure.is_number() ? figure.get<double>() : 0.0;
}

std::string failure_line(const Entry& entry) {
  Json json{{"file", entry.path}, {"reason", entry.failure}, {"verb", entry.verb}};
  json["flags"] = entry.flags;
  for (const auto& [name, value] : entry.columns)
    if (!json.contains(name)) json[name] = value;
  return dumped(json);
}

}  // namespace proofmass::fleet
