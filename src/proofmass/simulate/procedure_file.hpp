#pragma once

#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/simulate/procedure.hpp"

namespace proofmass::simulate {

/// Reads a description of the given procedure (TOML). An absent key has its default. Angles in
/// degrees, coefficients of the model equation in the standard's units (g/g² etc.).
/// Errors: unreadable, corrupt (not TOML), invalid_argument (a different procedure, an unknown key,
/// a value of the wrong type or rejected by check(); the message names file, line and key if there
/// is one).
[[nodiscard]] Result<ProcedureOptions> read_procedure_file(const std::string& path,
                                                           Procedure procedure);

/// The same from text; `name` is the file name in messages.
[[nodiscard]] Result<ProcedureOptions> parse_procedure_file(std::string_view text,
                                                            std::string_view name,
                                                            Procedure procedure);

/// A description that parses to the same options, with a comment on every key.
[[nodiscard]] std::string format_procedure_file(const ProcedureOptions& options);

}  // namespace proofmass::simulate
