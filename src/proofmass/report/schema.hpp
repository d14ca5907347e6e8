#pragma once

#include <string>
#include <vector>

#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// JSON Schema (draft 2020-12) of the documents of one verb, from samples of them.
/// - An entry that every sample has is required, one that some have is optional, no other is
///   allowed.
/// - If a choice decides which entries there are (Shape::decides), those that every sample with a
///   given word has are required with that word.
/// - The samples together must have each entry, and an item in each list.
/// `name` is that of the schema if the verb has several.
[[nodiscard]] std::string json_schema(const std::string& description,
                                      const std::vector<Document>& samples,
                                      const std::string& name = {});

/// The same for a verb with documents of several kinds: one of them, each from its own samples.
[[nodiscard]] std::string json_schema_of_kinds(const std::string& description,
                                               const std::vector<std::vector<Document>>& kinds);

}  // namespace proofmass::report
