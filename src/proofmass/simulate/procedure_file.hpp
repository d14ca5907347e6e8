#pragma once

#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/simulate/procedure.hpp"

namespace proofmass::simulate {

/// Reads a description of that procedure (TOML). A key that is absent keeps its default. Angles in
/// degrees, coefficients of the model equation in the standard's units (g/g² and kin).
/// Errors: unreadable, corrupt (no TOML), invalid_argument (it is of another procedure, an unknown
/// key, a value of the wrong kind or one that check() refuses; the message names file, line and key
/// where there is one).
[[nodiscard]] Result<ProcedureOptions> read_procedure_file(const std::string& path,
                                                           Procedure procedure);

/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Result<ProcedureOptions> parse_procedure_file(std::string_view text,
                                                            std::string_view name,
                                                            Procedure procedure);

/// A description that reads back as the same options, with a comment on every key.
[[nodiscard]] std::string format_procedure_file(const ProcedureOptions& options);

}  // namespace proofmass::simulate
