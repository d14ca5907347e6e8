#include "proofmass/fleet/figures.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace proofmass::fleet {
namespace {

using Json = nlohmann::ordered_json;

// What is no figure of the recording, or has columns of its own.
constexpr std::array<std::string_view, 8> left_out{"proofmass", "verb",  "input",      "warnings",
                                                   "channels",  "notes", "provenance", "file"};

std::string text_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string joined(const std::string& prefix, std::string_view key) {
  if (key == "value" || key == "parameters") return prefix;
  return prefix.empty() ? std::string(key) : prefix + "_" + std::string(key);
}

bool holds_scalars(const Json& list) {
  constexpr std::size_t most = 12;
  return list.size() <= most && std::ranges::all_of(list, [](const Json& item) {
           return item.is_number() || item.is_null();
         });
}

void flatten(const Json& value, const std::string& name, Row& row);

void flatten_list(const Json& list, const std::string& name, Row& row) {
  if (list.empty() || !holds_scalars(list)) return;
  const bool is_interval = list.size() == 2 && name.find("interval") != std::string::npos;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string end = is_interval ? (k == 0 ? "lower" : "upper") : std::to_string(k + 1);
    flatten(list[k], name + "_" + end, row);
  }
}

void flatten(const Json& value, const std::string& name, Row& row) {
  if (value.is_object()) {
    for (const auto& [key, item] : value.items()) flatten(item, joined(name, key), row);
  } else if (value.is_array()) {
    flatten_list(value, name, row);
  } else if (value.is_boolean()) {
    row.emplace_back(name, value.get<bool>() ? 1.0 : 0.0);
  } else if (value.is_number()) {
    row.emplace_back(name, value.get<double>());
  } else if (value.is_string()) {
    row.emplace_back(name, value.get<std::string>());
  }
}

void flatten_body(const Json& object, Row& row) {
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(left_out, key) == left_out.end()) flatten(value, joined("", key), row);
}

std::vector<std::string> texts_in(const Json& document, const char* key) {
  std::vector<std::string> texts;
  const auto found = document.find(key);
  if (found == document.end() || !found->is_array()) return texts;
  for (const Json& item : *found)
    if (item.is_string()) texts.push_back(item.get<std::string>());
  return texts;
}

// Those that name the channel, and those that name no channel.
std::string reason_for(const std::string& channel,
                       const std::vector<std::string>& channels,
                       const std::vector<std::string>& warnings) {
  std::string reason;
  for (const std::string& warning : warnings) {
    const auto names = [&](const std::string& name) { return warning.starts_with(name + ":"); };
    const bool of_another = !names(channel) && std::ranges::any_of(channels, names);
    if (!of_another) reason += (reason.empty() ? "" : "; ") + warning;
  }
  return reason;
}

Row channel_row(const Json& channel,
                const Row& common,
                const std::vector<std::string>& channels,
                const std::vector<std::string>& warnings) {
  const std::string name = text_at(channel, "name");
  Row row{{"channel", name}};
  row.insert(row.end(), common.begin(), common.end());
  for (const auto& [key, value] : channel.items())
    if (key != "name") flatten(value, joined("", key), row);
  row.emplace_back("reason", reason_for(name, channels, warnings));
  return row;
}

void read_provenance(const Json& document, DocumentRows& found) {
  const auto provenance = document.find("provenance");
  if (provenance == document.end() || !provenance->is_object()) return;
  found.version = text_at(*provenance, "version");
  found.commit = text_at(*provenance, "commit");
  const auto inputs = provenance->find("inputs");
  if (inputs == provenance->end() || !inputs->is_array()) return;
  for (const Json& input : *inputs)
    found.inputs.push_back({text_at(input, "path"), text_at(input, "sha256")});
}

}  // namespace

Result<DocumentRows> rows_of_document(std::string_view text) {
  const Json document = Json::parse(text, nullptr, false);
  if (!document.is_object() || !document.contains("proofmass"))
    return Error{Errc::corrupt, "is not a document of Proofmass"};
  DocumentRows found;
  read_provenance(document, found);
  Row common;
  flatten_body(document, common);
  const std::vector<std::string> warnings = texts_in(document, "warnings");
  const auto channels = document.find("channels");
  if (channels == document.end() || !channels->is_array() || channels->empty()) {
    common.emplace_back("reason", reason_for("", {}, warnings));
    found.rows.push_back(std::move(common));
    return found;
  }
  std::vector<std::string> names;
  for (const Json& channel : *channels)
    if (channel.is_object()) names.push_back(text_at(channel, "name"));
  for (const Json& channel : *channels)
    if (channel.is_object()) found.rows.push_back(channel_row(channel, common, names, warnings));
  return found;
}

}  // namespace proofmass::fleet
