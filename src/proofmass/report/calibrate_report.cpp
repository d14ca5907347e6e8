#include "proofmass/report/calibrate_report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/report/calibrate_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::Pose;
using calibrate::PoseResidual;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

const Unit& plain() {
  static const Unit unit{Quantity::unknown, 1.0, 0.0, "1"};
  return unit;
}

template <class Value>
void add(Recording& out, std::string name, const Unit& unit, std::size_t n, Value value) {
  std::vector<double> values;
  for (std::size_t k = 0; k < n; ++k) values.push_back(value(k));
  out.channels.push_back({std::move(name), unit, std::move(values)});
}

bool times_known(const CalibrateReport& report, std::size_t k) {
  return report.files[report.pose_file[k]].times_known;
}

}  // namespace

std::string calibrate_conclusion(const CalibrateReport& report) {
  std::string text = fmt::format("{}, {}: {}.", count_words(report.fit.poses.size(), "position"),
                                 model_words(report.fit.model), accuracy_words(report));
  for (const std::string& sentence : {lack_of_fit_sentence(report), doubtful_sentence(report)})
    if (!sentence.empty()) text += " " + sentence;
  const std::vector<std::string> suspects = suspect_sentences(report);
  constexpr std::size_t few = 2;
  for (std::size_t k = 0; k < std::min(suspects.size(), few); ++k) text += " " + suspects[k];
  if (suspects.size() > few) text += fmt::format(" So do {} more.", suspects.size() - few);
  return text;
}

std::string calibrate_text(const CalibrateReport& report) {
  std::string text = calibrate_conclusion(report) + "\n\n";
  std::vector<std::vector<std::string>> rows = figure_rows(report);
  text += aligned(rows) + '\n';
  rows = position_rows(report);
  constexpr std::size_t most_rows = 60;
  const std::size_t more = rows.size() > most_rows ? rows.size() - most_rows : 0;
  rows.resize(rows.size() - more);
  text += aligned(rows);
  if (more > 0)
    text += fmt::format("  … {} more: --output, --json and --report have them\n",
                        count_words(more, "position"));
  text += '\n';
  for (const std::string& sentence : calibrate_findings(report)) text += "  " + sentence + '\n';
  return text;
}

std::vector<Note> calibrate_notes(const CalibrateReport& report) {
  std::vector<Note> notes = report.notes;
  for (std::string& text : suspect_sentences(report))
    notes.push_back({Severity::bad, std::move(text)});
  if (std::string text = doubtful_sentence(report); !text.empty())
    notes.push_back({Severity::warning, std::move(text)});
  if (report.fit.lack_of_fit && report.fit.lack_of_fit->p < some_p)
    notes.push_back({Severity::warning, lack_of_fit_sentence(report)});
  // Where the residuals are rounding, a descent has nothing to come to an end by.
  constexpr double rounding_g = 1e-9;
  if (!report.fit.converged && report.fit.residual_rms_mps2 > rounding_g * report.fit.gravity_mps2)
    notes.push_back({Severity::bad, "the fit did not come to an end: do not use its figures"});
  if (report.check && !report.check->agrees && stds_known(report))
    notes.push_back({Severity::warning, "Monte Carlo: " + report.check->verdict});
  if (report.validation && report.validation->p && *report.validation->p < some_p)
    notes.push_back(
        {Severity::warning,
         fmt::format("new positions read {} rms away from gravity, {} were to be expected",
                     mg_words(report.validation->rms_mps2),
                     mg_words(report.validation->expected_rms_mps2))});
  for (const std::string& text : report.fit.notes) notes.push_back({Severity::warning, text});
  if (report.supply)
    for (const std::string& text : report.supply->notes) notes.push_back({Severity::warning, text});
  return notes;
}

Recording calibrate_series(const CalibrateReport& report) {
  Recording out;
  out.source = "proofmass calibrate";
  out.format = "series";
  const std::size_t n = report.poses.size();
  const Unit second = *parse_unit("s"), accel = *parse_unit("m/s^2");
  const std::vector<Pose>& poses = report.poses;
  const std::vector<PoseResidual>& residuals = report.fit.poses;
  add(out, "position", plain(), n, [](std::size_t k) { return static_cast<double>(k + 1); });
  add(out, "start", second, n, [&](std::size_t k) {
    return times_known(report, k) ? poses[k].start_s.value_or(none) : none;
  });
  add(out, "end", second, n,
      [&](std::size_t k) { return times_known(report, k) ? poses[k].end_s.value_or(none) : none; });
  constexpr const char* axes[] = {"x", "y", "z"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    add(out, std::string("mean_") + axes[i], report.unit, n,
        [&](std::size_t k) { return poses[k].mean(i); });
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    add(out, std::string("force_") + axes[i], accel, n,
        [&](std::size_t k) { return residuals[k].force_mps2(i); });
  }
  add(out, "residual", accel, n, [&](std::size_t k) { return residuals[k].residual_mps2; });
  add(out, "predicted_std", accel, n, [&](std::size_t k) {
    return residuals[k].predicted_std_mps2 > 0.0 ? residuals[k].predicted_std_mps2 : none;
  });
  add(out, "leave_one_out", accel, n,
      [&](std::size_t k) { return residuals[k].leave_one_out_mps2.value_or(none); });
  add(out, "suspect", plain(), n, [&](std::size_t k) { return residuals[k].suspect ? 1.0 : 0.0; });
  add(out, "used", plain(), n, [&](std::size_t k) { return residuals[k].used ? 1.0 : 0.0; });
  return out;
}

}  // namespace proofmass::report
