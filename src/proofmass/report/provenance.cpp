#include "proofmass/report/provenance.hpp"

#include <fmt/format.h>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/version.hpp"
#include "proofmass/report/json.hpp"
#include "proofmass/report/page/page.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

Object input_json(const ProvenanceInput& input) {
  if (!input.bytes) return {{"path", input.path}, {"reason", input.reason}};
  return {{"path", input.path}, {"bytes", *input.bytes}, {"sha256", input.sha256}};
}

Object provenance_json(const Provenance& provenance) {
  Object options;
  for (const auto& [name, value] : provenance.options) options.push_back({name, value});
  Array inputs;
  for (const ProvenanceInput& input : provenance.inputs) inputs.push_back(input_json(input));
  return {{"command", provenance.command}, {"options", std::move(options)},
          {"date", provenance.date},       {"version", version()},
          {"commit", provenance.commit},   {"host", provenance.host},
          {"inputs", std::move(inputs)}};
}

std::string indented(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c;
    if (c == '\n') out += "  ";
  }
  return out;
}

}  // namespace

std::string with_provenance(std::string document, const Provenance& provenance) {
  constexpr std::string_view end = "\n}\n";
  PM_EXPECTS(document.ends_with(end));
  document.resize(document.size() - end.size());
  return document + ",\n  \"provenance\": " + indented(json_text(provenance_json(provenance))) +
         std::string(end);
}

std::string page_with_provenance(std::string page, const Provenance& provenance) {
  constexpr std::string_view end = "</footer>";
  const std::size_t at = page.rfind(end);
  PM_EXPECTS(at != std::string::npos);
  std::string text = fmt::format(
      "<p>Command: <code>{}</code></p>\n<p>Evaluated {} on {}{}.</p>\n",
      escaped(provenance.command), escaped(provenance.date), escaped(provenance.host),
      provenance.commit.empty() ? "" : ", source at commit " + escaped(provenance.commit));
  for (const ProvenanceInput& input : provenance.inputs)
    text += input.bytes ? fmt::format("<p>{}: {} bytes, SHA-256 <code>{}</code></p>\n",
                                      escaped(input.path), grouped(*input.bytes), input.sha256)
                        : fmt::format("<p>{}: no checksum: {}</p>\n", escaped(input.path),
                                      escaped(input.reason));
  return page.insert(at, text);
}

}  // namespace proofmass::report
