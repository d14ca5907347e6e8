#include "flags.hpp"
#include "verb_flags.hpp"

namespace proofmass::app {
namespace {

void add_procedure_flags(CLI::App& verb, SimulateCommand& command) {
  CLI::Option* procedure =
      verb.add_option("--procedure", command.procedure,
                      "instead of the rig a calibration: tumble, four-position, six-position or "
                      "multi-position; or a slide along a line");
  procedure->type_name("NAME")->check(
      CLI::IsMember({"tumble", "four-position", "six-position", "multi-position", "slide"}));
  const auto add = [&](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->needs(procedure)->group("Procedure");
  };
  add("--session", command.session, "N", "same sensor and table, other noise and hand")
      ->check(not_negative());
  add("--positions", command.positions, "N", "of tumble (default 24) or multi-position (24)");
  add("--dwell", command.dwell_s, "S", "in each position")->check(positive());
  add("--supply", command.supply_v, "V", "of the ratiometric sensor (default 3.3)")
      ->check(positive());
  add("--strokes", command.strokes, "N", "of a slide, each followed by a rest (default 6)");
  add("--repetitions", command.repetitions, "N", "of a slide: each stroke there and back so often");
  add("--length", command.length_m, "M", "of a slide's stroke (default 0.4)")->check(finite());
  add("--stroke-time", command.stroke_s, "S", "of a slide's stroke (default 1)")->check(positive());
  add("--elevation", command.elevation_deg, "DEG", "of a slide's line above the horizontal")
      ->check(finite());
  verb.add_flag("--gravity-removed", command.gravity_removed, "of a slide, as phones do")
      ->needs(procedure)
      ->group("Procedure");
  verb.add_flag("--gyro", command.gyro, "of a slide: channels of angular rate")
      ->needs(procedure)
      ->group("Procedure");
  add("--signal", command.signal, "KIND", "acceleration (default), voltage or counts")
      ->check(CLI::IsMember({"acceleration", "voltage", "counts"}));
}

}  // namespace

void add_flags(CLI::App& app, SimulateCommand& command) {
  CLI::App& verb =
      *app.add_subcommand("simulate", "the rig, a calibration or a slide as a digital twin");
  verb.add_option("RIG", command.rig, "description, TOML (default: the thesis's rig)")
      ->type_name("");
  verb.add_option("--seed", command.seed, "same seed, same numbers")
      ->type_name("N")
      ->check(not_negative());
  verb.add_option("--rpm", command.rpm, "turn at this speed throughout")
      ->type_name("RPM")
      ->check(finite());
  verb.add_option("--rate", command.rate_hz, "samples a second")
      ->type_name("HZ")
      ->check(positive());
  verb.add_option("--duration", command.duration_s, "length of the recording")
      ->type_name("S")
      ->check(positive());
  verb.add_option("--gravity", command.gravity_mps2, "local gravity (default 9.80665)")
      ->type_name("M_PER_S2")
      ->check(positive());
  verb.add_flag("--datasheet-errors", command.datasheet_errors,
                "misalignment, cross-axis, scale and nonlinearity as the datasheet allows");
  verb.add_option("--adc-bits", command.adc_bits, "of the converter")->type_name("N");
  verb.add_flag("--print-config", command.print_config, "print the description and stop");
  add_procedure_flags(verb, command);
  add_output_file(verb, command.output,
                  "the recording; the truth goes to FILE.truth.csv; - is standard output");
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n  proofmass simulate --rpm 15 --seed 7 -o rig.csv\n"
      "  proofmass simulate --procedure multi-position -o poses.csv\n"
      "  proofmass simulate --procedure slide --length 0.5 -o slide.csv");
}

void add_flags(CLI::App& app, BudgetCommand& command) {
  CLI::App& verb = *app.add_subcommand("budget", "position error against time for a sensor");
  CLI::Option* bias =
      verb.add_option("--bias-mg", command.bias_mg, "bias that is left; may be repeated");
  bias->type_name("MG")->delimiter(',')->allow_extra_args(false)->check(finite());
  verb.add_option("--sensor", command.sensors,
                  "take bias and noise (white, flicker, random walk, ramp) from this sensor file")
      ->type_name("FILE.toml")
      ->allow_extra_args(false);
  verb.add_option("--times", command.times_s, "after these times (default 1,10,60,3600)")
      ->type_name("S,S...")
      ->delimiter(',')
      ->check(not_negative());
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass budget --bias-mg 3 --times 1,10,60");
}

}  // namespace proofmass::app
