#pragma once

#include <string>
#include <vector>

namespace proofmass::app {

struct WrittenFile {
  std::string flag, path;
};

/// Files named on a command line.
struct Files {
  std::vector<std::string> read;
  std::vector<std::string> sensors;  ///< also read
  std::vector<WrittenFile> written;

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

/// Files that a command reads and writes: each command has some of these members.
template <class C>
[[nodiscard]] Files files_of(const C& command) {
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
  if constexpr (requires { command.named.right; }) {
    files.add_read(command.named.right);
    files.add_read(command.named.left);
    files.add_read(command.named.frame);
    files.add_read(command.named.gnss);
  }
  if constexpr (requires { command.input; }) files.sensors = command.input.sensors;
  if constexpr (requires { command.sensors; }) files.sensors = command.sensors;
  files.add_written("-o", command.output.output);
  files.add_written("--json", command.output.json);
  files.add_written("--report", command.output.report);
  files.add_written("--page", command.output.page);
  if constexpr (requires { command.geojson; }) files.add_written("--geojson", command.geojson);
  if constexpr (requires { command.update_sensor; })
    files.add_written("--update-sensor", command.update_sensor);
  return files;
}

/// Throws Failure (usage) if an output is also an input (a recording, one in a folder of
/// recordings, a list, a sensor file) or another output. Files are compared by identity, regardless
/// of links and relative paths. --update-sensor may name the file of --sensor.
void hold_apart(const Files& files);

}  // namespace proofmass::app
