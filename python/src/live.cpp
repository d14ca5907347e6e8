#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "module.hpp"
#include "proofmass/core/live_analysis.hpp"
#include "record/live_estimate.hpp"
#include "recording.hpp"
#include "words.hpp"

namespace py = pybind11;

namespace proofmass::python {
namespace {

using Doubles = py::array_t<double, py::array::c_style>;

/// An online estimator fed with samples.
class Live {
 public:
  Live(const std::vector<std::string>& words,
       const std::vector<std::pair<std::string, std::string>>& channels,
       double rate_hz) {
    auto command = parsed<app::RecordCommand>(words);
    command.output.quiet = true;
    acquire::SourceHead head;
    head.recording.source = "live";
    head.recording.time.rate_hz = rate_hz;
    head.recording.time.source = rate_hz > 0.0 ? TimeSource::given_rate : TimeSource::stamps;
    for (const auto& [name, unit] : channels) {
      const auto known = parse_unit(unit);
      if (!known) refuse(name + ": no unit \"" + unit + "\" is known");
      head.recording.channels.push_back({name, *known, {}});
    }
    const auto ignored = [](const std::vector<Channel>&) {};
    analysis_ = need(app::make_estimate(command, ignored, notes_)(head));
    rows_.channels.resize(analysis_->columns().size());
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::string>> columns() const {
    std::vector<std::pair<std::string, std::string>> out;
    for (const Channel& column : analysis_->columns())
      out.emplace_back(column.name, column.unit.symbol);
    return out;
  }

  /// Takes samples × channels with their times; returns rows × (1 + columns), the first column
  /// being time.
  [[nodiscard]] Doubles add(const Doubles& times_s, const Doubles& channels) {
    const auto count = static_cast<std::size_t>(times_s.size());
    std::vector<std::span<const double>> views;
    for (py::ssize_t c = 0; c < channels.shape(0); ++c)
      views.emplace_back(channels.data(c, 0), count);
    const Block block{seen_, {views.begin(), views.end()}, {times_s.data(), count}};
    seen_ += count;
    {
      const py::gil_scoped_release unlocked;
      (void)need(analysis_->add(block, rows_));
    }
    return take();
  }

  [[nodiscard]] Doubles finish() {
    (void)need(analysis_->finish(rows_));
    return take();
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::string>> take_notes() {
    std::vector<Note> notes = std::exchange(notes_, {});
    for (Note& note : analysis_->take_notes()) notes.push_back(std::move(note));
    return words_of(notes);
  }

 private:
  [[nodiscard]] Doubles take() {
    const std::size_t count = rows_.stamps_s.size(), width = 1 + rows_.channels.size();
    Doubles out({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(width)});
    double* to = out.mutable_data();
    for (std::size_t k = 0; k < count; ++k) {
      *to++ = rows_.stamps_s[k];
      for (const std::vector<double>& channel : rows_.channels) *to++ = channel[k];
    }
    rows_.clear();
    return out;
  }

  std::unique_ptr<LiveAnalysis> analysis_;
  std::vector<Note> notes_;
  Rows rows_;
  std::size_t seen_ = 0;
};

}  // namespace

void add_live(py::module_& module) {
  py::class_<Live>(module, "Live")
      .def(py::init<const std::vector<std::string>&,
                    const std::vector<std::pair<std::string, std::string>>&, double>())
      .def_property_readonly("columns", &Live::columns)
      .def("add", &Live::add)
      .def("finish", &Live::finish)
      .def("take_notes", &Live::take_notes);
}

}  // namespace proofmass::python
