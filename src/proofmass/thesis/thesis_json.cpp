#include <algorithm>
#include <fmt/format.h>

#include "proofmass/report/json.hpp"
#include "proofmass/thesis/chapters.hpp"
#include "proofmass/thesis/comparison.hpp"
#include "proofmass/thesis/documents.hpp"

namespace proofmass::thesis {
namespace {

using report::Array;
using report::Object;
using report::Value;

std::string unit_of(const Finding& finding) {
  return finding.si_unit.empty() ? "1" : finding.si_unit;
}

Object printed(const Item& item) {
  Object values;
  for (const Finding& finding : item.findings)
    if (finding.thesis)
      values.push_back(
          {finding.key, Object{{"value", *finding.thesis}, {"unit", unit_of(finding)}}});
  return {{"text", item.thesis}, {"values", std::move(values)}};
}

Object found(const Item& item) {
  Object values;
  for (const Finding& finding : item.findings)
    values.push_back({finding.key, report::quantity(finding.ours, unit_of(finding))});
  return {{"text", item.ours}, {"values", std::move(values)}};
}

Object summary(const std::vector<Item>& items) {
  const Agreement all = agreement(items);
  return {{"items", static_cast<std::uint64_t>(items.size())},
          {"printed", static_cast<std::uint64_t>(all.printed)},
          {"compared", static_cast<std::uint64_t>(all.compared)},
          {"agreeing", static_cast<std::uint64_t>(all.agreeing)},
          {"alike", alike},
          {"alike_std", alike_std}};
}

// The reason of every null, with the name by which the document knows it.
std::vector<std::string> warnings_of(const ThesisReport& report) {
  std::vector<std::string> out = report::texts(report.notes, Severity::warning);
  for (const Item& item : report.programme.items)
    for (const Finding& finding : item.findings)
      if (!finding.ours || report::quantity(finding.ours, "").is_null())
        out.push_back(fmt::format("{}: {} ({}): {}", item.id, finding.key, finding.label,
                                  finding.reason.empty() ? "it is not finite" : finding.reason));
  return out;
}

}  // namespace

std::string thesis_json(const ThesisReport& report) {
  Array items;
  for (const Item& item : report.programme.items)
    items.push_back(Object{{"id", item.id},
                           {"title", item.title},
                           {"chapter", chapter_key(item)},
                           {"thesis", printed(item)},
                           {"ours", found(item)},
                           {"note", item.note}});
  return report::to_json({"thesis", report.inputs, warnings_of(report)},
                         {{"seed", report.seed},
                          {"runs", static_cast<std::uint64_t>(report.runs)},
                          {"simulated", report::array_of(report.programme.simulated)},
                          {"summary", summary(report.programme.items)},
                          {"items", std::move(items)}});
}

}  // namespace proofmass::thesis
