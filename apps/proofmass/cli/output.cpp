#include "cli/output.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <utility>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/plain_text.hpp"
#include "cli/provenance.hpp"
#include "host.hpp"
#include "input/input.hpp"
#include "proofmass/core/new_file.hpp"
#include "proofmass/io/shown_text.hpp"
#include "proofmass/io/write_recording.hpp"
#include "proofmass/report/page/json.hpp"

namespace proofmass::app {
namespace {

[[noreturn]] void cannot_print(int error) {
  throw Failure(failed,
                fmt::format("standard output: cannot be written: {}: choose a location that "
                            "exists and has room",
                            std::strerror(error)));
}

// Removes control sequences line by line: names of files and channels may contain them.
std::string clean_lines(const std::string& text) {
  std::string out;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    out += io::clean_text(std::string_view(text).substr(begin, end - begin));
    if (end < text.size()) out += '\n';
    begin = end + 1;
  }
  return out;
}

bool is_bad(const Note& note) {
  return note.severity >= Severity::bad;
}

}  // namespace

void write_text(const std::string& path, const std::string& text, const OutputFlags& flags) {
  if (flags.host) {
    flags.host->texts.emplace_back(path, text);
    return;
  }
  without_interruption([&] {
    const Status written = write_file(path, text);
    if (!written) {
      throw Failure(failed,
                    written.error().message + ": choose a location that exists and has room");
    }
  });
}

void print_out(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    cannot_print(errno);
  }
}

void publish(const Results& results, const OutputFlags& flags) {
  if (flags.host) {
    flags.host->text = results.text();
    flags.host->json = results.json();
    if (results.html && flags.host->wants_page) flags.host->html = results.html();
    return;
  }
  const auto json = [&] {
    return report::with_provenance(results.json(), flags.invocation->provenance());
  };
  if (!flags.report.empty())
    write_text(flags.report,
               report::page_with_provenance(results.html(), flags.invocation->provenance()), flags);
  if (!flags.page.empty()) write_text(flags.page, results.page(), flags);
  if (!flags.json.empty() && flags.json != "-") write_text(flags.json, json(), flags);
  // Standard output receives only one of series, document and text.
  if (flags.output == "-") return;
  print_out(flags.json == "-" ? json() : shown_text(clean_lines(results.text())));
}

void publish(const report::Document& document, const OutputFlags& flags) {
  publish({.text = [&] { return report::to_text(document); },
           .json = [&] { return report::to_json(document); },
           .html = [&] { return report::to_html(document); },
           .page = [&] { return report::page_json(document.page); }},
          flags);
}

OutputFlags with_output(const OutputFlags& flags, const std::string& path) {
  OutputFlags other = flags;
  other.output = path;
  return other;
}

void write_series(Recording recording, const OutputFlags& flags, const io::WriteOptions& options) {
  const std::string& path = flags.output;
  if (flags.host) {
    flags.host->series.emplace_back(path, std::move(recording));
    return;
  }
  const auto write = [&] {
    io::WriteOptions all = options;
    all.duckdb_library = duckdb_library();
    const Status status = io::write_recording(recording, path, all);
    if (status) return;
    throw Failure(status_of(status.error(), Stage::writing), status.error());
  };
  // Standard output may be a pipe that blocks, and cannot be left half written like a file.
  if (path == "-") return write();
  without_interruption(write);
}

void hold_to_strict(const OutputFlags& flags, bool bad) {
  if (flags.strict && bad) {
    throw Failure(bad_data, "done, but the data are bad (--strict): see the notes");
  }
}

void finish(const report::Document& document,
            const std::function<Recording()>& series,
            const OutputFlags& flags) {
  if (!document.notes_in_text) show_notes(document.page.notes, "", flags);
  if (series && !flags.output.empty()) write_series(series(), flags);
  publish(document, flags);
  if (!document.failure.empty()) throw Failure(bad_input, document.failure);
  hold_to_strict(flags, document.bad || std::ranges::any_of(document.page.notes, is_bad));
}

}  // namespace proofmass::app
