#include "proofmass/acquire/recover.hpp"

#include <filesystem>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "proofmass/report/recover_report.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct RecoverCommand {
  std::string file;
  OutputFlags output;
};

void add_recover_flags(CLI::App& verb, RecoverCommand& command) {
  verb.add_option("FILE", command.file, "run.mcap.part, or any damaged MCAP file")
      ->type_name("")
      ->required();
  verb.add_option("-o,--output", command.output.output,
                  "the new file (default: run.mcap for run.mcap.part, else run.recovered.mcap)")
      ->type_name("FILE.mcap")
      ->group("Output");
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass recover run.mcap.part");
}

// "run.mcap.part" → "run.mcap", "run.mcap" → "run.recovered.mcap".
std::string recovered_name(const std::string& file) {
  const std::filesystem::path path(file);
  if (path.extension() == ".part") return std::filesystem::path(path).replace_extension().string();
  return (path.parent_path() / (path.stem().string() + ".recovered" + path.extension().string()))
      .string();
}

void run_recover(const RecoverCommand& command) {
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
  finish(report::describe(report), {}, command.output);
}

}  // namespace

Verb recover_verb() {
  return make_verb<RecoverCommand>({.name = "recover",
                                    .group = "Live",
                                    .help = "recover the intact part of an unclosed recording"},
                                   add_recover_flags, run_recover);
}

}  // namespace proofmass::app
