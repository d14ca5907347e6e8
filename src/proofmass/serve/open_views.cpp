#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>

#include "proofmass/serve/analysis_arguments.hpp"
#include "proofmass/serve/bench_parts.hpp"
#include "proofmass/serve/live/json_numbers.hpp"
#include "proofmass/serve/view/stretch_noise.hpp"

namespace proofmass::serve {
namespace {

std::optional<double> number_in(const Target& target, std::string_view name) {
  const std::string text = target.find(name).value_or("");
  double value = 0.0;
  const auto [stop, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc() || stop != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::optional<Stretch> stretch_in(const Target& target) {
  const auto from = number_in(target, "from"), to = number_in(target, "to");
  if (!from || !to || !(*from < *to)) return std::nullopt;
  return Stretch{*from, *to};
}

Response window_response(const ViewWindow& window) {
  constexpr int time_digits = 12, value_digits = 8;
  std::string text = window.are_samples ? "{\"samples\":true,\"t\":" : "{\"samples\":false,\"t\":";
  append_numbers(text, window.time_s, time_digits);
  text += ",\"min\":";
  append_lists(text, window.min, value_digits);
  text += ",\"max\":";
  append_lists(text, window.max, value_digits);
  return {200, text + "}"};
}

FolderEntry entry_now(const BenchShared& shared, const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(shared.options.folder.path()) / name;
  std::error_code failed;
  FolderEntry entry{name};
  entry.bytes = std::filesystem::file_size(path, failed);
  const auto modified = std::filesystem::last_write_time(path, failed).time_since_epoch();
  entry.modified_s = std::chrono::duration_cast<std::chrono::seconds>(modified).count();
  return entry;
}

Json pyramid_head(const io::Pyramid& pyramid) {
  Json channels = Json::array();
  for (std::size_t k = 0; k < pyramid.names.size(); ++k)
    channels.push_back({{"name", pyramid.names[k]}, {"unit", pyramid.units[k]}});
  return {{"samples", pyramid.samples}, {"end_s", pyramid.end_s}, {"channels", channels}};
}

Json head_of(const std::string& folder) {
  std::ifstream in(folder + "/head.json");
  return Json::parse(in, nullptr, false);
}

}  // namespace

Result<OpenViews::View> OpenViews::view_of(const std::string& asked) {
  auto name = shared_.options.folder.existing(asked);
  if (!name) return name.error();
  const FolderEntry entry = entry_now(shared_, *name);
  const std::lock_guard lock(mutex_);
  auto found = std::ranges::find(views_, *name, &View::name);
  if (found != views_.end() && found->entry != entry) {
    shared_.jobs.forget(found->job);
    views_.erase(found);
    found = views_.end();
  }
  if (found == views_.end()) {
    constexpr std::size_t most = 4;
    if (views_.size() >= most) {
      shared_.jobs.forget(views_.front().job);
      std::error_code ignored;
      std::filesystem::remove_all(views_.front().folder, ignored);
      views_.erase(views_.begin());
    }
    auto folder = shared_.make_folder(fmt::format("view-{}", ++last_));
    if (!folder) return folder.error();
    View view{.name = *name, .entry = entry, .folder = std::move(folder).value()};
    view.job = shared_.jobs.add(shared_.command({"__view", plain_argument(*name), view.folder}),
                                JobUrgency::asked);
    if (auto stored = io::read_pyramid(shared_.options.folder.path() + "/" + *name))
      view.stored = std::make_shared<const io::Pyramid>(std::move(stored).value());
    views_.push_back(std::move(view));
    return views_.back();
  }
  std::rotate(found, found + 1, views_.end());
  View& view = views_.back();
  const auto status = shared_.jobs.status(view.job);
  if (!view.file && status && status->state == JobState::done) {
    auto file = ViewFile::open(view.folder);
    if (!file) return file.error();
    view.file = std::make_shared<const ViewFile>(std::move(file).value());
  }
  return view;
}

Result<std::shared_ptr<const ViewFile>> OpenViews::complete(const std::string& name) {
  auto view = view_of(name);
  if (!view) return view.error();
  if (!view->file) return Error{Errc::too_few_samples, "the recording is still being read"};
  return view->file;
}

Response OpenViews::state(const std::string& name) {
  const auto view = view_of(name);
  if (!view) return error_response(404, view.error().message);
  const JobStatus status = shared_.jobs.status(view->job).value_or(JobStatus{});
  Json json{{"state", view->file ? "done" : name_of(status.state)},
            {"fraction", status.fraction},
            {"stage", status.stage},
            {"error", status.state == JobState::failed ? Json(why_it_failed(status)) : Json()},
            {"head", nullptr}};
  if (view->file)
    json["head"] = head_of(view->folder);
  else if (view->stored)
    json["head"] = pyramid_head(*view->stored);
  return json_response(json);
}

Response OpenViews::window(const std::string& name, const Target& target) {
  constexpr double most_pixels = 8000.0;
  const auto stretch = stretch_in(target);
  const auto pixels = number_in(target, "pixels");
  if (!stretch || !pixels || *pixels < 1.0 || *pixels > most_pixels)
    return error_response(400, "expected from below to, and 1 to 8000 pixels");
  const auto view = view_of(name);
  if (!view) return error_response(404, view.error().message);
  const auto width = static_cast<std::size_t>(*pixels);
  if (view->file) return window_response(view->file->window(*stretch, width));
  if (view->stored) return window_response(pyramid_window(*view->stored, *stretch, width));
  return error_response(409, "the recording is still being read");
}

Response OpenViews::figures(const std::string& name, const Target& target) {
  const auto stretch = stretch_in(target);
  if (!stretch) return error_response(400, "expected from below to");
  const auto file = complete(name);
  if (!file) return error_response(409, file.error().message);
  Json channels = Json::array();
  for (const StretchFigures& one : (*file)->figures(*stretch))
    channels.push_back({{"count", one.count},
                        {"mean", one.mean},
                        {"rms", one.rms},
                        {"std", one.std},
                        {"min", one.min},
                        {"max", one.max}});
  return json_response({{"channels", channels}});
}

Response OpenViews::noise(const std::string& name, const Target& target) {
  const auto stretch = stretch_in(target);
  const auto channel = number_in(target, "channel");
  if (!stretch || !channel || *channel < 0.0 || *channel > 10'000.0)
    return error_response(400, "expected from below to, and a channel");
  const auto file = complete(name);
  if (!file) return error_response(409, file.error().message);
  const auto cut = (*file)->cut(*stretch, static_cast<std::size_t>(*channel), most_stretch_samples);
  if (!cut) return error_response(422, cut.error().message);
  auto page = stretch_noise(*cut);
  if (!page) return error_response(422, page.error().message);
  return {200, std::move(page).value()};
}

}  // namespace proofmass::serve
