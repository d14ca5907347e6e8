#include "distinct_files.hpp"

#include <fmt/format.h>

#include "exit_status.hpp"
#include "proofmass/core/new_file.hpp"

namespace proofmass::app {
namespace {

struct Output {
  std::string flag, path;
};

struct Files {
  std::vector<std::string> read;
  std::vector<std::string> sensors;  ///< read, too
  std::vector<Output> written;

  void add_read(const std::string& path) {
    if (!path.empty() && path != "-") read.push_back(path);
  }
  void add_read(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) add_read(path);
  }
  void add_written(const std::string& flag, const std::string& path) {
    if (!path.empty() && path != "-") written.push_back({flag, path});
  }
};

/// What a command reads and writes: each has some of these members.
template <class C>
Files files_of(const C& command) {
  Files files;
  if constexpr (requires { command.file; }) files.add_read(command.file);
  if constexpr (requires { command.files; }) files.add_read(command.files);
  if constexpr (requires { command.fixes; }) files.add_read(command.fixes);
  if constexpr (requires { command.rests; }) files.add_read(command.rests);
  if constexpr (requires { command.rig; }) files.add_read(command.rig);
  if constexpr (requires { command.still; }) files.add_read(command.still);
  if constexpr (requires { command.tumble; }) files.add_read(command.tumble);
  if constexpr (requires { command.turns; }) files.add_read(command.turns);
  if constexpr (requires { command.validate; }) files.add_read(command.validate);
  if constexpr (requires { command.wheels; }) files.add_read(command.wheels);
  if constexpr (requires { command.input; }) files.sensors = command.input.sensors;
  if constexpr (requires { command.sensors; }) files.sensors = command.sensors;
  files.add_written("-o", command.output.output);
  files.add_written("--json", command.output.json);
  files.add_written("--report", command.output.report);
  if constexpr (requires { command.update_sensor; })
    files.add_written("--update-sensor", command.update_sensor);
  return files;
}

void hold_apart(const Files& files) {
  for (std::size_t k = 0; k < files.written.size(); ++k) {
    const auto& [flag, path] = files.written[k];
    const auto refuse_if_read = [&](const std::vector<std::string>& read) {
      for (const std::string& input : read)
        if (is_same_or_within(path, input))
          throw Failure(usage, fmt::format("{} {}: would replace the input {}: name another file",
                                           flag, path, input));
    };
    refuse_if_read(files.read);
    if (flag != "--update-sensor") refuse_if_read(files.sensors);
    for (std::size_t j = 0; j < k; ++j)
      if (is_same_or_within(path, files.written[j].path))
        throw Failure(usage, fmt::format("{} and {} both name {}: name two files",
                                         files.written[j].flag, flag, path));
  }
}

}  // namespace

void hold_apart(const Command& command) {
  std::visit([](const auto& chosen) { hold_apart(files_of(chosen)); }, command);
}

}  // namespace proofmass::app
