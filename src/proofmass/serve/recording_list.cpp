#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <optional>

#include "proofmass/core/units.hpp"
#include "proofmass/serve/analysis_arguments.hpp"
#include "proofmass/serve/bench_parts.hpp"

namespace proofmass::serve {
namespace {

constexpr std::size_t most_listed = 500;

const std::vector<std::string_view> recording_endings{
    ".csv",     ".tsv",    ".txt",    ".dat",    ".npy",     ".npz",    ".mat",
    ".h5",      ".hdf5",   ".mcap",   ".tdms",   ".lvm",     ".wav",    ".zip",
    ".parquet", ".xio",    ".csv.gz", ".csv.xz", ".csv.zst", ".txt.gz", ".txt.xz",
    ".dat.gz",  ".dat.xz", ".tsv.gz", ".tsv.xz", ".mat.xz",  ".npy.gz", ".npy.xz"};

Json read_json(const std::string& path) {
  std::ifstream in(path);
  return Json::parse(in, nullptr, false);
}

// The curve's smallest and largest value in each of so many columns, from its thinned points.
Json thumbnail_of(const Json& curve) {
  constexpr std::size_t columns = 86;
  const Json &x = curve.at("x"), &y = curve.at("y");
  double first = 0.0, last = 0.0;
  bool any = false;
  for (const Json& value : x) {
    if (!value.is_number()) continue;
    if (!any) first = value.get<double>();
    last = value.get<double>();
    any = true;
  }
  std::array<Json, columns> low, high;
  for (std::size_t k = 0; k < x.size() && k < y.size(); ++k) {
    if (!x[k].is_number() || !y[k].is_number()) continue;
    const double part = last > first ? (x[k].get<double>() - first) / (last - first) : 0.0;
    const auto column = static_cast<std::size_t>(std::clamp(part, 0.0, 1.0) * (columns - 1));
    const double value = y[k].get<double>();
    if (low[column].is_null() || value < low[column].get<double>()) low[column] = value;
    if (high[column].is_null() || value > high[column].get<double>()) high[column] = value;
  }
  return {{"min", low}, {"max", high}};
}

bool is_acceleration(const Json& channel) {
  const Json& symbol = channel.at("unit");  // null where none is known
  if (!symbol.is_string()) return false;
  const auto unit = parse_unit(symbol.get<std::string>());
  return unit && unit->quantity == Quantity::acceleration;
}

// The curve of that label among a section's plots; null if there is none.
Json curve_named(const Json& section, const std::string& label) {
  for (const Json& figure : section.at("figures"))
    for (const Json& curve : figure.at("curves"))
      if (curve.value("label", "") == label && curve.contains("y")) return curve;
  return {};
}

// The accelerations, or the first channels if there are none.
Json thumbnails_of(const Json& channels, const Json& page) {
  constexpr std::size_t most = 3;
  std::vector<std::size_t> wanted;
  for (std::size_t k = 0; k < channels.size() && wanted.size() < most; ++k)
    if (is_acceleration(channels[k])) wanted.push_back(k);
  if (wanted.empty())
    for (std::size_t k = 0; k < std::min(most, channels.size()); ++k) wanted.push_back(k);
  Json all = Json::array();
  for (const std::size_t k : wanted) {
    const Json curve = curve_named(page.at("sections").at(0), channels[k].at("name"));
    if (curve.is_null()) continue;
    all.push_back(thumbnail_of(curve));
    all.back()["channel"] = k;
  }
  return all;
}

// What the list shows.
Json summary_of(const Json& document, const Json& page) {
  std::uint64_t clipped = 0;
  Json channels = Json::array();
  for (const Json& channel : document.at("channels")) {
    clipped += channel.value("clipped", std::uint64_t{0});
    channels.push_back({{"name", channel.at("name")}, {"unit", channel.at("unit")}});
  }
  return {{"samples", document.at("samples")},
          {"duration_s", document.at("duration_s")},
          {"rate_hz", document.at("rate_hz")},
          {"format", document.at("format")},
          {"channels", channels},
          {"gaps", document.at("timing").at("gaps").size()},
          {"clipped", clipped},
          {"conclusion", page.at("conclusion")},
          {"notes", page.at("notes")},
          {"thumbnails", thumbnails_of(channels, page)}};
}

}  // namespace

RecordingList::Inspection& RecordingList::inspection_of(const FolderEntry& entry) {
  auto found = inspections_.find(entry.name);
  if (found != inspections_.end() && found->second.entry != entry) {
    shared_.jobs.forget(found->second.job);
    inspections_.erase(found);
    found = inspections_.end();
  }
  if (found != inspections_.end()) return found->second;
  Inspection made{.entry = entry, .folder = {}};
  if (auto folder = shared_.make_folder(fmt::format("inspection-{}", ++last_))) {
    made.folder = std::move(folder).value();
    made.job = shared_.jobs.add(shared_.command({"inspect", plain_argument(entry.name),
                                                 "--json=" + made.folder + "/result.json",
                                                 "--page=" + made.folder + "/page.json"}),
                                JobUrgency::background);
  }
  return inspections_.emplace(entry.name, std::move(made)).first->second;
}

Json RecordingList::describe(Inspection& inspection) {
  const JobStatus status = shared_.jobs.status(inspection.job).value_or(JobStatus{});
  Json json{{"name", inspection.entry.name},
            {"bytes", inspection.entry.bytes},
            {"modified_s", inspection.entry.modified_s},
            {"state", name_of(status.state)},
            {"error", status.state == JobState::failed ? Json(why_it_failed(status)) : Json()},
            {"summary", nullptr}};
  if (status.state == JobState::done && !inspection.summary) {
    try {
      inspection.summary = summary_of(read_json(inspection.folder + "/result.json"),
                                      read_json(inspection.folder + "/page.json"));
    } catch (const nlohmann::json::exception& wrong) {
      json["error"] = std::string("inspect: ") + wrong.what();
    }
  }
  if (inspection.summary) json["summary"] = *inspection.summary;
  return json;
}

Response RecordingList::list() {
  const Folder& folder = shared_.options.folder;
  const std::vector<FolderEntry> entries = folder.list(recording_endings, most_listed);
  const std::lock_guard lock(mutex_);
  Json recordings = Json::array(), sensor_files = Json::array();
  std::size_t left = 0;
  for (const FolderEntry& entry : entries) {
    if (entry.name.ends_with(".pyramid.npz")) continue;
    recordings.push_back(describe(inspection_of(entry)));
    const std::string state = recordings.back()["state"];
    if (state == "waiting" || state == "running") ++left;
  }
  for (const FolderEntry& entry : folder.list({".toml"}, most_listed))
    sensor_files.push_back(entry.name);
  return json_response(
      {{"recordings", recordings}, {"sensor_files", sensor_files}, {"left", left}});
}

Response RecordingList::details(const std::string& asked) {
  const auto name = shared_.options.folder.existing(asked);
  if (!name) return error_response(404, name.error().message);
  const std::lock_guard lock(mutex_);
  const auto found = inspections_.find(*name);
  if (found == inspections_.end()) return error_response(404, "not in the list");
  shared_.jobs.hurry(found->second.job);
  Json json = describe(found->second);
  json["json"] = nullptr;
  json["page"] = nullptr;
  if (found->second.summary) {
    json["json"] = read_json(found->second.folder + "/result.json");
    json["page"] = read_json(found->second.folder + "/page.json");
  }
  return json_response(json);
}

}  // namespace proofmass::serve
