#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Information needed to repeat a result: program, version, date, inputs and options.
namespace proofmass::report {

struct ProvenanceInput {
  std::string path;  ///< as the user named it, or of a file in a named folder
  std::optional<std::uint64_t> bytes{};
  std::string sha256{};  ///< 64 hexadecimal digits; empty where `bytes` is absent
  std::string reason{};  ///< reason if there is no checksum
};

struct Provenance {
  std::string command;                                       ///< can be pasted into a shell
  std::vector<std::pair<std::string, std::string>> options;  ///< flags in effect, with their
                                                             ///< values
  std::string date;                                          ///< UTC, "2026-11-24T12:45:50Z"
  std::string commit;                                        ///< of the source; empty if unknown
  std::string host;
  std::vector<ProvenanceInput> inputs;
};

/// A document of to_json() with "provenance" as its last member.
[[nodiscard]] std::string with_provenance(std::string document, const Provenance& provenance);

/// A page of html() with the provenance in its footer.
[[nodiscard]] std::string page_with_provenance(std::string page, const Provenance& provenance);

}  // namespace proofmass::report
