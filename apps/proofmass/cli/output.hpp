#pragma once

#include <functional>
#include <string>

#include "cli/common_flags.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/io/recording_writer.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::app {

/// write_file(); throws Failure (failed).
void write_text(const std::string& path, const std::string& text, const OutputFlags& flags);

/// Writes to standard output. Throws Failure (failed) on error.
void print_out(const std::string& text);

/// Renderers of a result, called only if needed. `html` and `page` may be empty.
struct Results {
  std::function<std::string()> text, json, html, page = {};
};

/// Writes the outputs requested by the flags: with `--json -` only the document to standard output.
void publish(const Results& results, const OutputFlags& flags);

/// The same for a document.
void publish(const report::Document& document, const OutputFlags& flags);

/// io::write_recording to the file of --output; throws Failure.
void write_series(Recording recording,
                  const OutputFlags& flags,
                  const io::WriteOptions& options = {});

/// The flags with another --output, for companion files.
[[nodiscard]] OutputFlags with_output(const OutputFlags& flags, const std::string& path);

/// Throws Failure (bad_data) if --strict was given and the data are bad.
void hold_to_strict(const OutputFlags& flags, bool bad);

/// End of a verb: notes, the time series (if any) for --output, the document, --strict. Throws
/// Failure; for a document without a result bad_input, after printing it.
void finish(const report::Document& document,
            const std::function<Recording()>& series,
            const OutputFlags& flags);

}  // namespace proofmass::app
