#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// What a laboratory needs to repeat a result: who computed it, when, from what and how.
namespace proofmass::report {

struct ProvenanceInput {
  std::string path;  ///< as the user named it, or of a file in a folder that was named
  std::optional<std::uint64_t> bytes{};
  std::string sha256{};  ///< 64 hexadecimal digits; empty where `bytes` is absent
  std::string reason{};  ///< why there is no sum
};

struct Provenance {
  std::string command;                                       ///< as it can be typed again
  std::vector<std::pair<std::string, std::string>> options;  ///< flags in force, with their values
  std::string date;                                          ///< UTC, "2026-11-24T12:45:50Z"
  std::string commit;                                        ///< of the source; empty: not known
  std::string host;
  std::vector<ProvenanceInput> inputs;
};

/// A document of to_json() with "provenance" as its last member.
[[nodiscard]] std::string with_provenance(std::string document, const Provenance& provenance);

/// A page of html() with the same in its footer.
[[nodiscard]] std::string page_with_provenance(std::string page, const Provenance& provenance);

}  // namespace proofmass::report
