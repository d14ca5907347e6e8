#pragma once

#include <CLI/CLI.hpp>

#include "cli/common_flags.hpp"

// Flags that several verbs have, and what their values may be.
namespace proofmass::app {

/// A finite number that fits; `expected` is for the message. CLI11's own print bounds of 309
/// digits.
[[nodiscard]] CLI::Validator number(const char* expected, bool (*fits)(double));
[[nodiscard]] CLI::Validator positive();
[[nodiscard]] CLI::Validator finite();
[[nodiscard]] CLI::Validator not_negative();
[[nodiscard]] CLI::Validator latitude();
/// Takes a unit in every spelling that the program and others print: m/s^2, m/s², counts as LSB.
[[nodiscard]] CLI::Validator unit_spelling();

void add_input_flags(CLI::App& verb, InputFlags& flags);
/// Of these the sensor file, its supply and gravity, of verbs that read no file.
void add_place_flags(CLI::App& verb, InputFlags& flags);
/// --memory, of verbs that can do with a piece of a recording at a time.
void add_memory_flag(CLI::App& verb, InputFlags& flags);

void add_switch_on_flag(CLI::App& verb, InputFlags& flags, const char* help);
void add_output_flags(CLI::App& verb, OutputFlags& flags);
void add_report_flag(CLI::App& verb, OutputFlags& flags);
/// --page, of verbs whose report is a report::Page.
void add_page_flag(CLI::App& verb, OutputFlags& flags);
CLI::Option* add_output_file(CLI::App& verb, OutputFlags& flags, const char* help);

inline constexpr const char* gravity_std_help =
    "standard deviation of gravity (default: 0 of --gravity, 4e-4 of --latitude, else 0.015)";

}  // namespace proofmass::app
