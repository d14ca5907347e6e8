# Writes the current commit of SOURCE to OUT, empty if unknown, if OUT contains another.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE problem)
if(problem)
  set(commit "")
endif()
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [[
#pragma once

namespace proofmass::app {

inline constexpr const char* source_commit = "@commit@";

}  // namespace proofmass::app
]])
