#include "proofmass/acquire/recover.hpp"

#include <filesystem>

#include "console.hpp"
#include "exit_status.hpp"
#include "output.hpp"
#include "proofmass/report/record_report.hpp"
#include "verbs.hpp"

namespace proofmass::app {
namespace {

// "run.mcap.part" → "run.mcap", "run.mcap" → "run.recovered.mcap".
std::string recovered_name(const std::string& file) {
  const std::filesystem::path path(file);
  if (path.extension() == ".part") return std::filesystem::path(path).replace_extension().string();
  return (path.parent_path() / (path.stem().string() + ".recovered" + path.extension().string()))
      .string();
}

}  // namespace

void run(const RecoverCommand& command) {
  report::RecoverReport report;
  report.input = command.file;
  const std::string to =
      command.output.output.empty() ? recovered_name(command.file) : command.output.output;
  if (std::filesystem::exists(to))
    throw Failure(usage, to + " is there already: name another with --output");
  without_interruption([&] {
    report.recovery =
        need(acquire::recover(command.file, to, progress_bar(command.output)), Stage::reading);
  });
  publish({.text = [&] { return report::recover_text(report); },
           .json = [&] { return report::recover_json(report); },
           .html = {}},
          command.output);
  hold_to_strict(command.output, !report.recovery.was_whole);
}

}  // namespace proofmass::app
