#include "proofmass/serve/live/arguments.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include "proofmass/core/utf8.hpp"

namespace proofmass::serve {
namespace {

namespace fs = std::filesystem;

Error bad(std::string what) {
  return {Errc::invalid_argument, std::move(what)};
}

bool is_printable(std::string_view text) {
  return is_utf8(text) &&
         std::ranges::none_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

// What a source reads from the disk must lie in the folder. An escape could hide a name.
Status check_source(const std::string& source, const Folder& folder) {
  constexpr std::size_t longest = 1000;
  constexpr std::string_view replay = "replay:";
  if (source.empty() || source.size() > longest || source.front() == '-' || !is_printable(source) ||
      source.find(':') == std::string::npos)
    return bad("expected a source such as sim:wheel");
  if (source.starts_with("stdin")) return bad("serve has no standard input to record from");
  if (source.starts_with(replay)) {
    const std::string path = source.substr(replay.size(), source.find('?') - replay.size());
    if (path.find('%') != std::string::npos) return bad("replay: expected a name without %");
    if (const auto inside = folder.existing(path); !inside) return inside.error();
  }
  const std::size_t query = std::min(source.find('?'), source.size());
  const std::string settings = source.substr(query);
  if (source.starts_with("sim:") &&
      (settings.find("file") != std::string::npos || settings.find('%') != std::string::npos))
    return bad("sim: a description file is not taken here");
  return Done{};
}

// What a browser starts sends to a reader on this machine alone.
bool is_on_this_machine(std::string_view address) {
  for (const std::string_view host : {"udp:127.0.0.1:", "udp:localhost:"}) {
    if (!address.starts_with(host)) continue;
    const std::string_view port = address.substr(host.size());
    return !port.empty() && port.find_first_not_of("0123456789") == std::string_view::npos;
  }
  return false;
}

// "sim-20261122-123005.mcap"
std::string default_file(const std::string& source) {
  return fmt::format("{}-{:%Y%m%d-%H%M%S}.mcap", source.substr(0, source.find(':')),
                     fmt::localtime(std::time(nullptr)));
}

Status check_new(const std::string& name, const Folder& folder) {
  constexpr std::size_t longest = 200;
  if (!folder.only().empty()) return bad("only one file is served: nothing can be recorded here");
  if (name.empty() || name.size() > longest || name.front() == '.' || name.front() == '-' ||
      !is_printable(name) || name.find('/') != std::string::npos)
    return bad("expected the name of a file, without a path");
  std::error_code failed;
  const fs::path path = fs::path(folder.path()) / name;
  if (fs::symlink_status(path, failed).type() != fs::file_type::not_found)
    return bad(name + ": is there already; choose another name");
  return Done{};
}

Status add_live_option(const std::string& name,
                       const nlohmann::json& value,
                       const Folder& folder,
                       std::vector<std::string>& arguments) {
  constexpr std::array<std::string_view, 13> known{
      "rate",     "unit",      "estimate",  "radius",     "bandwidth", "lag",    "axis",
      "duration", "procedure", "positions", "target-std", "minutes",   "send-to"};
  const bool is_known = std::ranges::find(known, name) != known.end();
  if (!is_known && name != "sensor") return bad("record has no option " + name + " here");
  std::string word = value.is_string() ? value.get<std::string>() : "";
  if (value.is_number()) word = value.dump();
  if (word.empty() || !is_printable(word)) return bad(name + ": expected a text or a number");
  if (name == "send-to" && !is_on_this_machine(word))
    return bad("send-to: expected udp:127.0.0.1:PORT; record --send-to reaches other machines");
  if (name == "sensor") {
    const auto inside = folder.existing(word);
    if (!inside) return inside.error().at("sensor");
    word = *inside;
  }
  arguments.push_back(fmt::format("--{}={}", name, word));
  return Done{};
}

Status add_file(const nlohmann::json& asked, const Folder& folder, LiveArguments& out) {
  const auto file = asked.find("file");
  if (file == asked.end() || file->is_null()) {
    out.arguments.emplace_back("--no-file");
    return Done{};
  }
  if (!file->is_string()) return bad("file: expected a name, or null");
  out.file = file->get<std::string>();
  if (out.file.empty()) out.file = default_file(out.source);
  if (!out.file.ends_with(".mcap")) out.file += ".mcap";
  out.arguments.push_back("--output=" + out.file);
  return check_new(out.file, folder);
}

Status add_results(const Folder& folder, LiveArguments& out) {
  if (out.file.empty()) return bad("a procedure needs a file: its samples are analysed at the end");
  out.sensor_file = fs::path(out.file).replace_extension("toml").string();
  out.certificate = fs::path(out.file).replace_extension("html").string();
  for (const std::string& name : {out.sensor_file, out.certificate})
    if (const Status is_new = check_new(name, folder); !is_new) return is_new.error();
  out.arguments.push_back("--update-sensor=" + out.sensor_file);
  out.arguments.push_back("--report=" + out.certificate);
  return Done{};
}

}  // namespace

Result<LiveArguments> live_arguments(const nlohmann::json& asked, const Folder& folder) {
  if (!asked.is_object() || !asked.contains("source") || !asked["source"].is_string())
    return bad("expected {source, file, options}");
  LiveArguments out{.source = asked["source"].get<std::string>(),
                    .file = {},
                    .sensor_file = {},
                    .certificate = {},
                    .arguments = {"record"}};
  if (const Status s = check_source(out.source, folder); !s) return s.error();
  out.arguments.push_back(out.source);
  if (const Status s = add_file(asked, folder, out); !s) return s.error();
  const auto options = asked.value("options", nlohmann::json::object());
  if (!options.is_object()) return bad("options: expected an object");
  for (const auto& [name, value] : options.items())
    if (const Status s = add_live_option(name, value, folder, out.arguments); !s) return s.error();
  const auto procedure = options.find("procedure");
  if (procedure != options.end() && *procedure != "static")
    if (const Status s = add_results(folder, out); !s) return s.error();
  return out;
}

}  // namespace proofmass::serve
