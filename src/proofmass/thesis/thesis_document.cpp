#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/chapters.hpp"
#include "proofmass/thesis/comparison.hpp"
#include "proofmass/thesis/thesis_report.hpp"

namespace proofmass::thesis {
namespace {

using report::Document;
using report::Fields;
using report::Section;
using report::Table;
namespace field = report::field;

// "Table 2.1. Position error …".
std::string heading(const Item& item) {
  std::string text = item.id + ". " + item.title;
  if (!text.empty())
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string unit_of(const Finding& finding) {
  return finding.si_unit.empty() ? "1" : finding.si_unit;
}

report::Field named_values(Fields values, const char* meaning) {
  report::Field field = field::map("values", std::move(values), {.meaning = meaning});
  field.shape.pattern = "^[a-z][a-z0-9_]*$";
  return field;
}

Fields printed_fields(const Item& item) {
  Fields values;
  for (const Finding& finding : item.findings)
    if (finding.thesis)
      values.push_back(field::object(finding.key, {field::number("value", *finding.thesis),
                                                   field::text("unit", unit_of(finding))}));
  return {field::text("text", item.thesis, {.meaning = "statement of the thesis"}),
          named_values(std::move(values), "its printed numbers, by name")};
}

Fields our_fields(const Item& item) {
  Fields values;
  for (const Finding& finding : item.findings)
    values.push_back(field::measured(
        finding.key, finding.ours, unit_of(finding),
        {.why_null = finding.label + ": " +
                     (finding.reason.empty() ? "it is not finite" : finding.reason)}));
  return {field::text("text", item.ours, {.meaning = "our result"}),
          named_values(std::move(values), "the same numbers and further ones, by name")};
}

Fields item_fields(const Item& item) {
  report::Field id = field::text("id", item.id, {.meaning = "as in the thesis"});
  id.shape.pattern = "^(table|figure|section) ([2-6]|A)\\.\\d+$";
  return {std::move(id),
          field::text("title", item.title),
          field::choice("chapter", chapter_key(item), {"2", "3", "4", "5", "6", "A"}),
          field::object("thesis", printed_fields(item)),
          field::object("ours", our_fields(item)),
          field::text("note", item.note,
                      {.meaning = "why they differ, or that they agree; which result to use"})};
}

Fields summary_fields(const std::vector<Item>& items) {
  const Agreement all = agreement(items);
  return {field::count("items", items.size()),
          field::count("printed", all.printed, {.meaning = "numbers of the thesis"}),
          field::count("compared", all.compared, {.meaning = "of these, recomputed"}),
          field::count("agreeing", all.agreeing,
                       {.meaning = "of these, within `alike` of the printed value, or within "
                                   "`alike_std` standard deviations"}),
          field::magnitude("alike", alike),
          field::magnitude("alike_std", alike_std)};
}

Fields thesis_fields(const ThesisReport& report) {
  return {field::count("seed", report.seed, {.meaning = "of the simulation"}),
          field::count("runs", report.runs, {.meaning = "simulated at each speed"}),
          field::texts("simulated", report.programme.simulated,
                       {.meaning = "parts for which no recording was given"}),
          field::object("summary", summary_fields(report.programme.items)),
          field::records("items", report.programme.items, item_fields)};
}

Table findings_table(const std::vector<Finding>& findings) {
  const auto ours = [](const Finding& finding) {
    return finding.ours ? ours_words(finding) : std::string(report::absent);
  };
  const bool printed = std::ranges::any_of(
      findings, [](const Finding& finding) { return finding.thesis.has_value(); });
  Table table{.caption = "", .head = {"", "Proofmass"}, .rows = {}, .stacks = true};
  if (printed) table.head = {"", "Thesis", "Proofmass", "Difference"};
  for (const Finding& finding : findings) {
    if (printed)
      table.rows.push_back({finding.label, finding.thesis ? thesis_words(finding) : "–",
                            ours(finding), against_words(finding)});
    else
      table.rows.push_back({finding.label, ours(finding)});
  }
  return table;
}

// "Time constant; bias: the recording is too short.": a reason often holds for several numbers.
std::vector<std::string> reasons(const std::vector<Finding>& findings) {
  std::vector<std::pair<std::string, std::string>> labels;  // by reason
  for (const Finding& finding : findings) {
    if (finding.ours) continue;
    const auto same =
        std::ranges::find(labels, finding.reason, [](const auto& one) { return one.first; });
    if (same == labels.end())
      labels.emplace_back(finding.reason, finding.label);
    else
      same->second += "; " + finding.label;
  }
  std::vector<std::string> out;
  out.reserve(labels.size());
  for (const auto& [reason, of] : labels) out.push_back(of + ": " + reason);
  return out;
}

// The first number on which the two differ, else the first that can be compared, else the first of
// ours.
std::string most_telling(const Item& item) {
  const auto differs = [](const Finding& one) { return is_compared(one) && !agrees(one); };
  const auto is_known = [](const Finding& one) { return one.ours.has_value(); };
  auto found = std::ranges::find_if(item.findings, differs);
  if (found == item.findings.end()) found = std::ranges::find_if(item.findings, is_compared);
  if (found == item.findings.end()) found = std::ranges::find_if(item.findings, is_known);
  if (found == item.findings.end()) return {};
  const std::string printed = found->thesis ? thesis_words(*found) + " in the thesis, " : "";
  return fmt::format("{}: {}{}", found->label, printed,
                     ours_words(*found) + (found->thesis ? " ours" : ""));
}

// The first complete clause that fits.
std::string first_clause(const std::string& note, std::size_t most_letters) {
  for (const char* end : {". ", "; ", ": "}) {
    std::string clause = note.substr(0, note.find(end));
    if (clause.ends_with('.')) clause.pop_back();
    if (report::letters(clause) <= most_letters) return clause;
  }
  return {};
}

std::string digest(const Item& item) {
  constexpr std::size_t two_lines = 150;
  const std::string number = most_telling(item);
  const std::size_t taken = std::min(report::letters(number), two_lines);
  const std::string clause = first_clause(item.note, two_lines - taken);
  if (number.empty() && clause.empty()) return {};
  return number + (number.empty() || clause.empty() ? "" : ". ") + clause + '.';
}

Section part(const Item& item) {
  Section section{.heading = heading(item),
                  .id = item.id,
                  .gist = agreement_words(agreement(item)),
                  .digest = digest(item),
                  .sides = {{"The thesis", item.thesis}, {"Proofmass", item.ours}},
                  .points = reasons(item.findings),
                  .figures = report::plots(item.figures)};
  std::ranges::replace(section.id, ' ', '-');
  if (!item.note.empty()) section.sides.push_back({"Why, and which to use", item.note});
  if (!item.findings.empty()) section.tables.push_back(findings_table(item.findings));
  section.tables.insert(section.tables.end(), item.tables.begin(), item.tables.end());
  return section;
}

Section chapter_section(const Chapter& chapter) {
  Section section{.heading = chapter.title, .id = "chapter-" + chapter.key, .on_terminal = true};
  for (const Item* item : chapter.items) section.parts.push_back(part(*item));
  return section;
}

struct Headline {
  std::string_view id, key, label;
};

constexpr std::array<Headline, 4> headlines{{
    {"figure 5.17", "integrated", "Error after a turn: double integration"},
    {"figure 5.17", "thesis", "Filter of the thesis, smoothed"},
    {"figure 5.17", "wheel_smoothed", "Wheel model, smoothed"},
    {"figure 5.17", "wheel_datasheet", "With all errors of the datasheet"},
}};

std::vector<report::KeyFigure> figures_of(const std::vector<Item>& items) {
  const Agreement all = agreement(items);
  std::vector<report::KeyFigure> out{
      {"Numbers that agree", fmt::format("{} of {}", all.agreeing, all.compared)}};
  for (const auto& [id, key, label] : headlines) {
    const auto item = std::ranges::find(items, id, &Item::id);
    if (item == items.end()) continue;
    const auto finding = std::ranges::find(item->findings, key, &Finding::key);
    if (finding == item->findings.end() || !finding->ours) continue;
    out.push_back({std::string(label), ours_words(*finding)});
  }
  return out;
}

std::string conclusion(const ThesisReport& report) {
  const std::vector<Item>& items = report.programme.items;
  const Agreement all = agreement(items);
  const std::size_t lost = all.printed - all.compared;
  std::string words = fmt::format(
      "{} tables, figures and sections of the thesis, recomputed. They print {}: {} agree with "
      "ours, {} do not{}.",
      items.size(), report::count_words(all.printed, "number"), all.agreeing,
      all.compared - all.agreeing, lost > 0 ? fmt::format(", {} cannot be recomputed", lost) : "");
  if (!report.programme.simulated.empty())
    words += fmt::format(" Simulated on the thesis's rig, seed {}, {} at each speed: {}.",
                         report.seed, report::count_words(report.runs, "run"),
                         fmt::join(report.programme.simulated, ", "));
  if (!report.inputs.empty()) words += " Another rig need not agree with the thesis's.";
  return words;
}

Section reading_section() {
  return {
      .heading = "How to read this",
      .paragraphs = {
          "The thesis is M. A. Lele, Evaluation of Solid State Accelerometer Sensor for "
          "Effective Position Estimation, M.A.Sc., Dalhousie University, 2010.",
          "For each table and figure: the statement of the thesis on the left, the result of "
          "Proofmass for the same question on the right, and below why the two differ, or that "
          "they agree. The table compares the numbers: those of the thesis as printed, ours with "
          "a standard deviation where they have one. They agree if they differ by at most 10 % or "
          "two of these standard deviations; those of another rig need not.",
          "The wheel has two estimators throughout: the filter of the thesis with its errors "
          "corrected, and a model of the wheel, in which gravity rotates in the sensor frame and "
          "so determines the angle absolutely."}};
}

}  // namespace

Document describe(const ThesisReport& report) {
  Document document{.page = {.verb = "thesis",
                             .title = "The thesis, recomputed",
                             .inputs = report.inputs,
                             .conclusion = conclusion(report),
                             .key_figures = figures_of(report.programme.items),
                             .notes = report.notes,
                             .sections = {reading_section()},
                             .contents = true,
                             .numbered = false},
                    .fields = thesis_fields(report)};
  for (const Chapter& chapter : chapters(report.programme.items))
    document.page.sections.push_back(chapter_section(chapter));
  return document;
}

}  // namespace proofmass::thesis
