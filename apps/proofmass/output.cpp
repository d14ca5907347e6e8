#include "output.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <unistd.h>

#include "console.hpp"
#include "exit_status.hpp"
#include "input.hpp"
#include "plain_text.hpp"
#include "proofmass/io/write_recording.hpp"
#include "provenance.hpp"

namespace proofmass::app {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void cannot_write(const std::string& path, int error) {
  throw Failure(failed,
                fmt::format("{}: cannot be written: {}: choose a place that exists and has room",
                            path, std::strerror(error)));
}

bool fill(const std::string& path, const std::string& text) {
  std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "wb"));
  if (!file) return false;
  if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) return false;
  return std::fclose(file.release()) == 0;
}

}  // namespace

void write_text(const std::string& path, const std::string& text) {
  const std::string part = fmt::format("{}.part{}", path, getpid());
  errno = 0;
  without_interruption([&] {
    if (fill(part, text) && std::rename(part.c_str(), path.c_str()) == 0) return;
    const int error = errno;
    std::remove(part.c_str());
    cannot_write(path, error);
  });
}

void print_out(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    cannot_write("standard output", errno);
  }
}

void publish(const Results& results, const OutputFlags& flags) {
  const auto json = [&] {
    return report::with_provenance(results.json(), flags.invocation->provenance());
  };
  if (!flags.report.empty())
    write_text(flags.report,
               report::page_with_provenance(results.html(), flags.invocation->provenance()));
  if (!flags.json.empty() && flags.json != "-") write_text(flags.json, json());
  // One thing only goes to standard output: the series, the document or the text.
  if (flags.output == "-") return;
  print_out(flags.json == "-" ? json() : shown_text(results.text()));
}

void write_series(const Recording& recording,
                  const std::string& path,
                  const io::WriteOptions& options) {
  const auto write = [&] {
    io::WriteOptions all = options;
    all.duckdb_library = duckdb_library();
    const Status status = io::write_recording(recording, path, all);
    if (status) return;
    throw Failure(status_of(status.error(), Stage::writing), status.error().message);
  };
  // Standard output may be a pipe that nobody empties; there is no file to leave half done.
  if (path == "-") return write();
  without_interruption(write);
}

void hold_to_strict(const OutputFlags& flags, bool bad) {
  if (flags.strict && bad) {
    throw Failure(bad_data, "done, but the data are bad (--strict): see the notes");
  }
}

}  // namespace proofmass::app
