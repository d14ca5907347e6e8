#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/parquet/table.hpp"

// A verb's JSON document as rows of a table.
namespace proofmass::fleet {

/// Named fields, in the document's order.
using Row = std::vector<std::pair<std::string, io::parquet::TableCell>>;

struct InputSum {
  std::string path, sha256;
};

/// What a table keeps of a document.
struct DocumentRows {
  std::vector<Row> rows;         ///< one a channel, or one where there are no channels
  std::vector<InputSum> inputs;  ///< from its provenance
  std::string version, commit;
};

/// Every figure of a document under a name of its own: the keys on the way to it joined by "_",
/// without "value" and "parameters"; so "channels[].parameters.white.std" is "white_std" in the
/// channel's row. Pairs below an interval end in "_lower" and "_upper", other short lists of
/// figures in
/// "_1", "_2", …, methods and sensors in their place. Curves, spectra and other lists of objects
/// stay in the document. `channel` names the channel, `reason` says, in the document's own
/// warnings, what was not determined of it and why. Errors: corrupt (no document of Proofmass).
[[nodiscard]] Result<DocumentRows> rows_of_document(std::string_view document);

}  // namespace proofmass::fleet
