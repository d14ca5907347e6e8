#include <algorithm>
#include <fmt/format.h>

#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/chapters.hpp"
#include "proofmass/thesis/comparison.hpp"
#include "proofmass/thesis/documents.hpp"
#include "proofmass/thesis/wording.hpp"

namespace proofmass::thesis {
namespace {

// The first number on which the two differ, else the first that can be compared, else the first of
// ours.
std::string telling_number(const Item& item) {
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

// The first clause that says something on its own, if there is so much room for it.
std::string first_clause(const std::string& note, std::size_t most_letters) {
  for (const char* end : {". ", "; ", ": "}) {
    std::string clause = note.substr(0, note.find(end));
    if (clause.ends_with('.')) clause.pop_back();
    if (report::letters(clause) <= most_letters) return clause;
  }
  return {};
}

std::string lines(const Item& item) {
  const Agreement numbers = agreement(item);
  const std::string gist = numbers.compared > 0 ? " (" + agreement_words(numbers) + ")" : "";
  std::string text = fmt::format("  {}{}\n", heading(item), gist);
  constexpr std::size_t two_lines = 150;
  const std::string number = telling_number(item);
  const std::size_t taken = std::min(report::letters(number), two_lines);
  const std::string clause = first_clause(item.note, two_lines - taken);
  if (number.empty() && clause.empty()) return text;
  const std::string between = number.empty() || clause.empty() ? "" : ". ";
  return text + fmt::format("      {}{}{}.\n", number, between, clause);
}

}  // namespace

std::string thesis_text(const ThesisReport& report) {
  std::string text = thesis_conclusion(report.programme.items) + '\n';
  const std::string simulated = simulated_words(report);
  if (!simulated.empty()) text += simulated + '\n';
  if (!report.inputs.empty()) text += "A rig of one's own need not agree with the thesis's.\n";
  std::vector<std::vector<std::string>> rows;
  for (const Headline& one : headlines(report.programme.items))
    rows.push_back({one.label, one.value});
  if (!rows.empty()) text += '\n' + report::aligned(rows);
  for (const Chapter& chapter : chapters(report.programme.items)) {
    text += fmt::format("\n{}\n", chapter.title);
    for (const Item* item : chapter.items) text += lines(*item);
  }
  return text;
}

}  // namespace proofmass::thesis
