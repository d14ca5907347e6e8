# proofmass_tests(PROGRAM PREFIX prefix [LABELS labels...])
#
# Builds a program from its test sources and registers each test suite, as listed by the program, as
# one test of CTest: one process per suite instead of one per test, of which there are thousands.
function(proofmass_tests program)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "PREFIX" "LABELS")
  target_link_libraries(${program} PRIVATE GTest::gtest_main)
  target_compile_definitions(${program} PRIVATE PROOFMASS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  proofmass_compile_as(${program} test)
  set_target_properties(${program} PROPERTIES
    UNITY_BUILD ${PROOFMASS_UNITS} UNITY_BUILD_BATCH_SIZE 4)
  get_target_property(sources ${program} SOURCES)
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$") # replacements of parts of the language
  if(sources)
    set_source_files_properties(${sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${program}_suites.cmake)
  add_custom_command(TARGET ${program} POST_BUILD VERBATIM
    COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:${program}> -D PREFIX=${arg_PREFIX}
      "-D LABELS=${arg_LABELS}" -D LIST=${list} -P ${PROJECT_SOURCE_DIR}/cmake/list_suites.cmake)
  set(include ${CMAKE_CURRENT_BINARY_DIR}/${program}_include.cmake)
  file(CONFIGURE OUTPUT ${include} @ONLY CONTENT [[
if(EXISTS "@list@")
  include("@list@")
else()
  add_test(@program@_NOT_BUILT @program@_NOT_BUILT)
endif()
]])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${include})
endfunction()
