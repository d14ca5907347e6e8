#include "recording.hpp"

#include <pybind11/stl.h>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/command_line.hpp"
#include "computing.hpp"
#include "errors.hpp"
#include "input/input.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/io/recording_in_memory.hpp"
#include "proofmass/report/inspect_report.hpp"
#include "proofmass/report/wording.hpp"
#include "words.hpp"

namespace py = pybind11;

namespace proofmass::python {
namespace {

using Doubles = py::array_t<double, py::array::c_style>;

std::span<const double> values_of(const Doubles& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

std::vector<double> copy_of(const Doubles& array) {
  const std::span values = values_of(array);
  return {values.begin(), values.end()};
}

// Keeps the array alive. Its last user may be a thread without the interpreter's lock.
Samples borrowed(const Doubles& array) {
  const std::shared_ptr<const Doubles> owner(new Doubles(array), [](const Doubles* last) {
    const py::gil_scoped_acquire lock;
    delete last;
  });
  return Samples::borrowed(values_of(array), owner);
}

// Reads as the command `inspect` does; its input flags are those of every verb.
Handle read(const std::vector<std::string>& words, const py::object& progress) {
  const app::Verb verb = parsed_verb(words);
  const std::string file = verb.files().read.front();
  Handle result;
  compute(progress, [&](const Progress& report) {
    result.recording = shared(app::load(file, *verb.input, report));
  });
  return result;
}

/// Name, unit and values.
using Column = std::tuple<std::string, std::string, Doubles>;

Handle of_arrays(const std::string& source,
                 const std::vector<Column>& columns,
                 const std::optional<Doubles>& times_s,
                 std::optional<std::int64_t> start_ns,
                 const std::vector<std::string>& words,
                 bool copy) {
  std::vector<Channel> channels;
  for (const auto& [name, unit, values] : columns) {
    Channel& channel = channels.emplace_back();
    channel.name = name;
    channel.values = copy ? Samples(copy_of(values)) : borrowed(values);
    if (unit.empty()) continue;
    const auto known = parse_unit(unit);
    if (!known) refuse(name + ": no unit \"" + unit + "\" is known");
    channel.unit = *known;
  }
  io::ArrayTimes times{.start_ns = start_ns, .column = "time"};
  if (times_s) times.stamps_s = copy_of(*times_s);
  const app::Verb verb = parsed_verb(words);
  Result<Recording> made = io::recording_of_arrays(std::move(channels), std::move(times),
                                                   app::read_options(*verb.input, {}));
  if (!made) throw ResultError(made.error().at(source));
  Recording recording = std::move(made).value();
  recording.source = source;
  return {shared(std::move(recording))};
}

py::array_t<double> times_of(const SharedRecording& recording) {
  const TimeBase& time = recording->time;
  if (!time.is_uniform())
    return view_of(time.stamps_s.data(), {static_cast<py::ssize_t>(time.stamps_s.size())},
                   recording);
  py::array_t<double> out(static_cast<py::ssize_t>(recording->samples()));
  double* at = out.mutable_data();
  for (std::size_t k = 0; k < recording->samples(); ++k) at[k] = time.at(k);
  out.attr("flags").attr("writeable") = false;
  return out;
}

py::dict state_of(const SharedRecording& recording) {
  py::dict state;
  py::list channels;
  for (const Channel& channel : recording->channels) {
    channels.append(
        py::make_tuple(channel.name,
                       py::make_tuple(static_cast<int>(channel.unit.quantity), channel.unit.to_si,
                                      channel.unit.offset_si, channel.unit.symbol),
                       py::array_t<double>(static_cast<py::ssize_t>(channel.values.size()),
                                           channel.values.data())));
  }
  const TimeBase& time = recording->time;
  py::list notes, labels;
  for (const Note& note : recording->notes) {
    py::list advice;
    for (const Advice& one : note.advice) advice.append(py::make_tuple(one.option, one.value));
    notes.append(py::make_tuple(static_cast<int>(note.severity), note.text, advice));
  }
  for (const Label& label : recording->labels)
    labels.append(py::make_tuple(label.text, label.first, label.last));
  state["source"] = recording->source;
  state["format"] = recording->format;
  state["channels"] = channels;
  state["time"] =
      py::make_tuple(static_cast<int>(time.source), time.channel, time.rate_hz, time.stamps_s,
                     time.start_ns, time.band_s, time.mended, time.mended_backwards);
  state["notes"] = notes;
  state["labels"] = labels;
  state["label_channel"] = recording->label_channel;
  state["first_line"] = recording->first_line;
  return state;
}

TimeBase time_from(const py::tuple& state) {
  TimeBase time;
  time.source = static_cast<TimeSource>(state[0].cast<int>());
  time.channel = state[1].cast<std::string>();
  time.rate_hz = state[2].cast<double>();
  time.stamps_s = state[3].cast<std::vector<double>>();
  time.start_ns = state[4].cast<std::optional<std::int64_t>>();
  time.band_s = state[5].cast<double>();
  time.mended = state[6].cast<std::size_t>();
  time.mended_backwards = state[7].cast<std::size_t>();
  return time;
}

SharedRecording from_state(const py::dict& state) {
  Recording recording;
  recording.source = state["source"].cast<std::string>();
  recording.format = state["format"].cast<std::string>();
  for (const py::handle item : state["channels"]) {
    const auto channel = item.cast<py::tuple>();
    const auto unit = channel[1].cast<py::tuple>();
    recording.channels.push_back(
        {channel[0].cast<std::string>(),
         {static_cast<Quantity>(unit[0].cast<int>()), unit[1].cast<double>(),
          unit[2].cast<double>(), unit[3].cast<std::string>()},
         copy_of(channel[2].cast<Doubles>())});
  }
  recording.time = time_from(state["time"].cast<py::tuple>());
  for (const py::handle item : state["notes"]) {
    const auto note = item.cast<py::tuple>();
    Note& made = recording.notes.emplace_back();
    made.severity = static_cast<Severity>(note[0].cast<int>());
    made.text = note[1].cast<std::string>();
    for (const auto& [option, value] :
         note[2].cast<std::vector<std::pair<std::string, std::string>>>())
      made.advice.push_back({option, value});
  }
  for (const py::handle item : state["labels"]) {
    const auto label = item.cast<py::tuple>();
    recording.labels.push_back(
        {label[0].cast<std::string>(), label[1].cast<std::size_t>(), label[2].cast<std::size_t>()});
  }
  recording.label_channel = state["label_channel"].cast<std::string>();
  recording.first_line = state["first_line"].cast<std::size_t>();
  return shared(std::move(recording));
}

py::object channel_of(const Handle& handle, const std::string& name) {
  const Channel* found = handle.recording->find(name);
  if (found == nullptr) return py::none();
  return view_of(found->values.data(), {static_cast<py::ssize_t>(found->values.size())},
                 handle.recording);
}

std::string word_of(Severity severity) {
  if (severity == Severity::bad) return "bad";
  return severity == Severity::warning ? "warning" : "info";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> words_of(const std::vector<Note>& notes) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Note& note : notes) out.emplace_back(word_of(note.severity), report::with_flags(note));
  return out;
}

SharedRecording shared(Recording recording) {
  return std::make_shared<Recording>(std::move(recording));
}

Recording taken(const Handle& handle, bool is_temporary) {
  if (is_temporary && handle.recording.use_count() == 1)
    return std::move(*std::const_pointer_cast<Recording>(handle.recording));
  return *handle.recording;
}

void add_recording(py::module_& module) {
  py::class_<Handle>(module, "Recording")
      .def_property_readonly("source", [](const Handle& h) { return h.recording->source; })
      .def_property_readonly("format", [](const Handle& h) { return h.recording->format; })
      .def_property_readonly("samples", [](const Handle& h) { return h.recording->samples(); })
      .def_property_readonly("rate_hz", [](const Handle& h) { return h.recording->time.rate_hz; })
      .def_property_readonly("duration_s",
                             [](const Handle& h) { return h.recording->duration_s(); })
      .def_property_readonly("start_ns", [](const Handle& h) { return h.recording->time.start_ns; })
      .def_property_readonly("is_uniform",
                             [](const Handle& h) { return h.recording->time.is_uniform(); })
      .def_property_readonly(
          "time_source",
          [](const Handle& h) { return report::time_source_name(h.recording->time.source); })
      .def_property_readonly("notes", [](const Handle& h) { return words_of(h.recording->notes); })
      .def_property_readonly("labels",
                             [](const Handle& h) {
                               std::vector<std::tuple<std::string, std::size_t, std::size_t>> out;
                               for (const Label& label : h.recording->labels)
                                 out.emplace_back(label.text, label.first, label.last);
                               return out;
                             })
      .def_property_readonly("channels",
                             [](const Handle& h) {
                               std::vector<std::string> names;
                               for (const Channel& channel : h.recording->channels)
                                 names.push_back(channel.name);
                               return names;
                             })
      .def_property_readonly("units",
                             [](const Handle& h) {
                               std::vector<std::string> units;
                               for (const Channel& channel : h.recording->channels)
                                 units.push_back(channel.unit.symbol);
                               return units;
                             })
      .def("time_s", [](const Handle& h) { return times_of(h.recording); })
      .def("channel", channel_of)
      .def("cut", [](const Handle& h, double from_s,
                     double to_s) { return Handle{shared(need(cut(*h.recording, from_s, to_s)))}; })
      .def(py::pickle([](const Handle& h) { return state_of(h.recording); },
                      [](const py::dict& state) { return Handle{from_state(state)}; }));
  module.def("read", read);
  module.def("of_arrays", of_arrays);
  module.def("is_unit", [](const std::string& text) { return parse_unit(text).has_value(); });
}

}  // namespace proofmass::python
