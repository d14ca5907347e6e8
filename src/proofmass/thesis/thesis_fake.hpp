#pragma once

#include "proofmass/thesis/thesis_report.hpp"

// Made-up items with known numbers, for the tests of this module.
namespace proofmass::thesis {

inline Finding fake_finding(std::string key,
                            std::optional<double> thesis,
                            std::optional<Uncertain> ours) {
  return {.key = std::move(key),
          .label = "Error <1>",
          .si_unit = "m",
          .shown = {"mm", 1e-3},
          .thesis = thesis,
          .ours = ours};
}

inline report::Figure fake_figure() {
  return {.title = "Error & time",
          .description = "It grows.",
          .x = {.label = "Time (s)"},
          .y = {.label = "Error (m)"},
          .curves = {{"ours", {0.0, 1.0, 2.0}, {0.0, 1.0, 4.0}}}};
}

/// Three items of two chapters: one equal number, one off by a factor, one that is not
/// determinable, and one of ours alone.
inline ThesisReport fake_report() {
  Finding lost = fake_finding("lost", 1.0, std::nullopt);
  lost.reason = "the recording is too short";
  ThesisReport report{.inputs = {"a<b.csv"}, .seed = 7, .runs = 50};
  report.notes = {{Severity::warning, "a<b.csv: 3 rows are missing"},
                  {Severity::info, "a<b.csv: separator ','"}};
  report.programme.simulated = {"static", "tumble"};
  report.programme.items = {
      {.id = "table 2.1",
       .title = "Position error",
       .thesis = "It prints <16> cells.",
       .ours = "The same.",
       .note = "They agree; the formula is ½ b t².",
       .findings = {fake_finding("after_1_s", 0.015, Uncertain{0.015, 0.0})}},
      {.id = "figure 5.13",
       .title = "Position",
       .thesis = "3.58 m.",
       .ours = "0.1 m.",
       .note = "",
       .findings = {fake_finding("at_2_s", 3.6, Uncertain{0.1, 0.001}), lost},
       .figures = {fake_figure(), fake_figure()}},
      {.id = "figure 5.19",
       .title = "Angle",
       .thesis = "A curve.",
       .ours = "Ours.",
       .note = "Ours has a band.",
       .findings = {fake_finding("rms", std::nullopt, Uncertain{0.002, 0.0001})}}};
  return report;
}

}  // namespace proofmass::thesis
