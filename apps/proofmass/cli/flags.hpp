#pragma once

#include <CLI/CLI.hpp>

#include "cli/common_flags.hpp"

// Flags common to several verbs, and checks of their values.
namespace proofmass::app {

/// A finite number accepted by `fits`; `expected` is for the message. CLI11's own checks print
/// bounds of 309 digits.
[[nodiscard]] CLI::Validator number(const char* expected, bool (*fits)(double));
[[nodiscard]] CLI::Validator positive();
[[nodiscard]] CLI::Validator finite();
[[nodiscard]] CLI::Validator not_negative();
[[nodiscard]] CLI::Validator latitude();
/// Accepts a unit in every spelling that this program and others print: m/s^2, m/s², counts as LSB.
[[nodiscard]] CLI::Validator unit_spelling();

void add_input_flags(CLI::App& verb, InputFlags& flags);
/// The subset for verbs without recordings: sensor file, supply and gravity.
void add_place_flags(CLI::App& verb, InputFlags& flags);
/// --memory, for verbs that can process a recording in pieces.
void add_memory_flag(CLI::App& verb, InputFlags& flags);

void add_switch_on_flag(CLI::App& verb, InputFlags& flags, const char* help);
void add_output_flags(CLI::App& verb, OutputFlags& flags);
void add_report_flag(CLI::App& verb, OutputFlags& flags);
/// --page, for verbs whose report is a report::Page.
void add_page_flag(CLI::App& verb, OutputFlags& flags);
CLI::Option* add_output_file(CLI::App& verb, OutputFlags& flags, const char* help);

inline constexpr const char* gravity_std_help =
    "standard deviation of gravity (default: 0 of --gravity, 4e-4 of --latitude, else 0.015)";

}  // namespace proofmass::app
