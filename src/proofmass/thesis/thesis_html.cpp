#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "proofmass/report/page.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/chapters.hpp"
#include "proofmass/thesis/comparison.hpp"
#include "proofmass/thesis/documents.hpp"
#include "proofmass/thesis/wording.hpp"

namespace proofmass::thesis {
namespace {

using report::Page;
using report::Section;
using report::Table;

std::string ours_or_not(const Finding& finding) {
  return finding.ours ? ours_words(finding) : "not to be told";
}

Table findings_table(const std::vector<Finding>& findings) {
  const bool printed = std::ranges::any_of(
      findings, [](const Finding& finding) { return finding.thesis.has_value(); });
  Table table{.caption = "", .head = {"", "Proofmass"}, .rows = {}, .stacks = true};
  if (printed) table.head = {"", "Thesis", "Proofmass", "Against it"};
  for (const Finding& finding : findings) {
    if (printed)
      table.rows.push_back({finding.label, finding.thesis ? thesis_words(finding) : "–",
                            ours_or_not(finding), against_words(finding)});
    else
      table.rows.push_back({finding.label, ours_or_not(finding)});
  }
  return table;
}

// "Time constant; bias: the recording is too short.": a reason often holds for several numbers.
std::vector<std::string> reasons(const std::vector<Finding>& findings) {
  std::vector<std::pair<std::string, std::string>> of;  // reason, labels
  for (const Finding& finding : findings) {
    if (finding.ours) continue;
    const auto same =
        std::ranges::find(of, finding.reason, [](const auto& one) { return one.first; });
    if (same == of.end())
      of.emplace_back(finding.reason, finding.label);
    else
      same->second += "; " + finding.label;
  }
  std::vector<std::string> out;
  out.reserve(of.size());
  for (const auto& [reason, labels] : of) out.push_back(labels + ": " + reason);
  return out;
}

Section part(const Item& item) {
  Section section{.heading = heading(item),
                  .id = item.id,
                  .gist = agreement_words(agreement(item)),
                  .sides = {{"The thesis", item.thesis}, {"Proofmass", item.ours}},
                  .points = reasons(item.findings),
                  .figures = report::plots(item.figures)};
  std::ranges::replace(section.id, ' ', '-');
  if (!item.note.empty()) section.sides.push_back({"Why, and what to take", item.note});
  if (!item.findings.empty()) section.tables.push_back(findings_table(item.findings));
  section.tables.insert(section.tables.end(), item.tables.begin(), item.tables.end());
  return section;
}

Section chapter_section(const Chapter& chapter) {
  Section section{.heading = chapter.title, .id = "chapter-" + chapter.key};
  for (const Item* item : chapter.items) section.parts.push_back(part(*item));
  return section;
}

std::vector<report::KeyFigure> key_figures(const std::vector<Item>& items) {
  const Agreement all = agreement(items);
  std::vector<report::KeyFigure> out{
      {"Numbers that agree", fmt::format("{} of {}", all.agreeing, all.compared)}};
  for (const Headline& one : headlines(items)) out.push_back({one.label, one.value});
  return out;
}

Section reading_section() {
  return {
      .heading = "How to read this",
      .paragraphs = {
          "The thesis is M. A. Lele, Evaluation of Solid State Accelerometer Sensor for "
          "Effective Position Estimation, M.A.Sc., Dalhousie University, 2010.",
          "Each table and figure has what the thesis prints on the left, what Proofmass finds "
          "for the same question on the right, and why the two differ, or that they agree, "
          "below. The table sets the numbers beside each other: a number of the thesis stands "
          "as it is printed, ours with its standard deviation where it has one. They agree where "
          "they differ by no more than 10 % or two of these standard deviations; those of a rig of "
          "one's own need not.",
          "Of the wheel there are two estimators throughout: the thesis's own filter with its "
          "slips mended, and a model of the wheel, which knows that gravity turns past the "
          "sensor and so gives the angle absolutely."}};
}

}  // namespace

std::string thesis_html(const ThesisReport& report) {
  const std::vector<Item>& items = report.programme.items;
  Page page{.verb = "thesis",
            .title = "The thesis, computed anew",
            .inputs = report.inputs,
            .conclusion = thesis_conclusion(items),
            .key_figures = key_figures(items),
            .notes = report.notes,
            .sections = {reading_section()},
            .contents = true,
            .numbered = false};
  const std::string simulated = simulated_words(report);
  if (!simulated.empty()) page.notes.push_back({Severity::info, simulated});
  for (const Chapter& chapter : chapters(items)) page.sections.push_back(chapter_section(chapter));
  return html(page);
}

}  // namespace proofmass::thesis
