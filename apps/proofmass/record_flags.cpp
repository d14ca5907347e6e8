#include "flags.hpp"
#include "verb_flags.hpp"

namespace proofmass::app {
namespace {

void add_file_flags(CLI::App& verb, RecordCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Recording");
  };
  add("-o,--output", command.output.output, "FILE.mcap",
      "the recording (default: named by source and time)");
  add("--duration", command.duration_s, "S", "end after so long (default: at Ctrl-C)")
      ->check(positive());
  add("--rotate", command.rotate_s, "S", "begin a new file after so long: run.0001.mcap, …")
      ->check(positive());
  add("--rotate-mb", command.rotate_mb, "MB", "or after so much")->check(positive());
  CLI::Option* trigger = add("--trigger", command.trigger, "CHANNEL>LEVEL",
                             "keep only what is around a passing of this level, in the channel's "
                             "unit; < is downwards");
  add("--trigger-before", command.trigger_before_s, "S", "how much before it (default 1)")
      ->check(not_negative())
      ->needs(trigger);
  add("--trigger-after", command.trigger_after_s, "S", "and behind it (default 1)")
      ->check(not_negative())
      ->needs(trigger);
  verb.add_flag("--reconnect", command.reconnect,
                "wait for a source that is not there yet or has gone, and continue after a marked "
                "gap")
      ->group("Recording");
  add("--stall", command.stall_s, "S", "silence that is told (default 2)")->check(positive());
  add("--stall-end", command.stall_end_s, "S",
      "silence that is taken for a source that has gone (default 30)")
      ->check(positive());
}

void add_estimate_flags(CLI::App& verb, RecordCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Estimate");
  };
  CLI::Option* estimate =
      add("--estimate", command.estimate, "WHAT",
          "work out and record beside the samples: wheel (angle and speed), tilt (roll and pitch) "
          "or track (displacement)");
  estimate->check(CLI::IsMember({"wheel", "tilt", "track"}));
  add("--lag", command.lag_s, "S",
      "of the estimates that know what follows (default 0.25, of track 3)")
      ->check(not_negative())
      ->needs(estimate);
  add("--radius", command.radius_m, "M", "of the wheel's sensors, where known")
      ->check(positive())
      ->needs(estimate);
  add("--bandwidth", command.bandwidth_hz, "HZ",
      "-3 dB of the filter of the wheel's sensors, which delays the angle (default: of the "
      "--sensor file, or not known)")
      ->check(positive())
      ->needs(estimate);
  add("--axis", command.axis, "AXIS", "of the wheel's axle, or of the motion (default: found)")
      ->needs(estimate);
  add("--procedure", command.guide.procedure, "NAME",
      "be led through it: tumble, multi-position or static; then calibrate, or tell the noise")
      ->check(CLI::IsMember({"tumble", "multi-position", "static"}))
      ->excludes(estimate);
}

void add_guide_flags(CLI::App& verb, GuideFlags& flags) {
  CLI::Option* procedure = verb.get_option("--procedure");
  const auto add = [&](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Procedure")->needs(procedure);
  };
  add("--positions", flags.positions, "N",
      "in a turn of the table, or at least by hand (default 12)")
      ->check(CLI::Range(4, 360));
  add("--target-std", flags.target_std_mg, "MG",
      "how well readings of 1 g shall be calibrated (default 1)")
      ->check(positive());
  add("--minutes", flags.minutes, "MIN",
      "of static (default: until the noise shows its floor, 5 to 60)")
      ->check(positive());
  add("--update-sensor", flags.update_sensor, "FILE.toml", "write what is found into this file");
}

// Those of the input flags that make sense where samples are still to come.
void add_live_input_flags(CLI::App& verb, InputFlags& flags) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Input");
  };
  add("--rate", flags.rate_hz, "HZ", "ask the source for this sample rate (as rate= in SOURCE)")
      ->check(positive());
  add("--unit", flags.unit, "UNIT",
      "of channels whose unit the source does not know: g, mg, m/s2, V, mV or counts")
      ->check(CLI::IsMember({"g", "mg", "m/s2", "V", "mV", "counts"}))
      ->transform(unit_spelling());
  add("--channel", flags.channels, "NAME",
      "of the estimate and the procedure; may be repeated (default: all accelerometers). All "
      "channels are recorded")
      ->allow_extra_args(false);
  add_place_flags(verb, flags);
}

}  // namespace

void add_flags(CLI::App& app, RecordCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "record", "live samples to disk, from a device, the network, a pipe or the twin");
  CLI::Option* source =
      verb.add_option("SOURCE", command.source,
                      "such as sim:, serial:/dev/ttyACM0, iio:ip:HOST; - is standard input");
  source->type_name("");
  verb.add_flag("--list", command.list, "show what is there to record from, and all kinds of it")
      ->excludes(source);
  add_file_flags(verb, command);
  add_estimate_flags(verb, command);
  add_guide_flags(verb, command.guide);
  add_live_input_flags(verb, command.input);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass record --list\n"
      "  proofmass record sim: -o run.mcap --duration 60 --estimate wheel\n"
      "  proofmass record 'serial:/dev/ttyACM0?baud=115200' --unit g --reconnect\n"
      "  proofmass record 'iio:ip:192.168.0.7?rate=1000' --procedure multi-position");
}

void add_flags(CLI::App& app, RecoverCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "recover", "what is whole of a recording that was not closed, as a file that is");
  verb.add_option("FILE", command.file, "run.mcap.part, or any MCAP file that is damaged")
      ->type_name("")
      ->required();
  verb.add_option("-o,--output", command.output.output,
                  "where to (default: run.mcap of run.mcap.part, else run.recovered.mcap)")
      ->type_name("FILE.mcap")
      ->group("Output");
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass recover run.mcap.part");
}

}  // namespace proofmass::app
