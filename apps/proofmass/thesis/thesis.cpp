#include <algorithm>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/input.hpp"
#include "proofmass/thesis/thesis_report.hpp"
#include "thesis/command.hpp"
#include "thesis/recordings.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

void add_recording_flags(CLI::App& verb, ThesisCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--static", command.still, "FILE",
      "your own static recording from power-on (default: simulated)");
  CLI::Option* tumble =
      add("--tumble", command.tumble, "FILE",
          "your own positions, or a recording with a rest in each (default: simulated)");
  add("--angles", command.angles_deg, "DEG,…",
      "angle of each rest of that recording, in order: \"0,90,180,270,0\"")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(finite())
      ->needs(tumble);
  add("--wheel", command.wheels, "FILE",
      "your own recordings of the turning wheel, one for each speed (default: simulated)");
  add("--radius", command.radius_m, "M", "distance of your sensors from the axle, if known")
      ->check(positive());
}

void add_thesis_flags(CLI::App& verb, ThesisCommand& command) {
  add_recording_flags(verb, command);
  verb.add_option("--runs", command.runs, "simulated runs at each speed, for the bands")
      ->type_name("N")
      ->check(number("a whole number from 2 to 1000",
                     [](double x) { return x >= 2.0 && x <= 1000.0 && x == std::floor(x); }))
      ->capture_default_str();
  verb.add_option("--static-hours", command.static_hours, "duration of the simulated static test")
      ->type_name("H")
      ->check(number("hours from 0.1 to 24", [](double x) { return x >= 0.1 && x <= 24.0; }))
      ->capture_default_str();
  verb.add_option("--seed", command.seed, "seed of the random numbers")
      ->type_name("N")
      ->check(not_negative())
      ->capture_default_str();
  add_input_flags(verb, command.input);
  add_switch_on_flag(verb, command.input,
                     "time since power-on at the first sample of each recording (default 0 for "
                     "--static; for --wheel it removes the warm-up drift in the --sensor file)");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass thesis --report thesis.html\n"
      "  proofmass thesis --wheel 11rpm.csv 21rpm.csv --radius 0.1 --json -");
}

constexpr double s_per_h = 3600.0;

std::vector<std::string> files_of(const ThesisCommand& command) {
  std::vector<std::string> files;
  if (!command.still.empty()) files.push_back(command.still);
  if (!command.tumble.empty()) files.push_back(command.tumble);
  files.insert(files.end(), command.wheels.begin(), command.wheels.end());
  if (std::ranges::count(files, "-") > 1)
    throw Failure(usage, "standard input can be one recording only: name files");
  return files;
}

void run_thesis(const ThesisCommand& command) {
  thesis::ThesisReport report;
  report.inputs = files_of(command);
  report.seed = command.seed;
  report.runs = command.runs;
  const thesis::OwnRecordings own = own_recordings(command, report.notes);
  report.programme =
      need(thesis::run_programme(own, {.seed = command.seed,
                                       .seeds = command.runs,
                                       .static_duration_s = s_per_h * command.static_hours,
                                       .gravity_mps2 = gravity_mps2(command.input),
                                       .progress = progress_bar(command.output)}),
           Stage::computing);
  finish(thesis::describe(report), {}, command.output);
}

}  // namespace

Verb thesis_verb() {
  return make_verb<ThesisCommand>({.name = "thesis",
                                   .group = "Study",
                                   .help = "every table and figure of the thesis compared with "
                                           "ours, simulated or from your own rig"},
                                  add_thesis_flags, run_thesis);
}

}  // namespace proofmass::app
