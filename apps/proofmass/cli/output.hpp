#pragma once

#include <functional>
#include <string>

#include "cli/common_flags.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/io/recording_writer.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::app {

/// write_file(), or Failure (failed).
void write_text(const std::string& path, const std::string& text, const OutputFlags& flags);

/// Writes to standard output. Throws Failure (failed) where that does not take it.
void print_out(const std::string& text);

/// The shapes of a verb's results, made only if they are asked for. `html` and `page` may be empty.
struct Results {
  std::function<std::string()> text, json, html, page = {};
};

/// Writes what the flags ask for: with `--json -` the document alone to standard output.
void publish(const Results& results, const OutputFlags& flags);

/// The same of a document.
void publish(const report::Document& document, const OutputFlags& flags);

/// io::write_recording to where --output says, or Failure.
void write_series(Recording recording,
                  const OutputFlags& flags,
                  const io::WriteOptions& options = {});

/// The flags with another --output: what is written beside it.
[[nodiscard]] OutputFlags with_output(const OutputFlags& flags, const std::string& path);

/// Throws Failure (bad_data) if --strict was given and the data are bad.
void hold_to_strict(const OutputFlags& flags, bool bad);

/// How a verb ends: notes, the time series (where it has one) if --output asks for it, the
/// document, --strict. Throws Failure, after a document without a result as bad_input.
void finish(const report::Document& document,
            const std::function<Recording()>& series,
            const OutputFlags& flags);

}  // namespace proofmass::app
