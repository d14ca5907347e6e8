# Writes to LIST the tests of CTest that run PROGRAM, one for each of its suites, called PREFIX.Suite.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listing
  COMMAND_ERROR_IS_FATAL ANY)
# A suite is at the beginning of its line, followed by a dot; its tests are indented below it.
string(REGEX MATCHALL "\n[A-Za-z0-9_/]+\\." suites "\n${listing}")
set(text)
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "[\n.]" "" suite "${suite}")
  set(test "[=[${PREFIX}.${suite}]=]")
  string(APPEND text "add_test(${test} [=[${PROGRAM}]=] --gtest_brief=1 [=[--gtest_filter=${suite}.*]=])\n")
  # A suite is skipped if none of its tests passed or failed.
  string(APPEND text "set_tests_properties(${test} PROPERTIES LABELS [=[${LABELS}]=]\n"
    "  SKIP_REGULAR_EXPRESSION [=[PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^\n]*\n)+$]=])\n")
endforeach()
file(WRITE ${LIST} "${text}")
