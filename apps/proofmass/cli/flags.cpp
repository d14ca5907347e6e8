#include "cli/flags.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <string_view>
#include <utility>

namespace proofmass::app {

CLI::Validator number(const char* expected, bool (*fits)(double)) {
  const auto check = [expected, fits](std::string& text) -> std::string {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && stop == end && std::isfinite(value) && fits(value)) return {};
    return fmt::format("expected {}, not '{}'", expected, text);
  };
  return CLI::Validator(check, "");
}

CLI::Validator positive() {
  return number("a number above 0", [](double x) { return x > 0.0; });
}
CLI::Validator finite() {
  return number("a number", [](double) { return true; });
}
CLI::Validator not_negative() {
  return number("a number of 0 or more", [](double x) { return x >= 0.0; });
}
CLI::Validator latitude() {
  return number("degrees from -90 to 90", [](double x) { return std::abs(x) <= 90.0; });
}

CLI::Validator unit_spelling() {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 13> same{{
      {"m/s^2", "m/s2"},
      {"m/s\u00b2", "m/s2"},
      {"m/s**2", "m/s2"},
      {"m/s/s", "m/s2"},
      {"ms-2", "m/s2"},
      {"ms^-2", "m/s2"},
      {"m*s^-2", "m/s2"},
      {"mps2", "m/s2"},
      {"count", "counts"},
      {"LSB", "counts"},
      {"\u00b0/s", "deg/s"},
      {"dps", "deg/s"},
      {"rad*s^-1", "rad/s"},
  }};
  const auto spell = [same](std::string& text) -> std::string {
    for (const auto& [other, ours] : same)
      if (text == other) text = ours;
    return {};
  };
  return CLI::Validator(spell, "");
}

void add_input_flags(CLI::App& verb, InputFlags& flags) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Input");
  };
  add("--rate", flags.rate_hz, "HZ", "sample rate, if the file has no time column")
      ->check(positive());
  add("--unit", flags.unit, "UNIT",
      "unit of the accelerometer channels: g, mg, m/s2, V, mV or counts; of gyroscopes: deg/s or "
      "rad/s")
      ->check(CLI::IsMember({"g", "mg", "m/s2", "V", "mV", "counts", "deg/s", "rad/s"}))
      ->transform(unit_spelling());
  add("--channel", flags.channels, "NAME", "use this channel; may be repeated (default: all)")
      ->allow_extra_args(false);
  add("--dataset,--variable", flags.variables, "NAME",
      "dataset, variable, group, topic or file to read from a file or folder with several; may be "
      "repeated (default: chosen by size and name)")
      ->allow_extra_args(false);
  add("--time", flags.time, "NAME", "the time column (default: found by name and content)");
  add("--from", flags.from_s, "S", "start of the interval to use")->check(finite());
  add("--to", flags.to_s, "S", "end of the interval to use")->check(finite());
  add("--resample", flags.resample_hz, "HZ",
      "resample onto a uniform grid, also several --variable (default: as recorded)")
      ->check(positive());
  add("--resample-method", flags.resample_method, "METHOD",
      "of --resample: sinc (band-limited), cubic, linear, nearest or mean (default sinc)")
      ->check(CLI::IsMember({"sinc", "cubic", "linear", "nearest", "mean"}));
  add("--skew", flags.skew_s, "S",
      "correct a multiplexer skew of S seconds between successive channels")
      ->check(finite());
  add_place_flags(verb, flags);
}

void add_place_flags(CLI::App& verb, InputFlags& flags) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Input");
  };
  CLI::Option* sensor =
      add("--sensor", flags.sensors, "FILE.toml",
          "apply this sensor file's calibration first; once for all sensors or once for each");
  sensor->allow_extra_args(false);
  add("--supply", flags.supply_v, "V", "supply of the ratiometric sensor, instead of the file's")
      ->check(positive())
      ->needs(sensor);
  CLI::Option* gravity =
      add("--gravity", flags.gravity_mps2, "M_PER_S2", "local gravity (default 9.80665)");
  gravity->check(positive());
  CLI::Option* where =
      add("--latitude", flags.latitude_deg, "DEG", "compute gravity from the latitude");
  where->check(latitude())->excludes(gravity);
  add("--height", flags.height_m, "M", "height above the ellipsoid, for gravity")
      ->check(finite())
      ->needs(where);
}

void add_memory_flag(CLI::App& verb, InputFlags& flags) {
  verb.add_option("--memory", flags.memory_mb,
                  "a recording whose table is larger is read a piece at a time (default 1024)")
      ->type_name("MB")
      ->group("Input")
      ->check(not_negative());
}

void add_switch_on_flag(CLI::App& verb, InputFlags& flags, const char* help) {
  verb.add_option("--since-switch-on", flags.since_switch_on_s, help)
      ->type_name("S")
      ->group("Input")
      ->check(not_negative());
}

void add_output_flags(CLI::App& verb, OutputFlags& flags) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Output");
  };
  add("--json", flags.json, "FILE",
      "write the results as JSON; - is standard output, without the text");
  verb.add_flag("-q,--quiet", flags.quiet, "no warnings, notes or progress on stderr")
      ->group("Output");
  verb.add_flag("-v,--verbose", flags.verbose, "show details found while reading")->group("Output");
  verb.add_flag("--strict", flags.strict, "exit with status 5 if the data are bad")
      ->group("Output");
  // Parsed earlier, by config_path(); added here for --help.
  verb.add_option("--config", "read flags from this file")->type_name("FILE.toml")->group("Output");
}

void add_report_flag(CLI::App& verb, OutputFlags& flags) {
  verb.add_option("--report", flags.report, "write one self-contained page with the plots")
      ->type_name("FILE.html")
      ->group("Output");
}

void add_page_flag(CLI::App& verb, OutputFlags& flags) {
  verb.add_option("--page", flags.page, "write what the report shows, with its plots as numbers")
      ->type_name("FILE.json")
      ->group("Output");
}

CLI::Option* add_output_file(CLI::App& verb, OutputFlags& flags, const char* help) {
  return verb.add_option("-o,--output", flags.output, help)->type_name("FILE.csv")->group("Output");
}

}  // namespace proofmass::app
