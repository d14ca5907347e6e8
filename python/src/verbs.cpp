#include <map>
#include <memory>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>
#include <utility>
#include <vector>

#include "cli/distinct_files.hpp"
#include "computing.hpp"
#include "host.hpp"
#include "module.hpp"
#include "recording.hpp"
#include "words.hpp"

namespace py = pybind11;

namespace proofmass::python {
namespace {

/// Inputs of the call that replace files.
struct Given {
  std::map<std::string, const Handle*> recordings;
  std::map<std::string, std::string> sensor_files;
  bool temporary = false;   ///< the recordings are not used elsewhere
  bool read_again = false;  ///< the verb may read one more than once
};

py::dict results_of(app::Host& host) {
  py::dict out;
  py::list series;
  for (auto& [name, recording] : host.series)
    series.append(py::make_tuple(name, Handle{shared(std::move(recording))}));
  out["json"] = py::bytes(host.json);
  out["text"] = host.text;
  out["html"] = host.html;
  out["notes"] = words_of(host.notes);
  out["series"] = series;
  out["texts"] = host.texts;
  return out;
}

py::dict run_verb(const std::vector<std::string>& words,
                  const Given& given,
                  const py::object& progress) {
  const app::Verb verb = parsed_verb(words);
  const auto host = std::make_shared<app::Host>();
  for (const auto& [name, handle] : given.recordings)
    host->recordings.emplace(name, taken(*handle, given.temporary));
  host->sensor_files = given.sensor_files;
  host->may_be_read_again = given.read_again;
  if (verb.input != nullptr) verb.input->host = host;
  verb.output->host = host;
  app::hold_apart(verb.files());
  compute(progress, [&](const Progress& report) {
    host->progress = report;
    verb.run();
  });
  return results_of(*host);
}

}  // namespace

void add_verbs(py::module_& module) {
  module.def("run", [](const std::vector<std::string>& words,
                       const std::map<std::string, const Handle*>& recordings,
                       const std::map<std::string, std::string>& sensor_files, bool temporary,
                       bool read_again, const py::object& progress) {
    return run_verb(words, {recordings, sensor_files, temporary, read_again}, progress);
  });
}

}  // namespace proofmass::python
